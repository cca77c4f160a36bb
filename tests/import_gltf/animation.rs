//! Animated models at a time: closed forms of each interpolation, and what may move.

use halfshade::camera::Projection;
use halfshade::import::{ImportOptions, Imported, Pose, import_model};
use halfshade::light::Light;
use halfshade::material::Surface;
use halfshade::math::DVec3;
use serde_json::{Value, json};

use super::builder::{Doc, import_bytes_with};
use super::models::models;

/// A triangle with an animation that has no channels yet.
fn animated() -> Doc {
    let mut doc = Doc::triangle();
    doc.push(
        "animations",
        json!({ "name": "move", "channels": [], "samplers": [] }),
    );
    doc
}

/// Adds a channel to an animation.
fn add_channel(
    doc: &mut Doc,
    target: Value,
    interpolation: &str,
    times: &[f32],
    (kind, values): (&str, &[f32]),
) {
    let input = doc.floats("SCALAR", times);
    let output = doc.floats(kind, values);
    let animation = doc.json["animations"].as_array_mut().unwrap();
    let animation = animation.last_mut().unwrap();
    let samplers = animation["samplers"].as_array_mut().unwrap();
    samplers.push(json!({ "input": input, "output": output, "interpolation": interpolation }));
    let sampler = samplers.len() - 1;
    let channels = animation["channels"].as_array_mut().unwrap();
    channels.push(json!({ "sampler": sampler, "target": target }));
}

/// A target of `KHR_animation_pointer`.
fn pointer(pointer: &str) -> Value {
    json!({ "path": "pointer", "extensions": { "KHR_animation_pointer": { "pointer": pointer } } })
}

fn try_at(doc: &Doc, seconds: f64, animation: Option<&str>) -> Result<Imported, String> {
    let pose = Pose {
        seconds,
        animation: animation.map(str::to_owned),
    };
    let options = ImportOptions {
        pose: Some(&pose),
        ..ImportOptions::default()
    };
    import_bytes_with("model.glb", &doc.glb(), options).map_err(|error| error.to_string())
}

/// The scene at a time of the first animation, without warnings.
fn at(doc: &Doc, seconds: f64) -> Imported {
    let imported = try_at(doc, seconds, None).unwrap();
    let warnings: Vec<_> = imported.warnings.iter().collect();
    assert!(warnings.is_empty(), "{warnings:?}");
    imported
}

fn place(imported: &Imported) -> DVec3 {
    imported.scene.instances[0].transform.translation
}

fn translation() -> Value {
    json!({ "node": 0, "path": "translation" })
}

#[test]
fn without_a_time_a_model_is_at_rest() {
    let mut doc = animated();
    let ends = ("VEC3", &[1.0, 0.0, 0.0, 2.0, 0.0, 0.0][..]);
    add_channel(&mut doc, translation(), "LINEAR", &[0.0, 1.0], ends);
    assert_eq!(place(&doc.import().unwrap()), DVec3::ZERO);
    assert_eq!(place(&at(&doc, 0.0)), DVec3::X);
}

#[test]
fn steps_hold_and_lines_are_straight() {
    let ends = [0.0, 0.0, 0.0, 4.0, 0.0, 8.0];
    let last = DVec3::new(4.0, 0.0, 8.0);
    for (interpolation, middle) in [("STEP", DVec3::ZERO), ("LINEAR", last / 2.0)] {
        let mut doc = animated();
        add_channel(
            &mut doc,
            translation(),
            interpolation,
            &[1.0, 3.0],
            ("VEC3", &ends),
        );
        for (seconds, expected) in [
            (-1.0, DVec3::ZERO),
            (0.0, DVec3::ZERO),
            (1.0, DVec3::ZERO),
            (2.0, middle),
            (3.0, last),
            (9.0, last),
        ] {
            assert_eq!(
                place(&at(&doc, seconds)),
                expected,
                "{interpolation} at {seconds}"
            );
        }
    }
}

/// Through value and slope of a cubic at two places goes that cubic and no other.
#[test]
fn splines_are_the_cubic_that_their_keys_are_of() {
    let mut doc = animated();
    let cubic = |t: f64| DVec3::new(t * t * t, 1.0 - t * t, 5.0 * t);
    let slope = |t: f64| DVec3::new(3.0 * t * t, -2.0 * t, 5.0);
    let times = [0.5_f32, 2.0, 2.5];
    let key = |&time: &f32| {
        let time = f64::from(time);
        // What comes before the first key and after the last must not matter: it is the same here.
        [slope(time), cubic(time), slope(time)].map(|v| v.as_vec3().to_array())
    };
    let keys: Vec<f32> = times.iter().flat_map(key).flatten().collect();
    add_channel(
        &mut doc,
        translation(),
        "CUBICSPLINE",
        &times,
        ("VEC3", &keys),
    );
    for seconds in [0.5, 0.75, 1.0, 1.9, 2.0, 2.25, 2.5] {
        let distance = (place(&at(&doc, seconds)) - cubic(seconds)).length();
        assert!(distance < 1e-6, "{seconds}: {distance}");
    }
    assert!((place(&at(&doc, 0.0)) - cubic(0.5)).length() < 1e-6);
    assert!((place(&at(&doc, 3.0)) - cubic(2.5)).length() < 1e-6);
}

#[test]
fn rotations_turn_evenly_and_on_the_shorter_way() {
    let half = std::f32::consts::FRAC_PI_4;
    for sign in [1.0, -1.0] {
        let mut doc = animated();
        // A quarter turn about z, the second quaternion of length 2 and either sign.
        let (sin, cos) = (2.0 * sign * half.sin(), 2.0 * sign * half.cos());
        let ends = [0.0, 0.0, 0.0, 1.0, 0.0, 0.0, sin, cos];
        let target = json!({ "node": 0, "path": "rotation" });
        add_channel(&mut doc, target, "LINEAR", &[0.0, 3.0], ("VEC4", &ends));
        for (seconds, degrees) in [(0.0, 0.0_f64), (1.0, 30.0), (2.0, 60.0), (3.0, 90.0)] {
            let x = at(&doc, seconds).scene.instances[0]
                .transform
                .matrix3
                .x_axis;
            let (sin, cos) = degrees.to_radians().sin_cos();
            let distance = (x - DVec3::new(cos, sin, 0.0)).length();
            assert!(distance < 1e-6, "{sign}, {seconds}: {x}");
        }
    }
}

#[test]
fn morph_weights_of_nodes_move_by_path_and_by_pointer() {
    let by_path = json!({ "node": 0, "path": "weights" });
    let one = pointer("/meshes/0/weights/1");
    let both: &[f32] = &[0.0, 1.0, 2.0, 5.0];
    let second: &[f32] = &[1.0, 5.0];
    for (target, weights, first) in [
        (by_path, both, 1.0),
        (pointer("/nodes/0/weights"), both, 1.0),
        (one, second, 0.0),
    ] {
        let mut doc = animated();
        let up = doc.floats("VEC3", &[0., 0., 1., 0., 0., 1., 0., 0., 1.]);
        let right = doc.floats("VEC3", &[1., 0., 0., 1., 0., 0., 1., 0., 0.]);
        doc.primitive()["targets"] = json!([{ "POSITION": right }, { "POSITION": up }]);
        doc.json["meshes"][0]["weights"] = json!([0, 0]);
        add_channel(&mut doc, target, "LINEAR", &[0.0, 2.0], ("SCALAR", weights));
        let (min, _) = at(&doc, 1.0).scene.bounds().unwrap();
        assert_eq!(min, DVec3::new(first, 0.0, 3.0));
    }
}

#[test]
fn pointers_move_materials_cameras_lights_and_what_is_visible() {
    let mut doc = animated();
    doc.push("materials", json!({ "pbrMetallicRoughness": {} }));
    doc.primitive()["material"] = json!(0);
    doc.push(
        "cameras",
        json!({ "type": "perspective", "perspective": { "yfov": 1.0 } }),
    );
    doc.json["extensions"] =
        json!({ "KHR_lights_punctual": { "lights": [{ "type": "point", "intensity": 7 }] } });
    let light = json!({ "KHR_lights_punctual": { "light": 0 }, "KHR_node_visibility": {} });
    doc.push("nodes", json!({ "camera": 0, "extensions": light }));
    doc.json["scenes"][0]["nodes"] = json!([0, 1]);
    let times = [0.0, 2.0];
    for (target, interpolation, kind, values) in [
        (
            "/materials/0/pbrMetallicRoughness/baseColorFactor",
            "LINEAR",
            "VEC4",
            &[0.0, 0.5, 1.0, 1.0, 1.0, 0.5, 0.0, 1.0][..],
        ),
        (
            "/cameras/0/perspective/yfov",
            "LINEAR",
            "SCALAR",
            &[0.5, 1.5],
        ),
        (
            "/extensions/KHR_lights_punctual/lights/0/intensity",
            "LINEAR",
            "SCALAR",
            &[10.0, 20.0],
        ),
        (
            "/nodes/1/extensions/KHR_node_visibility/visible",
            "STEP",
            "SCALAR",
            &[1.0, 0.0],
        ),
    ] {
        add_channel(
            &mut doc,
            pointer(target),
            interpolation,
            &times,
            (kind, values),
        );
    }
    let scene = at(&doc, 1.0).scene;
    let Surface::MetallicRoughness(surface) = &scene.materials[0].surface else {
        panic!("not metallic-roughness");
    };
    assert_eq!(surface.base_color.factor.channels(), [0.5, 0.5, 0.5]);
    let Projection::Perspective {
        vertical_fov_radians,
        ..
    } = scene.cameras[0].item.projection
    else {
        panic!("not perspective");
    };
    assert!((vertical_fov_radians - 1.0).abs() < 1e-6);
    let Light::Point(light) = &scene.lights[0].item else {
        panic!("not a point");
    };
    assert_eq!(light.intensity.channels(), [15.0; 3]);
    // Hidden nodes have no lights, but they have cameras.
    let scene = at(&doc, 2.0).scene;
    assert_eq!((scene.lights.len(), scene.cameras.len()), (0, 1));
}

#[test]
fn hidden_nodes_hide_what_is_below_them_at_rest_too() {
    let mut doc = Doc::triangle();
    doc.push("nodes", json!({ "children": [0] }));
    doc.json["scenes"][0]["nodes"] = json!([1]);
    for (above, below, count) in [(false, true, 0), (true, false, 0), (true, true, 1)] {
        let visible = |is: bool| json!({ "KHR_node_visibility": { "visible": is } });
        doc.json["nodes"][1]["extensions"] = visible(above);
        doc.json["nodes"][0]["extensions"] = visible(below);
        let imported = doc.import().unwrap();
        assert_eq!(imported.scene.triangle_count(), count);
        assert!(imported.warnings.is_empty());
    }
}

#[test]
fn an_animation_is_chosen_by_name_or_number() {
    let mut doc = animated();
    add_channel(
        &mut doc,
        translation(),
        "STEP",
        &[0.0],
        ("VEC3", &[1.0, 0.0, 0.0]),
    );
    doc.push(
        "animations",
        json!({ "name": "jump", "channels": [], "samplers": [] }),
    );
    add_channel(
        &mut doc,
        translation(),
        "STEP",
        &[0.0],
        ("VEC3", &[0.0, 2.0, 0.0]),
    );
    for (name, expected) in [
        (None, DVec3::X),
        (Some("move"), DVec3::X),
        (Some("jump"), 2.0 * DVec3::Y),
        (Some("1"), 2.0 * DVec3::Y),
    ] {
        assert_eq!(
            place(&try_at(&doc, 0.0, name).unwrap()),
            expected,
            "{name:?}"
        );
    }
    let error = try_at(&doc, 0.0, Some("junp")).unwrap_err();
    let expected = r#"no animation is called "junp"; there are: 0 "move", 1 "jump""#;
    assert!(error.ends_with(expected), "{error}");
    assert!(try_at(&Doc::triangle(), 0.0, Some("junp")).is_ok());
}

#[test]
fn broken_channels_are_left_out_with_a_word() {
    let vec3: (&str, &[f32]) = ("VEC3", &[1.0, 2.0, 3.0]);
    for (target, times, values, expected) in [
        (translation(), &[0.0, 1.0][..], vec3, "1 values for 2 keys"),
        (
            json!({ "node": 9, "path": "translation" }),
            &[0.0],
            vec3,
            "node 9 is not there",
        ),
        (
            json!({ "node": 0, "path": "colour" }),
            &[0.0],
            vec3,
            "path \"colour\" is not known",
        ),
        (
            json!({ "node": 0, "path": "rotation" }),
            &[0.0],
            vec3,
            "a rotation needs four numbers",
        ),
        (
            translation(),
            &[0.0],
            ("VEC3", &[f32::NAN; 3]),
            "its value is not finite",
        ),
        (
            pointer("/bufferViews/0/byteLength"),
            &[0.0],
            ("SCALAR", &[3.0]),
            "\"/bufferViews/0/byteLength\" cannot be animated",
        ),
        (
            pointer("/nodes/5/scale"),
            &[0.0],
            vec3,
            "\"/nodes/5/scale\" leads nowhere",
        ),
    ] {
        let mut doc = animated();
        add_channel(&mut doc, target, "LINEAR", times, values);
        let imported = try_at(&doc, 0.5, None).unwrap();
        let warnings: Vec<String> = imported.warnings.iter().map(|w| w.message).collect();
        let expected = format!("animation \"move\", channel 0: {expected}; it is left out");
        assert_eq!(warnings, [expected]);
        assert_eq!(place(&imported), DVec3::ZERO);
    }
}

/// The numbers come from the files' keys, worked out by a script of a few lines that reads nothing
/// else.
#[test]
fn models_of_others_move_as_their_keys_say() {
    let Some(models) = models() else { return };
    let at = |path: &str, seconds| {
        let pose = Pose {
            seconds,
            animation: None,
        };
        let options = ImportOptions {
            pose: Some(&pose),
            ..ImportOptions::default()
        };
        import_model(&models.join("gltf").join(path), options)
            .unwrap()
            .scene
    };
    // The cube's top, y of the mesh, points down the world's z.
    let cube = "AnimatedMorphCube/glTF-Binary/AnimatedMorphCube.glb";
    for (seconds, top) in [
        (0.5, 0.560_891_62),
        (1.0, -0.294_215_15),
        (2.0, -0.525_120_7),
    ] {
        let (_, max) = at(cube, seconds).bounds().unwrap();
        assert!((max.z - top).abs() < 2e-6, "{seconds}: {}", max.z);
    }
    // Half of a half turn about x, at the top of the way.
    let scene = at("BoxAnimated/glTF-Binary/BoxAnimated.glb", 1.875);
    let turned = |transform: &halfshade::math::DAffine3| transform.matrix3.z_axis.y.abs() > 0.999;
    let boxes: Vec<_> = scene.instances.iter().map(|i| i.transform).collect();
    assert_eq!(boxes.iter().filter(|t| turned(t)).count(), 1, "{boxes:?}");
    let raised =
        |transform: &&halfshade::math::DAffine3| (transform.translation.y - 2.52).abs() < 1e-6;
    assert!(boxes.iter().filter(raised).count() >= 1, "{boxes:?}");
    // Joints of a skin: the mesh bends, and keeps its triangles.
    let skin = "RiggedSimple/glTF-Binary/RiggedSimple.glb";
    let (rest, bent) = (at(skin, 0.0), at(skin, 1.0));
    assert_eq!(rest.triangle_count(), bent.triangle_count());
    assert_ne!(rest.bounds(), bent.bounds());
}
