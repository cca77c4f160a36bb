//! Very many triangles from one small mesh: a forest of one tree.

use glam::{DQuat, DVec3};

use super::model::{Finish, Model, Part, Placement};
use super::plants::conifer;
use super::random::{Random, fractal_noise};

/// How many trees stand in the forest.
pub const TREES: usize = 13_000;

/// Half of the width of the ground, in metres.
const HALF_WIDTH: f64 = 420.0;

fn height(x: f64, z: f64) -> f64 {
    let hills = fractal_noise(DVec3::new(x, 0.0, z) / 180.0, 3, 3);
    // Flat where the camera is, higher in the distance.
    let rise = (-z / 200.0).clamp(0.0, 2.0);
    16.0 * hills * rise.min(1.0) + 18.0 * rise * rise
}

/// Hills, and a tree that is placed 13,000 times: over 7 million triangles as rendered.
pub fn forest() -> Model {
    let mut model = Model::default();
    let ground = model.material("forest floor", [0.13, 0.12, 0.05], Finish::Matte);
    let bark = model.material("bark", [0.12, 0.07, 0.04], Finish::Matte);
    let dark = model.material("dark needles", [0.02, 0.075, 0.03], Finish::Matte);
    let light = model.material("light needles", [0.045, 0.12, 0.035], Finish::Matte);
    let mut sheet = Part::new(ground);
    sheet.sheet(48, |u, v| {
        let (x, z) = ((2.0 * u - 1.0) * HALF_WIDTH, (1.0 - 2.0 * v) * HALF_WIDTH);
        DVec3::new(x, height(x, z), z)
    });
    model.add("ground", vec![sheet]);
    let tree = model.mesh("tree", conifer(bark, [dark, light], 18, 21));
    model.place_crowd(tree, places());
    model
}

/// Trees on a jittered lattice, so that none stand in each other.
fn places() -> Vec<Placement> {
    let mut random = Random::new(9);
    let side = (TREES as f64).sqrt().ceil() as usize;
    let cell = 2.0 * (HALF_WIDTH - 5.0) / side as f64;
    (0..TREES)
        .map(|i| {
            let mut along =
                |i: usize| (i as f64 + random.range(0.1, 0.9)) * cell - (HALF_WIDTH - 5.0);
            let (x, z) = (along(i % side), along(i / side));
            let size = random.range(7.0, 15.0);
            Placement {
                translation: DVec3::new(x, height(x, z) - 0.2, z),
                rotation: DQuat::from_rotation_y(random.angle()),
                scale: DVec3::new(size, size * random.range(0.9, 1.25), size),
            }
        })
        .collect()
}
