//! A half plane between a disk light and a receiver: the case with a closed form (see
//! `scenes/penumbra.toml`).

use glam::DVec3;

use super::model::{Finish, Model, Part};

/// Half of the width of receiver and blocker, in metres: for the light, without end.
const HALF_WIDTH: f64 = 50.0;
/// Height of the blocker above the receiver, in metres.
const BLOCKER_HEIGHT: f64 = 6.0;

/// The receiver is the plane y = 0, the blocker the half x < 0 of the plane y = 6.
pub fn penumbra() -> Model {
    let mut model = Model::default();
    let receiver = model.material("receiver", [0.8; 3], Finish::Matte);
    let blocker = model.material("blocker", [0.2; 3], Finish::Matte);
    model.add(
        "receiver",
        vec![sheet(receiver, 0.0, -HALF_WIDTH, HALF_WIDTH)],
    );
    model.add(
        "blocker",
        vec![sheet(blocker, BLOCKER_HEIGHT, -HALF_WIDTH, 0.0)],
    );
    model
}

fn sheet(material: usize, y: f64, x0: f64, x1: f64) -> Part {
    let mut part = Part::new(material);
    part.polygon(&[
        DVec3::new(x0, y, HALF_WIDTH),
        DVec3::new(x1, y, HALF_WIDTH),
        DVec3::new(x1, y, -HALF_WIDTH),
        DVec3::new(x0, y, -HALF_WIDTH),
    ]);
    part
}
