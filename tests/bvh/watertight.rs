//! G1: nothing escapes from a closed mesh.

use glam::{Quat, Vec3};
use halfshade::bvh::Builder;
use halfshade::math::Ray;

use super::meshes::{Mesh, Random, sphere};

/// Directions from `center` at every vertex, edge midpoint, points of edges, and anywhere.
fn directions(mesh: &Mesh, center: Vec3, random: &mut Random) -> Vec<Vec3> {
    let mut directions: Vec<Vec3> = mesh.positions.iter().map(|p| p - center).collect();
    for triangle in 0..mesh.indices.len() {
        let corners = mesh.corners(triangle);
        for k in 0..3 {
            let (p, q) = (corners[k], corners[(k + 1) % 3]);
            let s = random.unit();
            directions.push(0.5 * (p - center) + 0.5 * (q - center));
            directions.push((1.0 - s) * (p - center) + s * (q - center));
        }
    }
    directions.extend((0..2000).map(|_| random.vector()));
    directions.retain(|d| *d != Vec3::ZERO);
    directions
}

fn escapes(mesh: &Mesh, center: Vec3) -> usize {
    let mut random = Random(1);
    let directions = directions(mesh, center, &mut random);
    mesh.trees()
        .iter()
        .filter(|(name, _)| !name.starts_with("none"))
        .map(|(name, tree)| {
            let escaped = |d: &&Vec3| {
                let ray = Ray::new(center, **d);
                assert_eq!(tree.closest_hit(&ray).is_some(), tree.any_hit(&ray));
                tree.closest_hit(&ray).is_none()
            };
            let escapes = directions.iter().filter(escaped).count();
            if escapes > 0 {
                println!("{escapes} of {} escape: {name}", directions.len());
            }
            escapes
        })
        .sum()
}

/// A closed box whose faces are grids with T-junctions: each face has its own number of cells.
fn box_with_t_junctions() -> Mesh {
    let mut mesh = Mesh::default();
    for face in 0..6 {
        let cells = 3 + face;
        let axis = face / 2;
        let side = if face % 2 == 0 { -1.0 } else { 1.0 };
        let point = |i: usize, j: usize| {
            let at = |i: usize| -1.0 + 2.0 * (i as f32 / cells as f32);
            let mut p = [side; 3];
            p[(axis + 1) % 3] = at(i);
            p[(axis + 2) % 3] = at(j);
            Vec3::from(p)
        };
        for (i, j) in (0..cells).flat_map(|i| (0..cells).map(move |j| (i, j))) {
            mesh.add([point(i, j), point(i + 1, j), point(i, j + 1)]);
            mesh.add([point(i + 1, j), point(i + 1, j + 1), point(i, j + 1)]);
        }
    }
    mesh
}

#[test]
fn nothing_escapes_at_any_scale_and_place() {
    for scale in [1e-6, 1.0, 1e6] {
        assert_eq!(
            escapes(&sphere(3).map(|p| scale * p), Vec3::ZERO),
            0,
            "scale {scale}"
        );
        for shift in [1e3, 1e4, 1e5, 1e6] {
            let center = scale * shift * Vec3::new(1.0, -0.7, 0.4);
            let mesh = sphere(3).map(|p| scale * p + center);
            assert_eq!(escapes(&mesh, center), 0, "scale {scale}, shift {shift}");
        }
    }
}

#[test]
fn nothing_escapes_from_a_flat_or_a_needle_shaped_body() {
    for shape in [Vec3::new(1.0, 1e-3, 1.0), Vec3::new(1e-4, 1.0, 1e-3)] {
        assert_eq!(
            escapes(&sphere(3).map(|p| shape * p), Vec3::ZERO),
            0,
            "{shape}"
        );
        let inside = 0.4 * shape * Vec3::new(0.9, -0.8, 0.7);
        assert_eq!(escapes(&sphere(2).map(|p| shape * p), inside), 0, "{shape}");
    }
}

#[test]
fn nothing_escapes_through_t_junctions() {
    let mesh = box_with_t_junctions();
    for center in [
        Vec3::ZERO,
        Vec3::new(0.9, -0.3, 0.99),
        Vec3::new(0.999, 0.999, -0.999),
    ] {
        assert_eq!(escapes(&mesh, center), 0, "{center}");
    }
}

/// Slanted triangles of all sizes, which spatial splits cut: a large box around, turned, some of
/// whose triangles are divided again and again.
#[test]
fn nothing_escapes_where_large_triangles_meet_small_ones() {
    let turn = Quat::from_rotation_x(0.3) * Quat::from_rotation_z(0.7);
    for scale in [1e-6, 1.0, 1e6] {
        let mut mesh = sphere(0);
        for round in 0..600 {
            let [a, b, c] = mesh.corners(mesh.indices.len() - 1 - round % 3);
            let at = mesh.indices.len() - 1 - round % 3;
            let middle = (a + b + c) / 3.0;
            let [i, j, k] = mesh.indices[at];
            let new = mesh.positions.len() as u32;
            mesh.positions.push(middle);
            mesh.indices[at] = [i, j, new];
            mesh.indices.extend([[j, k, new], [k, i, new]]);
        }
        let mesh = mesh.map(|p| scale * (turn * p));
        assert_eq!(escapes(&mesh, Vec3::ZERO), 0, "scale {scale}");
        let aside = scale * Vec3::new(0.3, -0.2, 0.4);
        assert_eq!(escapes(&mesh, aside), 0, "scale {scale}");
    }
}

#[test]
fn nothing_escapes_from_a_fan_of_needles() {
    // A double cone: 100,000 triangles meet at each tip.
    const SIDES: u32 = 100_000;
    let mut mesh = Mesh::default();
    mesh.positions.extend([Vec3::Z, Vec3::NEG_Z]);
    for i in 0..SIDES {
        let angle = std::f64::consts::TAU * f64::from(i) / f64::from(SIDES);
        mesh.positions
            .push(Vec3::new(angle.cos() as f32, angle.sin() as f32, 0.0));
    }
    for i in 0..SIDES {
        let (p, q) = (2 + i, 2 + (i + 1) % SIDES);
        mesh.indices.extend([[0, p, q], [1, q, p]]);
    }
    let mut random = Random(5);
    let directions = directions(&mesh, Vec3::ZERO, &mut random);
    let tree = mesh.tree(Builder::Balanced);
    let near = |d: &Vec3| d.x.hypot(d.y) < 1e-3;
    let chosen = directions
        .iter()
        .step_by(997)
        .chain(directions.iter().filter(|d| near(d)));
    let escaped = chosen.filter(|d| tree.closest_hit(&Ray::new(Vec3::ZERO, **d)).is_none());
    assert_eq!(escaped.count(), 0);
}
