//! `halfshade bench` and the library behind it: files, counts and names. No time is asserted.

#![allow(clippy::unwrap_used, clippy::expect_used)]

mod bvh;
mod features;
mod scaling;

use std::fs;
use std::path::Path;
use std::process::{Command, Output};

use serde_json::Value;
use tempfile::TempDir;

/// A pyramid on a floor; two quadrilaterals and four triangles.
const OBJ: &str = "\
v -1 0 -1\nv 1 0 -1\nv 1 0 1\nv -1 0 1\nv 0 4 0
v -3 0 -3\nv 3 0 -3\nv 3 0 3\nv -3 0 3
f 9 8 7 6\nf 1 2 3 4\nf 1 5 2\nf 2 5 3\nf 3 5 4\nf 4 5 1
";

fn folder() -> TempDir {
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("scene.obj"), OBJ).unwrap();
    folder
}

fn bench(folder: &Path, arguments: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_halfshade"))
        .arg("bench")
        .args(arguments)
        .current_dir(folder)
        .output()
        .unwrap()
}

fn bench_json(folder: &Path, arguments: &[&str]) -> Value {
    let output = bench(folder, arguments);
    let error = String::from_utf8_lossy(&output.stderr);
    assert_eq!(output.status.code(), Some(0), "{arguments:?}: {error}");
    serde_json::from_slice(&output.stdout).unwrap()
}

/// The words of the commands that `-h` shows.
fn examples(folder: &Path, command: &str) -> Vec<Vec<String>> {
    let output = bench(folder, &[command, "-h"]);
    let text = String::from_utf8(output.stdout).unwrap();
    let lines = text.lines();
    let examples = lines.filter_map(|line| line.trim().strip_prefix("halfshade bench "));
    examples
        .map(|line| line.split(' ').map(str::to_owned).collect())
        .collect()
}

#[test]
fn the_examples_of_the_help_work() {
    let folder = folder();
    let path = folder.path();
    let few = ["bvh", "scene.obj", "--save-rays", "bunny", "--json"];
    bench_json(path, &[&few[..], &["--resolution", "8"]].concat());
    fs::create_dir(path.join("scenes")).unwrap();
    for file in ["bunny.obj", "house.obj"] {
        fs::write(path.join(file), OBJ).unwrap();
    }
    let scene = "[[model]]\nfile = \"../house.obj\"\n";
    fs::write(path.join("scenes/house.toml"), scene).unwrap();
    let mut count = 0;
    for (command, small) in [
        ("bvh", "--resolution 8 --repeats 1"),
        ("features", "--size 8x6 --samples 1 --repeats 1"),
    ] {
        for example in examples(path, command) {
            let mut arguments: Vec<&str> = Vec::new();
            let mut words = example.iter().map(String::as_str);
            while let Some(word) = words.next() {
                match word {
                    "--size" | "--samples" => drop(words.next()),
                    word => arguments.push(word),
                }
            }
            arguments.extend(small.split(' '));
            if arguments.contains(&"--scaling") {
                arguments.extend(["--max-triangles", "1000"]);
            }
            let output = bench(path, &arguments);
            let text = String::from_utf8_lossy(&output.stderr);
            assert_eq!(output.status.code(), Some(0), "{arguments:?}: {text}");
            count += 1;
        }
    }
    assert!(count >= 7, "{count}");
    for file in ["hits.bin", "scaling.svg", "scaling.csv", "scaling.md"] {
        assert!(path.join(file).is_file(), "{file}");
    }
}

#[test]
fn what_is_wrong_is_named() {
    let folder = folder();
    let path = folder.path();
    fs::write(path.join("empty.obj"), "v 0 0 0\n").unwrap();
    fs::write(path.join("other.ray"), "RAY2....").unwrap();
    fs::write(path.join("short.ray"), b"RAY1\x02\0\0\0....").unwrap();
    let scene = |more: &[&'static str]| [&["bvh", "scene.obj"], more].concat();
    for (arguments, status, expected) in [
        (vec![], 2, "Usage"),
        (vec!["bvh"], 2, "MESH"),
        (scene(&["--builder", "best"]), 2, "balanced"),
        (scene(&["--width", "wide"]), 2, "portable"),
        (scene(&["--threads", "0"]), 2, "1.."),
        (scene(&["--repeats", "0"]), 2, "1.."),
        (scene(&["--dump-hits", "x"]), 2, "--rays"),
        (
            vec!["bvh", "a", "b", "--rays", "r", "--dump-hits", "x"],
            2,
            "one mesh",
        ),
        (vec!["bvh", "a", "b", "--save-rays", "x"], 2, "one mesh"),
        (scene(&["--scaling"]), 2, "--scaling"),
        (scene(&["-o", "x.svg"]), 2, "--scaling"),
        (scene(&["--max-triangles", "9000"]), 2, "--scaling"),
        (vec!["bvh", "--scaling", "--threads", "1,2"], 2, "threads"),
        (
            vec!["bvh", "--scaling", "--max-triangles", "9"],
            2,
            "1000..",
        ),
        (vec!["bvh", "--scaling", "--builder", "none"], 2, "trees"),
        (vec!["bvh", "--scaling", "-o", "no/x.svg"], 1, "no/x.svg"),
        (vec!["features", "missing.obj"], 1, "missing.obj"),
        (
            vec!["features", "scene.obj", "--seconds", "0"],
            2,
            "seconds",
        ),
        (vec!["bvh", "missing.obj"], 1, "missing.obj"),
        (vec!["bvh", "empty.obj"], 1, "empty.obj: holds nothing"),
        (scene(&["--rays", "missing.ray"]), 1, "missing.ray"),
        (scene(&["--rays", "other.ray"]), 1, "not a ray file"),
        (
            scene(&["--rays", "short.ray:any"]),
            1,
            "announces 2 rays of 32 bytes, but 4 bytes follow",
        ),
        (
            scene(&["--rays", "other.ray", "--dump-hits", "no/x"]),
            1,
            "does not exist",
        ),
    ] {
        let output = bench(path, &arguments);
        let text = String::from_utf8(output.stderr).unwrap();
        assert_eq!(output.status.code(), Some(status), "{arguments:?}: {text}");
        assert!(text.contains(expected), "{arguments:?}: {text}");
    }
}
