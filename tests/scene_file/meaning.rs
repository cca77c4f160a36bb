//! Every key does what the reference says.

use halfshade::camera::Projection;
use halfshade::color::{Rgb, srgb8_to_linear};
use halfshade::light::Light;
use halfshade::material::{AlphaMode, Surface};
use halfshade::math::{DVec3, UVec2, Vec3};
use halfshade::sampling::{Pattern, SamplingConfig, Target};
use halfshade::scene::{IntegratorKind, Settings};

use crate::files::scene;

fn close(a: Vec3, b: Vec3) -> bool {
    (a - b).length() < 1e-6
}

#[test]
fn an_empty_file_is_a_scene_with_default_settings() {
    let imported = scene("").unwrap();
    assert_eq!(imported.settings, Settings::default());
    assert_eq!(imported.scene.triangle_count(), 0);
    assert!(imported.scene.background.radiance.is_black());
    // Ambient light comes with the default lights, and only with them.
    assert!(!imported.scene.background.ambient.is_black());
    let dark = scene("light = []\n").unwrap();
    assert!(dark.scene.background.ambient.is_black());
    assert!(imported.warnings.is_empty());
}

#[test]
fn settings_are_read() {
    let imported = scene(
        "[film]\nsize = [320, 200]\n\
         [sampling]\nsamples = 9\npattern = \"jittered\"\ntarget = \"circle\"\nseed = 18446744073709551615\n\
         [integrator]\nkind = \"depth\"\nmax_depth = 3\nshadow_terminator = false\n\
         [background]\nradiance = [0.5, 0.7, 1.0]\nambient = [0.1, 0.2, 0.3]\n",
    )
    .unwrap();
    let expected = Settings {
        size: UVec2::new(320, 200),
        sampling: SamplingConfig {
            samples: 9,
            pattern: Pattern::Jittered,
            target: Target::Circle,
            seed: u64::MAX,
        },
        integrator: IntegratorKind::Depth,
        max_depth: Some(3),
        shadow_terminator: false,
        ..Settings::default()
    };
    assert_eq!(imported.settings, expected);
    assert_eq!(imported.scene.background.radiance, Rgb::new(0.5, 0.7, 1.0));
    assert_eq!(imported.scene.background.ambient, Rgb::new(0.1, 0.2, 0.3));
}

#[test]
fn a_camera_of_its_own_is_the_first() {
    let imported = scene(
        "[camera]\nposition = [1e9, 1.0, 5.0]\nlook_at = [1e9, 1.0, 2.0]\nup = [1, 0, 0]\nvertical_fov = 90\nlens_radius = 0.25\n",
    )
    .unwrap();
    let camera = &imported.scene.cameras[0];
    assert_eq!(camera.origin, DVec3::new(1e9, 1.0, 5.0));
    assert_eq!(camera.item.position, Vec3::ZERO);
    assert!(close(*camera.item.back, Vec3::Z));
    assert!(close(*camera.item.up, Vec3::X));
    assert!(close(*camera.item.right, Vec3::NEG_Y));
    assert_eq!(camera.item.lens_radius, 0.25);
    assert_eq!(camera.item.focus_distance, 3.0);
    let Projection::Perspective {
        vertical_fov_radians,
    } = camera.item.projection
    else {
        panic!("a perspective camera")
    };
    assert!((vertical_fov_radians - std::f32::consts::FRAC_PI_2).abs() < 1e-6);
}

#[test]
fn an_up_along_the_view_is_replaced() {
    let imported =
        scene("[camera]\nposition = [0.1, 9.3, 0.7]\nlook_at = [0.1, 0, 0.7]\n").unwrap();
    let camera = &imported.scene.cameras[0].item;
    assert!(close(*camera.back, Vec3::Y));
    assert!(camera.up.dot(*camera.back).abs() < 1e-6);
    assert!(camera.right.dot(*camera.up).abs() < 1e-6);
}

#[test]
fn lights_of_every_kind_are_read() {
    let imported = scene(
        "[[light]]\nkind = \"point\"\nposition = [4, 6, 3]\nintensity = [900, 850, 700]\nradius = 0.5\nsamples = 81\n\
         falloff = { constant = 1.0, quadratic = 0.5 }\n\
         [[light]]\nkind = \"spot\"\nposition = [0, 1, 0]\ndirection = [0, -2, 0]\nintensity = [1, 2, 3]\ninner_angle = 30\nouter_angle = 30\n\
         [[light]]\nkind = \"distant\"\ndirection = [0, -1, 0]\nirradiance = \"#ffffff\"\nangle = 90\n\
         [[light]]\nkind = \"disk\"\nposition = [0, 3, 0]\nnormal = [0, -4, 0]\nradius = 0.5\nradiance = [20, 20, 20]\nvisible = false\n\
         [[light]]\nkind = \"rectangle\"\nposition = [1, 2, 3]\nedge_u = [2, 0, 0]\nedge_v = [0, 0, 1]\nradiance = [1, 1, 1]\nsamples = 4\n\
         [[light]]\nkind = \"sphere\"\nposition = [1, 2, 3]\nradius = 2\nradiance = [1, 1, 1]\n",
    )
    .unwrap();
    let lights = &imported.scene.lights;
    let [
        Light::Point(point),
        Light::Spot(spot),
        Light::Distant(distant),
    ] = [lights[0].item, lights[1].item, lights[2].item]
    else {
        panic!("{lights:?}")
    };
    assert_eq!(lights[0].origin, DVec3::new(4.0, 6.0, 3.0));
    assert_eq!(point.position, Vec3::ZERO);
    assert_eq!(point.intensity, Rgb::new(900.0, 850.0, 700.0));
    assert_eq!((point.radius, point.samples), (0.5, 81));
    let falloff = [
        point.falloff.constant,
        point.falloff.linear,
        point.falloff.quadratic,
    ];
    assert_eq!(falloff, [1.0, 0.0, 0.5]);
    assert_eq!(*spot.direction, Vec3::NEG_Y);
    assert_eq!((spot.radius, spot.samples), (0.0, 1));
    assert_eq!(spot.falloff.quadratic, 1.0);
    assert!(spot.outer_angle_radians > spot.inner_angle_radians);
    assert!((spot.outer_angle_radians - 30f32.to_radians()).abs() < 1e-6);
    assert_eq!(distant.irradiance, Rgb::WHITE);
    assert_eq!(distant.angle_radians, std::f32::consts::FRAC_PI_2);
    let [
        Light::Disk(disk),
        Light::Rectangle(rectangle),
        Light::Sphere(sphere),
    ] = [lights[3].item, lights[4].item, lights[5].item]
    else {
        panic!("{lights:?}")
    };
    assert_eq!(
        (*disk.normal, disk.radius, disk.is_visible),
        (Vec3::NEG_Y, 0.5, false)
    );
    assert_eq!(
        (rectangle.half_u, rectangle.half_v),
        (2.0 * Vec3::X, Vec3::Z)
    );
    assert_eq!((rectangle.samples, rectangle.is_visible), (4, true));
    assert_eq!(lights[4].origin, DVec3::new(1.0, 2.0, 3.0));
    assert_eq!((sphere.radius, sphere.center), (2.0, Vec3::ZERO));
}

#[test]
fn materials_are_read() {
    let imported = scene(
        "[[material]]\nname = \"brass\"\nkind = \"phong\"\ndiffuse = [0.4, 0.3, 0.1]\nspecular = [0.5, 0.4, 0.2]\n\
         exponent = 80.0\nreflect = [0.1, 0.1, 0.1]\ntransmit = [0, 0, 0.5]\nindex_of_refraction = 1.25\nemission = [0, 2, 0]\n\
         [[material]]\nname = \"glass\"\nkind = \"gltf\"\nbase_color = \"#fff\"\nmetallic = 0\nroughness = 0.25\nior = 1.4\n\
         transmission = 1\nopacity = 0.5\nemissive = [1, 0, 0]\nemissive_strength = 3\n",
    )
    .unwrap();
    let [brass, glass] = imported.scene.materials.as_slice() else {
        panic!("two materials")
    };
    let Surface::Phong(phong) = &brass.surface else {
        panic!("{brass:?}")
    };
    assert_eq!(brass.name, "brass");
    assert_eq!(phong.diffuse.factor, Rgb::new(0.4, 0.3, 0.1));
    assert_eq!(phong.specular.factor, Rgb::new(0.5, 0.4, 0.2));
    assert_eq!(phong.exponent.factor, 80.0);
    assert_eq!(phong.reflect, Rgb::splat(0.1));
    assert_eq!(phong.transmit, Rgb::new(0.0, 0.0, 0.5));
    assert_eq!(phong.index_of_refraction, 1.25);
    assert_eq!(brass.emission.factor, Rgb::new(0.0, 2.0, 0.0));
    let Surface::MetallicRoughness(parameters) = &glass.surface else {
        panic!("{glass:?}")
    };
    assert_eq!(parameters.base_color.factor, Rgb::WHITE);
    assert_eq!(parameters.metallic.factor, 0.0);
    assert_eq!(parameters.roughness.factor, 0.25);
    assert_eq!(parameters.index_of_refraction, 1.4);
    assert_eq!(parameters.transmission.factor, 1.0);
    assert_eq!(glass.emission.factor, Rgb::new(3.0, 0.0, 0.0));
    assert_eq!(
        (glass.alpha_mode, glass.opacity.factor),
        (AlphaMode::Blend, 0.5)
    );
}

#[test]
fn shares_that_make_light_are_warned_about() {
    let material = |diffuse: f32| {
        format!(
            "[[material]]\nname = \"m\"\nkind = \"phong\"\ndiffuse = [{diffuse}, 0, 0]\nspecular = [0.3, 0, 0]\nreflect = [0.3, 0, 0]\n"
        )
    };
    assert!(scene(&material(0.4)).unwrap().warnings.is_empty());
    let warnings = scene(&material(0.9)).unwrap().warnings;
    let warning = warnings.iter().next().expect("a warning");
    assert!(warning.message.contains("\"m\"") && warning.message.contains("1.500"));
}

#[test]
fn strings_are_srgb_and_numbers_are_linear() {
    let background = |color: &str| {
        let text = format!("[background]\nradiance = {color}\n");
        scene(&text).unwrap().scene.background.radiance
    };
    let expected = Rgb::new(
        srgb8_to_linear(0xc0),
        srgb8_to_linear(0x80),
        srgb8_to_linear(0x40),
    );
    assert_eq!(background("\"#c08040\""), expected);
    assert_eq!(background("\"#C08040\""), expected);
    assert_eq!(background("\"#f0a\""), background("\"#ff00aa\""));
    assert_eq!(background("[0.25, 1, 7.5]"), Rgb::new(0.25, 1.0, 7.5));
}
