//! The models of this project, made from nothing but numbers; see `models/SOURCES.md`.

mod buffer;
mod cornell;
mod forest;
mod garden;
mod glass;
mod gltf;
mod house;
mod model;
mod obj;
mod penumbra;
mod plants;
mod random;
mod shapes;
mod spectra;
mod terrain;
mod walls;

use glam::DVec3;
use std::fs;
use std::io;
use std::path::Path;

use model::{Camera, Light, Model};

const COMMENT: &str = "Made by models/generate.rs of Halfshade";

/// A file that was made.
pub struct File {
    pub name: &'static str,
    pub bytes: Vec<u8>,
    /// Triangles as rendered; 0 for a file of materials.
    pub triangles: usize,
}

/// The models that are kept in the repository.
pub fn small_files() -> Vec<File> {
    let mut files = vec![
        glb("house.glb", &house_with_garden()),
        glb("forest.glb", &forest::forest()),
    ];
    files.extend(obj("cornell.obj", "cornell.mtl", &cornell::cornell_box()));
    files.extend(obj("penumbra.obj", "penumbra.mtl", &penumbra::penumbra()));
    files.extend(obj("glass.obj", "glass.mtl", &glass::glass_and_mirrors()));
    files
}

/// The models that are too large to keep.
pub fn large_files() -> Vec<File> {
    vec![glb("terrain.glb", &terrain::terrain())]
}

/// Writes `files` into `folder`, which is made where it is not there.
///
/// # Errors
/// Where the system cannot write.
pub fn write(folder: &Path, files: &[File]) -> io::Result<()> {
    fs::create_dir_all(folder)?;
    for file in files {
        fs::write(folder.join(file.name), &file.bytes)?;
    }
    Ok(())
}

/// Linear colour of the Cornell box's lamp, W/(m² sr); `scenes/cornell.toml` holds these numbers.
pub fn cornell_lamp() -> [f64; 3] {
    spectra::lamp()
}

fn house_with_garden() -> Model {
    let mut model = Model::default();
    house::add_house(&mut model);
    garden::add_garden(&mut model);
    model.camera = Some(Camera {
        position: DVec3::new(8.2, 2.9, 15.0),
        look_at: DVec3::new(0.0, 2.35, 0.0),
        vertical_fov: 0.63,
    });
    model.lights = vec![
        Light::Directional {
            name: "sun",
            direction: DVec3::new(-0.62, -0.55, -0.56),
            color: [1.0, 0.76, 0.5],
            irradiance: 3.4,
        },
        Light::Point {
            name: "lamp over the door",
            position: DVec3::new(house::DOOR, 2.32, house::HALF.1 + 0.55),
            color: [1.0, 0.7, 0.35],
            intensity: 2.4,
        },
        Light::Point {
            name: "lamp in the room",
            position: DVec3::new(1.6, 2.3, 0.0),
            color: [1.0, 0.65, 0.3],
            intensity: 16.0,
        },
    ];
    model
}

fn glb(name: &'static str, model: &Model) -> File {
    File {
        name,
        bytes: gltf::write_glb(model, COMMENT),
        triangles: model.triangle_count(),
    }
}

fn obj(name: &'static str, materials: &'static str, model: &Model) -> [File; 2] {
    [
        File {
            name,
            bytes: obj::write_obj(model, COMMENT, materials).into_bytes(),
            triangles: model.triangle_count(),
        },
        File {
            name: materials,
            bytes: obj::write_mtl(model, COMMENT).into_bytes(),
            triangles: 0,
        },
    ]
}
