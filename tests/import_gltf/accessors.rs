//! Accessors and topology: every way in which numbers may lie in a file.

use halfshade::import::WarningCode;
use halfshade::math::{Vec2, Vec3};
use halfshade::scene::Mesh;
use serde_json::json;

use super::builder::{Doc, warned};

/// The only mesh of a document.
fn mesh(doc: &Doc) -> Mesh {
    let mut imported = doc.import().unwrap();
    assert!(imported.warnings.is_empty(), "{:?}", imported.warnings);
    assert_eq!(imported.scene.meshes.len(), 1);
    imported.scene.meshes.remove(0)
}

#[test]
fn texture_coordinates_of_every_component_type() {
    // (componentType, bytes of the numbers 0, 1, largest, smallest, 1, 0; raw; normalised)
    let le16 = |v: [i32; 6]| v.iter().flat_map(|&v| (v as i16).to_le_bytes()).collect();
    let le32 = |v: [u32; 6]| v.iter().flat_map(|v| v.to_le_bytes()).collect();
    let lef = |v: [f32; 6]| v.iter().flat_map(|v| v.to_le_bytes()).collect();
    let cases: [(u32, Vec<u8>, f32, f32, f32); 6] = [
        (5120, vec![0, 1, 127, 128, 1, 0], 127.0, -128.0, -1.0),
        (5121, vec![0, 1, 255, 0, 1, 0], 255.0, 0.0, 0.0),
        (
            5122,
            le16([0, 1, 32767, -32768, 1, 0]),
            32767.0,
            -32768.0,
            -1.0,
        ),
        (5123, le16([0, 1, 65535, 0, 1, 0]), 65535.0, 0.0, 0.0),
        (
            5125,
            le32([0, 1, u32::MAX, 0, 1, 0]),
            u32::MAX as f32,
            0.0,
            0.0,
        ),
        (5126, lef([0.0, 1.0, 2.5, -3.0, 1.0, 0.0]), 2.5, -3.0, -3.0),
    ];
    for (component, bytes, largest, smallest, smallest_normalized) in cases {
        for normalized in [false, true] {
            let mut doc = Doc::triangle();
            let uv = doc.accessor("VEC2", component, 3, &bytes);
            doc.json["accessors"][uv]["normalized"] = json!(normalized);
            doc.primitive()["attributes"]["TEXCOORD_0"] = json!(uv);
            let unit = if normalized && component != 5126 {
                largest
            } else {
                1.0
            };
            let lowest = if normalized {
                smallest_normalized
            } else {
                smallest
            };
            let expected = [
                Vec2::new(0.0, 1.0 / unit),
                Vec2::new(largest / unit, lowest),
                Vec2::new(1.0 / unit, 0.0),
            ];
            let mesh = mesh(&doc);
            assert_eq!(mesh.uv_sets()[0], expected, "{component} {normalized}");
        }
    }
}

#[test]
fn indices_of_every_component_type() {
    for (component, size) in [(5121, 1), (5123, 2), (5125, 4)] {
        let mut doc = Doc::triangle();
        let bytes: Vec<u8> = [2u32, 0, 1]
            .iter()
            .flat_map(|i| i.to_le_bytes()[..size].to_vec())
            .collect();
        let indices = doc.accessor("SCALAR", component, 3, &bytes);
        doc.primitive()["indices"] = json!(indices);
        assert_eq!(mesh(&doc).indices(), [[2, 0, 1]], "{component}");
    }
    let mut doc = Doc::triangle();
    let floats = doc.floats("SCALAR", &[0.0, 1.0, 2.0]);
    doc.primitive()["indices"] = json!(floats);
    let error = doc.error();
    assert_eq!(
        error,
        ", mesh \"tail\", primitive 0: accessor 1: its numbers must be unsigned integers"
    );
}

#[test]
fn interleaved_attributes() {
    let mut doc = Doc::triangle();
    let mut bytes = Vec::new();
    for i in 0..3u8 {
        for v in [f32::from(i), 2.0, 3.0] {
            bytes.extend(v.to_le_bytes());
        }
        bytes.extend([i, 128, 255, 0]);
    }
    let view = doc.view(&bytes);
    doc.json["bufferViews"][view]["byteStride"] = json!(16);
    let positions = doc.push(
        "accessors",
        json!({ "bufferView": view, "componentType": 5126, "count": 3, "type": "VEC3" }),
    );
    let colors = doc.push(
        "accessors",
        json!({ "bufferView": view, "byteOffset": 12, "componentType": 5121, "count": 3,
                "type": "VEC3", "normalized": true }),
    );
    doc.primitive()["attributes"] = json!({ "POSITION": positions, "COLOR_0": colors });
    let mesh = mesh(&doc);
    assert_eq!(mesh.positions()[2], Vec3::new(2.0, 2.0, 3.0));
    assert_eq!(mesh.colors()[1], [1.0 / 255.0, 128.0 / 255.0, 1.0, 1.0]);
    doc.json["bufferViews"][view]["byteStride"] = json!(8);
    assert!(
        doc.error()
            .contains("elements of 12 bytes cannot lie 8 bytes apart")
    );
}

#[test]
fn colours_are_clamped() {
    let mut doc = Doc::triangle();
    let nan = f32::NAN;
    let colors = doc.floats(
        "VEC4",
        &[2., -1., 0.5, 0.25, nan, 0., 0., 1., 1., 1., 1., 1.],
    );
    doc.primitive()["attributes"]["COLOR_0"] = json!(colors);
    let mesh = mesh(&doc);
    assert_eq!(mesh.colors()[0], [1.0, 0.0, 0.5, 0.25]);
    assert_eq!(mesh.colors()[1], [0.0, 0.0, 0.0, 1.0]);
}

/// A document whose positions are replaced at two places.
fn sparse(base: bool, places: [u16; 2]) -> Doc {
    let mut doc = Doc::triangle();
    let at: Vec<u8> = places.iter().flat_map(|i| i.to_le_bytes()).collect();
    let at = doc.view(&at);
    let values = [7.0f32, 8.0, 9.0, 10.0, 11.0, 12.0];
    let values: Vec<u8> = values.iter().flat_map(|v| v.to_le_bytes()).collect();
    let values = doc.view(&values);
    doc.json["accessors"][0]["sparse"] = json!({
        "count": 2,
        "indices": { "bufferView": at, "componentType": 5123 },
        "values": { "bufferView": values },
    });
    if !base {
        let accessor = doc.json["accessors"][0].as_object_mut().unwrap();
        accessor.remove("bufferView");
    }
    doc
}

#[test]
fn sparse_values_replace_those_of_the_view_or_zeros() {
    let (a, b) = (Vec3::new(7.0, 8.0, 9.0), Vec3::new(10.0, 11.0, 12.0));
    assert_eq!(mesh(&sparse(true, [0, 2])).positions(), [a, Vec3::X, b]);
    assert_eq!(mesh(&sparse(false, [0, 1])).positions(), [a, b, Vec3::ZERO]);
    let error = sparse(true, [0, 3]).error();
    assert!(
        error.ends_with("accessor 0: replaces element 3 of 3"),
        "{error}"
    );
}

#[test]
fn an_accessor_without_data_is_zeros() {
    let mut doc = Doc::triangle();
    let uv = doc.push(
        "accessors",
        json!({ "componentType": 5126, "count": 3, "type": "VEC2" }),
    );
    doc.primitive()["attributes"]["TEXCOORD_0"] = json!(uv);
    assert_eq!(mesh(&doc).uv_sets()[0], [Vec2::ZERO; 3]);
}

#[test]
fn sets_of_texture_coordinates_keep_their_numbers() {
    let mut doc = Doc::triangle();
    let uv = doc.floats("VEC2", &[0.5; 6]);
    doc.primitive()["attributes"]["TEXCOORD_2"] = json!(uv);
    let mesh = mesh(&doc);
    assert_eq!(mesh.uv_sets().len(), 3);
    assert_eq!(mesh.uv_sets()[0], [Vec2::ZERO; 3]);
    assert_eq!(mesh.uv_sets()[2], [Vec2::splat(0.5); 3]);
}

#[test]
fn strips_and_fans_and_lists() {
    let cases = [
        (json!(4), vec![[0, 1, 2], [2, 1, 3]]),
        (json!(null), vec![[0, 1, 2], [2, 1, 3]]),
        (json!(5), vec![[0, 1, 2], [1, 2, 2], [2, 2, 1], [2, 3, 1]]),
        (json!(6), vec![[1, 2, 0], [2, 2, 0], [2, 1, 0], [1, 3, 0]]),
    ];
    for (mode, expected) in cases {
        let mut doc = Doc::new();
        let positions = doc.floats("VEC3", &[0., 0., 0., 1., 0., 0., 0., 1., 0., 1., 1., 0.]);
        let indices = doc.accessor("SCALAR", 5121, 6, &[0, 1, 2, 2, 1, 3]);
        let primitive = json!({
            "attributes": { "POSITION": positions }, "indices": indices, "mode": mode
        });
        doc.push("meshes", json!({ "primitives": [primitive] }));
        doc.push("nodes", json!({ "mesh": 0 }));
        doc.push("scenes", json!({ "nodes": [0] }));
        assert_eq!(mesh(&doc).indices(), expected, "mode {mode}");
    }
}

#[test]
fn points_and_lines_are_counted() {
    let mut doc = Doc::triangle();
    for mode in [0, 1, 2, 3] {
        let mut primitive = doc.primitive().clone();
        primitive["mode"] = json!(mode);
        let primitives = doc.json["meshes"][0]["primitives"].as_array_mut().unwrap();
        primitives.push(primitive);
    }
    let imported = doc.import().unwrap();
    assert_eq!(imported.scene.triangle_count(), 1);
    assert_eq!(warned(&imported, WarningCode::NotTriangles), 4);
}

#[test]
fn attributes_that_do_not_fit_are_dropped_with_a_warning() {
    let mut doc = Doc::triangle();
    let short = doc.floats("VEC3", &[0.0, 0.0, 1.0]);
    let wrong = doc.floats("VEC2", &[0.0; 6]);
    doc.primitive()["attributes"]["NORMAL"] = json!(short);
    doc.primitive()["attributes"]["TANGENT"] = json!(wrong);
    doc.primitive()["attributes"]["COLOR_0"] = json!(99);
    let imported = doc.import().unwrap();
    assert_eq!(warned(&imported, WarningCode::BadAttribute), 3);
    let mesh = &imported.scene.meshes[0];
    assert!(mesh.normals().is_empty() && mesh.tangents().is_empty() && mesh.colors().is_empty());
}

#[test]
fn primitives_keep_only_their_part_of_a_large_accessor() {
    let mut doc = Doc::triangle();
    let many: Vec<f32> = (0..3000).map(|i| i as f32).collect();
    let positions = doc.floats("VEC3", &many);
    let normals = doc.floats("VEC3", &many);
    let indices = doc.accessor("SCALAR", 5121, 6, &[9, 200, 7, 7, 200, 8]);
    *doc.primitive() = json!({
        "attributes": { "POSITION": positions, "NORMAL": normals }, "indices": indices
    });
    let mesh = mesh(&doc);
    let x: Vec<f32> = mesh.positions().iter().map(|p| p.x).collect();
    assert_eq!(x, [21.0, 24.0, 27.0, 600.0]);
    assert_eq!(mesh.positions(), mesh.normals());
    assert_eq!(mesh.indices(), [[2, 3, 0], [0, 3, 1]]);
}

#[test]
fn primitives_of_one_shape_share_a_mesh() {
    let mut doc = Doc::triangle();
    doc.push("materials", json!({}));
    let mut other = doc.primitive().clone();
    other["material"] = json!(0);
    doc.push("meshes", json!({ "primitives": [other] }));
    doc.json["nodes"] = json!([{ "mesh": 0 }, { "mesh": 0 }, { "mesh": 1 }]);
    doc.json["scenes"] = json!([{ "nodes": [0, 1, 2] }]);
    let imported = doc.import().unwrap();
    assert_eq!(imported.scene.meshes.len(), 1);
    let materials: Vec<u32> = imported
        .scene
        .instances
        .iter()
        .map(|i| i.material.0)
        .collect();
    assert_eq!(materials, [1, 1, 0], "the default material comes last");
    assert_eq!(imported.scene.materials.len(), 2);
}
