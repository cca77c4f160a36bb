//! Animated models: one moment, numbered frames, and the page about extensions.

use std::fs;
use std::path::Path;

use serde_json::json;

use super::{SMALL, folder, json as read_json, names, run, stderr, stdout};

/// `model.gltf`: a triangle that moves by one to the right in the first of its two seconds.
fn write_model(folder: &Path) {
    let corners: [f32; 9] = [0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0];
    let times: [f32; 2] = [0.0, 1.0];
    let places: [f32; 6] = [0.0, 0.0, 0.0, 1.0, 0.0, 0.0];
    let numbers = corners.iter().chain(&times).chain(&places);
    let bytes: Vec<u8> = numbers.flat_map(|number| number.to_le_bytes()).collect();
    fs::write(folder.join("model.bin"), &bytes).unwrap();
    let accessor = |view: usize, count: usize, kind: &str| json!({ "bufferView": view, "componentType": 5126, "count": count, "type": kind });
    let view = |offset: usize, length: usize| json!({ "buffer": 0, "byteOffset": offset, "byteLength": length });
    let model = json!({
        "asset": { "version": "2.0" },
        "buffers": [{ "uri": "model.bin", "byteLength": bytes.len() }],
        "bufferViews": [view(0, 36), view(36, 8), view(44, 24)],
        "accessors": [accessor(0, 3, "VEC3"), accessor(1, 2, "SCALAR"), accessor(2, 2, "VEC3")],
        "meshes": [{ "primitives": [{ "attributes": { "POSITION": 0 } }] }],
        "nodes": [{ "mesh": 0 }],
        "scenes": [{ "nodes": [0] }],
        "animations": [{
            "name": "slide",
            "samplers": [{ "input": 1, "output": 2 }],
            "channels": [{ "sampler": 0, "target": { "node": 0, "path": "translation" } }],
        }],
    });
    fs::write(folder.join("model.gltf"), model.to_string()).unwrap();
}

#[test]
fn frames_are_numbered_and_move_before_a_camera_that_stands_still() {
    let folder = folder();
    let path = folder.path();
    write_model(path);
    let render = |arguments: &[&str]| {
        let all = [
            &["render", "model.gltf", "-o", "a.png", "--stats", "s.json"],
            arguments,
            &SMALL,
        ];
        let output = run(path, &all.concat());
        assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
    };
    let digest = |name: &str| read_json(&path.join(name))["sha256"].clone();
    render(&["--frames", "1..4", "--fps", "2"]);
    let frames: Vec<_> = (1..=4)
        .map(|frame| digest(&format!("s.000{frame}.json")))
        .collect();
    let pictures = names(path)
        .into_iter()
        .filter(|name| name.ends_with(".png"));
    assert!(pictures.eq((1..=4).map(|frame| format!("a.000{frame}.png"))));
    assert_ne!(frames[0], frames[1]);
    // After its last key it stands still.
    assert_eq!(frames[1], frames[2]);
    assert_eq!(frames[2], frames[3]);
    render(&["--time-code", "0.5", "--animation", "slide"]);
    assert_eq!(digest("s.json"), frames[0]);
    render(&["--time-code", "0"]);
    let first = digest("s.json");
    render(&[]);
    assert_eq!(
        digest("s.json"),
        first,
        "the first key is the place of rest"
    );
    assert_ne!(digest("s.json"), frames[0]);
}

#[test]
fn moments_that_make_no_sense_are_refused() {
    let folder = folder();
    write_model(folder.path());
    for (arguments, status) in [
        (&["--frames", "3..1"][..], 2),
        (&["--frames", "3"], 2),
        (&["--frames", "0..1", "--time-code", "1"], 2),
        (&["--animation", "slide"], 2),
        (&["--fps", "30"], 2),
        (&["--time-code", "soon"], 2),
        (&["--time-code", "1", "--animation", "jump"], 1),
    ] {
        let all = [&["render", "model.gltf"], arguments, &SMALL].concat();
        let output = run(folder.path(), &all);
        assert_eq!(
            output.status.code(),
            Some(status),
            "{arguments:?}: {}",
            stderr(&output)
        );
    }
}

#[test]
fn the_page_about_extensions_is_what_the_program_prints() {
    let output = run(Path::new("."), &["info", "--extensions"]);
    assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
    let page = concat!(env!("CARGO_MANIFEST_DIR"), "/docs/extensions.md");
    let page = fs::read_to_string(page).unwrap_or_default();
    assert!(
        stdout(&output) == page,
        "docs/extensions.md is old: halfshade info --extensions > docs/extensions.md"
    );
    let output = run(Path::new("."), &["info", "--extensions", "--json"]);
    let table: serde_json::Value = serde_json::from_str(stdout(&output)).unwrap();
    let lights = table
        .as_array()
        .unwrap()
        .iter()
        .find(|row| row["name"] == "KHR_lights_punctual");
    assert_eq!(lights.unwrap()["support"], "read");
    assert_eq!(run(Path::new("."), &["info"]).status.code(), Some(2));
}
