//! Transparent pictures, layers, sequences, exposure and denoising, as files.

use std::collections::BTreeMap;
use std::fs;

use super::{channels, folder, json, names, program, render, render_well, stderr};

#[test]
fn layers_of_every_kind_are_named_channels() {
    let folder = folder();
    let path = folder.path().join("a.exr");
    let kinds = "position,uv,object,material,direct,indirect,emission,lights";
    let arguments = ["-o", "a.exr", "--transparent", "--layers", kinds];
    render_well(folder.path(), &arguments);
    let channels: BTreeMap<_, _> = channels(&path).into_iter().collect();
    let names: Vec<&str> = channels.keys().map(String::as_str).collect();
    let layer = |name: &str, suffixes: &str| -> Vec<String> {
        suffixes.chars().map(|c| format!("{name}.{c}")).collect()
    };
    let mut expected: Vec<String> = ["A", "B", "G", "R"].map(String::from).to_vec();
    for i in 0..3 {
        expected.extend(layer(&format!("CryptoObject{i:02}"), "ABGR"));
        expected.extend(layer(&format!("CryptoMaterial{i:02}"), "ABGR"));
    }
    for name in ["direct", "emission", "indirect"] {
        expected.extend(layer(name, "BGR"));
    }
    // The three lights that a scene without lights gets.
    for name in ["background", "surfaces", "0", "1", "2"] {
        expected.extend(layer(&format!("light_{name}"), "BGR"));
    }
    expected.extend(layer("position", "XYZ"));
    expected.extend(layer("uv", "UV"));
    expected.sort();
    assert_eq!(names, expected);
    for (i, green) in channels["G"].iter().enumerate() {
        let sum = |parts: &[&str]| -> f32 { parts.iter().map(|name| channels[*name][i]).sum() };
        let of_objects = ["CryptoObject00.G", "CryptoObject00.A"];
        assert!((sum(&of_objects) - channels["A"][i]).abs() < 1e-5);
        let by_events = sum(&["direct.G", "indirect.G", "emission.G"]);
        assert!((by_events - green).abs() < 1e-5);
    }
    let meta = exr::meta::MetaData::read_from_file(&path, true).unwrap();
    let others = &meta.headers[0].own_attributes.other;
    let others = others
        .iter()
        .chain(&meta.headers[0].shared_attributes.other);
    let manifests: Vec<String> = others
        .filter(|(name, _)| name.to_string().ends_with("/manifest"))
        .map(|(_, value)| format!("{value:?}"))
        .collect();
    assert_eq!(manifests.len(), 2, "{manifests:?}");
    assert!(
        manifests.iter().any(|text| text.contains("pyramid")),
        "{manifests:?}"
    );
}

#[test]
fn transparent_files_have_an_opacity() {
    let folder = folder();
    let path = folder.path();
    render_well(path, &["-o", "a.png", "--transparent"]);
    render_well(path, &["-o", "b.png", "--set", "film.transparent=true"]);
    let a = image::open(path.join("a.png")).unwrap();
    assert_eq!(a.color(), image::ColorType::Rgba8);
    let levels: Vec<u8> = a.to_rgba8().pixels().map(|pixel| pixel.0[3]).collect();
    assert!(levels.contains(&0) && levels.contains(&255));
    assert_eq!(
        fs::read(path.join("a.png")).unwrap(),
        fs::read(path.join("b.png")).unwrap()
    );
}

#[test]
fn a_way_around_the_scene_makes_numbered_files() {
    let folder = folder();
    let path = folder.path();
    let arguments = ["--orbit", "3", "-o", "a.png", "--stats", "s.json"];
    render_well(path, &arguments);
    let expected = [
        "a.0001.png",
        "a.0002.png",
        "a.0003.png",
        "s.0001.json",
        "s.0002.json",
        "s.0003.json",
        "scene.obj",
    ];
    assert_eq!(names(path), expected);
    let digest = |name: &str| json(&path.join(name))["sha256"].to_string();
    // It begins where the camera is.
    render_well(path, &["-o", "b.png", "--stats", "b.json"]);
    assert_eq!(digest("s.0001.json"), digest("b.json"));
    assert_ne!(digest("s.0001.json"), digest("s.0002.json"));
}

#[test]
fn an_automatic_exposure_is_said_so_that_it_can_be_given() {
    let folder = folder();
    let path = folder.path();
    let output = render_well(path, &["-o", "a.png", "--exposure", "auto"]);
    let said = stderr(&output);
    let stops = said
        .split("--exposure ")
        .nth(1)
        .and_then(|s| s.split(' ').next());
    let stops = stops.unwrap_or_else(|| panic!("{said}"));
    render_well(path, &["-o", "b.png", "--exposure", stops]);
    assert_eq!(
        fs::read(path.join("a.png")).unwrap(),
        fs::read(path.join("b.png")).unwrap()
    );
}

#[test]
fn without_its_library_denoising_says_where_it_looked() {
    let folder = folder();
    let output = program(folder.path())
        .args(["render", "scene.obj", "--denoise", "--size", "8x8"])
        .env("HALFSHADE_OIDN", "nowhere/oidn.so")
        .output()
        .unwrap();
    let text = stderr(&output);
    assert_eq!(output.status.code(), Some(1), "{text}");
    for part in ["Open Image Denoise", "nowhere/oidn.so", "HALFSHADE_OIDN"] {
        assert!(text.contains(part), "{text}");
    }
    assert_eq!(names(folder.path()), ["scene.obj"]);
}

#[test]
fn parts_of_light_are_not_shown_of_a_picture_of_something_else() {
    let folder = folder();
    let arguments = ["-o", "a.exr", "--layers", "direct", "--integrator", "depth"];
    let output = render(folder.path(), &arguments);
    assert_eq!(output.status.code(), Some(1));
    assert!(stderr(&output).contains("\"depth\""), "{}", stderr(&output));
}
