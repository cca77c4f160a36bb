//! Nodes: transforms, what is shown, and graphs that are none.

use halfshade::import::WarningCode;
use halfshade::math::{DAffine3, DVec3};
use serde_json::{Value, json};

use super::builder::{Doc, warned};

fn with_nodes(nodes: Value) -> Doc {
    let mut doc = Doc::triangle();
    doc.json["nodes"] = nodes;
    doc
}

/// The transforms of all instances.
fn transforms(doc: &Doc) -> Vec<DAffine3> {
    let imported = doc.import().unwrap();
    imported
        .scene
        .instances
        .iter()
        .map(|i| i.transform)
        .collect()
}

#[test]
fn matrices_and_trs_compose_in_double_precision() {
    let doc = with_nodes(json!([
        { "children": [1], "translation": [500000.0001, 0, 0] },
        { "children": [2], "matrix": [0,1,0,0, -1,0,0,0, 0,0,1,0, 0.0002,0,0,1] },
        { "mesh": 0, "scale": [2, 3, -4], "rotation": [0, 0, 0.6, 0.6] },
    ]));
    let [transform] = transforms(&doc)[..] else {
        panic!()
    };
    assert_eq!(transform.translation, DVec3::new(500000.0003, 0.0, 0.0));
    // Two quarter turns about z, after the scale.
    let expected = DVec3::new(-2.0, -3.0, -4.0);
    let image = transform.transform_vector3(DVec3::ONE);
    assert!((image - expected).length() < 1e-14, "{image}");
    assert!(
        transform.matrix3.determinant() < 0.0,
        "mirrored nodes stay so"
    );
}

#[test]
fn only_the_default_scene_is_shown() {
    let mut doc = with_nodes(json!([
        { "mesh": 0, "translation": [1, 0, 0] },
        { "mesh": 0, "translation": [2, 0, 0] },
        { "mesh": 0, "translation": [3, 0, 0] },
    ]));
    let shown =
        |doc: &Doc| -> Vec<f64> { transforms(doc).iter().map(|t| t.translation.x).collect() };
    doc.json["scenes"] = json!([{ "nodes": [1] }, { "nodes": [2, 0] }]);
    assert_eq!(shown(&doc), [2.0], "the first, where the file names none");
    doc.json["scene"] = json!(1);
    assert_eq!(shown(&doc), [3.0, 1.0]);
    doc.json["scene"] = json!(2);
    assert_eq!(doc.error(), ", scene 2: there are only 2");
    doc.json["scene"] = json!(null);
    doc.json["scenes"] = json!([]);
    assert_eq!(shown(&doc), [1.0, 2.0, 3.0]);
    assert_eq!(warned(&doc.import().unwrap(), WarningCode::BadValue), 1);
    doc.json["scenes"] = json!([{ "nodes": [7] }]);
    assert_eq!(
        doc.error(),
        ", scene 0: node 7 is not there: there are only 3"
    );
}

#[test]
fn a_scene_may_list_a_node_and_its_parent() {
    let mut doc = with_nodes(json!([
        { "children": [1], "translation": [1, 0, 0] }, { "mesh": 0 }
    ]));
    doc.json["scenes"] = json!([{ "nodes": [1, 0, 1] }]);
    let [transform] = transforms(&doc)[..] else {
        panic!()
    };
    assert_eq!(transform.translation.x, 1.0);
}

#[test]
fn graphs_that_are_no_forest_are_errors_that_name_a_node() {
    let cases = [
        (
            json!([{ "name": "a", "children": [1] }, { "children": [2] }, { "children": [0] }]),
            ", node \"a\": is below itself: the nodes form a cycle",
        ),
        (
            json!([{}, { "name": "self", "children": [1] }]),
            ", node \"self\": is below itself: the nodes form a cycle",
        ),
        (
            json!([{ "name": "a", "children": [2] }, { "children": [2] }, { "name": "c" }]),
            ", node \"c\": has two parents, node \"a\" and node 1",
        ),
        (
            json!([{ "name": "a", "children": [9] }]),
            ", node \"a\": its child 9 is not there: there are only 1 nodes",
        ),
        (
            json!([{ "name": "a", "mesh": 4 }]),
            ", node \"a\": its mesh 4 is not there: there are only 1",
        ),
    ];
    for (nodes, expected) in cases {
        assert_eq!(with_nodes(nodes).error(), expected);
    }
}

#[test]
fn a_chain_of_many_nodes_does_not_overflow_the_stack() {
    let length = 200_000;
    let mut nodes: Vec<Value> = (1..length)
        .map(|i| json!({ "children": [i], "translation": [1, 0, 0] }))
        .collect();
    nodes.push(json!({ "mesh": 0 }));
    let [transform] = transforms(&with_nodes(json!(nodes)))[..] else {
        panic!()
    };
    assert_eq!(transform.translation.x, f64::from(length - 1));
}

#[test]
fn nodes_without_a_finite_place_are_left_out() {
    let mut doc = with_nodes(json!([
        { "mesh": 0 },
        { "children": [2], "scale": [1e300, 1, 1] },
        { "name": "far", "children": [3], "scale": [1e300, 1, 1], "mesh": 0 },
        { "mesh": 0 },
    ]));
    doc.json["scenes"] = json!([{ "nodes": [0, 1] }]);
    let imported = doc.import().unwrap();
    assert_eq!(imported.scene.instances.len(), 1);
    let warnings: Vec<_> = imported.warnings.iter().collect();
    assert_eq!(warnings.len(), 1);
    assert!(
        warnings[0].message.starts_with("node \"far\": "),
        "{}",
        warnings[0].message
    );
}

#[test]
fn a_rotation_of_no_length_turns_nothing() {
    let doc = with_nodes(json!([{ "mesh": 0, "rotation": [0, 0, 0, 0] }]));
    assert_eq!(transforms(&doc), [DAffine3::IDENTITY]);
    assert_eq!(warned(&doc.import().unwrap(), WarningCode::BadValue), 1);
}

/// A node with three instances; `count` numbers in the list of scales.
fn instanced(scales: usize) -> Doc {
    let mut doc = Doc::triangle();
    let translations = doc.floats("VEC3", &[1., 0., 0., 2., 0., 0., 3., 0., 0.]);
    // A half turn about y, as normalised bytes.
    let turns = [[0u8, 127, 0, 0]; 3].concat();
    let rotations = doc.accessor("VEC4", 5120, 3, &turns);
    doc.json["accessors"][rotations]["normalized"] = json!(true);
    let scales = doc.floats("VEC3", &vec![2.0; 3 * scales]);
    doc.json["nodes"] = json!([{
        "mesh": 0, "translation": [10, 0, 0],
        "extensions": { "EXT_mesh_gpu_instancing": { "attributes": {
            "TRANSLATION": translations, "ROTATION": rotations, "SCALE": scales
        } } }
    }]);
    doc
}

#[test]
fn instances_are_placed_in_their_node() {
    let transforms = transforms(&instanced(3));
    assert_eq!(transforms.len(), 3);
    for (i, transform) in transforms.iter().enumerate() {
        let corner = transform.transform_point3(DVec3::X);
        let expected = DVec3::new(10.0 + (i + 1) as f64 - 2.0, 0.0, 0.0);
        assert!((corner - expected).length() < 1e-14, "{corner}");
    }
    assert!(
        instanced(2)
            .error()
            .ends_with("its attributes differ in length")
    );
}
