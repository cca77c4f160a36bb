//! Many triangles: hills with boulders.

use glam::DVec3;

use super::model::{Finish, Model, Part, Placement};
use super::random::{Random, fractal_noise};

/// Half of the width of the hills, in metres.
const HALF_WIDTH: f64 = 200.0;

/// Height of the hills, in metres.
fn height(x: f64, z: f64) -> f64 {
    let p = DVec3::new(x, 0.0, z) / 90.0;
    let hills = fractal_noise(p, 8, 11);
    // A valley along z for the camera, with ridges on both sides.
    let valley = (x / 120.0).powi(2).min(1.0);
    14.0 + 26.0 * hills * (0.35 + 0.65 * valley) + 30.0 * valley
}

/// About a million triangles, each of its own: 960,000 of ground and 40 boulders of 1,280.
pub fn terrain() -> Model {
    let mut model = Model::default();
    let ground = model.material("ground", [0.32, 0.26, 0.17], Finish::Matte);
    let rock = model.material("rock", [0.42, 0.41, 0.39], Finish::Matte);
    let mut sheet = Part::new(ground);
    sheet.sheet(GROUND_CELLS, |u, v| {
        // u × v points up where v runs towards −z.
        let (x, z) = ((2.0 * u - 1.0) * HALF_WIDTH, (1.0 - 2.0 * v) * HALF_WIDTH);
        DVec3::new(x, height(x, z), z)
    });
    model.add("ground", vec![sheet]);
    let mut random = Random::new(5);
    for i in 0..40 {
        let (x, z) = (random.range(-60.0, 60.0), random.range(-40.0, 110.0));
        let size = random.range(0.8, 5.0);
        let mesh = model.mesh(format!("boulder {i}"), vec![boulder(rock, i)]);
        let center = DVec3::new(x, height(x, z) + 0.2 * size, z);
        model.place(mesh, vec![Placement::turned(center, random.angle(), size)]);
    }
    model
}

/// Cells along one side of the ground.
const GROUND_CELLS: u32 = 693;

fn boulder(material: usize, seed: u64) -> Part {
    let mut part = Part::new(material);
    part.sphere(3, |direction| {
        let bumps = fractal_noise(direction * 1.7, 4, 100 + seed);
        direction * DVec3::new(1.0, 0.75, 0.9) * (1.0 + 0.4 * bumps)
    });
    part
}
