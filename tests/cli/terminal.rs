//! What files hold does no harm to the terminal.

use std::fs;

use super::{OBJ, folder, render_well, run, stderr, stdout};

/// A glTF file with a camera whose name would clear a terminal.
const CAMERA: &str = r#"{
    "asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0]}],
    "nodes": [{"camera": 0, "name": "a\u001b[2Jb\u009b31m"}],
    "cameras": [{"type": "perspective", "name": "a\u001b[2Jb\u009b31m",
                 "perspective": {"yfov": 1.0, "znear": 0.1}}]
}"#;

fn assert_harmless(text: &str) {
    let harmful = text.chars().find(|c| c.is_control() && *c != '\n');
    assert_eq!(harmful, None, "{text:?}");
    assert!(text.contains("\\u{1b}"), "{text:?}");
}

#[test]
fn control_characters_of_files_are_escaped() {
    let folder = folder();
    let path = folder.path();
    fs::write(path.join("camera.gltf"), CAMERA).unwrap();
    assert_harmless(stdout(&run(path, &["info", "camera.gltf"])));
    let output = run(path, &["render", "camera.gltf", "--camera", "none"]);
    assert_eq!(output.status.code(), Some(2));
    assert_harmless(stderr(&output));

    fs::write(path.join("bad.toml"), "[film]\nsize = \"\u{1b}[31m\"\n").unwrap();
    let output = run(path, &["info", "bad.toml"]);
    assert_eq!(output.status.code(), Some(1));
    assert_harmless(stderr(&output));

    let text = format!("mtllib \u{1b}[31mlost.mtl\n{OBJ}");
    fs::write(path.join("scene.obj"), text).unwrap();
    assert_harmless(stderr(&render_well(path, &[])));
}

#[test]
fn only_short_lines_are_shown() {
    let folder = folder();
    let path = folder.path();
    for (length, is_shown) in [(100, true), (500_000, false)] {
        let comment = "x".repeat(length);
        let text = format!("[film]\nsiez = [3, 4] # {comment}\n");
        fs::write(path.join("typo.toml"), text).unwrap();
        let output = run(path, &["info", "typo.toml"]);
        let text = stderr(&output);
        assert_eq!(output.status.code(), Some(1), "{text}");
        assert!(text.contains("line 2") && text.contains("siez"), "{text}");
        assert_eq!(text.contains("[3, 4]"), is_shown);
        assert!(text.len() < 2_000, "{} bytes", text.len());
    }
}

#[test]
fn huge_extents_are_short() {
    let folder = folder();
    let path = folder.path();
    let scene = "[[model]]\nfile = \"scene.obj\"\nscale = 1e300\n";
    fs::write(path.join("huge.toml"), scene).unwrap();
    let output = run(path, &["info", "huge.toml"]);
    let text = stdout(&output);
    assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
    assert!(text.contains("e300"), "{text}");
    assert!(text.lines().all(|line| line.len() < 200), "{text}");
}
