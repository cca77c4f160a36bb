//! The program as its users meet it: arguments, messages, exit statuses, files.

#![allow(clippy::unwrap_used, clippy::expect_used)]

mod compare;
mod files;
mod help;
#[cfg(unix)]
mod interrupt;
mod limits;
mod picture;
mod sequence;
mod terminal;
mod verdict;

use std::fs;
use std::path::Path;
use std::process::{Command, Output, Stdio};

use serde_json::Value;
use tempfile::TempDir;

/// A pyramid on a floor: `scene.obj` in a folder of its own.
const OBJ: &str = "\
v -1 0 -1\nv 1 0 -1\nv 1 0 1\nv -1 0 1\nv 0 1.5 0
v -3 0 -3\nv 3 0 -3\nv 3 0 3\nv -3 0 3
o floor\nf 9 8 7 6
o pyramid\nf 1 5 2\nf 2 5 3\nf 3 5 4\nf 4 5 1
";

/// Options that make a small picture fast.
const SMALL: [&str; 4] = ["--size", "40x30", "--samples", "4"];

fn folder() -> TempDir {
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("scene.obj"), OBJ).unwrap();
    folder
}

fn program(folder: &Path) -> Command {
    let mut command = Command::new(env!("CARGO_BIN_EXE_halfshade"));
    command.current_dir(folder).env_remove("RUST_BACKTRACE");
    command
}

fn run(folder: &Path, arguments: &[&str]) -> Output {
    program(folder).args(arguments).output().unwrap()
}

fn render(folder: &Path, arguments: &[&str]) -> Output {
    let all: Vec<&str> = [&["render", "scene.obj"], arguments, &SMALL].concat();
    run(folder, &all)
}

fn render_well(folder: &Path, arguments: &[&str]) -> Output {
    let output = render(folder, arguments);
    assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
    output
}

fn stdout(output: &Output) -> &str {
    std::str::from_utf8(&output.stdout).unwrap()
}

fn stderr(output: &Output) -> &str {
    std::str::from_utf8(&output.stderr).unwrap()
}

fn names(folder: &Path) -> Vec<String> {
    let mut names: Vec<String> = fs::read_dir(folder)
        .unwrap()
        .map(|entry| entry.unwrap().file_name().into_string().unwrap())
        .collect();
    names.sort();
    names
}

fn json(path: &Path) -> Value {
    serde_json::from_slice(&fs::read(path).unwrap()).unwrap()
}

/// Digest of the pixels that `arguments` make of `scene.obj`.
fn digest(folder: &Path, arguments: &[&str]) -> String {
    let with_stats = [arguments, &["--stats", "digest.json", "-o", "digest.png"]].concat();
    render_well(folder, &with_stats);
    let stats = json(&folder.join("digest.json"));
    stats["sha256"].as_str().unwrap().to_owned()
}

/// The channels of a one-part EXR file.
fn channels(path: &Path) -> Vec<(String, Vec<f32>)> {
    let image = exr::prelude::read_all_flat_layers_from_file(path).unwrap();
    assert_eq!(image.layer_data.len(), 1);
    let list = &image.layer_data[0].channel_data.list;
    list.iter()
        .map(|c| (c.name.to_string(), c.sample_data.values_as_f32().collect()))
        .collect()
}

#[test]
fn wrong_arguments_are_named_and_exit_with_2() {
    let folder = folder();
    for (arguments, expected) in [
        (&[][..], "Usage"),
        (&["paint"], "paint"),
        (&["render"], "<SCENE>"),
        (&["render", "scene.obj", "--sampels", "3"], "--samples"),
        (&["render", "scene.obj", "--samples", "0"], "1.."),
        (&["render", "scene.obj", "--size", "40"], "1280x720"),
        (&["render", "scene.obj", "--size", "0x40"], "1280x720"),
        (&["render", "scene.obj", "--crop", "1,2,3"], "x,y,w,h"),
        (&["render", "scene.obj", "--pattern", "hexagon"], "sobol"),
        (&["render", "scene.obj", "--bvh", "worst"], "median"),
        (&["render", "scene.obj", "--set", "film.size"], "PATH=VALUE"),
        (&["render", "scene.obj", "--exposure", "nan"], "stops"),
        (&["render", "scene.obj", "--threads", "0"], "1.."),
        (&["render", "scene.obj", "--time", "0"], "--time"),
        (&["render", "scene.obj", "-q", "-v"], "--verbose"),
        (&["render", "scene.obj", "-o", "a.jpg"], ".png or .exr"),
        (&["render", "scene.obj", "-o", "png"], ".png or .exr"),
        (
            &["render", "scene.obj", "-o", "a.png", "-o", "a.png"],
            "twice",
        ),
        (
            &["render", "scene.obj", "-o", "a.png", "--layers", "depth"],
            ".exr",
        ),
        (
            &[
                "render",
                "scene.obj",
                "-o",
                "a.exr",
                "--layers",
                "depth,depth",
            ],
            "twice",
        ),
        (
            &["render", "scene.obj", "-o", "a.exr", "--layers", "sky"],
            "albedo",
        ),
        (
            &["render", "scene.obj", "-o", "a.exr", "--tone-map", "aces"],
            ".png",
        ),
        (
            &[
                "render",
                "scene.obj",
                "--size",
                "40x30",
                "--crop",
                "39,0,2,1",
            ],
            "40x30",
        ),
        (
            &[
                "render",
                "scene.obj",
                "--size",
                "40x30",
                "--replay",
                "40,0,0",
            ],
            "40x30",
        ),
        (
            &["render", "scene.obj", "--samples", "4", "--replay", "0,0,4"],
            "4",
        ),
        (&["render", "scene.obj", "--camera", "left"], "\"left\""),
        (
            &["render", "scene.obj", "--set", "film.zise=3"],
            "film.zise",
        ),
        (&["info", "scene.obj", "--set", "light.7.radius=0"], "light"),
        (&["info"], "<SCENE>"),
    ] {
        let output = run(folder.path(), arguments);
        let text = stderr(&output);
        assert_eq!(output.status.code(), Some(2), "{arguments:?}: {text}");
        assert!(text.contains(expected), "{arguments:?}: {text}");
        assert!(output.stdout.is_empty(), "{arguments:?}");
    }
    assert_eq!(names(folder.path()), ["scene.obj"]);
}

#[test]
fn failed_jobs_say_why_exit_with_1_and_write_nothing() {
    let folder = folder();
    let path = folder.path();
    fs::create_dir(path.join("a_folder")).unwrap();
    fs::create_dir(path.join("folder.png")).unwrap();
    fs::write(path.join("typo.toml"), "[sampling]\nsmaples = 3\n").unwrap();
    fs::write(path.join("noise.glb"), [0x9b; 300]).unwrap();
    fs::write(path.join("kept.png"), "old").unwrap();
    let before = names(path);
    for (arguments, expected) in [
        (
            &["render", "none.obj", "-o", "kept.png"][..],
            &["none.obj"][..],
        ),
        (&["render", "none.toml"], &["none.toml"]),
        (&["render", "a_folder"], &["a_folder", ".toml"]),
        (&["render", "noise.glb", "-o", "kept.png"], &["noise.glb"]),
        (
            &["render", "typo.toml"],
            &["typo.toml", "line 2", "smaples", "\"samples\""],
        ),
        (
            &["render", "scene.obj", "-o", "no/a.png"],
            &["no/a.png", "folder \"no\""],
        ),
        (
            &["render", "scene.obj", "-o", "folder.png"],
            &["folder.png", "is a folder"],
        ),
        (
            &["render", "scene.obj", "--stats", "no/s.json"],
            &["no/s.json"],
        ),
        (&["info", "none.obj"], &["none.obj"]),
        (&["info", "noise.glb"], &["noise.glb"]),
    ] {
        let output = run(path, arguments);
        let text = stderr(&output);
        assert_eq!(output.status.code(), Some(1), "{arguments:?}: {text}");
        assert_eq!(text.matches("error:").count(), 1, "{arguments:?}: {text}");
        for part in expected {
            assert!(text.contains(part), "{arguments:?}: {text}");
        }
        for part in ["panicked", "src/", ".rs", "backtrace"] {
            assert!(!text.contains(part), "{arguments:?}: {text}");
        }
    }
    assert_eq!(names(path), before);
    assert_eq!(fs::read(path.join("kept.png")).unwrap(), b"old");
}

#[test]
fn a_model_by_itself_becomes_a_picture_of_its_name() {
    let folder = folder();
    render_well(folder.path(), &[]);
    assert_eq!(names(folder.path()), ["scene.obj", "scene.png"]);
    let picture = image::open(folder.path().join("scene.png")).unwrap();
    assert_eq!((picture.width(), picture.height()), (40, 30));
    let levels = picture.to_rgb8();
    let brightest = levels.pixels().map(|p| p.0[1]).max().unwrap();
    let darkest = levels.pixels().map(|p| p.0[1]).min().unwrap();
    assert!(brightest > 60 && darkest < 10, "{darkest} to {brightest}");
}

#[test]
fn one_render_writes_many_files_with_layers() {
    let folder = folder();
    let all = "albedo,normal,depth,variance,samples,error,half_a,half_b";
    render_well(
        folder.path(),
        &["-o", "a.png", "-o", "b.EXR", "--png16", "--layers", all],
    );
    let png = image::open(folder.path().join("a.png")).unwrap();
    assert_eq!(png.color(), image::ColorType::Rgb16);
    let channels = channels(&folder.path().join("b.EXR"));
    let values = |name: &str| {
        let found = channels.iter().find(|(other, _)| other == name);
        &found.unwrap_or_else(|| panic!("no {name}")).1
    };
    let expected = [
        "B",
        "G",
        "R",
        "albedo.B",
        "albedo.G",
        "albedo.R",
        "depth.Z",
        "error.Y",
        "half_a.B",
        "half_a.G",
        "half_a.R",
        "half_b.B",
        "half_b.G",
        "half_b.R",
        "normal.X",
        "normal.Y",
        "normal.Z",
        "samples.Y",
        "variance.B",
        "variance.G",
        "variance.R",
    ];
    let mut sorted: Vec<&str> = channels.iter().map(|(name, _)| name.as_str()).collect();
    sorted.sort_unstable();
    assert_eq!(sorted, expected);
    assert!(values("samples.Y").iter().all(|&v| v == 4.0));
    assert!(values("depth.Z").iter().any(|&v| v > 1.0));
    assert!(values("variance.G").iter().any(|&v| v > 0.0));
    assert!(values("error.Y").iter().any(|&v| v > 0.0));
    let halves = values("half_a.G").iter().zip(values("half_b.G"));
    for ((a, b), g) in halves.zip(values("G")) {
        assert!((0.5 * (a + b) - g).abs() <= 1e-6 * g.abs(), "{a} {b} {g}");
    }
    let floor = values("normal.Y").iter().filter(|&&y| y > 0.999).count();
    assert!(floor > 100, "{floor} pixels show the floor's normal");
}

#[test]
fn the_same_bits_for_any_number_of_threads() {
    let folder = folder();
    let with = |threads: &str| {
        let arguments = ["--threads", threads, "-o", "a.exr", "--layers", "variance"];
        let sha256 = digest(folder.path(), &arguments);
        (sha256, fs::read(folder.path().join("a.exr")).unwrap())
    };
    let one = with("1");
    for threads in ["1", "2", "7"] {
        assert!(with(threads) == one, "{threads} threads");
    }
    assert_ne!(digest(folder.path(), &["--seed", "1"]), one.0);
}

#[test]
fn more_memory_than_allowed_is_refused_before_the_build() {
    let folder = folder();
    let output = render(folder.path(), &["--max-memory", "1M"]);
    assert_eq!(output.status.code(), Some(1));
    let message = stderr(&output);
    assert!(
        message.contains("balanced tree over 6 triangles"),
        "{message}"
    );
    assert!(
        message.contains("--max-memory allows (1.0 MiB)"),
        "{message}"
    );
    assert!(!folder.path().join("scene.png").exists());
    render_well(folder.path(), &["--max-memory", "1G"]);
}

#[test]
fn a_crop_holds_the_bits_of_the_whole() {
    let folder = folder();
    render_well(folder.path(), &["-o", "whole.exr"]);
    render_well(folder.path(), &["-o", "part.exr", "--crop", "5,7,20,11"]);
    let whole = channels(&folder.path().join("whole.exr"));
    let part = channels(&folder.path().join("part.exr"));
    for ((name, whole), (_, part)) in whole.iter().zip(&part) {
        let expected: Vec<u32> = (7..18)
            .flat_map(|y| (5..25).map(move |x| y * 40 + x))
            .map(|i: usize| whole[i].to_bits())
            .collect();
        let got: Vec<u32> = part.iter().map(|v| v.to_bits()).collect();
        assert_eq!(got, expected, "{name}");
    }
}

#[test]
fn options_go_above_the_scene_file_and_into_the_header() {
    let folder = folder();
    let path = folder.path();
    let text =
        "[film]\nsize = [400, 300]\n[sampling]\nsamples = 9\n[[model]]\nfile = \"scene.obj\"\n";
    fs::write(path.join("a.toml"), text).unwrap();
    let arguments = [
        &[
            "render",
            "a.toml",
            "-o",
            "a.exr",
            "--pattern",
            "grid",
            "--seed",
            "12",
        ][..],
        &["--set", "integrator.max_depth=3", "--light-samples", "2"],
        &["--size", "8x6"],
    ];
    let output = run(path, &arguments.concat());
    assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
    let meta = exr::meta::MetaData::read_from_file(path.join("a.exr"), true).unwrap();
    let header = &meta.headers[0];
    assert_eq!(header.layer_size, exr::math::Vec2(8, 6));
    let key = exr::prelude::Text::from("halfshade");
    let attributes = &header.own_attributes.other;
    let Some(exr::prelude::AttributeValue::Text(text)) = attributes.get(&key) else {
        panic!("{attributes:?}");
    };
    let text = text.to_string();
    for line in [
        "scene = a.toml",
        "size = 8x6",
        "samples = 9",
        "pattern = grid",
        "seed = 12",
        "max_depth = 3",
        "light_samples = 2",
        "set = integrator.max_depth=3",
    ] {
        assert!(text.lines().any(|other| other == line), "{line}: {text}");
    }
}

#[test]
fn what_was_added_can_be_pasted_and_gives_the_same_picture() {
    let folder = folder();
    let bare = digest(folder.path(), &[]);
    let output = render_well(folder.path(), &[]);
    let added: Vec<&str> = stderr(&output)
        .lines()
        .skip_while(|line| !line.starts_with('['))
        .take_while(|line| !line.starts_with("scene.png"))
        .collect();
    let text = format!("{}\n[[model]]\nfile = \"scene.obj\"\n", added.join("\n"));
    fs::write(folder.path().join("pasted.toml"), &text).unwrap();
    let arguments = ["render", "pasted.toml", "--stats", "p.json"];
    let output = run(folder.path(), &[&arguments[..], &SMALL].concat());
    assert_eq!(output.status.code(), Some(0), "{}{text}", stderr(&output));
    assert!(!stderr(&output).contains("note:"), "{}", stderr(&output));
    assert_eq!(json(&folder.path().join("p.json"))["sha256"], bare.as_str());
}

#[test]
fn png_options_change_the_file_and_not_the_pixels() {
    let folder = folder();
    let plain = digest(folder.path(), &[]);
    let before = fs::read(folder.path().join("digest.png")).unwrap();
    for options in [
        &["--exposure", "-2"][..],
        &["--tone-map", "aces"],
        &["--tone-map", "agx"],
        &["--tone-map", "pbr-neutral"],
    ] {
        assert_eq!(digest(folder.path(), options), plain, "{options:?}");
        let after = fs::read(folder.path().join("digest.png")).unwrap();
        assert!(after != before, "{options:?}");
    }
}

#[test]
fn stats_have_the_documented_keys() {
    let folder = folder();
    digest(folder.path(), &["--threads", "2", "--seed", "5"]);
    let stats = json(&folder.path().join("digest.json"));
    assert_eq!(stats["size"], serde_json::json!([40, 30]));
    let samples = serde_json::json!({"min": 4, "mean": 4.0, "max": 4});
    assert_eq!(stats["samples"], samples);
    assert_eq!(stats["triangles"], 6);
    assert_eq!(stats["threads"], 2);
    assert_eq!(stats["seed"], 5);
    assert_eq!(stats["rays"]["camera"], 40 * 30 * 4);
    assert!(stats["rays"]["shadow"].as_u64().unwrap() > 0);
    assert_eq!(stats["rays"]["secondary"], 0);
    assert_eq!(stats["stopped_by"], "samples");
    assert_eq!(stats["rejected_samples"], 0);
    assert_eq!(stats["sha256"].as_str().unwrap().len(), 64);
    let error = |key: &str| stats["error"][key].as_f64().unwrap();
    assert_eq!(stats["error"]["metric"], "sqrt-relmse");
    assert!(0.0 < error("low") && error("low") < error("estimate"));
    assert!((0.0..=1.0).contains(&error("worst_share")));
    for key in ["left_out", "cpu_seconds", "peak_memory_bytes"] {
        assert!(stats.as_object().unwrap().contains_key(key), "{key}");
    }
    let seconds = |key: &str| stats["seconds"][key].as_f64().unwrap();
    let steps = ["import", "prepare", "render", "output"].map(seconds);
    assert!(steps.iter().all(|&s| s >= 0.0));
    assert!(steps.iter().sum::<f64>() <= seconds("total") + 1e-9);
    if cfg!(target_os = "linux") {
        assert!(stats["cpu_seconds"].is_f64() && stats["peak_memory_bytes"].is_u64());
    }
}

#[test]
fn the_digest_is_that_of_the_written_pixels() {
    use sha2::{Digest, Sha256};
    let folder = folder();
    let sha256 = digest(folder.path(), &["-o", "a.exr"]);
    let channels = channels(&folder.path().join("a.exr"));
    let of = |name: &str| &channels.iter().find(|(other, _)| other == name).unwrap().1;
    let (r, g, b) = (of("R"), of("G"), of("B"));
    let mut hash = Sha256::new();
    for i in 0..r.len() {
        for value in [r[i], g[i], b[i]] {
            hash.update(value.to_le_bytes());
        }
    }
    let hex: String = hash.finalize().iter().map(|b| format!("{b:02x}")).collect();
    assert_eq!(hex, sha256);
}

#[test]
fn info_has_the_documented_keys() {
    let folder = folder();
    let output = run(folder.path(), &["info", "scene.obj", "--json"]);
    assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
    let info: Value = serde_json::from_slice(&output.stdout).unwrap();
    assert_eq!(info["triangles"], 6);
    assert_eq!(info["bounds"]["min"], serde_json::json!([-3.0, 0.0, -3.0]));
    assert_eq!(info["bounds"]["max"], serde_json::json!([3.0, 1.5, 3.0]));
    // Those that a render adds are not in the file.
    assert_eq!((&info["cameras"], &info["lights"]), (&0.into(), &0.into()));
    assert!(info["memory_bytes"].as_u64().unwrap() > 100);
    for key in ["warnings", "left_out"] {
        assert!(info[key].is_array(), "{key}");
    }
    for key in [
        "vertices",
        "instances",
        "meshes",
        "materials",
        "textures",
        "images",
        "animations",
    ] {
        assert!(info[key].is_u64(), "{key}");
    }
    let table = run(folder.path(), &["info", "scene.obj"]);
    assert!(
        stdout(&table).contains("triangles   6"),
        "{}",
        stdout(&table)
    );
    assert!(stdout(&table).contains("[camera]"), "{}", stdout(&table));
}

#[test]
fn warnings_go_to_standard_error_and_into_info() {
    let folder = folder();
    let text = format!("mtllib lost.mtl\n{OBJ}");
    fs::write(folder.path().join("scene.obj"), text).unwrap();
    let output = render_well(folder.path(), &[]);
    let lines: Vec<&str> = stderr(&output)
        .lines()
        .filter(|line| line.starts_with("warning: ") && line.contains("lost.mtl"))
        .collect();
    assert_eq!(lines.len(), 1, "{}", stderr(&output));
    let output = run(folder.path(), &["info", "scene.obj", "--json"]);
    let info: Value = serde_json::from_slice(&output.stdout).unwrap();
    let warning = &info["warnings"][0];
    assert_eq!(
        (&warning["code"], &warning["count"]),
        (&"missing-file".into(), &1.into())
    );
}

#[test]
fn quiet_is_quiet() {
    let folder = folder();
    let output = render_well(folder.path(), &["-q"]);
    assert!(output.stderr.is_empty() && output.stdout.is_empty());
    let output = render_well(folder.path(), &["-v"]);
    assert!(stderr(&output).contains("shadow"), "{}", stderr(&output));
}

#[test]
fn a_sample_is_replayed_with_its_rays() {
    let folder = folder();
    let output = render_well(folder.path(), &["--replay", "20,20,3"]);
    let text = stdout(&output);
    assert!(text.starts_with("camera ray"), "{text}");
    assert!(text.contains("shadow ray"), "{text}");
    assert!(
        text.trim_end()
            .lines()
            .last()
            .unwrap()
            .starts_with("radiance"),
        "{text}"
    );
    assert_eq!(names(folder.path()), ["scene.obj"]);
}

#[test]
fn a_closed_pipe_is_no_error() {
    let folder = folder();
    let mut child = program(folder.path())
        .args(["info", "scene.obj", "--json"])
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .unwrap();
    drop(child.stdout.take());
    let output = child.wait_with_output().unwrap();
    assert_eq!(stderr(&output), "");
    assert_eq!(output.status.code(), Some(0));
}
