//! The models that are kept are the ones that the generator makes.

#[path = "../models/generate/mod.rs"]
#[allow(dead_code)] // The large models are for tests/scenes.rs.
mod generate;

use std::fs;
use std::path::Path;

/// A file that is kept in the repository must stay below this.
const LARGEST: usize = 1_000_000;

#[test]
fn kept_models_are_what_the_generator_makes() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("models");
    for file in generate::small_files() {
        let kept = fs::read(folder.join(file.name)).unwrap_or_default();
        assert!(
            kept == file.bytes,
            "models/{} is not what the generator makes ({} bytes kept, {} made); \
             `cargo run --release --example generate-models` writes it anew",
            file.name,
            kept.len(),
            file.bytes.len()
        );
        assert!(kept.len() < LARGEST, "models/{} is too large", file.name);
    }
}

#[test]
fn models_are_as_large_as_they_are_said_to_be() {
    let triangles = |name: &str| {
        let files = generate::small_files();
        files
            .iter()
            .find(|file| file.name == name)
            .map(|file| file.triangles)
    };
    assert!(
        triangles("house.glb") > Some(20_000),
        "{:?}",
        triangles("house.glb")
    );
    assert!(
        triangles("forest.glb") > Some(7_000_000),
        "{:?}",
        triangles("forest.glb")
    );
    // 6 quadrilaterals of the walls and 8 of the ceiling less its own, 10 of the blocks.
    assert_eq!(triangles("cornell.obj"), Some(2 * (4 + 8 + 10)));
    assert_eq!(triangles("penumbra.obj"), Some(4));
}

#[test]
fn the_lamp_of_the_cornell_scene_has_the_published_spectrum() {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("scenes/cornell.toml");
    let scene = fs::read_to_string(path).unwrap_or_default();
    let lamp = generate::cornell_lamp()
        .map(|c| format!("{c:.4}"))
        .join(", ");
    let line = format!("radiance = [{lamp}]");
    assert!(scene.contains(&line), "no `{line}` in scenes/cornell.toml");
}
