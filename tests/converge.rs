//! `halfshade converge`: slopes, bias, what the reference does not tell, and what scripts rely on. No time
//! is asserted.

#![allow(clippy::unwrap_used, clippy::expect_used)]

use std::fs;
use std::path::Path;
use std::process::{Command, Output};

use serde_json::Value;
use tempfile::TempDir;

/// A pyramid on a floor.
const OBJ: &str = "\
v -1 0 -1\nv 1 0 -1\nv 1 0 1\nv -1 0 1\nv 0 1.5 0
v -3 0 -3\nv 3 0 -3\nv 3 0 3\nv -3 0 3
f 9 8 7 6\nf 1 5 2\nf 2 5 3\nf 3 5 4\nf 4 5 1
";
/// A soft shadow of it.
const SCENE: &str = "\
[film]\nsize = [36, 24]\n[[model]]\nfile = \"scene.obj\"
[[light]]\nkind = \"disk\"\nposition = [2.0, 5.0, 3.0]\nnormal = [0.0, -1.0, 0.0]\nradius = 0.8\nradiance = [9.0, 9.0, 9.0]
";

fn folder() -> TempDir {
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("scene.obj"), OBJ).unwrap();
    fs::write(folder.path().join("soft.toml"), SCENE).unwrap();
    folder
}

fn converge(folder: &Path, arguments: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_halfshade"))
        .args(["converge", "soft.toml", "-o", "out"])
        .args(if arguments.contains(&"--seconds") {
            &[][..]
        } else {
            &["--seconds", "1000"]
        })
        .args(arguments)
        .current_dir(folder)
        .output()
        .unwrap()
}

fn converge_json(folder: &Path, arguments: &[&str]) -> Value {
    let output = converge(folder, &[arguments, &["--json"]].concat());
    let error = String::from_utf8_lossy(&output.stderr);
    assert_eq!(output.status.code(), Some(0), "{arguments:?}: {error}");
    serde_json::from_slice(&output.stdout).unwrap()
}

fn points<'a>(study: &'a Value, method: &str) -> Vec<&'a Value> {
    let points = study["points"].as_array().unwrap().iter();
    points.filter(|point| point["method"] == method).collect()
}

#[test]
fn random_falls_with_the_root_and_the_others_faster() {
    let folder = folder();
    let arguments = [
        &["--methods", "random,jittered,sobol,grid"][..],
        &[
            "--max-samples",
            "128",
            "--repeats",
            "6",
            "--reference-samples",
            "8192",
        ],
    ];
    let study = converge_json(folder.path(), &arguments.concat());
    let law = |method: &str| {
        let slopes = study["slopes"].as_array().unwrap();
        slopes
            .iter()
            .find(|slope| slope["method"] == method)
            .unwrap()["law"]
            .clone()
    };
    let random = law("random");
    let [low, high] = [0, 1].map(|i| random["slope_interval"][i].as_f64().unwrap());
    assert!(low <= -0.5 && -0.5 <= high && high - low < 0.1, "{random}");
    assert_eq!(random["bias_squared"], 0.0);
    for method in ["jittered", "sobol"] {
        let law = law(method);
        assert!(
            law["slope_interval"][1].as_f64().unwrap() < low,
            "{method}: {law}"
        );
    }
    for point in points(&study, "random") {
        let [relmse, own, variance] =
            ["relmse", "estimated_relmse", "variance"].map(|key| point[key].as_f64());
        let relmse = relmse.unwrap();
        // All of its error is variance, and from eight samples on it knows how large it is.
        assert!((variance.unwrap() / relmse - 1.0).abs() < 0.1, "{point}");
        assert!(point["bias_squared"].is_null(), "{point}");
        if point["samples"].as_f64().unwrap() >= 8.0 {
            assert!((own.unwrap() / relmse - 1.0).abs() < 0.3, "{point}");
        }
    }
    // One sample in the middle of each pixel is the same for all seeds.
    let grid = points(&study, "grid");
    assert!(grid[0]["variance"].as_f64().unwrap() < 1e-12, "{}", grid[0]);
    for point in grid {
        let parts = ["bias_squared", "relmse"].map(|key| point[key].as_f64().unwrap());
        assert!(parts[0] > 0.3 * parts[1], "{point}");
        assert!(point["estimated_relmse"].is_null());
    }
}

#[test]
fn a_picture_as_good_as_the_reference_is_below_the_floor() {
    let folder = folder();
    let arguments = [
        &["--methods", "sobol,sobol@256", "--max-samples", "4"][..],
        &["--repeats", "4", "--reference-samples", "256"],
    ];
    let study = converge_json(folder.path(), &arguments.concat());
    let [good] = points(&study, "sobol@256")[..] else {
        panic!("{study}");
    };
    let floor = &study["references"][0]["floors"]["relmse"];
    let measured = good["measured_relmse"].as_f64().unwrap();
    let twice = measured / floor["estimate"].as_f64().unwrap() / 2.0;
    // Both are estimates from one small picture.
    assert!((twice - 1.0).abs() < 0.5, "{twice}: {good}");
    for key in ["relmse", "rmse", "bias_squared"] {
        assert!(good[key].is_null(), "{key}: {good}");
    }
    assert_eq!(good["floor_relmse"], floor["bound"]);
    for point in points(&study, "sobol") {
        assert!(
            point["relmse"].as_f64() > floor["bound"].as_f64(),
            "{point}"
        );
    }
    let csv = fs::read_to_string(folder.path().join("out/curve.csv")).unwrap();
    let column = csv
        .lines()
        .next()
        .unwrap()
        .split(',')
        .position(|c| c == "relmse");
    let line = csv
        .lines()
        .find(|line| line.starts_with("sobol@256,"))
        .unwrap();
    assert_eq!(line.split(',').nth(column.unwrap()), Some(""), "{line}");
    let output = converge(folder.path(), &arguments.concat());
    let table = String::from_utf8(output.stdout).unwrap();
    let line = table
        .lines()
        .find(|line| line.contains("sobol@256"))
        .unwrap();
    assert!(
        line.contains("< ") && line.contains("below floor"),
        "{line}"
    );
    // A goal above the floor is reached by then at the latest; one below it is not told.
    let time = study["time_to_error"].as_array().unwrap().last().unwrap();
    assert_eq!(time["method"], "sobol@256");
    let bound = floor["bound"].as_f64().unwrap();
    for goal in time["goals"].as_array().unwrap() {
        let is_above = goal["relmse"].as_f64().unwrap() >= bound;
        let expected = if is_above {
            "at_most"
        } else {
            "below_the_floor"
        };
        assert_eq!(goal["known"], expected, "{goal}");
    }
}

#[test]
fn files_have_what_scripts_rely_on() {
    let folder = folder();
    let other = "method,seconds,relmse\nelsewhere,0.5,0.02\nelsewhere,2,0.005\n";
    fs::write(folder.path().join("other.csv"), other).unwrap();
    let arguments = [
        &[
            "--methods",
            "sobol:circle,jittered:4@9,sobol:adaptive",
            "--max-samples",
            "8",
        ][..],
        &["--repeats", "2", "--against", "other.csv"],
    ];
    let study = converge_json(folder.path(), &arguments.concat());
    let out = folder.path().join("out");
    let kept: Value = serde_json::from_slice(&fs::read(out.join("curve.json")).unwrap()).unwrap();
    assert_eq!(kept["points"], study["points"]);
    assert_eq!(study["points"].as_array().unwrap().len(), 4 + 1 + 4);
    let brute = points(&study, "jittered:4@9")[0];
    // Two sets of 3 × 2 cells.
    assert_eq!(
        (&brute["samples"], &brute["light_samples"]),
        (&12.0.into(), &4.into())
    );
    assert_eq!(brute["rays"]["camera"], 12 * 36 * 24);
    for point in study["points"].as_array().unwrap() {
        for key in [
            "seconds",
            "cpu_seconds",
            "standard_error",
            "repeats",
            "flip",
            "coverage",
        ] {
            assert!(point.get(key).is_some(), "{key}: {point}");
        }
        let seed = study["references"][0]["seed"].as_u64();
        assert!(point["first_seed"].as_u64() > seed, "{point}");
    }
    let targets: Vec<_> = study["references"]
        .as_array()
        .unwrap()
        .iter()
        .map(|r| &r["target"])
        .collect();
    assert_eq!(targets, ["rectangle", "circle"]);
    assert_eq!(study["against"].as_array().unwrap().len(), 2);

    let page = fs::read_to_string(out.join("index.html")).unwrap();
    // The only addresses are names of namespaces.
    for (at, _) in page.match_indices("http") {
        assert!(
            page[at..].starts_with("http://www.w3.org/2000/svg"),
            "{}",
            &page[at..at + 60]
        );
    }
    for part in [
        "elsewhere",
        "sobol:circle",
        "<svg",
        "noise floor",
        "type=\"range\"",
    ] {
        assert!(page.contains(part), "{part}");
    }

    // The reference is kept while it is that of the scene, and no longer.
    let modified = || {
        fs::metadata(out.join("reference-circle.json"))
            .unwrap()
            .modified()
            .unwrap()
    };
    let before = modified();
    converge_json(folder.path(), &arguments.concat());
    assert_eq!(modified(), before);
    converge_json(
        folder.path(),
        &[&arguments.concat()[..], &["--set", "light.0.radius=0.7"]].concat(),
    );
    assert_ne!(modified(), before);
}

#[test]
fn what_takes_too_long_is_left_out_and_said() {
    let folder = folder();
    let arguments = [
        "--methods",
        "sobol,jittered:81@81",
        "--max-samples",
        "2",
        "--repeats",
        "1",
    ];
    let study = converge_json(
        folder.path(),
        &[&arguments[..], &["--seconds", "1e-9"]].concat(),
    );
    assert_eq!(study["points"].as_array().unwrap().len(), 1);
    let left_out = study["left_out"].to_string();
    assert!(left_out.contains("sobol from 2 samples on"), "{left_out}");
    assert!(
        left_out.contains("jittered:81@81 from 81 samples on"),
        "{left_out}"
    );
}

#[test]
fn wrong_arguments_are_named() {
    let folder = folder();
    for (arguments, expected) in [
        (&["--methods", "sobl"][..], "did you mean \"sobol\"?"),
        (&["--repeats", "0"], "--repeats"),
    ] {
        let output = converge(folder.path(), arguments);
        let error = String::from_utf8_lossy(&output.stderr);
        assert_eq!(output.status.code(), Some(2), "{error}");
        assert!(error.contains(expected), "{error}");
    }
    let output = converge(folder.path(), &["--against", "missing.csv"]);
    assert_eq!(output.status.code(), Some(1));
    assert!(String::from_utf8_lossy(&output.stderr).contains("missing.csv: could not be read"));
}
