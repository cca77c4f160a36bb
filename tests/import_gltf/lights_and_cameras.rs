//! Lights and cameras: where they are, where they look, and which are left out.

use std::f32::consts::FRAC_PI_2;

use halfshade::camera::{Camera, Projection};
use halfshade::color::Rgb;
use halfshade::import::WarningCode;
use halfshade::light::Light;
use halfshade::math::{DVec3, Vec3};
use halfshade::scene::Placed;
use serde_json::{Value, json};

use super::builder::{Doc, warned};

/// A node at (1e9, 2, 3), turned by a quarter about y and scaled, that holds `entry`.
fn placed(entry: Value) -> Value {
    let s = 0.5f64.sqrt();
    let mut node = json!({
        "name": "holder", "translation": [1e9, 2, 3], "rotation": [0, s, 0, s], "scale": [2, 3, 4]
    });
    node.as_object_mut()
        .unwrap()
        .extend(entry.as_object().unwrap().clone());
    node
}

fn with_light(light: Value) -> Doc {
    let mut doc = Doc::triangle();
    doc.json["extensions"] = json!({ "KHR_lights_punctual": { "lights": [light] } });
    let used = json!({ "extensions": { "KHR_lights_punctual": { "light": 0 } } });
    doc.json["nodes"] = json!([placed(used)]);
    doc
}

fn light(entry: Value) -> Placed<Light> {
    let imported = with_light(entry).import().unwrap();
    assert!(imported.warnings.is_empty());
    imported.scene.lights[0].clone()
}

fn near(a: Vec3, b: Vec3) -> bool {
    (a - b).length() < 1e-6
}

#[test]
fn lights_keep_their_numbers() {
    let point =
        light(json!({ "type": "point", "color": [1, 0.5, 0], "intensity": 8, "name": "l" }));
    assert_eq!(point.origin, DVec3::new(1e9, 2.0, 3.0));
    assert_eq!(point.name, "l");
    let Light::Point(point) = point.item else {
        panic!()
    };
    assert_eq!(point.intensity, Rgb::new(8.0, 4.0, 0.0));
    assert_eq!((point.position, point.radius), (Vec3::ZERO, 0.0));
    assert_eq!(
        (point.falloff.quadratic, point.falloff.range),
        (1.0, f32::INFINITY)
    );

    let sun = light(json!({ "type": "directional", "intensity": 3 }));
    let Light::Distant(sun) = sun.item else {
        panic!()
    };
    assert_eq!(sun.irradiance, Rgb::splat(3.0));
    assert!(
        near(*sun.direction, -Vec3::X),
        "-z, turned by a quarter about y"
    );

    let spot = json!({ "type": "spot", "range": 9,
                       "spot": { "innerConeAngle": 0.25, "outerConeAngle": 0.5 } });
    let Light::Spot(spot) = light(spot).item else {
        panic!()
    };
    assert!(near(*spot.direction, -Vec3::X));
    assert_eq!(
        (spot.inner_angle_radians, spot.outer_angle_radians),
        (0.25, 0.5)
    );
    assert_eq!((spot.intensity, spot.falloff.range), (Rgb::WHITE, 9.0));
}

#[test]
fn lights_that_cannot_shine_are_left_out() {
    for entry in [
        json!({ "type": "moon" }),
        json!({}),
        json!({ "type": "point", "intensity": -1 }),
        json!({ "type": "point", "intensity": 1e300 }),
        json!({ "type": 7 }),
    ] {
        let imported = with_light(entry.clone()).import().unwrap();
        assert!(imported.scene.lights.is_empty(), "{entry}");
        assert!(warned(&imported, WarningCode::BadLight) > 0, "{entry}");
    }
    let mut doc = with_light(json!({ "type": "point" }));
    doc.json["nodes"][0]["extensions"]["KHR_lights_punctual"]["light"] = json!(3);
    assert_eq!(warned(&doc.import().unwrap(), WarningCode::BadLight), 1);
}

#[test]
fn impossible_cones_and_ranges_are_repaired() {
    for spot in [
        json!({ "innerConeAngle": 0.5, "outerConeAngle": 0.5 }),
        json!({ "innerConeAngle": -1, "outerConeAngle": 4 }),
        json!({ "outerConeAngle": 0 }),
    ] {
        let doc = with_light(json!({ "type": "spot", "spot": spot, "range": 0 }));
        let imported = doc.import().unwrap();
        assert_eq!(warned(&imported, WarningCode::BadValue), 2);
        let Light::Spot(light) = imported.scene.lights[0].item else {
            panic!()
        };
        let (inner, outer) = (light.inner_angle_radians, light.outer_angle_radians);
        assert!(
            0.0 <= inner && inner < outer && outer <= FRAC_PI_2,
            "{spot}"
        );
        assert_eq!(light.falloff.range, f32::INFINITY);
    }
}

fn with_camera(camera: Value) -> Doc {
    let mut doc = Doc::triangle();
    doc.push("cameras", camera);
    doc.json["nodes"] = json!([placed(json!({ "camera": 0 }))]);
    doc
}

fn camera(entry: Value) -> Placed<Camera> {
    with_camera(entry).import().unwrap().scene.cameras[0].clone()
}

#[test]
fn cameras_look_down_their_z_whatever_their_scale() {
    let perspective = camera(json!({ "type": "perspective",
                                     "perspective": { "yfov": 0.75, "znear": 0.1 } }));
    assert_eq!(perspective.origin, DVec3::new(1e9, 2.0, 3.0));
    assert_eq!(perspective.name, "holder");
    let camera_item = perspective.item;
    assert!(near(*camera_item.back, Vec3::X) && near(*camera_item.up, Vec3::Y));
    assert!(near(*camera_item.right, -Vec3::Z));
    let projection = Projection::Perspective {
        vertical_fov_radians: 0.75,
    };
    assert_eq!(camera_item.projection, projection);

    let entry = json!({ "type": "orthographic",
                        "orthographic": { "xmag": 2, "ymag": 1.5, "zfar": 1, "znear": 0 } });
    let projection = Projection::Orthographic { half_height: 1.5 };
    assert_eq!(camera(entry).item.projection, projection);
}

#[test]
fn cameras_that_cannot_see_are_left_out() {
    for entry in [
        json!({}),
        json!({ "perspective": { "yfov": 0 } }),
        json!({ "perspective": { "yfov": 3.2 } }),
        json!({ "orthographic": { "ymag": 0 } }),
    ] {
        let imported = with_camera(entry.clone()).import().unwrap();
        assert!(imported.scene.cameras.is_empty(), "{entry}");
        assert_eq!(warned(&imported, WarningCode::BadCamera), 1, "{entry}");
    }
    let mut doc = with_camera(json!({ "perspective": { "yfov": 1 } }));
    doc.json["nodes"][0]["scale"] = json!([1, 1, 0]);
    assert_eq!(warned(&doc.import().unwrap(), WarningCode::BadCamera), 1);
    doc.json["nodes"][0]["camera"] = json!(8);
    assert_eq!(warned(&doc.import().unwrap(), WarningCode::BadCamera), 1);
}
