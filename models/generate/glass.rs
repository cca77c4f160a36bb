//! Glass and mirrors on a chequered floor, in a ring of columns.

use glam::{DQuat, DVec3};

use super::model::{Finish, MaterialId, Model, Part, Placement};

/// Clear glass.
const GLASS: Finish = Finish::Glass(1.5);

/// A glass ball, a hollow one, a prism, a cube, two mirrors, and matte balls to be seen in them.
pub fn glass_and_mirrors() -> Model {
    let mut model = Model::default();
    floor(&mut model);
    let clear = model.material("clear glass", [1.0; 3], GLASS);
    let tinted = model.material("green glass", [0.55, 0.95, 0.75], GLASS);
    let mirror = model.material("mirror", [0.92; 3], Finish::Mirror);
    let steel = model.material("steel", [0.62, 0.64, 0.68], Finish::Mirror);
    model.add("glass ball", vec![ball(clear, (-0.75, 0.6, 0.9), 0.6)]);
    // A bubble: its inner surface is turned inside out, so that glass is between the two.
    let mut bubble = ball(clear, (1.5, 0.45, 1.35), 0.41);
    turn_inside_out(&mut bubble);
    model.add(
        "hollow ball",
        vec![ball(clear, (1.5, 0.45, 1.35), 0.45), bubble],
    );
    model.add("steel ball", vec![ball(steel, (0.75, 0.8, -0.75), 0.8)]);
    prism(&mut model, clear);
    cube(&mut model, tinted);
    wall_mirror(&mut model, mirror);
    matte_balls(&mut model);
    colonnade(&mut model);
    model
}

fn floor(model: &mut Model) {
    let light = model.material("light tile", [0.75, 0.73, 0.68], Finish::Matte);
    let dark = model.material("dark tile", [0.08, 0.09, 0.11], Finish::Matte);
    let mut parts = [Part::new(light), Part::new(dark)];
    for (i, j) in (0..576).map(|cell| (cell % 24, cell / 24)) {
        let (x, z) = (0.5 * f64::from(i) - 6.0, 0.5 * f64::from(j) - 6.0);
        parts[((i + j) % 2) as usize].polygon(&[
            DVec3::new(x, 0.0, z + 0.5),
            DVec3::new(x + 0.5, 0.0, z + 0.5),
            DVec3::new(x + 0.5, 0.0, z),
            DVec3::new(x, 0.0, z),
        ]);
    }
    model.add("floor", parts.into());
}

fn ball(material: MaterialId, center: (f64, f64, f64), radius: f64) -> Part {
    let mut part = Part::new(material);
    part.sphere(3, |direction| DVec3::from(center) + direction * radius);
    // The sphere's own normals, which its triangles only come near to.
    for (normal, p) in part.normals.iter_mut().zip(&part.positions) {
        *normal = (*p - DVec3::from(center)).normalize();
    }
    part
}

fn turn_inside_out(part: &mut Part) {
    part.faces.iter_mut().for_each(|face| face.reverse());
    part.normals
        .iter_mut()
        .for_each(|normal| *normal = -*normal);
}

fn prism(model: &mut Model, material: MaterialId) {
    let mut part = Part::new(material);
    let base = [(0.0, 0.0), (0.7, 0.0), (0.35, 0.606)].map(|(x, y)| DVec3::new(x, y, 0.0));
    part.prism(&base, DVec3::Z * 1.1);
    let mesh = model.mesh("prism", vec![part]);
    let place = Placement::turned(DVec3::new(0.05, 0.001, 1.35), 0.9, 1.0);
    model.place(mesh, vec![place]);
}

fn cube(model: &mut Model, material: MaterialId) {
    let mut part = Part::new(material);
    part.cuboid(DVec3::new(-0.35, 0.0, -0.35), DVec3::new(0.35, 0.7, 0.35));
    let mesh = model.mesh("cube", vec![part]);
    let place = Placement::turned(DVec3::new(-2.2, 0.001, 0.75), 0.5, 1.0);
    model.place(mesh, vec![place]);
}

/// A mirror that leans in its wooden frame behind the rest.
fn wall_mirror(model: &mut Model, material: MaterialId) {
    let wood = model.material("frame", [0.28, 0.13, 0.05], Finish::Matte);
    let (half, height, border) = (1.6, 2.3, 0.12);
    let mut glass = Part::new(material);
    glass.polygon(&[
        DVec3::new(-half, 0.0, 0.0),
        DVec3::new(half, 0.0, 0.0),
        DVec3::new(half, height, 0.0),
        DVec3::new(-half, height, 0.0),
    ]);
    let mut frame = Part::new(wood);
    for (min, max) in [
        ((-half - border, -border), (half + border, 0.0)),
        ((-half - border, height), (half + border, height + border)),
        ((-half - border, 0.0), (-half, height)),
        ((half, 0.0), (half + border, height)),
        ((-half, 0.0), (half, height)),
    ] {
        let is_back = (min.0, max.0) == (-half, half);
        let front = if is_back { -0.02 } else { 0.06 };
        frame.cuboid(
            DVec3::new(min.0, min.1, -0.06),
            DVec3::new(max.0, max.1, front),
        );
    }
    let mesh = model.mesh("wall mirror", vec![glass, frame]);
    let place = Placement {
        translation: DVec3::new(-1.2, border + 0.02, -2.2),
        rotation: DQuat::from_rotation_y(0.35) * DQuat::from_rotation_x(-0.06),
        scale: DVec3::ONE,
    };
    model.place(mesh, vec![place]);
}

fn matte_balls(model: &mut Model) {
    let red = model.material("red", [0.62, 0.06, 0.04], Finish::Glossy(0.25));
    let yellow = model.material("yellow", [0.75, 0.5, 0.06], Finish::Glossy(0.4));
    let blue = model.material("blue", [0.05, 0.13, 0.5], Finish::Matte);
    model.add("red ball", vec![ball(red, (-0.75, 0.3, -0.55), 0.3)]);
    model.add("yellow ball", vec![ball(yellow, (2.3, 0.35, 0.3), 0.35)]);
    model.add("blue ball", vec![ball(blue, (-1.35, 0.2, 1.75), 0.2)]);
}

/// Columns around the floor: something to be seen in mirrors and glass.
fn colonnade(model: &mut Model) {
    const COUNT: u32 = 14;
    const RADIUS: f64 = 5.7;
    const HEIGHT: f64 = 3.0;
    let marble = model.material("marble", [0.62, 0.55, 0.47], Finish::Matte);
    let (mut shafts, mut blocks) = (Part::new(marble), Part::new(marble));
    let at = |i: u32| {
        // The camera stands between two columns.
        let angle = std::f64::consts::TAU * (f64::from(i) + 0.65) / f64::from(COUNT);
        DVec3::new(RADIUS * angle.cos(), 0.0, RADIUS * angle.sin())
    };
    for i in 0..COUNT {
        let foot = at(i);
        shafts.tube(foot, foot + DVec3::Y * HEIGHT, 0.2, 0.16, 20);
        for (y, width, height) in [(0.0, 0.56, 0.16), (HEIGHT - 0.14, 0.5, 0.14)] {
            blocks.beam(foot + DVec3::Y * y, foot + DVec3::Y * (y + height), width);
        }
        let top = DVec3::Y * (HEIGHT + 0.15);
        blocks.beam(foot + top, at(i + 1) + top, 0.3);
    }
    model.add("colonnade", vec![shafts, blocks]);
}
