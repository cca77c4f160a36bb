//! Pictures of the surroundings: their files, what they are multiplied with, and what else they change.

use std::io::Cursor;

use halfshade::color::Rgb;
use halfshade::import::SceneOptions;
use halfshade::math::{UVec2, UnitVec3};
use halfshade::output::exr::{Layer, Values, Window, write};
use halfshade::scene::{IntegratorKind, Keep};

use crate::files::{Files, with};

/// Two pixels: dim in the left half of all directions, bright in the right one.
const SKY: [[f32; 3]; 2] = [[0.25, 0.5, 1.0], [8.0, 4.0, 2.0]];

const LEFT: [f32; 3] = [-1.0, 0.0, 0.0];
const RIGHT: [f32; 3] = [1.0, 0.0, 0.0];

fn hdr() -> Vec<u8> {
    let mut bytes = Cursor::new(Vec::new());
    let pixels = SKY.map(image::Rgb);
    image::codecs::hdr::HdrEncoder::new(&mut bytes)
        .encode(&pixels, 2, 1)
        .unwrap();
    bytes.into_inner()
}

/// A directory with `sky.hdr`, `sky.exr` and `sky.png`.
fn skies() -> Files {
    let files = Files::new();
    files.write("sky.hdr", hdr());
    let path = files.write("sky.exr", "");
    let pixels = SKY.map(Rgb::from);
    let layer = Layer {
        name: "",
        values: Values::Colors(&pixels),
    };
    write(&path, Window::whole(UVec2::new(2, 1)), &[layer], &[]).unwrap();
    let mut bytes = Cursor::new(Vec::new());
    let image = image::RgbImage::from_fn(2, 1, |x, _| image::Rgb([188 + 67 * x as u8; 3]));
    image.write_to(&mut bytes, image::ImageFormat::Png).unwrap();
    files.write("sky.png", bytes.into_inner());
    files
}

fn toward(direction: [f32; 3]) -> UnitVec3 {
    UnitVec3::normalize(direction.into()).unwrap()
}

#[test]
fn every_format_is_read() {
    let files = skies();
    let seen = |name: &str, direction| {
        let text = format!("background.environment = \"{name}\"\n");
        let imported = files.scene(&text, &SceneOptions::default()).unwrap();
        let map = imported.scene.environment.unwrap();
        assert_eq!((map.name.as_str(), map.size()), (name, [2, 1]));
        map.radiance(toward(direction)).channels()
    };
    for name in ["sky.hdr", "sky.exr"] {
        assert_eq!(seen(name, LEFT), SKY[0], "{name}");
        assert_eq!(seen(name, RIGHT), SKY[1], "{name}");
    }
    // sRGB is decoded: level 188 is about one half.
    assert!((seen("sky.png", LEFT)[1] - 0.503).abs() < 2e-3);
    assert_eq!(seen("sky.png", RIGHT), [1.0; 3]);
}

#[test]
fn radiance_multiplies_and_rotate_turns() {
    let files = skies();
    let text = "[background]\nenvironment = \"sky.exr\"\nradiance = [2, 1, 0.5]\nrotate = 180\n";
    let scene = files.scene(text, &SceneOptions::default()).unwrap().scene;
    assert_eq!(scene.background.radiance, Rgb::BLACK);
    let map = scene.environment.unwrap();
    let got = map.radiance(toward(RIGHT));
    for (got, expected) in got.channels().into_iter().zip([0.5, 0.5, 0.5]) {
        assert!((got - expected).abs() < 1e-5, "{got}");
    }
}

/// The path of an override is that of the scene file as well.
#[test]
fn an_override_names_another() {
    let files = skies();
    let options = with(&[("background.environment", "\"sky.hdr\"")]);
    let text = "background.environment = \"missing.exr\"\n";
    let imported = files.scene(text, &options).unwrap();
    assert_eq!(imported.scene.environment.unwrap().name, "sky.hdr");
}

/// Only in `path` do surroundings light a scene: there no lights are added.
#[test]
fn surroundings_take_the_place_of_default_lights_in_path() {
    let files = skies();
    let text = |kind: &str| {
        format!(
            "background.environment = \"sky.exr\"\nintegrator.kind = \"{kind}\"\n\
             [[model]]\nfile = \"triangle.obj\"\n"
        )
    };
    let lights = |kind| {
        let imported = files.scene(&text(kind), &SceneOptions::default());
        imported.unwrap().scene.lights.len()
    };
    assert_eq!((lights("path"), lights("whitted")), (0, 3));
}

#[test]
fn what_needs_no_light_reads_no_surroundings() {
    let files = skies();
    let options = SceneOptions {
        keep: Keep::NOTHING,
        ..SceneOptions::default()
    };
    let text = "background.environment = \"sky.exr\"\nintegrator.kind = \"depth\"\nlight = []\n";
    let imported = files.scene(text, &options).unwrap();
    assert!(imported.scene.environment.is_none());
    let left_out = &imported.left_out[0];
    assert!(left_out.what.ends_with("sky.exr"), "{left_out:?}");
    assert_eq!(left_out.saved_bytes, 2 * 12);
}

#[test]
fn files_that_are_no_pictures_are_named() {
    let files = skies();
    files.write("text.exr", "not a picture");
    files.write("cut.hdr", &hdr()[..40]);
    let many_pixels = include_bytes!("../../fuzz/seeds/exr/many-pixels");
    files.write("many.exr", many_pixels);
    let whole = std::fs::read(files.write("again.exr", "")).unwrap();
    assert!(whole.is_empty());
    for (name, word) in [
        ("missing.exr", "missing.exr"),
        ("text.exr", "surroundings"),
        ("cut.hdr", "surroundings"),
        ("again.exr", "surroundings"),
        ("many.exr", "do not fit into its 541 bytes"),
    ] {
        let text = format!("background.environment = \"{name}\"\n");
        let error = files.scene(&text, &SceneOptions::default()).unwrap_err();
        assert!(error.starts_with(name) && error.contains(word), "{error}");
    }
}

/// glTF files by themselves are shown by all light, everything else as it was.
#[test]
fn models_by_themselves_have_their_technique() {
    let files = Files::new();
    let kind = |name: &str, overrides: &[(&str, &str)]| {
        let imported = files.import(name, &with(overrides)).unwrap();
        (imported.settings.integrator, imported.settings.depth())
    };
    assert_eq!(kind("studio.gltf", &[]), (IntegratorKind::Path, 64));
    assert_eq!(kind("triangle.obj", &[]), (IntegratorKind::Whitted, 8));
    let asked = [
        ("integrator.kind", "\"whitted\""),
        ("integrator.max_depth", "2"),
    ];
    assert_eq!(kind("studio.gltf", &asked), (IntegratorKind::Whitted, 2));
    let text = "[[model]]\nfile = \"studio.gltf\"\n";
    let scene = files.scene(text, &SceneOptions::default()).unwrap();
    assert_eq!(scene.settings.integrator, IntegratorKind::Whitted);
}

/// Where lights are added, what stands in for the surroundings is radiance in `path`; the text that is
/// printed says the same again.
#[test]
fn default_lights_bring_radiance_from_everywhere_in_path() {
    let files = Files::new();
    let model = "[[model]]\nfile = \"triangle.obj\"\n[integrator]\nkind = \"path\"\n";
    let scene = files.scene(model, &SceneOptions::default()).unwrap();
    assert_eq!(scene.scene.background.radiance, Rgb::splat(0.15));
    assert_eq!(scene.scene.background.ambient, Rgb::BLACK);
    let text = scene.defaults.unwrap().text;
    let again = files.scene(&format!("{text}{model}"), &SceneOptions::default());
    assert_eq!(again.unwrap().scene.background, scene.scene.background);
    // Unless the file says what there is.
    let dark = format!("background.radiance = [0, 0, 0]\n{model}");
    let dark = files.scene(&dark, &SceneOptions::default()).unwrap();
    assert_eq!(dark.scene.background.radiance, Rgb::BLACK);
}
