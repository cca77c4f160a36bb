//! What is done with hostile bytes: they are read as a file, and what comes of it is made ready,
//! looked at, and written again. Nothing may panic, hang, or take memory out of proportion.

use std::fs;
use std::path::{Path, PathBuf};

use halfshade::bvh::Builder;
use halfshade::import::{ImportOptions, Imported, SceneOptions, import, import_model};
use halfshade::integrate::{RayLog, integrator};
use halfshade::math::{Ray, UVec2, Vec3};
use halfshade::prepare::prepare;
use halfshade::report::read_picture;
use halfshade::sampling::Sampler;
use tempfile::TempDir;

/// Larger scenes are only read: building trees over them would be most of the time.
const MOST_TRIANGLES: u64 = 2_000;

thread_local! {
    /// A folder with what files may name.
    static FOLDER: TempDir = folder();
}

fn folder() -> TempDir {
    let memory = Path::new("/dev/shm");
    let folder = if memory.is_dir() {
        tempfile::tempdir_in(memory)
    } else {
        tempfile::tempdir()
    };
    let folder = folder.expect("a folder for temporary files");
    let write = |name: &str, text: &str| {
        fs::write(folder.path().join(name), text).expect("a temporary file");
    };
    write("a.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
    write("a.mtl", "newmtl m\nKd 0.5 0.4 0.3\n");
    folder
}

fn file(name: &str, bytes: &[u8]) -> PathBuf {
    let path = FOLDER.with(|folder| folder.path().join(name));
    fs::write(&path, bytes).expect("a temporary file");
    path
}

/// A model, by itself and as a scene.
pub fn model(extension: &str, bytes: &[u8]) {
    let path = file(&format!("model.{extension}"), bytes);
    match import_model(&path, ImportOptions::default()) {
        Ok(_) => look(import(&path, &SceneOptions::default())),
        Err(error) => assert!(error.to_string().contains("model."), "{error}"),
    }
}

/// A library of materials, with a model that uses the names in it.
pub fn library(bytes: &[u8]) {
    file("all.mtl", bytes);
    let mut model =
        String::from("mtllib all.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nvt 1 0\nvt 0 1\n");
    for name in ["m", "a", "b", ""] {
        model += &format!("usemtl {name}\nf 1/1 2/2 3/3\n");
    }
    look(import(
        &file("all.obj", model.as_bytes()),
        &SceneOptions::default(),
    ));
}

/// A scene file.
pub fn scene(bytes: &[u8]) {
    look(import(&file("scene.toml", bytes), &SceneOptions::default()));
}

/// A picture: read as `compare` reads it, and as a texture.
pub fn picture(extension: &str, bytes: &[u8]) {
    let name = format!("picture.{extension}");
    let path = file(&name, bytes);
    if let Ok(opened) = read_picture(&path) {
        let size = opened.picture.size;
        assert_eq!(
            opened.picture.pixels.len() as u64,
            u64::from(size.x) * u64::from(size.y)
        );
    }
    if extension == "png" {
        library(format!("newmtl m\nmap_Kd {name}\n").as_bytes());
    }
}

/// Makes a scene ready and follows some rays through it.
fn look<E>(imported: Result<Imported, E>) {
    let Ok(Imported {
        scene, settings, ..
    }) = imported
    else {
        return;
    };
    if scene.triangle_count() > MOST_TRIANGLES {
        return;
    }
    let prepared = prepare(&scene, Builder::default()).scene;
    let technique = integrator(&prepared, &settings);
    let mut log = RayLog::default();
    for i in 0..8 {
        let sampler = Sampler::new(&settings.sampling, UVec2::ZERO, i);
        let corner = |bit: u32| if i >> bit & 1 == 0 { -1.0 } else { 1.0 };
        let origin = Vec3::new(corner(0), corner(1), corner(2));
        let ray = Ray::new(origin, Vec3::new(0.1, 0.2, 0.15) - origin);
        technique.radiance(&ray, &sampler, &mut log);
    }
    if let Some(placed) = scene.cameras.first() {
        let camera = prepared.camera(placed);
        let ray = camera
            .rays(settings.size)
            .at(0.5 * settings.size.as_vec2(), Default::default());
        let sampler = Sampler::new(&settings.sampling, UVec2::ZERO, 0);
        technique.radiance(&ray, &sampler, &mut log);
    }
}
