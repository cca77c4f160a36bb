//! The scenes of this project: each imports without a warning, shows something, and is told of in
//! the README; the penumbra scene follows its closed form.
#![allow(clippy::unwrap_used, clippy::expect_used)]

#[path = "common/project.rs"]
mod project;

use std::f64::consts::PI;
use std::fs;

use halfshade::film::Rect;
use project::{Overrides, film, load, root, scenes};

#[test]
fn every_scene_imports_without_a_warning() {
    for path in scenes() {
        let imported = load(&path, &[]);
        let warnings: Vec<_> = imported.warnings.iter().collect();
        assert!(warnings.is_empty(), "{}: {warnings:?}", path.display());
        assert!(imported.defaults.is_none(), "{}", path.display());
    }
}

#[test]
fn every_scene_shows_something() {
    let tiny: Overrides = &[("film.size", "[48, 32]"), ("sampling.samples", "4")];
    for path in scenes() {
        let name = path.display();
        let mut imported = load(&path, tiny);
        imported.settings.light_samples = Some(1);
        let film = film(&imported, None);
        assert_eq!(film.rejected, 0, "{name}");
        let values: Vec<f64> = film.means().iter().map(|c| c.luminance().into()).collect();
        let mean = values.iter().sum::<f64>() / values.len() as f64;
        let spread = values.iter().map(|v| (v - mean).abs()).sum::<f64>() / values.len() as f64;
        let clipped = values.iter().filter(|&&v| v > 1.0).count();
        assert!((0.05..0.9).contains(&mean), "{name}: mean luminance {mean}");
        assert!(spread > 0.05, "{name}: mean deviation {spread}");
        let most = values.len() / 20;
        assert!(clipped <= most, "{name}: {clipped} pixels too bright");
    }
}

#[test]
fn the_penumbra_scene_follows_its_closed_form() {
    let path = root().join("scenes/penumbra.toml");
    let imported = load(&path, &[("sampling.samples", "256")]);
    let middle_row = Rect {
        x: 0,
        y: 150,
        width: 300,
        height: 1,
    };
    let values = film(&imported, Some(middle_row)).means();
    let mut sum = 0.0;
    for (column, value) in values.iter().enumerate() {
        let x = (column as f64 + 0.5) / 500.0 - 0.3;
        let expected = 0.7995 * visible_fraction(3.0 * x / 0.6);
        let error = f64::from(value.g) - expected;
        assert!(error.abs() < 0.02, "x = {x}: {} for {expected}", value.g);
        sum += error * error;
    }
    let rmse = (sum / values.len() as f64).sqrt();
    assert!(rmse < 0.004, "root of the mean square error {rmse}");
}

/// The share of a disk that is on the lit side of a straight edge; `s` is the distance of its
/// centre from the edge over its radius.
fn visible_fraction(s: f64) -> f64 {
    let s = s.clamp(-1.0, 1.0);
    ((-s).acos() + s * (1.0 - s * s).sqrt()) / PI
}

#[test]
fn the_readme_tells_of_every_scene() {
    let readme = fs::read_to_string(root().join("README.md")).unwrap();
    for path in scenes() {
        let name = format!("scenes/{}", path.file_name().unwrap().to_str().unwrap());
        assert!(readme.contains(&name), "{name} is not in README.md");
        let text = fs::read_to_string(&path).unwrap();
        assert!(text.starts_with("# "), "{name} does not say what it shows");
    }
}
