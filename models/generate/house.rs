//! The house: walls with openings, a tiled roof, windows, a door under a porch, a chimney.

use glam::{DQuat, DVec3};

use super::model::{Finish, MaterialId, Model, Part, Placement};
use super::random::Random;
use super::walls::Plate;

/// Half of the house along x and z, without the overhang of its roof, in metres.
pub const HALF: (f64, f64) = (4.0, 3.0);
/// Height of the floor and of the top of the walls, in metres.
const STOREY: (f64, f64) = (0.3, 3.2);
/// Height of the ridge, which runs along x, in metres.
const RIDGE: f64 = 5.5;
const THICKNESS: f64 = 0.3;
/// Where the door is, along x.
pub const DOOR: f64 = -1.7;

struct Materials {
    plaster: MaterialId,
    stone: MaterialId,
    timber: MaterialId,
    white: MaterialId,
    glass: MaterialId,
    door: MaterialId,
    brick: MaterialId,
    brass: MaterialId,
    curtain: MaterialId,
    floor: MaterialId,
}

impl Materials {
    fn new(model: &mut Model) -> Self {
        let mut matte = |name, color| model.material(name, color, Finish::Matte);
        Self {
            plaster: matte("plaster", [0.76, 0.68, 0.54]),
            stone: matte("plinth", [0.30, 0.28, 0.26]),
            timber: matte("timber", [0.16, 0.075, 0.03]),
            white: matte("white paint", [0.78, 0.77, 0.73]),
            brick: matte("brick", [0.36, 0.12, 0.07]),
            curtain: matte("curtain", [0.55, 0.10, 0.08]),
            floor: matte("floor boards", [0.34, 0.19, 0.09]),
            glass: model.material("glass", [0.93, 0.96, 0.96], Finish::Glass(1.5)),
            door: model.material("door", [0.06, 0.20, 0.17], Finish::Glossy(0.4)),
            brass: model.material("brass", [0.80, 0.55, 0.22], Finish::Mirror),
        }
    }
}

/// Adds the house to `model`, its door towards +z.
pub fn add_house(model: &mut Model) {
    let m = Materials::new(model);
    walls(model, &m);
    windows(model, &m);
    door(model, &m);
    porch(model, &m);
    roof(model, &m);
    chimney(model, &m);
}

/// Openings of the front wall as (x0, x1, y0, y1): the door and two windows.
const FRONT: [(f64, f64, f64, f64); 3] = [
    (DOOR - 0.55, DOOR + 0.55, 0.3, 2.4),
    (-0.1, 1.2, 1.15, 2.45),
    (1.9, 3.2, 1.15, 2.45),
];

/// Opening of the right wall as (z0, z1, y0, y1).
const SIDE: (f64, f64, f64, f64) = (-0.8, 0.8, 1.15, 2.45);

fn walls(model: &mut Model, m: &Materials) {
    let (hx, hz) = HALF;
    let (low, high) = STOREY;
    let mut plaster = Part::new(m.plaster);
    let mut plate = |origin, u, width, openings: &[(f64, f64, f64, f64)]| {
        Plate {
            origin,
            u,
            width,
            heights: STOREY,
            thickness: THICKNESS,
        }
        .add_to(&mut plaster, openings);
    };
    let front = FRONT.map(|(x0, x1, y0, y1)| (x0 + hx, x1 + hx, y0, y1));
    let (z0, z1, y0, y1) = SIDE;
    plate(DVec3::new(-hx, 0.0, hz), DVec3::X, 2.0 * hx, &front);
    plate(DVec3::new(hx, 0.0, -hz), -DVec3::X, 2.0 * hx, &[]);
    // The side walls stand between the front and the back.
    let inner = 2.0 * (hz - THICKNESS);
    let side = (hz - THICKNESS - z1, hz - THICKNESS - z0, y0, y1);
    plate(
        DVec3::new(hx, 0.0, hz - THICKNESS),
        -DVec3::Z,
        inner,
        &[side],
    );
    plate(DVec3::new(-hx, 0.0, THICKNESS - hz), DVec3::Z, inner, &[]);
    for x in [-hx, hx - THICKNESS] {
        let gable = [(high, hz), (RIDGE, 0.0), (high, -hz)];
        let corners = gable.map(|(y, z)| DVec3::new(x, y, z));
        plaster.prism(&[corners[0], corners[2], corners[1]], DVec3::X * THICKNESS);
    }
    plaster.cuboid(
        DVec3::new(-hx, high - 0.1, -hz) + DVec3::splat(0.02),
        DVec3::new(hx, high, hz) - DVec3::splat(0.02),
    );
    let mut plinth = Part::new(m.stone);
    plinth.cuboid(
        DVec3::new(-hx - 0.08, -0.3, -hz - 0.08),
        DVec3::new(hx + 0.08, low, hz + 0.08),
    );
    let mut floor = Part::new(m.floor);
    floor.cuboid(
        DVec3::new(THICKNESS - hx, low, THICKNESS - hz),
        DVec3::new(hx - THICKNESS, low + 0.02, hz - THICKNESS),
    );
    model.add("walls", vec![plaster, plinth, floor, timbers(m)]);
}

/// Dark beams on the corners, under the eaves and on the gable.
fn timbers(m: &Materials) -> Part {
    let (hx, hz) = HALF;
    let (low, high) = STOREY;
    let mut part = Part::new(m.timber);
    for (x, z) in [(-hx, hz), (hx, hz), (hx, -hz), (-hx, -hz)] {
        part.beam(DVec3::new(x, low, z), DVec3::new(x, high, z), 0.2);
    }
    let mut line = |from: (f64, f64, f64), to: (f64, f64, f64)| {
        part.beam(DVec3::from(from), DVec3::from(to), 0.14);
    };
    line((-hx, high - 0.1, hz), (hx, high - 0.1, hz));
    line((hx, high, -hz), (hx, high, hz));
    line((hx, high, 0.0), (hx, RIDGE - 0.15, 0.0));
    for z in [-1.0, 1.0] {
        line((hx, high, 2.0 * z), (hx, RIDGE - 0.75, 0.9 * z));
    }
    for x in [-2.9, -0.6, 1.55] {
        line((x, low, hz), (x, high - 0.1, hz));
    }
    part
}

fn windows(model: &mut Model, m: &Materials) {
    let (hx, hz) = HALF;
    let mesh = model.mesh("window", window(m, 1.3, 1.3));
    let front = FRONT[1..].iter();
    let front = front.map(|&(x0, _, y0, _)| Placement::at(DVec3::new(x0, y0, hz)));
    model.place(mesh, front.collect());
    let mesh = model.mesh("side window", window(m, 1.6, 1.3));
    let (_, z1, y0, _) = SIDE;
    let place = DVec3::new(hx, y0, z1);
    model.place(
        mesh,
        vec![Placement::turned(place, std::f64::consts::FRAC_PI_2, 1.0)],
    );
}

/// A window that fills an opening from (0, 0) to (width, height) of a wall whose outside is z = 0.
fn window(m: &Materials, width: f64, height: f64) -> Vec<Part> {
    let mut frame = Part::new(m.white);
    let mut bar = |x0: f64, y0: f64, x1: f64, y1: f64| {
        frame.cuboid(DVec3::new(x0, y0, -0.16), DVec3::new(x1, y1, -0.09));
    };
    let w = 0.07;
    bar(0.0, 0.0, w, height);
    bar(width - w, 0.0, width, height);
    bar(w, 0.0, width - w, w);
    bar(w, height - w, width - w, height);
    bar(0.5 * (width - w), w, 0.5 * (width + w), height - w);
    bar(w, 0.62 * height, 0.5 * (width - w), 0.62 * height + 0.05);
    bar(
        0.5 * (width + w),
        0.62 * height,
        width - w,
        0.62 * height + 0.05,
    );
    frame.cuboid(
        DVec3::new(-0.1, -0.07, -0.14),
        DVec3::new(width + 0.1, 0.0, 0.12),
    );
    let mut pane = Part::new(m.glass);
    pane.polygon(&[
        DVec3::new(w, w, -0.125),
        DVec3::new(width - w, w, -0.125),
        DVec3::new(width - w, height - w, -0.125),
        DVec3::new(w, height - w, -0.125),
    ]);
    vec![frame, pane, curtains(m, width, height)]
}

/// Two curtains in folds, drawn to the sides.
fn curtains(m: &Materials, width: f64, height: f64) -> Part {
    let mut part = Part::new(m.curtain);
    let fold = |x: f64| 0.035 * (x * 42.0).sin() - 0.4;
    for from in [-0.05, 0.8 * width] {
        for i in 0..14 {
            let step = (0.25 * width) / 14.0;
            let (x0, x1) = (from + step * f64::from(i), from + step * f64::from(i + 1));
            part.polygon(&[
                DVec3::new(x0, -0.1, fold(x0)),
                DVec3::new(x1, -0.1, fold(x1)),
                DVec3::new(x1, height + 0.1, fold(x1)),
                DVec3::new(x0, height + 0.1, fold(x0)),
            ]);
        }
    }
    part
}

fn door(model: &mut Model, m: &Materials) {
    let (_, hz) = HALF;
    let (x0, x1, y0, y1) = FRONT[0];
    let mut frame = Part::new(m.white);
    let mut post = |x0: f64, y0: f64, x1: f64, y1: f64| {
        frame.cuboid(DVec3::new(x0, y0, hz - 0.2), DVec3::new(x1, y1, hz - 0.05));
    };
    post(x0, y0, x0 + 0.08, y1);
    post(x1 - 0.08, y0, x1, y1);
    post(x0 + 0.08, y1 - 0.08, x1 - 0.08, y1);
    let mut leaf = Part::new(m.door);
    leaf.cuboid(
        DVec3::new(x0 + 0.08, y0, hz - 0.18),
        DVec3::new(x1 - 0.08, y1 - 0.08, hz - 0.12),
    );
    for (dx, dy, height) in [
        (0.16, 0.15, 0.7),
        (0.58, 0.15, 0.7),
        (0.16, 1.05, 0.8),
        (0.58, 1.05, 0.8),
    ] {
        let corner = DVec3::new(x0 + dx, y0 + dy, hz - 0.12);
        leaf.cuboid(corner, corner + DVec3::new(0.36, height, 0.025));
    }
    let mut knob = Part::new(m.brass);
    let center = DVec3::new(x1 - 0.16, y0 + 0.98, hz - 0.07);
    knob.sphere(2, |direction| center + direction * 0.04);
    model.add("door", vec![frame, leaf, knob]);
}

/// A little roof on two posts over the door, with two steps under it.
fn porch(model: &mut Model, m: &Materials) {
    let (_, hz) = HALF;
    let (x0, x1) = (DOOR - 0.95, DOOR + 0.95);
    let mut timber = Part::new(m.timber);
    for x in [x0 + 0.1, x1 - 0.1] {
        timber.beam(
            DVec3::new(x, 0.15, hz + 1.1),
            DVec3::new(x, 2.55, hz + 1.1),
            0.13,
        );
        timber.beam(DVec3::new(x, 2.5, hz), DVec3::new(x, 2.5, hz + 1.2), 0.11);
    }
    timber.beam(
        DVec3::new(x0, 2.58, hz + 1.1),
        DVec3::new(x1, 2.58, hz + 1.1),
        0.12,
    );
    timber.parallelepiped(
        DVec3::new(x0 - 0.15, 2.55, hz + 1.45),
        DVec3::X * (x1 - x0 + 0.3),
        DVec3::new(0.0, 0.5, -1.45),
        DVec3::new(0.0, 0.06, 0.02),
    );
    // What the lamp hangs from.
    timber.beam(
        DVec3::new(DOOR, 2.62, hz + 0.55),
        DVec3::new(DOOR, 2.4, hz + 0.55),
        0.03,
    );
    let mut steps = Part::new(m.stone);
    steps.cuboid(DVec3::new(x0, -0.2, hz), DVec3::new(x1, 0.27, hz + 0.75));
    steps.cuboid(
        DVec3::new(x0 - 0.2, -0.2, hz),
        DVec3::new(x1 + 0.2, 0.13, hz + 1.35),
    );
    model.add("porch", vec![timber, steps]);
    let tiles = tile_materials(model);
    let slope = Slope {
        corner: DVec3::new(x0 - 0.15, 2.63, hz + 1.47),
        across: DVec3::X * (x1 - x0 + 0.3),
        up: DVec3::new(0.0, 0.5, -1.45),
    };
    tile(model, tiles, &[slope], 77);
}

fn tile_materials(model: &mut Model) -> [MaterialId; 3] {
    const TILES: [(&str, [f64; 3]); 3] = [
        ("red tile", [0.36, 0.095, 0.045]),
        ("brown tile", [0.27, 0.085, 0.05]),
        ("pale tile", [0.44, 0.15, 0.075]),
    ];
    TILES.map(|(name, color)| {
        let known = model.materials.iter().position(|m| m.name == name);
        known.unwrap_or_else(|| model.material(name, color, Finish::Matte))
    })
}

fn roof(model: &mut Model, m: &Materials) {
    let (hx, hz) = HALF;
    let (overhang, eave) = (0.45, 0.55);
    let rise = (RIDGE - STOREY.1) / hz;
    let mut boards = Part::new(m.timber);
    let mut slopes = Vec::new();
    for side in [1.0, -1.0] {
        let corner = DVec3::new(
            -side * (hx + overhang),
            STOREY.1 - eave * rise,
            side * (hz + eave),
        );
        let across = DVec3::X * (side * 2.0 * (hx + overhang));
        let up = DVec3::new(0.0, RIDGE + 0.05, 0.0) - DVec3::new(0.0, corner.y, corner.z);
        let out = across.cross(up).normalize();
        boards.parallelepiped(corner, across, up, out * 0.1);
        slopes.push(Slope {
            corner: corner + out * 0.11,
            across,
            up,
        });
    }
    model.add("roof boards", vec![boards]);
    let tiles = tile_materials(model);
    tile(model, tiles, &slopes, 7);
    let mut ridge = Part::new(tiles[1]);
    let (from, to) = (-hx - overhang, hx + overhang);
    for i in 0..22 {
        let step = (to - from) / 22.0;
        let at = |x: f64, y: f64| DVec3::new(x, RIDGE + 0.12 + y, 0.0);
        let x = from + step * f64::from(i);
        ridge.tube(at(x - 0.03, 0.0), at(x + step, 0.02), 0.15, 0.13, 12);
    }
    model.add("ridge", vec![ridge]);
}

/// A parallelogram to be covered with tiles: its lower corner, its lower edge, and the way up.
struct Slope {
    corner: DVec3,
    across: DVec3,
    up: DVec3,
}

/// Covers slopes with rows of tiles that overlap the row below.
fn tile(model: &mut Model, materials: [MaterialId; 3], slopes: &[Slope], seed: u64) {
    const SIZE: (f64, f64, f64) = (0.37, 0.52, 0.035);
    let mut random = Random::new(seed);
    let meshes = materials.map(|material| {
        let mut part = Part::new(material);
        part.cuboid(DVec3::ZERO, DVec3::new(0.95 * SIZE.0, SIZE.1, SIZE.2));
        model.mesh("tile", vec![part])
    });
    let mut places = [Vec::new(), Vec::new(), Vec::new()];
    for slope in slopes {
        let (right, up) = (slope.across.normalize(), slope.up.normalize());
        let axes = glam::DMat3::from_cols(right, up, right.cross(up));
        let columns = (slope.across.length() / SIZE.0).round();
        let rows = (slope.up.length() / 0.38).round();
        let (width, height) = (slope.across.length() / columns, slope.up.length() / rows);
        for row in 0..rows as u32 {
            // Every other row is moved by half a tile; half tiles close its ends.
            let shift = 0.5 * f64::from(row % 2);
            for column in 0..columns as u32 + row % 2 {
                let left = (f64::from(column) - shift).max(0.0);
                let right_end = (f64::from(column + 1) - shift).min(columns);
                let corner = slope.corner
                    + right * (left * width)
                    + up * (f64::from(row) * height + random.range(-0.012, 0.012));
                // The lower end rests on the row below.
                let tilt = DQuat::from_rotation_x(-0.075 + random.range(-0.008, 0.008));
                places[random.index(3)].push(Placement {
                    translation: corner + right.cross(up) * 0.035,
                    rotation: DQuat::from_mat3(&axes) * tilt,
                    scale: DVec3::new((right_end - left) * width / SIZE.0, 1.0, 1.0),
                });
            }
        }
    }
    for (mesh, places) in meshes.into_iter().zip(places) {
        model.place(mesh, places);
    }
}

fn chimney(model: &mut Model, m: &Materials) {
    let mut brick = Part::new(m.brick);
    let (min, max) = (DVec3::new(1.7, 3.4, -1.35), DVec3::new(2.5, 6.3, -0.65));
    brick.cuboid(min, max);
    let mut stone = Part::new(m.stone);
    let margin = DVec3::new(0.1, 0.0, 0.1);
    stone.cuboid(
        DVec3::new(min.x, max.y, min.z) - margin,
        DVec3::new(max.x, max.y + 0.12, max.z) + margin,
    );
    let mut pots = Part::new(m.brick);
    for x in [1.95, 2.25] {
        let foot = DVec3::new(x, max.y + 0.1, -1.0);
        pots.tube(foot, foot + DVec3::Y * 0.42, 0.13, 0.1, 14);
    }
    model.add("chimney", vec![brick, stone, pots]);
}
