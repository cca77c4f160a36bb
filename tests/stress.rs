//! `halfshade stress`: every numerical case, and what scripts read of it.
#![allow(clippy::unwrap_used, clippy::expect_used)]

use std::path::Path;
use std::process::{Command, Output};

use halfshade::stress::cases;
use serde_json::Value;

fn stress(arguments: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_halfshade"))
        .arg("stress")
        .args(arguments)
        .current_dir(env!("CARGO_MANIFEST_DIR"))
        .output()
        .unwrap()
}

fn json(output: &Output) -> Vec<Value> {
    let error = String::from_utf8_lossy(&output.stderr);
    serde_json::from_slice(&output.stdout).unwrap_or_else(|_| panic!("{error}"))
}

#[test]
fn every_case_passes() {
    let output = stress(&["--json"]);
    let reports = json(&output);
    let ids: Vec<&str> = cases().map(|case| case.id).collect();
    let given: Vec<&str> = reports.iter().map(|r| r["id"].as_str().unwrap()).collect();
    assert_eq!(given, ids);
    assert_eq!(ids.len(), 26);
    for report in &reports {
        let id = report["id"].as_str().unwrap();
        assert_eq!(report["status"], "pass", "{report:#}");
        assert!(report["case"].is_string());
        assert!(
            report["measured"].is_number() && report["bound"].is_number(),
            "{id}"
        );
    }
    assert_eq!(output.status.code(), Some(0));
}

#[test]
fn cases_are_chosen_by_name() {
    let reports = json(&stress(&["g9", "L11", "--json"]));
    assert_eq!(
        (&reports[0]["id"], &reports[1]["id"]),
        (&"G9".into(), &"L11".into())
    );
    let output = stress(&["G14"]);
    assert_eq!(output.status.code(), Some(2));
    assert!(String::from_utf8_lossy(&output.stderr).contains("G14"));
}

#[test]
fn the_page_holds_the_sweeps() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("report");
    let output = stress(&["G9", "L8", "-o", path.to_str().unwrap()]);
    assert_eq!(output.status.code(), Some(0));
    let page = std::fs::read_to_string(path.join("stress.html")).unwrap();
    for text in ["<h2>G9", "<h2>L8", "<svg", "angle above the plane, rad"] {
        assert!(page.contains(text), "{text}");
    }
}

#[test]
fn a_scene_is_held_against_itself() {
    // By whitted and by path.
    for scene in ["scenes/glass.toml", "scenes/cornell.toml"] {
        assert_holds(scene);
    }
}

fn assert_holds(scene: &str) {
    let output = stress(&[scene, "--size", "40x30", "--json"]);
    let reports = json(&output);
    let of = |id: &str| {
        reports
            .iter()
            .filter(|r| r["id"] == *id)
            .collect::<Vec<_>>()
    };
    for id in [
        "scale-2",
        "scale-10",
        "shift",
        "axes",
        "mirror",
        "order",
        "instances",
        "tree",
    ] {
        assert!(!of(id).is_empty(), "{id}");
    }
    for report in of("scale-2").iter().chain(&of("tree")) {
        assert_eq!(report["measured"], 0.0, "{report:#}");
    }
    assert_eq!(output.status.code(), Some(0));
}

/// A sheet that is there twice in two colours: which is seen depends on the order in the file.
#[test]
fn a_scene_that_depends_on_the_order_of_its_triangles_fails() {
    let folder = tempfile::tempdir().unwrap();
    let write = |name: &str, text: &str| std::fs::write(folder.path().join(name), text).unwrap();
    write("two.obj", TWO_SHEETS);
    let scene: &Path = &folder.path().join("two.obj");
    let output = stress(&[scene.to_str().unwrap(), "--size", "40x30", "--json"]);
    let reports = json(&output);
    let order = reports.iter().find(|r| r["id"] == "order").unwrap();
    assert_eq!(order["status"], "fail");
    let note = order["checks"][0]["note"].as_str().unwrap();
    assert!(note.contains("--replay"), "{note}");
    assert_eq!(output.status.code(), Some(1));
}

/// The same square, cut along one diagonal and the other, with normals to two sides.
const TWO_SHEETS: &str = "\
v -1 -1 0\nv 1 -1 0\nv 1 1 0\nv -1 1 0\nvn 0 0 1\nvn 0.6 0 0.8
f 1//1 2//1 3//1\nf 1//1 3//1 4//1\nf 1//2 2//2 4//2\nf 2//2 3//2 4//2
";
