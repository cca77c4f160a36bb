//! The camera and the lights of scenes that have none.

use halfshade::camera::{Camera, Projection};
use halfshade::import::{Imported, SceneOptions};
use halfshade::light::Light;
use halfshade::math::{DVec3, Vec2, Vec3};
use halfshade::scene::Placed;

use crate::files::{Files, scene};

/// A box with its lower corner at `min`.
fn box_obj(min: DVec3, size: DVec3) -> String {
    let mut text = String::new();
    for corner in 0..8 {
        let offset = DVec3::new(
            f64::from(corner & 1),
            f64::from(corner >> 1 & 1),
            f64::from(corner >> 2),
        );
        let p = min + size * offset;
        text += &format!("v {:?} {:?} {:?}\n", p.x, p.y, p.z);
    }
    text + "f 1 2 4 3\nf 5 6 8 7\n"
}

fn bare(files: &Files, obj: &str) -> Imported {
    files.write("box.obj", obj);
    files.import("box.obj", &SceneOptions::default()).unwrap()
}

/// Where `camera` sees `point`: -1 to 1 across and up the part of the picture that is `aspect`
/// wide for its height.
fn seen_at(camera: &Placed<Camera>, point: DVec3, aspect: f64) -> Vec2 {
    let v = (point - camera.origin).as_vec3() - camera.item.position;
    let Projection::Perspective {
        vertical_fov_radians,
    } = camera.item.projection
    else {
        panic!("a perspective camera")
    };
    let depth = -v.dot(*camera.item.back);
    assert!(depth > 0.0, "behind the camera");
    let half_height = depth * (0.5 * vertical_fov_radians).tan();
    Vec2::new(
        v.dot(*camera.item.right) / (half_height * aspect as f32),
        v.dot(*camera.item.up) / half_height,
    )
}

#[test]
fn the_default_camera_shows_everything_and_little_else() {
    let files = Files::new();
    for (size, film) in [
        (DVec3::new(1.0, 1.0, 1.0), [1280.0, 720.0]),
        (DVec3::new(9.0, 0.0, 9.0), [1280.0, 720.0]),
        (DVec3::new(0.1, 30.0, 0.1), [1280.0, 720.0]),
        (DVec3::new(30.0, 0.1, 0.1), [200.0, 900.0]),
    ] {
        let min = DVec3::new(-7.0, 2.0, 5.0);
        files.write("box.obj", box_obj(min, size));
        let text = format!(
            "[film]\nsize = [{}, {}]\n[[model]]\nfile = \"box.obj\"\n",
            film[0], film[1]
        );
        let imported = files.scene(&text, &SceneOptions::default()).unwrap();
        let mut largest: f32 = 0.0;
        for corner in 0..8 {
            let sign = |bit: i32| f64::from(corner >> bit & 1);
            let point = min + size * DVec3::new(sign(0), sign(1), sign(2));
            let at = seen_at(&imported.scene.cameras[0], point, film[0] / film[1]);
            largest = largest.max(at.abs().max_element());
        }
        assert!((0.7..0.97).contains(&largest), "{size}: {largest}");
    }
}

#[test]
fn the_default_camera_follows_powers_of_two_to_the_bit() {
    let files = Files::new();
    let at = |scale: f64| {
        let obj = box_obj(
            scale * DVec3::new(0.25, -1.5, 3.0),
            scale * DVec3::new(1.0, 0.75, 2.5),
        );
        bare(&files, &obj)
    };
    let one = at(1.0);
    for k in [-40, -7, 3, 40] {
        let scale = 2f64.powi(k);
        let scaled = at(scale);
        let [a, b] = [&one, &scaled].map(|imported| &imported.scene.cameras[0]);
        assert_eq!(b.origin, scale * a.origin, "2^{k}");
        assert_eq!(
            (b.item.right, b.item.up, b.item.back),
            (a.item.right, a.item.up, a.item.back)
        );
        assert_eq!(b.item.focus_distance, scale as f32 * a.item.focus_distance);
        for (a, b) in one.scene.lights.iter().zip(&scaled.scene.lights) {
            assert_eq!(format!("{a:?}"), format!("{b:?}"), "2^{k}");
        }
    }
}

#[test]
fn a_scene_far_from_the_origin_is_framed_as_near_it() {
    let files = Files::new();
    let at = |min: DVec3| {
        let imported = bare(&files, &box_obj(min, DVec3::ONE));
        imported.scene.cameras[0].origin - min
    };
    let moved = at(DVec3::new(5e6, 1e5, -4e6)) - at(DVec3::ZERO);
    assert!(moved.length() < 1e-8, "{moved}");
}

#[test]
fn nothing_to_see_is_no_reason_to_fail() {
    let files = Files::new();
    files.write("point.obj", "v 3 4 5\nv 3 4 5\nv 3 4 5\nf 1 2 3\n");
    files.write("empty.obj", "");
    for text in [
        "",
        "[[model]]\nfile = \"point.obj\"\n",
        "[[model]]\nfile = \"empty.obj\"\n",
    ] {
        let Ok(imported) = files.scene(text, &SceneOptions::default()) else {
            assert!(text.contains("empty"), "{text}");
            continue;
        };
        let camera = &imported.scene.cameras[0];
        assert!(camera.origin.is_finite() && camera.item.back.is_finite());
        assert_eq!(imported.scene.lights.len(), 3);
    }
}

fn assert_same(a: &Imported, b: &Imported) {
    // Debug prints floating-point numbers to their last digit.
    assert_eq!(
        format!("{:?}", a.scene.cameras),
        format!("{:?}", b.scene.cameras)
    );
    assert_eq!(
        format!("{:?}", a.scene.lights),
        format!("{:?}", b.scene.lights)
    );
    assert_eq!(a.scene.background, b.scene.background);
}

#[test]
fn pasted_defaults_are_the_same_to_the_bit() {
    let files = Files::new();
    let obj = box_obj(
        DVec3::new(0.1, 1e3 / 7.0, -5e5 / 3.0),
        DVec3::new(1e-3, 2.0, 0.3),
    );
    let implicit = bare(&files, &obj);
    let defaults = implicit.defaults.as_ref().expect("defaults");
    assert_eq!((defaults.cameras, defaults.lights), (1, 3));
    let text = format!("[[model]]\nfile = \"box.obj\"\n\n{}", defaults.text);
    let pasted = files.scene(&text, &SceneOptions::default()).unwrap();
    assert!(pasted.defaults.is_none(), "{:?}", pasted.defaults);
    assert_same(&implicit, &pasted);
}

#[test]
fn a_background_without_ambient_light_gets_the_default() {
    let background = |text: &str| scene(text).unwrap().scene.background;
    let bare = background("");
    assert_eq!(background("[background]\n"), bare);
    assert_eq!(background("[background]\nradiance = [0, 0, 0]\n"), bare);
    let dark = background("[background]\nambient = [0, 0, 0]\n");
    assert!(dark.ambient.is_black() && !bare.ambient.is_black());

    let implicit = scene("[background]\nradiance = [0.1, 0.2, 0.7]\n").unwrap();
    assert_eq!(implicit.scene.background.ambient, bare.ambient);
    let pasted = scene(&implicit.defaults.clone().expect("defaults").text).unwrap();
    assert_same(&implicit, &pasted);
}

#[test]
fn the_lens_of_a_default_camera_is_pasted_with_it() {
    let lens = "[camera]\nlens_radius = 0.1\nfocus_distance = 2.7\nvertical_fov = 33.3\n";
    let implicit = scene(lens).unwrap();
    assert_eq!(implicit.scene.cameras[0].item.lens_radius, 0.1);
    let pasted = scene(&implicit.defaults.clone().expect("defaults").text).unwrap();
    assert_same(&implicit, &pasted);
}

#[test]
fn only_what_is_missing_is_added() {
    let lamp = "[[light]]\nkind = \"distant\"\ndirection = [0, -1, 0]\nirradiance = [1, 1, 1]\n";
    let view = "[camera]\nposition = [0, 0, 9]\nlook_at = [0, 0, 0]\n";
    let counts = |text: &str| {
        let defaults = scene(text).unwrap().defaults;
        defaults.map_or((0, 0), |added| (added.cameras, added.lights))
    };
    assert_eq!(counts(lamp), (1, 0));
    assert_eq!(counts(view), (0, 3));
    assert_eq!(counts(&format!("{view}{lamp}")), (0, 0));
    assert_eq!(counts(&format!("light = []\n{view}")), (0, 0));
    assert!(scene("light = []\n").unwrap().scene.lights.is_empty());
}

#[test]
fn a_matte_surface_that_faces_the_key_light_is_well_exposed() {
    let imported = scene("").unwrap();
    let radiance = |normal: Vec3| -> f32 {
        let reflectance = 0.5 / std::f32::consts::PI;
        let lights = imported.scene.lights.iter();
        let samples = lights.filter_map(|l| l.item.sample(Vec3::ZERO, Vec2::splat(0.5)));
        samples
            .map(|s| reflectance * s.weight.r * s.wi.dot(normal).max(0.0))
            .sum()
    };
    let Light::Distant(key) = imported.scene.lights[0].item else {
        panic!("a distant key light")
    };
    let facing_key = radiance(-*key.direction);
    assert!((0.45..0.65).contains(&facing_key), "{facing_key}");
    let facing_camera = radiance(*imported.scene.cameras[0].item.back);
    assert!((0.25..0.6).contains(&facing_camera), "{facing_camera}");
}
