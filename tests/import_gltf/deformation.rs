//! Morph targets at their default weights and skins at the rest pose.

use halfshade::import::WarningCode;
use halfshade::math::{DVec3, Vec3};
use serde_json::json;

use super::builder::{Doc, warned};

/// World positions of the first instance.
fn world(doc: &Doc) -> Vec<DVec3> {
    let scene = doc.import().unwrap().scene;
    let instance = &scene.instances[0];
    let positions = scene.mesh(instance.mesh).positions().iter();
    positions
        .map(|p| instance.transform.transform_point3(p.as_dvec3()))
        .collect()
}

fn morphed() -> Doc {
    let mut doc = Doc::triangle();
    let up = doc.floats("VEC3", &[0., 0., 1., 0., 0., 1., 0., 0., 1.]);
    let right = doc.floats("VEC3", &[2., 0., 0., 2., 0., 0., 2., 0., 0.]);
    let normals = doc.floats("VEC3", &[0., 0., 1., 0., 0., 1., 0., 0., 1.]);
    let primitive = doc.primitive();
    primitive["attributes"]["NORMAL"] = json!(normals);
    primitive["targets"] = json!([{ "POSITION": up, "NORMAL": right }, { "POSITION": right }]);
    doc
}

#[test]
fn targets_are_added_by_weight() {
    let mut doc = morphed();
    assert_eq!(world(&doc)[0], DVec3::ZERO, "without weights");
    doc.json["meshes"][0]["weights"] = json!([0.5, 0.25]);
    assert_eq!(
        world(&doc)[0],
        DVec3::new(0.5, 0.0, 0.5),
        "the mesh's weights"
    );
    let scene = doc.import().unwrap().scene;
    assert_eq!(scene.meshes[0].normals()[1], Vec3::new(1.0, 0.0, 1.0));
    doc.json["nodes"][0]["weights"] = json!([0.0, 1.0]);
    assert_eq!(
        world(&doc)[0],
        DVec3::new(2.0, 0.0, 0.0),
        "the node's weights"
    );
}

#[test]
fn nodes_share_a_mesh_where_their_weights_agree() {
    let mut doc = morphed();
    doc.json["nodes"] = json!([
        { "mesh": 0 }, { "mesh": 0, "weights": [0, 0] }, { "mesh": 0, "weights": [1, 0] },
        { "mesh": 0, "weights": [1] },
    ]);
    doc.json["scenes"] = json!([{ "nodes": [0, 1, 2, 3] }]);
    let scene = doc.import().unwrap().scene;
    let meshes: Vec<u32> = scene.instances.iter().map(|i| i.mesh.0).collect();
    assert_eq!(meshes, [0, 0, 1, 2]);
}

/// A triangle that follows two joints: vertex 0 the first, 1 the second, 2 both alike.
fn skinned() -> Doc {
    let mut doc = Doc::triangle();
    let joints = doc.accessor("VEC4", 5121, 3, &[0, 9, 9, 9, 1, 9, 9, 9, 0, 1, 9, 9]);
    // Weights that do not add up to one.
    let weights = doc.floats("VEC4", &[0.5, 0., 0., 0., 1., 0., 0., 0., 0.4, 0.4, 0., 0.]);
    let normals = doc.floats("VEC3", &[0., 0., 1., 0., 0., 1., 0., 0., 1.]);
    let mut bind = vec![0.0f32; 32];
    for i in 0..4 {
        bind[5 * i] = 1.0;
        bind[16 + 5 * i] = 1.0;
    }
    bind[12] = -7.0;
    let bind = doc.floats("MAT4", &bind);
    let attributes = &mut doc.primitive()["attributes"];
    attributes["JOINTS_0"] = json!(joints);
    attributes["WEIGHTS_0"] = json!(weights);
    attributes["NORMAL"] = json!(normals);
    doc.push(
        "skins",
        json!({ "joints": [1, 2], "inverseBindMatrices": bind }),
    );
    doc.json["nodes"] = json!([
        { "mesh": 0, "skin": 0, "translation": [0, 1000, 0], "scale": [5, 5, 5] },
        { "translation": [7, 0, 0] },
        { "translation": [0, 0, 3] },
    ]);
    doc.json["scenes"] = json!([{ "nodes": [0, 1, 2] }]);
    doc
}

#[test]
fn vertices_follow_their_joints_and_not_their_node() {
    let doc = skinned();
    let expected = [
        DVec3::ZERO,
        DVec3::new(1.0, 0.0, 3.0),
        DVec3::new(0.0, 1.0, 1.5),
    ];
    for (ours, expected) in world(&doc).into_iter().zip(expected) {
        assert!((ours - expected).length() < 1e-6, "{ours}, not {expected}");
    }
    assert_eq!(doc.import().unwrap().scene.meshes[0].indices(), [[0, 1, 2]]);
}

#[test]
fn a_skin_far_from_the_origin_keeps_its_shape() {
    let mut doc = skinned();
    let far = 1e9;
    doc.json["nodes"][1]["translation"] = json!([7.0 + far, 0, 0]);
    doc.json["nodes"][2]["translation"] = json!([far, 0, 3]);
    let world = world(&doc);
    assert!(
        (world[1] - world[0] - DVec3::new(1.0, 0.0, 3.0)).length() < 1e-6,
        "{world:?}"
    );
}

#[test]
fn mirrored_joints_keep_the_outside_outside() {
    let mut doc = skinned();
    doc.json["nodes"][1]["scale"] = json!([1, 1, -1]);
    doc.json["nodes"][2]["scale"] = json!([1, 1, -1]);
    let scene = doc.import().unwrap().scene;
    let mesh = &scene.meshes[0];
    assert_eq!(mesh.indices(), [[0, 2, 1]], "wound the other way");
    // The front, z > 0 before, is z < 0 now; normals say so too.
    for normal in mesh.normals() {
        assert_eq!(*normal, -Vec3::Z);
    }
}

#[test]
fn broken_skins_are_named() {
    let mut doc = skinned();
    doc.json["skins"][0]["joints"] = json!([1, 99]);
    assert_eq!(doc.error(), ", node 0: skin 0: its joint 99 is not there");
    doc.json["skins"][0]["joints"] = json!([1, 2, 0]);
    assert_eq!(doc.error(), ", node 0: skin 0: 2 matrices for 3 joints");
    doc.json["skins"][0] = json!({ "joints": [1] });
    let expected = ", mesh \"tail\", primitive 0: \
                    vertex 1 follows joint 1, but there are only 1";
    assert_eq!(doc.error(), expected);
    doc.json["skins"][0] = json!({ "joints": [1, 2], "inverseBindMatrices": 0 });
    assert!(doc.error().contains("elements of 16 numbers are needed"));
    doc.json["nodes"][0]["skin"] = json!(5);
    assert_eq!(
        doc.error(),
        ", node 0: skin 5 is not there: there are only 1"
    );
}

#[test]
fn instances_of_a_skinned_mesh_are_one() {
    let mut doc = skinned();
    let scales = doc.floats("VEC3", &[1.0; 6]);
    let instancing = json!({ "attributes": { "SCALE": scales } });
    doc.json["nodes"][0]["extensions"] = json!({ "EXT_mesh_gpu_instancing": instancing });
    let imported = doc.import().unwrap();
    assert_eq!(imported.scene.instances.len(), 1);
    assert_eq!(warned(&imported, WarningCode::Approximated), 1);
}

#[test]
fn a_skin_without_weights_leaves_the_mesh_in_its_node() {
    let mut doc = skinned();
    let attributes = doc.primitive()["attributes"].as_object_mut().unwrap();
    attributes.remove("WEIGHTS_0");
    assert_eq!(world(&doc)[1], DVec3::new(5.0, 1000.0, 0.0));
    assert_eq!(warned(&doc.import().unwrap(), WarningCode::BadAttribute), 1);
}
