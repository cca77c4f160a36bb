//! The Cornell box with the measurements that Cornell University's Program of Computer Graphics
//! published (www.graphics.cornell.edu/online/box/data.html), in metres in place of millimetres.

use glam::DVec3;

use super::model::{Finish, MaterialId, Model, Part};
use super::spectra::{GREEN, RED, WHITE, reflectance};

/// The box, open towards the camera, with an opening in its ceiling where the light is.
pub fn cornell_box() -> Model {
    let mut model = Model::default();
    let white = model.material("white", reflectance(&WHITE), Finish::Matte);
    let red = model.material("red", reflectance(&RED), Finish::Matte);
    let green = model.material("green", reflectance(&GREEN), Finish::Matte);
    model.add("floor", quads(white, &FLOOR));
    model.add("ceiling", quads(white, &ceiling()));
    model.add("back wall", quads(white, &BACK_WALL));
    model.add("right wall", quads(green, &RIGHT_WALL));
    model.add("left wall", quads(red, &LEFT_WALL));
    model.add("short block", quads(white, &SHORT_BLOCK));
    model.add("tall block", quads(white, &TALL_BLOCK));
    model
}

type Quad = [[f64; 3]; 4];

fn quads(material: MaterialId, quads: &[Quad]) -> Vec<Part> {
    let mut part = Part::new(material);
    for quad in quads {
        part.polygon(&quad.map(|corner| DVec3::from(corner) / 1000.0));
    }
    vec![part]
}

/// The published ceiling is one quadrilateral with the light in its plane. Here its middle is
/// left open, so that nothing lies in the plane of the light.
fn ceiling() -> Vec<Quad> {
    const HEIGHT: f64 = 548.8;
    let (x, z) = ([0.0, 213.0, 343.0, 556.0], [0.0, 227.0, 332.0, 559.2]);
    let mut quads = Vec::new();
    for (i, j) in (0..9).map(|cell| (cell % 3, cell / 3)) {
        if (i, j) != (1, 1) {
            let at = |i: usize, j: usize| [x[i], HEIGHT, z[j]];
            quads.push([at(i + 1, j), at(i + 1, j + 1), at(i, j + 1), at(i, j)]);
        }
    }
    quads
}

const FLOOR: [Quad; 1] = [[
    [552.8, 0.0, 0.0],
    [0.0, 0.0, 0.0],
    [0.0, 0.0, 559.2],
    [549.6, 0.0, 559.2],
]];

const BACK_WALL: [Quad; 1] = [[
    [549.6, 0.0, 559.2],
    [0.0, 0.0, 559.2],
    [0.0, 548.8, 559.2],
    [556.0, 548.8, 559.2],
]];

const RIGHT_WALL: [Quad; 1] = [[
    [0.0, 0.0, 559.2],
    [0.0, 0.0, 0.0],
    [0.0, 548.8, 0.0],
    [0.0, 548.8, 559.2],
]];

const LEFT_WALL: [Quad; 1] = [[
    [552.8, 0.0, 0.0],
    [549.6, 0.0, 559.2],
    [556.0, 548.8, 559.2],
    [556.0, 548.8, 0.0],
]];

const SHORT_BLOCK: [Quad; 5] = [
    [
        [130.0, 165.0, 65.0],
        [82.0, 165.0, 225.0],
        [240.0, 165.0, 272.0],
        [290.0, 165.0, 114.0],
    ],
    [
        [290.0, 0.0, 114.0],
        [290.0, 165.0, 114.0],
        [240.0, 165.0, 272.0],
        [240.0, 0.0, 272.0],
    ],
    [
        [130.0, 0.0, 65.0],
        [130.0, 165.0, 65.0],
        [290.0, 165.0, 114.0],
        [290.0, 0.0, 114.0],
    ],
    [
        [82.0, 0.0, 225.0],
        [82.0, 165.0, 225.0],
        [130.0, 165.0, 65.0],
        [130.0, 0.0, 65.0],
    ],
    [
        [240.0, 0.0, 272.0],
        [240.0, 165.0, 272.0],
        [82.0, 165.0, 225.0],
        [82.0, 0.0, 225.0],
    ],
];

const TALL_BLOCK: [Quad; 5] = [
    [
        [423.0, 330.0, 247.0],
        [265.0, 330.0, 296.0],
        [314.0, 330.0, 456.0],
        [472.0, 330.0, 406.0],
    ],
    [
        [423.0, 0.0, 247.0],
        [423.0, 330.0, 247.0],
        [472.0, 330.0, 406.0],
        [472.0, 0.0, 406.0],
    ],
    [
        [472.0, 0.0, 406.0],
        [472.0, 330.0, 406.0],
        [314.0, 330.0, 456.0],
        [314.0, 0.0, 456.0],
    ],
    [
        [314.0, 0.0, 456.0],
        [314.0, 330.0, 456.0],
        [265.0, 330.0, 296.0],
        [265.0, 0.0, 296.0],
    ],
    [
        [265.0, 0.0, 296.0],
        [265.0, 330.0, 296.0],
        [423.0, 330.0, 247.0],
        [423.0, 0.0, 247.0],
    ],
];
