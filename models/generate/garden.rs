//! Everything around the house: lawn, path, pond, fence, trees, bushes, grass and flowers.

use glam::{DQuat, DVec3};

use super::house::{DOOR, HALF};
use super::model::{Finish, MaterialId, Model, Part, Placement};
use super::plants::{broad_tree, conifer, flower, tuft};
use super::random::{Random, fractal_noise, noise};

/// Centre of the pond on the lawn.
const POND: (f64, f64) = (4.6, 7.2);
const POND_RADIUS: f64 = 1.7;

/// Adds the garden to `model`.
pub fn add_garden(model: &mut Model) {
    let lawn = model.material("lawn", [0.105, 0.20, 0.045], Finish::Matte);
    ground(model, lawn);
    path(model);
    pond(model);
    fence(model);
    trees(model);
    grass(model);
    flowers(model);
}

/// Height of the ground: flat around the house, hills beyond.
fn height(x: f64, z: f64) -> f64 {
    let distance = (x * x + z * z).sqrt();
    let t = ((distance - 13.0) / 40.0).clamp(0.0, 1.0);
    let hills = fractal_noise(DVec3::new(x, 0.0, z) / 26.0, 3, 8);
    let bumps = 0.03 * noise(DVec3::new(x, 0.0, z) / 1.5, 4);
    bumps + t * t * (3.0 - 2.0 * t) * (3.0 + 4.5 * hills)
}

fn ground(model: &mut Model, lawn: MaterialId) {
    let mut part = Part::new(lawn);
    // Finer near the house: the cells grow with the distance.
    let spread = |t: f64| {
        let s = 2.0 * t - 1.0;
        s * (12.0 + 78.0 * s.abs())
    };
    part.sheet(54, |u, v| {
        let (x, z) = (spread(u), -spread(v));
        DVec3::new(x, height(x, z), z)
    });
    model.add("lawn", vec![part]);
}

/// Middle of the path at `z`, along x.
fn path_x(z: f64) -> f64 {
    let t = z - HALF.1 - 1.3;
    DOOR + 0.02 * t * t + 0.25 * (0.9 * t).sin()
}

fn path(model: &mut Model) {
    let mut random = Random::new(31);
    let shades = [
        ("path stone", [0.36, 0.34, 0.31]),
        ("pale path stone", [0.46, 0.43, 0.38]),
        ("dark path stone", [0.25, 0.24, 0.24]),
    ];
    let meshes = shades.map(|(name, color)| {
        let material = model.material(name, color, Finish::Matte);
        let seed = model.meshes.len() as u64;
        model.mesh(name, vec![stone(material, seed)])
    });
    let mut places = [Vec::new(), Vec::new(), Vec::new()];
    let mut z = HALF.1 + 1.75;
    while z < 16.0 {
        for side in [-0.36, 0.36] {
            let x = path_x(z) + side + random.range(-0.06, 0.06);
            let at = DVec3::new(x, height(x, z) + 0.01, z + random.range(-0.12, 0.12));
            places[random.index(3)].push(Placement {
                translation: at,
                rotation: DQuat::from_rotation_y(random.angle()),
                scale: DVec3::new(0.38, 0.09, 0.31) * random.range(0.85, 1.08),
            });
        }
        z += 0.64;
    }
    for (mesh, places) in meshes.into_iter().zip(places) {
        model.place(mesh, places);
    }
}

/// A flat stone of radius 1.
fn stone(material: MaterialId, seed: u64) -> Part {
    let mut part = Part::new(material);
    part.sphere(2, |direction| {
        let bumps = noise(direction * 1.8, seed);
        // The top is flatter than a sphere's.
        let flat = DVec3::new(direction.x, direction.y.clamp(-0.6, 0.6), direction.z);
        flat * (1.0 + 0.16 * bumps)
    });
    part
}

fn pond(model: &mut Model) {
    let water = model.material("water", [0.30, 0.40, 0.42], Finish::Mirror);
    let rim = model.material("rim stone", [0.40, 0.39, 0.36], Finish::Matte);
    let mut surface = Part::new(water);
    let at = |angle: f64, radius: f64, y: f64| {
        let (sin, cos) = angle.sin_cos();
        let radius = radius * (1.0 + 0.12 * (2.0 * angle).sin());
        DVec3::new(POND.0 + 1.25 * radius * cos, y, POND.1 - 0.8 * radius * sin)
    };
    let corners: Vec<_> = (0..48)
        .map(|i| {
            at(
                std::f64::consts::TAU * f64::from(i) / 48.0,
                POND_RADIUS,
                0.06,
            )
        })
        .collect();
    surface.polygon(&corners);
    model.add("pond", vec![surface]);
    let mesh = model.mesh("rim stone", vec![stone(rim, 3)]);
    let mut random = Random::new(12);
    let places = (0..34).map(|i| Placement {
        translation: at(
            std::f64::consts::TAU * f64::from(i) / 34.0,
            POND_RADIUS + 0.06,
            0.04,
        ),
        rotation: DQuat::from_rotation_y(random.angle()),
        scale: DVec3::new(0.22, 0.15, 0.18) * random.range(0.75, 1.25),
    });
    let places = places.collect();
    model.place(mesh, places);
}

fn fence(model: &mut Model) {
    let paint = model.material("fence paint", [0.72, 0.71, 0.67], Finish::Matte);
    let mut picket = Part::new(paint);
    let outline = [
        (-0.045, 0.0),
        (0.045, 0.0),
        (0.045, 0.8),
        (0.0, 0.9),
        (-0.045, 0.8),
    ];
    picket.prism(
        &outline.map(|(x, y)| DVec3::new(x, y, 0.0)),
        DVec3::Z * 0.025,
    );
    let picket = model.mesh("picket", vec![picket]);
    let mut rails = Part::new(paint);
    let mut places = Vec::new();
    for (from, to) in [
        ((-8.0, 6.0), (-8.0, -5.0)),
        ((-8.0, -5.0), (8.5, -5.0)),
        ((8.5, -5.0), (8.5, 4.0)),
    ] {
        let (from, to) = (DVec3::new(from.0, 0.0, from.1), DVec3::new(to.0, 0.0, to.1));
        let along = (to - from).normalize();
        let inward = along.cross(DVec3::Y);
        for y in [0.25, 0.65] {
            rails.beam(from + DVec3::Y * y, to + DVec3::Y * y, 0.05);
        }
        let count = ((to - from).length() / 0.17) as u32;
        let angle = (-along.z).atan2(along.x);
        places.extend((0..count).map(|i| {
            let at = from + along * (0.17 * (f64::from(i) + 0.5)) + inward * 0.03;
            Placement::turned(at, angle, 1.0)
        }));
    }
    model.place(picket, places);
    model.add("rails", vec![rails]);
}

fn trees(model: &mut Model) {
    let bark = model.material("bark", [0.13, 0.085, 0.05], Finish::Matte);
    let dark = model.material("dark leaves", [0.05, 0.13, 0.025], Finish::Matte);
    let light = model.material("light leaves", [0.11, 0.20, 0.035], Finish::Matte);
    let needles = [
        model.material("needles", [0.02, 0.075, 0.035], Finish::Matte),
        model.material("young needles", [0.035, 0.105, 0.04], Finish::Matte),
    ];
    let stand = |x: f64, z: f64, angle: f64, size: f64| {
        Placement::turned(DVec3::new(x, height(x, z), z), angle, size)
    };
    let oak = model.mesh("tree", broad_tree(bark, [dark, light], 1));
    let places = [
        (-6.3, 3.6, 0.3, 1.05),
        (6.4, 0.4, 2.1, 1.0),
        (-11.0, -7.0, 4.0, 1.5),
        (13.0, -9.0, 1.0, 1.6),
        (-15.0, 3.0, 3.1, 1.4),
        // Beside the view, for its shadow.
        (12.2, 8.6, 5.0, 1.35),
    ];
    model.place(oak, places.map(|(x, z, a, s)| stand(x, z, a, s)).to_vec());
    let fir = model.mesh("fir", conifer(bark, needles, 22, 6));
    let mut random = Random::new(17);
    let mut firs = vec![
        stand(-5.6, -4.0, 0.5, 7.5),
        stand(5.8, -4.2, 1.5, 6.5),
        stand(-3.0, -6.5, 2.5, 9.0),
    ];
    while firs.len() < 46 {
        let (sin, cos) = random.range(3.4, 6.1).sin_cos();
        let distance = random.range(15.0, 48.0);
        let (x, z) = (1.5 * distance * cos, distance * sin);
        firs.push(stand(x, z, random.angle(), random.range(6.0, 12.0)));
    }
    model.place(fir, firs);
    let mut bush = broad_tree(bark, [light, dark], 2);
    // Only the crown, set down on the ground.
    bush.remove(0);
    for part in &mut bush {
        for p in &mut part.positions {
            *p = (*p - DVec3::Y * 2.3) * 0.4;
        }
    }
    let bush = model.mesh("bush", bush);
    let places = [
        (4.75, 2.3, 0.0, 1.0),
        (4.8, -0.9, 1.0, 0.8),
        (-4.7, 2.6, 2.0, 0.9),
        (-4.8, 0.8, 3.0, 1.1),
    ];
    model.place(bush, places.map(|(x, z, a, s)| stand(x, z, a, s)).to_vec());
}

/// Whether grass may grow there: not in the house, on the path or in the pond.
fn is_free(x: f64, z: f64) -> bool {
    let in_house = x.abs() < HALF.0 + 0.25 && z.abs() < HALF.1 + 0.25;
    let on_steps = (x - DOOR).abs() < 1.3 && (0.0..HALF.1 + 1.5).contains(&z);
    let on_path = z > HALF.1 && (x - path_x(z)).abs() < 0.85;
    let (px, pz) = ((x - POND.0) / 1.25, (z - POND.1) / 0.8);
    let in_pond = (px * px + pz * pz).sqrt() < 1.12 * POND_RADIUS + 0.3;
    !(in_house || on_steps || on_path || in_pond)
}

fn grass(model: &mut Model) {
    let mut random = Random::new(40);
    let shades = [
        ("grass", [0.13, 0.26, 0.05], 14),
        ("pale grass", [0.20, 0.29, 0.07], 11),
        ("dark grass", [0.08, 0.19, 0.035], 17),
    ];
    for (name, color, blades) in shades {
        let material = model.material(name, color, Finish::Matte);
        let seed = model.meshes.len() as u64;
        let mesh = model.mesh(name, vec![tuft(material, blades, seed)]);
        let mut places = Vec::new();
        while places.len() < 420 {
            let (x, z) = (random.range(-8.5, 9.5), random.range(-3.0, 13.5));
            if is_free(x, z) {
                let at = DVec3::new(x, height(x, z) - 0.01, z);
                places.push(Placement::turned(
                    at,
                    random.angle(),
                    random.range(0.8, 1.5),
                ));
            }
        }
        model.place(mesh, places);
    }
}

fn flowers(model: &mut Model) {
    let stalk = model.material("stalk", [0.07, 0.18, 0.03], Finish::Matte);
    let heart = model.material("flower heart", [0.75, 0.45, 0.02], Finish::Matte);
    let petals = [
        ("white petals", [0.80, 0.78, 0.76]),
        ("red petals", [0.65, 0.05, 0.05]),
        ("blue petals", [0.16, 0.16, 0.62]),
    ];
    let mut random = Random::new(23);
    for (name, color) in petals {
        let petal = model.material(name, color, Finish::Matte);
        let seed = model.meshes.len() as u64;
        let mesh = model.mesh("flower", flower(stalk, petal, heart, seed));
        let mut places = Vec::new();
        while places.len() < 26 {
            // A bed under the windows, and some on the lawn.
            let is_bed = places.len() < 18;
            let (x, z) = if is_bed {
                (random.range(-0.3, 4.0), random.range(3.3, 3.9))
            } else {
                (random.range(-6.0, 8.0), random.range(4.5, 12.0))
            };
            if is_free(x, z) {
                let at = DVec3::new(x, height(x, z), z);
                places.push(Placement::turned(
                    at,
                    random.angle(),
                    random.range(0.8, 1.25),
                ));
            }
        }
        model.place(mesh, places);
    }
}
