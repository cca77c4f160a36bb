//! Meshes to trace: those of the numerical cases, and a real one.

use std::path::PathBuf;

use glam::Vec3;
pub use halfshade::bench::Triangles as Mesh;
pub use halfshade::stress::meshes::*;

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
