//! Meshes to trace: those of the numerical cases, a room, and a real one.

use std::path::PathBuf;

use glam::Vec3;
pub use halfshade::bench::Triangles as Mesh;
use halfshade::bvh::{Builder, Width};
pub use halfshade::stress::meshes::*;

#[test]
fn a_mesh_has_a_tree_of_every_builder_and_width() {
    let widths = Width::available();
    assert_eq!(widths[0], Width::Portable);
    let icosahedron = sphere(0);
    assert_eq!(icosahedron.indices.len(), 20);
    let trees = icosahedron.trees().len();
    assert_eq!(trees, Builder::ALL.len() * widths.len());
}

/// Large and small triangles: walls, slanted beams from wall to wall, needles, and balls on the
/// floor.
pub fn room() -> Mesh {
    let mut random = Random(61);
    let mut mesh = Mesh::default();
    let mut quad = |a: Vec3, u: Vec3, v: Vec3| {
        mesh.add([a, a + u, a + v]);
        mesh.add([a + u + v, a + v, a + u]);
    };
    for (u, v) in [(Vec3::X, Vec3::Y), (Vec3::Y, Vec3::Z), (Vec3::Z, Vec3::X)] {
        quad(-4.0 * Vec3::ONE, 8.0 * u, 8.0 * v);
        quad(4.0 * Vec3::ONE, -8.0 * u, -8.0 * v);
    }
    for _ in 0..120 {
        let (start, way) = (3.9 * random.vector(), 3.0 * random.vector());
        quad(start, way, 0.03 * random.vector());
        quad(start, 1e-5 * random.vector(), way);
    }
    for _ in 0..12 {
        let center = 3.5 * random.vector();
        let ball = sphere(3).map(|p| center + 0.3 * p);
        (0..ball.indices.len()).for_each(|i| mesh.add(ball.corners(i)));
    }
    mesh
}

/// The Stanford bunny of the project's model collection, where that is at hand.
pub fn bunny() -> Option<Mesh> {
    let models = std::env::var("HALFSHADE_MODELS").map_or_else(
        |_| PathBuf::from(concat!(env!("CARGO_MANIFEST_DIR"), "/../shared/models")),
        PathBuf::from,
    );
    let path = models.join("obj/stanford-bunny/stanford-bunny.obj");
    let Ok(text) = std::fs::read_to_string(&path) else {
        println!("skipped: no {}", path.display());
        return None;
    };
    let mut mesh = Mesh::default();
    for line in text.lines() {
        let mut words = line.split_whitespace();
        let kind = words.next();
        if kind == Some("v") {
            let mut next = || words.next().unwrap().parse().unwrap();
            mesh.positions.push(Vec3::new(next(), next(), next()));
        } else if kind == Some("f") {
            let mut next = || {
                let index = words.next().unwrap().split('/').next().unwrap();
                index.parse::<u32>().unwrap() - 1
            };
            mesh.indices.push([next(), next(), next()]);
        }
    }
    assert_eq!(mesh.indices.len(), 69451);
    Some(mesh)
}
