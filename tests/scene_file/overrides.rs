//! `--set PATH=VALUE`.

use halfshade::color::Rgb;
use halfshade::import::Imported;
use halfshade::light::Light;
use halfshade::math::{DVec3, UVec2};
use halfshade::sampling::Pattern;

use crate::files::scene_with;

const LAMP: &str = "[[light]]\nkind = \"point\"\nposition = [0, 0, 0]\nintensity = [1, 1, 1]\nradius = 2\n\n[film]\nsize = [10, 10]\n";

fn radius(imported: &Imported, light: usize) -> f32 {
    match imported.scene.lights[light].item {
        Light::Point(point) => point.radius,
        other => panic!("{other:?}"),
    }
}

#[test]
fn a_value_replaces_that_of_the_file() {
    let imported = scene_with(LAMP, &[("light.0.radius", "0"), ("film.size", "[3, 4]")]).unwrap();
    assert_eq!(radius(&imported, 0), 0.0);
    assert_eq!(imported.settings.size, UVec2::new(3, 4));
}

#[test]
fn the_last_of_several_counts() {
    let twice = [("light.0.radius", "5"), ("light.0.radius", "7")];
    assert_eq!(radius(&scene_with(LAMP, &twice).unwrap(), 0), 7.0);
}

#[test]
fn elements_of_lists_can_be_set() {
    let imported = scene_with(
        LAMP,
        &[("film.size.1", "77"), ("light.0.position.2", "1e9")],
    );
    let imported = imported.unwrap();
    assert_eq!(imported.settings.size, UVec2::new(10, 77));
    assert_eq!(imported.scene.lights[0].origin, DVec3::new(0.0, 0.0, 1e9));
}

#[test]
fn bare_words_are_text() {
    for value in ["random", "\"random\"", " 'random' "] {
        let imported = scene_with("", &[("sampling.pattern", value)]).unwrap();
        assert_eq!(imported.settings.sampling.pattern, Pattern::Random);
    }
    let imported = scene_with("", &[("background.radiance", "#ffffff")]).unwrap();
    assert_eq!(imported.scene.background.radiance, Rgb::WHITE);
}

#[test]
fn what_is_missing_is_made() {
    let set = [
        ("light.1.kind", "point"),
        ("light.1.position", "[1, 2, 3]"),
        ("light.1.intensity", "[1, 1, 1]"),
        ("light.1.falloff.constant", "1"),
    ];
    let imported = scene_with(LAMP, &set).unwrap();
    assert_eq!(imported.scene.lights.len(), 2);
    assert_eq!(imported.scene.lights[1].origin, DVec3::new(1.0, 2.0, 3.0));
    let imported = scene_with(
        "",
        &[(
            "light.0",
            "{ kind = 'distant', direction = [0, 1, 0], irradiance = '#fff' }",
        )],
    );
    assert_eq!(imported.unwrap().scene.lights.len(), 1);
}

#[test]
fn mistakes_name_the_path() {
    for (path, value, words) in [
        ("light.0.raduis", "1", "unknown key \"raduis\" in [[light]]"),
        (
            "light.0.radius",
            "-1",
            "radius must be a number that is at least 0, not -1",
        ),
        ("light.0.radius", "large", "not \"large\""),
        (
            "light.0.radius.x",
            "1",
            "light.0.radius is 2, which has no \"x\"",
        ),
        ("light.2.radius", "1", "light is a list of 1: the next is 1"),
        ("light.1.radius", "1", "needs \"kind\""),
        (
            "light.first.radius",
            "1",
            "light is a list: \"first\" must be a number",
        ),
        ("light..radius", "1", "not a path"),
        ("", "1", "not a path"),
        ("ligth.0.radius", "1", "did you mean \"light\"?"),
        ("film.size", "[3, 4", "not \"[3, 4\""),
        ("film.size", "[3, 4]\n[sampling]", "size must be"),
        ("light.0.position", "[0, nan, 0]", "finite"),
    ] {
        let error = scene_with(LAMP, &[(path, value)]).expect_err(path);
        let place = format!("scene.toml, --set {path}");
        assert!(error.starts_with(&place), "{path}={value}: {error}");
        assert!(error.contains(words), "{path}={value}: {error}");
    }
}

#[test]
fn lines_of_the_file_stay_what_they_are() {
    let text = format!("{LAMP}\n[sampling]\nsamples = 0\n");
    let set = [
        ("light.0.falloff", "{ constant = 1 }"),
        ("light.0.samples", "3"),
    ];
    let error = scene_with(&text, &set).expect_err("samples = 0");
    assert!(error.starts_with("scene.toml, line 11: "), "{error}");
}
