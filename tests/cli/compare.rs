//! `halfshade compare`.

use std::fs;
use std::path::Path;
use std::process::Output;

use halfshade::color::Rgb;
use halfshade::math::UVec2;
use halfshade::output::exr::{Layer, Values, Window, write as write_exr};
use halfshade::output::png::{PngOptions, write as write_png};
use serde_json::{Value, json};
use tempfile::TempDir;

use super::{names, run, stderr, stdout};

const SIZE: UVec2 = UVec2::new(32, 24);

fn exr(path: &Path, pixels: &[Rgb]) {
    let layer = Layer {
        name: "",
        values: Values::Colors(pixels),
    };
    write_exr(path, Window::whole(SIZE), &[layer], &[]).unwrap();
}

/// `half.exr` and `quarter.exr` are of one colour, `bad.exr` has two pixels that are not finite,
/// `dark.exr` has no others, and `small.png` is of another size.
fn folder() -> TempDir {
    let folder = tempfile::tempdir().unwrap();
    let file = |name: &str| folder.path().join(name);
    let count = (SIZE.x * SIZE.y) as usize;
    let plain = |v: f32| vec![Rgb::splat(v); count];
    exr(&file("half.exr"), &plain(0.5));
    exr(&file("quarter.exr"), &plain(0.25));
    let mut bad = plain(0.5);
    bad[33] = Rgb::new(0.0, f32::NAN, 0.0);
    bad[40] = Rgb::splat(f32::INFINITY);
    exr(&file("bad.exr"), &bad);
    exr(&file("dark.exr"), &plain(f32::NAN));
    write_png(
        &file("quarter.png"),
        SIZE,
        &plain(0.25),
        None,
        PngOptions::default(),
    )
    .unwrap();
    let small = UVec2::new(5, 4);
    write_png(
        &file("small.png"),
        small,
        &plain(0.5)[..20],
        None,
        PngOptions::default(),
    )
    .unwrap();
    folder
}

fn compare(folder: &Path, arguments: &[&str]) -> Output {
    run(folder, &[&["compare"], arguments].concat())
}

fn compare_well(folder: &Path, arguments: &[&str]) -> Output {
    let output = compare(folder, arguments);
    assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
    output
}

fn json_of(folder: &Path, a: &str, b: &str) -> Value {
    let output = compare_well(folder, &[a, b, "--json"]);
    serde_json::from_str(stdout(&output)).unwrap()
}

#[test]
fn json_has_the_documented_keys() {
    let folder = folder();
    let report = json_of(folder.path(), "half.exr", "quarter.exr");
    let number = |key: &str| {
        report[key]
            .as_f64()
            .unwrap_or_else(|| panic!("{key}: {report}"))
    };
    assert!((number("rmse") - 0.25).abs() < 1e-9);
    assert!((number("mae") - 0.25).abs() < 1e-9);
    assert!((number("relmse") - 0.0625 / 0.0725).abs() < 1e-9);
    for key in ["psnr", "ssim", "flip", "hdr_flip"] {
        assert!(number(key) > 0.0, "{key}");
    }
    assert_eq!(report["non_finite"], json!([0, 0]));
    assert_eq!(report["first_non_finite"], json!([null, null]));
    assert_eq!(report["size"], json!([32, 24]));
    let worst = &report["worst"][0];
    assert_eq!(report["worst"].as_array().unwrap().len(), 3);
    assert_eq!(worst["pixel"], json!([0, 0]));
    assert_eq!(worst["a"], json!([0.5, 0.5, 0.5]));
    assert_eq!(worst["b"], json!([0.25, 0.25, 0.25]));
}

#[test]
fn equal_pictures_are_equal_in_text_and_json() {
    let folder = folder();
    let report = json_of(folder.path(), "half.exr", "half.exr");
    for key in ["rmse", "relmse", "mae", "flip", "hdr_flip"] {
        assert_eq!(report[key], 0.0, "{key}");
    }
    assert_eq!(report["psnr"], Value::Null);
    assert_eq!(report["ssim"], 1.0);
    assert_eq!(report["worst"], json!([]));
    let output = compare_well(folder.path(), &["half.exr", "half.exr"]);
    let text = stdout(&output);
    for part in [
        "A half.exr, 32x24 pixels",
        "B half.exr (reference)",
        "infinite",
    ] {
        assert!(text.contains(part), "{part}: {text}");
    }
}

#[test]
fn png_and_exr_of_one_picture_are_nearly_equal() {
    let folder = folder();
    let report = json_of(folder.path(), "quarter.png", "quarter.exr");
    let rmse = report["rmse"].as_f64().unwrap();
    // Half a level of 255, as wide as levels are at a quarter.
    assert!(rmse < 0.5 * 0.0041, "{rmse}");
}

#[test]
fn pixels_that_are_not_finite_are_told_and_left_out() {
    let folder = folder();
    let report = json_of(folder.path(), "bad.exr", "quarter.exr");
    assert_eq!(report["non_finite"], json!([2, 0]));
    assert_eq!(report["first_non_finite"], json!([[1, 1], null]));
    assert!((report["rmse"].as_f64().unwrap() - 0.25).abs() < 1e-9);
    let output = compare_well(folder.path(), &["bad.exr", "quarter.exr"]);
    let text = stdout(&output);
    assert!(
        text.contains("2 pixels in A, 0 in B; the first in A at 1,1; left out"),
        "{text}"
    );
}

#[test]
fn limits_decide_the_exit_status() {
    let folder = folder();
    let with = |limits: &[&str]| {
        compare(
            folder.path(),
            &[&["half.exr", "quarter.exr"], limits].concat(),
        )
    };
    for limits in [
        &[
            "--fail-above",
            "rmse=0.2501",
            "--fail-above",
            "non_finite=0",
        ][..],
        &["--fail-above", "flip=1", "--fail-below", "psnr=3"],
    ] {
        let output = with(limits);
        assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
    }
    for (limits, expected) in [
        (
            &["--fail-above", "relmse=1e-4"][..],
            &["relmse is 0.86", "above 0.0001"][..],
        ),
        (
            &[
                "--fail-above",
                "rmse=1",
                "--fail-above",
                "mae=0.1",
                "--fail-below",
                "ssim=1",
            ],
            &["half.exr: mae is 0.25, above 0.1; ssim is 0.", "below 1"],
        ),
    ] {
        let output = with(limits);
        let text = stderr(&output);
        assert_eq!(output.status.code(), Some(1), "{text}");
        assert!(
            stdout(&output).contains("relMSE"),
            "the figures are printed all the same"
        );
        for part in expected {
            assert!(text.contains(part), "{limits:?}: {text}");
        }
    }
    let small = compare(
        folder.path(),
        &["small.png", "small.png", "--fail-below", "ssim=0.5"],
    );
    assert_eq!(small.status.code(), Some(1));
    assert!(
        stderr(&small).contains("ssim is not known"),
        "{}",
        stderr(&small)
    );
    let bad = compare(
        folder.path(),
        &["bad.exr", "bad.exr", "--fail-above", "non_finite=3"],
    );
    assert_eq!(bad.status.code(), Some(1), "two in each");
}

#[test]
fn wrong_arguments_are_named_and_exit_with_2() {
    let folder = folder();
    let before = names(folder.path());
    for (arguments, expected) in [
        (&["half.exr"][..], "<B>"),
        (
            &["half.exr", "quarter.exr", "--fail-above", "relmes=1"],
            "did you mean \"relmse\"?",
        ),
        (
            &["half.exr", "quarter.exr", "--fail-above", "loss=1"],
            "known: rmse",
        ),
        (
            &["half.exr", "quarter.exr", "--fail-above", "rmse"],
            "METRIC=VALUE",
        ),
        (
            &["half.exr", "quarter.exr", "--fail-above", "rmse=low"],
            "not a number",
        ),
        (
            &["half.exr", "quarter.exr", "--fail-above", "psnr=30"],
            "--fail-below",
        ),
        (
            &["half.exr", "quarter.exr", "--fail-below", "flip=0.1"],
            "--fail-above",
        ),
        (&["half.exr", "quarter.exr", "--map", "ssim"], "relative"),
        (&["half.exr", "quarter.exr", "-o", "d.exr"], ".png or .html"),
        (
            &["half.exr", "quarter.exr", "-o", "d.png", "-o", "./d.png"],
            "twice",
        ),
        (
            &["quarter.png", "quarter.exr", "-o", "quarter.png"],
            "one of the pictures",
        ),
    ] {
        let output = compare(folder.path(), arguments);
        let text = stderr(&output);
        assert_eq!(output.status.code(), Some(2), "{arguments:?}: {text}");
        assert!(text.contains(expected), "{arguments:?}: {text}");
        assert!(output.stdout.is_empty(), "{arguments:?}");
    }
    assert_eq!(names(folder.path()), before);
}

#[test]
fn what_cannot_be_compared_says_why_and_exits_with_1() {
    let folder = folder();
    fs::write(folder.path().join("text.png"), "not a picture").unwrap();
    let before = names(folder.path());
    for (arguments, expected) in [
        (
            &["none.exr", "half.exr"][..],
            &["none.exr", "could not be read"][..],
        ),
        (
            &["half.exr", "text.png"],
            &["text.png", "neither a PNG nor an EXR"],
        ),
        (
            &["half.exr", "small.png", "-o", "d.png"],
            &["half.exr and small.png", "sizes differ: 32x24 and 5x4"],
        ),
        (
            &["dark.exr", "half.exr"],
            &["dark.exr", "no pixel is finite in both"],
        ),
        (
            &["half.exr", "half.exr", "-o", "no/d.html"],
            &["no/d.html", "folder \"no\""],
        ),
    ] {
        let output = compare(folder.path(), arguments);
        let text = stderr(&output);
        assert_eq!(output.status.code(), Some(1), "{arguments:?}: {text}");
        assert_eq!(text.matches("error:").count(), 1, "{arguments:?}: {text}");
        for part in expected {
            assert!(text.contains(part), "{arguments:?}: {text}");
        }
    }
    assert_eq!(names(folder.path()), before);
}

#[test]
fn differences_are_written_as_pictures_and_pages() {
    let folder = folder();
    let path = folder.path();
    compare_well(
        path,
        &["bad.exr", "quarter.exr", "-o", "d.png", "-o", "d.HTML"],
    );
    let map = image::open(path.join("d.png")).unwrap().into_rgb8();
    assert!(map.width() >= SIZE.x && map.height() > SIZE.y);
    let cyan = map.pixels().filter(|p| p.0 == [0, 255, 255]).count();
    assert_eq!(cyan, 2);
    let page = fs::read_to_string(path.join("d.HTML")).unwrap();
    for part in [
        "bad.exr against quarter.exr",
        "type=\"range\"",
        "relMSE",
        "are cyan",
        "1e-4",
    ] {
        assert!(page.contains(part), "{part}");
    }
    assert!(!page.contains("http"));
    let flip = fs::read(path.join("d.png")).unwrap();
    for other in ["hdr-flip", "relative"] {
        compare_well(
            path,
            &["bad.exr", "quarter.exr", "-o", "d.png", "--map", other],
        );
        assert!(fs::read(path.join("d.png")).unwrap() != flip, "{other}");
    }
}

#[test]
fn a_passed_limit_keeps_the_picture_of_the_difference() {
    let folder = folder();
    let output = compare(
        folder.path(),
        &[
            "half.exr",
            "quarter.exr",
            "--fail-above",
            "rmse=0",
            "-o",
            "d.png",
        ],
    );
    assert_eq!(output.status.code(), Some(1));
    assert!(names(folder.path()).contains(&"d.png".to_owned()));
}
