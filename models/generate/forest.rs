//! Very many triangles from one small mesh: a forest of one tree.

use glam::{DQuat, DVec3};

use super::model::{Finish, Model, Part, Placement};
use super::plants::conifer;
use super::random::{Random, fractal_noise};

/// Half of the width of the ground, in metres.
const HALF_WIDTH: f64 = 460.0;

/// Height of the ground, in metres: hills that rise with the distance from the camera.
fn height(x: f64, z: f64) -> f64 {
    let hills = fractal_noise(DVec3::new(x, 0.0, z) / 150.0, 3, 3);
    let rise = ((160.0 - z) / 250.0).clamp(0.0, 2.2);
    38.0 * hills * rise.min(1.0) + 16.0 * rise * rise
}

/// Hills, and a tree that is placed some 10,000 times: over 7 million triangles as rendered.
pub fn forest() -> Model {
    let mut model = Model::default();
    let ground = model.material("forest floor", [0.17, 0.19, 0.06], Finish::Matte);
    let bark = model.material("bark", [0.12, 0.07, 0.04], Finish::Matte);
    let dark = model.material("dark needles", [0.03, 0.11, 0.04], Finish::Matte);
    let light = model.material("light needles", [0.075, 0.17, 0.045], Finish::Matte);
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

/// Trees on a jittered lattice, so that none stand in each other, with clearings.
fn places() -> Vec<Placement> {
    const SIDE: u32 = 136;
    let mut random = Random::new(9);
    let cell = 2.0 * (HALF_WIDTH - 5.0) / f64::from(SIDE);
    let mut places = Vec::new();
    for i in 0..SIDE * SIDE {
        let mut along =
            |i: u32| (f64::from(i) + random.range(0.1, 0.9)) * cell - (HALF_WIDTH - 5.0);
        let (x, z) = (along(i % SIDE), along(i / SIDE));
        let density = fractal_noise(DVec3::new(x, 0.0, z) / 70.0, 3, 31);
        if density < -0.18 {
            continue;
        }
        let size = random.range(7.0, 13.0) * (1.0 + 0.5 * density);
        places.push(Placement {
            translation: DVec3::new(x, height(x, z) - 0.2, z),
            rotation: DQuat::from_rotation_y(random.angle()),
            scale: DVec3::new(size, size * random.range(0.9, 1.25), size),
        });
    }
    places
}
