//! Trees, bushes and grass, about the point where they leave the ground.

use glam::DVec3;

use super::model::{MaterialId, Part};
use super::random::Random;

/// A broad tree about 5 m high: a trunk with branches, and leaves in clumps around their ends.
/// The leaves are of two materials.
pub fn broad_tree(bark: MaterialId, leaves: [MaterialId; 2], seed: u64) -> Vec<Part> {
    let mut random = Random::new(seed);
    let mut wood = Part::new(bark);
    let mut foliage = leaves.map(Part::new);
    let fork = DVec3::new(random.range(-0.15, 0.15), 1.7, random.range(-0.15, 0.15));
    wood.tube(DVec3::Y * -0.2, DVec3::Y * 0.25, 0.30, 0.19, 10);
    wood.tube(DVec3::Y * 0.2, fork, 0.19, 0.13, 10);
    let clumps = 8;
    for i in 0..clumps {
        let (sin, cos) = (f64::from(i) * 2.4 + random.range(0.0, 0.5)).sin_cos();
        let out = if i == 0 { 0.0 } else { random.range(0.8, 1.3) };
        let rise = if i == 0 { 2.5 } else { random.range(0.9, 2.1) };
        let center = fork + DVec3::new(out * cos, rise, out * sin);
        wood.tube(fork - DVec3::Y * 0.1, center, 0.09, 0.02, 6);
        let radius = random.range(0.75, 1.05);
        for leaf in 0..160 {
            let side = usize::from(leaf % 3 == 0);
            let direction = random.direction();
            let depth = random.range(0.65, 1.0);
            let at = center + direction * radius * depth * DVec3::new(1.0, 0.8, 1.0);
            add_leaf(&mut foliage[side], at, direction, &mut random);
        }
    }
    let [dark, light] = foliage;
    vec![wood, dark, light]
}

/// A pointed leaf that looks outward, more or less.
fn add_leaf(part: &mut Part, at: DVec3, outward: DVec3, random: &mut Random) {
    let normal = (outward + 0.8 * random.direction() + 0.3 * DVec3::Y).normalize();
    let along = normal.cross(random.direction()).normalize();
    let across = normal.cross(along);
    let (length, width) = (random.range(0.13, 0.22), random.range(0.06, 0.1));
    part.polygon(&[
        at - along * length,
        at + across * width - along * 0.2 * length,
        at + along * length,
        at - across * width - along * 0.2 * length,
    ]);
}

/// A conifer of height 1, to be scaled: a trunk and layers of drooping boughs, `detail` boughs in
/// the lowest one.
pub fn conifer(bark: MaterialId, needles: [MaterialId; 2], detail: u32, seed: u64) -> Vec<Part> {
    let mut random = Random::new(seed);
    let mut wood = Part::new(bark);
    wood.tube(DVec3::Y * -0.05, DVec3::Y * 0.97, 0.035, 0.004, 7);
    let mut foliage = needles.map(Part::new);
    let layers = 14;
    for layer in 0..layers {
        let t = f64::from(layer) / f64::from(layers - 1);
        let (base, reach) = (0.13 + 0.82 * t, 0.25 * (1.0 - t) + 0.035);
        let boughs = (f64::from(detail) * (1.0 - 0.6 * t)).round() as u32;
        let turn = random.angle();
        for bough in 0..boughs {
            let angle = turn
                + std::f64::consts::TAU * f64::from(bough) / f64::from(boughs)
                + random.range(-0.15, 0.15);
            let length = reach * random.range(0.85, 1.1);
            let side = ((bough + layer) % 2) as usize;
            add_bough(&mut foliage[side], base, angle, length);
        }
    }
    let [dark, light] = foliage;
    vec![wood, dark, light]
}

/// A bough: two bent wings that meet in a ridge, from the trunk at height `base` outward.
fn add_bough(part: &mut Part, base: f64, angle: f64, length: f64) {
    let (sin, cos) = angle.sin_cos();
    let (out, side) = (DVec3::new(cos, 0.0, sin), DVec3::new(-sin, 0.0, cos));
    let width = 0.32 * length;
    let root = DVec3::Y * (base + 0.22 * length);
    let ridge = DVec3::Y * (base + 0.03 * length) + out * 0.55 * length;
    let tip = DVec3::Y * (base - 0.28 * length) + out * length;
    let low = DVec3::Y * (base - 0.14 * length) + out * 0.5 * length;
    for wing in [-1.0, 1.0] {
        let edge = low + side * (wing * width);
        let mut corners = [root, ridge, tip, edge];
        if wing > 0.0 {
            corners.reverse();
        }
        part.polygon(&[corners[0], corners[1], corners[3]]);
        part.polygon(&[corners[1], corners[2], corners[3]]);
    }
}

/// A tuft of `blades` blades of grass, each bent over by its own weight.
pub fn tuft(material: MaterialId, blades: u32, seed: u64) -> Part {
    let mut random = Random::new(seed);
    let mut part = Part::new(material);
    for _ in 0..blades {
        let (sin, cos) = random.angle().sin_cos();
        let lean = DVec3::new(cos, 0.0, sin);
        let side = DVec3::new(-sin, 0.0, cos) * random.range(0.006, 0.012);
        let height = random.range(0.10, 0.24);
        let foot = lean * random.range(0.0, 0.06);
        let knee = foot + DVec3::Y * (0.6 * height) + lean * (0.15 * height);
        let tip = foot + DVec3::Y * height + lean * (0.55 * height);
        part.polygon(&[
            foot - side,
            foot + side,
            knee + 0.7 * side,
            knee - 0.7 * side,
        ]);
        part.polygon(&[knee - 0.7 * side, knee + 0.7 * side, tip]);
    }
    part
}

/// A flower about 30 cm high: a stalk, petals and a heart.
pub fn flower(stalk: MaterialId, petal: MaterialId, heart: MaterialId, seed: u64) -> Vec<Part> {
    let mut random = Random::new(seed);
    let head = DVec3::new(random.range(-0.04, 0.04), random.range(0.24, 0.34), 0.03);
    let mut green = Part::new(stalk);
    green.beam(DVec3::ZERO, head, 0.012);
    let mut petals = Part::new(petal);
    for i in 0..7 {
        let (sin, cos) = (std::f64::consts::TAU * f64::from(i) / 7.0).sin_cos();
        let out = DVec3::new(cos, 0.35, sin) * 0.075;
        let side = DVec3::new(-sin, 0.0, cos) * 0.03;
        petals.polygon(&[
            head,
            head + 0.6 * out - side,
            head + out,
            head + 0.6 * out + side,
        ]);
    }
    let mut middle = Part::new(heart);
    middle.sphere(1, |direction| head + direction * 0.025 + DVec3::Y * 0.008);
    vec![green, petals, middle]
}
