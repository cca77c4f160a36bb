//! The scenes of this project.
#![allow(dead_code)] // each test file uses its own part of it

#[path = "../../models/generate/mod.rs"]
mod generate;

use std::fs;
use std::path::{Path, PathBuf};
use std::sync::Once;
use std::sync::atomic::AtomicBool;

use halfshade::bvh::Builder;
use halfshade::film::{Film, Rect};
use halfshade::import::{Imported, SceneOptions, import};
use halfshade::integrate::Aov;
use halfshade::prepare::{PreparedScene, prepare, prepare_keeping};
use halfshade::render::{Job, render};
use halfshade::scene::{Keep, LeftOut};

/// Changes of a scene file: paths and values.
pub type Overrides<'a> = &'a [(&'a str, &'a str)];

/// Renders `crop`, or the whole film.
pub fn film(imported: &Imported, crop: Option<Rect>) -> Film {
    let prepared = prepare(&imported.scene, Builder::default());
    assert!(prepared.warnings.is_empty());
    let whole = job(imported, &prepared.scene);
    let job = Job {
        crop: crop.unwrap_or(whole.crop),
        ..whole
    };
    render(&job, &AtomicBool::new(false), &|_| {})
}

/// Renders the whole film and `layers` without what they do not need, but for what `keep` holds; and what was left out.
pub fn film_keeping(imported: &Imported, layers: Vec<Aov>, keep: Keep) -> (Film, Vec<LeftOut>) {
    let prepared = prepare_keeping(&imported.scene, Builder::default(), keep);
    let job = Job {
        layers,
        ..job(imported, &prepared.scene)
    };
    let film = render(&job, &AtomicBool::new(false), &|_| {});
    let loaded = [&imported.left_out, &prepared.left_out];
    let left_out = loaded.into_iter().flatten().cloned();
    (film, left_out.collect())
}

/// The whole film, as the first camera sees it.
fn job<'a>(imported: &'a Imported, scene: &'a PreparedScene<'a>) -> Job<'a> {
    Job {
        scene,
        camera: scene.camera(&imported.scene.cameras[0]),
        settings: &imported.settings,
        crop: Rect::full(imported.settings.size),
        layers: Vec::new(),
    }
}

/// Imports a scene file.
pub fn load(path: &Path, overrides: Overrides) -> Imported {
    make_large_models();
    let overrides = overrides.iter();
    let options = SceneOptions {
        overrides: overrides.map(|(k, v)| ((*k).into(), (*v).into())).collect(),
        ..SceneOptions::default()
    };
    import(path, &options).unwrap_or_else(|error| panic!("{error}"))
}

/// Models that are too large to keep are made before a scene asks for them.
pub fn make_large_models() {
    static ONCE: Once = Once::new();
    ONCE.call_once(|| {
        let folder = root().join("target/models");
        let files = generate::large_files();
        let is_made = |file: &generate::File| {
            fs::read(folder.join(file.name)).is_ok_and(|bytes| bytes == file.bytes)
        };
        if !files.iter().all(is_made) {
            generate::write(&folder, &files).unwrap();
        }
    });
}

/// All scene files, by name.
pub fn scenes() -> Vec<PathBuf> {
    let entries = fs::read_dir(root().join("scenes")).unwrap();
    let mut paths: Vec<PathBuf> = entries.map(|entry| entry.unwrap().path()).collect();
    paths.retain(|path| path.extension().is_some_and(|e| e == "toml"));
    paths.sort();
    assert!(paths.len() >= 7, "{paths:?}");
    paths
}

/// The project's folder.
pub fn root() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR"))
}
