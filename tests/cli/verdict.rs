//! What a render says of its own numbers: the verdict, and what led to it.

use std::fs;

use serde_json::Value;

use super::{folder, render, render_well, run, stderr};

/// The part of the stats of a render of `scene` that is about stability, and what was said.
fn stability(scene: &str, arguments: &[&str]) -> (Value, String) {
    let folder = folder();
    fs::write(folder.path().join("scene.obj"), scene).unwrap();
    let all = [arguments, &["--stats", "stats.json"]].concat();
    let output = render_well(folder.path(), &all);
    let text = fs::read_to_string(folder.path().join("stats.json")).unwrap();
    let stats: Value = serde_json::from_str(&text).unwrap();
    (stats["stability"].clone(), stderr(&output).to_owned())
}

const CUBE: &str = "\
v -1 -1 -1\nv 1 -1 -1\nv 1 1 -1\nv -1 1 -1\nv -1 -1 1\nv 1 -1 1\nv 1 1 1\nv -1 1 1
f 4 3 2 1\nf 5 6 7 8\nf 1 2 6 5\nf 3 4 8 7\nf 2 3 7 6\nf 4 1 5 8
";

#[test]
fn an_ordinary_picture_is_stable() {
    let (stability, said) = stability(CUBE, &[]);
    assert_eq!(said.lines().last(), Some("stable"));
    assert_eq!(stability["verdict"], "stable");
    assert_eq!(stability["dropped"]["samples"], 0);
    assert!(stability["leaks"].is_null());
}

#[test]
fn nothing_leaks_from_a_cube() {
    let (stability, said) = stability(CUBE, &["--check-leaks", "-v"]);
    assert_eq!(stability["leaks"]["meshes"], 1);
    assert_eq!(stability["leaks"]["leaked"], 0);
    assert!(
        stability["leaks"]["rays"].as_u64() > Some(50_000),
        "{stability}"
    );
    assert!(said.contains("leaks: 0 of"), "{said}");
}

#[test]
fn a_cube_without_a_face_is_not_closed() {
    let open = CUBE.replace("f 4 3 2 1\n", "");
    let (stability, _) = stability(&open, &["--check-leaks"]);
    assert_eq!(stability["leaks"]["meshes"], 0);
}

#[test]
fn odd_triangles_are_counted_by_mesh() {
    let scene = "o odd\nv 0 0 0\nv 1 0 0\nv 0 1 0\nv 0.5 1e-4 0\n\
                 f 1 2 3\nf 3 1 2\nf 1 2 4\no fine\nv 0 0 1\nf 1 2 5\n";
    let (stability, said) = stability(scene, &["-v"]);
    let meshes = stability["triangles"].as_array().unwrap();
    assert_eq!(meshes.len(), 1, "{stability:#}");
    assert_eq!(meshes[0]["duplicate"], 1);
    assert_eq!(meshes[0]["needle"], 1);
    assert!(said.contains("1 duplicate, 1 needles"), "{said}");
    assert_eq!(stability["verdict"], "stable");
}

/// A scene file over the pyramid, with `more`.
fn scene_with(more: &str, arguments: &[&str]) -> (String, Option<i32>) {
    let folder = folder();
    let text = format!(
        "[camera]\nposition = [0, 3, 6]\nlook_at = [0, 0.5, 0]\n[[model]]\nfile = \"scene.obj\"\n{more}"
    );
    fs::write(folder.path().join("a scene.toml"), text).unwrap();
    let all = [&["render", "a scene.toml", "--size", "40x30"], arguments].concat();
    let output = run(folder.path(), &all);
    (stderr(&output).to_owned(), output.status.code())
}

#[test]
fn samples_that_overflow_are_dropped_and_can_be_replayed() {
    let light =
        "[[light]]\nkind = \"point\"\nposition = [0, 2.5, 0]\nintensity = [3e38, 3e38, 3e38]\n";
    let (said, status) = scene_with(&light.repeat(200), &["--samples", "2"]);
    assert_eq!(status, Some(0), "{said}");
    assert!(said.contains("unstable: "), "{said}");
    assert!(said.contains("pixels have no finite samples"), "{said}");
    let replay = said
        .lines()
        .find_map(|line| line.split_once("dropped sample: "));
    let replay = replay.unwrap().1;
    let start = "halfshade render 'a scene.toml' --size 40x30 --samples 2 --replay ";
    let id = replay
        .strip_prefix(start)
        .unwrap_or_else(|| panic!("{replay}"));
    let (said, status) = scene_with(&light.repeat(200), &["--samples", "2", "--replay", id]);
    assert_eq!(status, Some(0), "{said}");
}

#[test]
fn a_lamp_in_the_floor_is_not_stable() {
    let lamp = |y: f32| {
        format!(
            "[[light]]\nkind = \"disk\"\nposition = [2, {y}, 2]\nnormal = [0, 1, 0]\nradius = 0.3\n\
             radiance = [9, 9, 9]\n"
        )
    };
    let (said, _) = scene_with(&lamp(0.0), &["--samples", "2"]);
    assert!(
        said.contains("unstable: light 0 lies in a surface"),
        "{said}"
    );
    let (said, _) = scene_with(&lamp(1e-3), &["--samples", "2"]);
    assert!(said.lines().any(|line| line == "stable"), "{said}");
}

#[test]
fn what_the_depth_cuts_off_is_told() {
    let mirror = "[[material]]\nname = \"mirror\"\nkind = \"phong\"\nreflect = [0.5, 0.5, 0.5]\n";
    let model = "material = \"mirror\"\n";
    let (said, _) = scene_with(
        &format!("{model}{mirror}"),
        &["--samples", "2", "--max-depth", "1", "-v"],
    );
    assert!(said.contains("depth limit: "), "{said}");
    let (said, _) = scene_with("", &["--samples", "2", "--max-depth", "1", "-v"]);
    assert!(!said.contains("depth limit: "), "{said}");
}

#[test]
fn the_quiet_say_nothing() {
    let output = render(folder().path(), &["--quiet"]);
    assert_eq!(stderr(&output), "");
}
