//! Many triangles: hills with boulders.

use glam::DVec3;

use super::model::{Finish, Model, Part, Placement};
use super::random::{Random, fractal_noise};

/// Half of the width of the hills, in metres.
const HALF_WIDTH: f64 = 200.0;

/// Height of the ground, in metres: a valley along z between ridges.
fn height(x: f64, z: f64) -> f64 {
    let p = DVec3::new(x, 0.0, z);
    // Where the noise changes its sign there is a crest.
    let crests = 1.0 - 1.6 * fractal_noise(p / 110.0, 8, 11).abs();
    let floor = 1.5 * fractal_noise(p / 24.0, 6, 23);
    let bend = 14.0 * (z / 55.0).sin();
    let side = ((x - bend).abs() / 95.0).min(1.3);
    floor + side * side * (18.0 + 46.0 * crests)
}

/// About a million triangles, each of its own: 800,000 of ground and 40 boulders of 5,120.
pub fn terrain() -> Model {
    let mut model = Model::default();
    let ground = model.material("ground", [0.31, 0.24, 0.15], Finish::Matte);
    let rock = model.material("rock", [0.30, 0.29, 0.27], Finish::Matte);
    let mut sheet = Part::new(ground);
    sheet.sheet(GROUND_CELLS, |u, v| {
        // u × v points up where v runs towards −z.
        let (x, z) = ((2.0 * u - 1.0) * HALF_WIDTH, (1.0 - 2.0 * v) * HALF_WIDTH);
        DVec3::new(x, height(x, z), z)
    });
    model.add("ground", vec![sheet]);
    let mut random = Random::new(5);
    for i in 0..40 {
        let z = random.range(-60.0, 118.0);
        let x = 14.0 * (z / 55.0).sin() + random.range(-34.0, 34.0);
        let size = 0.7 + 3.6 * random.unit().powi(3);
        let mesh = model.mesh(format!("boulder {i}"), vec![boulder(rock, i)]);
        let center = DVec3::new(x, height(x, z) + 0.2 * size, z);
        model.place(mesh, vec![Placement::turned(center, random.angle(), size)]);
    }
    model
}

/// Cells along one side of the ground.
const GROUND_CELLS: u32 = 632;

fn boulder(material: usize, seed: u64) -> Part {
    let mut part = Part::new(material);
    part.sphere(4, |direction| {
        let bumps = fractal_noise(direction * 1.3, 6, 100 + seed);
        let cracks = fractal_noise(direction * 2.3, 5, 200 + seed).abs();
        direction * DVec3::new(1.0, 0.72, 0.85) * (0.9 + 0.35 * bumps + 0.3 * cracks)
    });
    part
}
