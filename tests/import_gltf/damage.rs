//! Broken and hostile files: one clear error, never a panic, a hang, or memory out of proportion.

use std::fs;
use std::time::{Duration, Instant};

use halfshade::import::{ImportOptions, import_model};
use serde_json::{Value, json};

use super::builder::{Doc, import_bytes};
use super::models::models;

#[test]
fn an_index_out_of_range_names_mesh_primitive_and_triangle() {
    let mut doc = Doc::triangle();
    let indices = doc.accessor("SCALAR", 5121, 6, &[0, 1, 2, 0, 1, 3]);
    doc.primitive()["indices"] = json!(indices);
    let expected = ", mesh \"tail\", primitive 0: \
                    triangle 1 uses vertex 3, but there are only 3";
    assert_eq!(doc.error(), expected);
}

#[test]
fn broken_references_are_named() {
    type Damage = fn(&mut Value);
    let cases: [(Damage, &str); 12] = [
        (
            |r| r["accessors"] = json!([]),
            "accessor 0: there are only 0",
        ),
        (
            |r| r["bufferViews"] = json!([]),
            "bufferView 0: there are only 0 buffer views",
        ),
        (
            |r| r["bufferViews"][0]["buffer"] = json!(3),
            "bufferView 0: lies in buffer 3, but there are only 1",
        ),
        (
            |r| r["bufferViews"][0] = json!({ "byteLength": 36 }),
            "bufferView 0: names no buffer",
        ),
        (
            |r| {
                r["accessors"][0]["sparse"] = json!({
                    "count": 1, "indices": { "componentType": 5121 }, "values": { "bufferView": 0 },
                });
            },
            "accessor 0: its sparse indices name no bufferView",
        ),
        (
            |r| {
                r["accessors"][0]["sparse"] = json!({
                    "count": 1, "indices": { "bufferView": 0, "componentType": 5121 }, "values": {},
                });
            },
            "accessor 0: its sparse values name no bufferView",
        ),
        (
            |r| r["bufferViews"][0]["byteOffset"] = json!(u64::MAX),
            "bufferView 0: ends after the 36 bytes of buffer 0",
        ),
        (
            |r| r["accessors"][0]["byteOffset"] = json!(u64::MAX),
            "accessor 0: 3 elements do not fit into the 36 bytes of bufferView 0",
        ),
        (
            |r| r["accessors"][0]["componentType"] = json!(5130),
            "accessor 0: componentType 5130 is not known",
        ),
        (
            |r| r["accessors"][0]["type"] = json!("VEC9"),
            "accessor 0: of a type that is not known",
        ),
        (
            |r| r["meshes"][0]["primitives"][0]["material"] = json!(2),
            "material 2 is not there: there are only 0",
        ),
        (
            |r| r["meshes"][0]["primitives"][0]["mode"] = json!(7),
            "mode 7 is not known",
        ),
    ];
    for (damage, expected) in cases {
        let mut doc = Doc::triangle();
        doc.json["buffers"] = json!([{ "byteLength": 36 }]);
        damage(&mut doc.json);
        assert_eq!(
            doc.error(),
            format!(", mesh \"tail\", primitive 0: {expected}")
        );
    }
}

/// Imports what asks for gigabytes; the error, which must come at once.
fn refused(doc: &Doc) -> String {
    let start = Instant::now();
    let error = doc.error();
    assert!(start.elapsed() < Duration::from_secs(20), "{error}");
    error
}

#[test]
fn gigabytes_in_a_tiny_file_are_refused() {
    let mut elements = Doc::triangle();
    elements.json["accessors"][0]["count"] = json!(1_000_000_000);
    assert!(refused(&elements).contains("1000000000 elements do not fit into the 36 bytes"));

    let mut buffer = Doc::triangle();
    buffer.json["buffers"] = json!([{ "byteLength": 1u64 << 40 }]);
    assert!(refused(&buffer).contains("buffer 0: cut short"));

    for count in [1_000_000, 1_000_000_000, u64::MAX] {
        let mut zeros = Doc::triangle();
        zeros.json["accessors"][0] = json!({
            "componentType": 5126, "count": count, "type": "VEC3",
        });
        let error = refused(&zeros);
        assert!(
            error.contains("memory") || error.contains("elements"),
            "{error}"
        );
    }
}

/// A list of `count` entries.
fn list(count: usize, entry: impl Fn(usize) -> Value) -> Value {
    Value::Array((0..count).map(entry).collect())
}

#[test]
fn multiplication_by_sharing_is_refused() {
    // 20,000 nodes × 2,000 primitives: 40 million instances from less than a megabyte.
    let mut instances = Doc::triangle();
    let primitive = instances.primitive().clone();
    instances.json["meshes"][0]["primitives"] = list(2_000, |_| primitive.clone());
    instances.json["nodes"] = list(20_000, |_| json!({ "mesh": 0 }));
    instances.json["scenes"] = json!([{ "nodes": list(20_000, |i| json!(i)) }]);
    assert!(refused(&instances).contains("asks for far more memory"));

    // One vertex list of 12 kB in 100,000 different morphs.
    let mut morphs = Doc::triangle();
    let positions = morphs.floats("VEC3", &[0.5; 3 * 1002]);
    *morphs.primitive() = json!({
        "attributes": { "POSITION": positions }, "targets": [{ "POSITION": positions }]
    });
    morphs.json["nodes"] = list(100_000, |i| json!({ "mesh": 0, "weights": [i + 1] }));
    morphs.json["scenes"] = json!([{ "nodes": list(100_000, |i| json!(i)) }]);
    assert!(refused(&morphs).contains("asks for far more memory"));
}

#[test]
fn long_names_and_lists_cost_no_more_than_they_are_long() {
    let name = "x".repeat(1_000_000);
    let mut cameras = Doc::triangle();
    cameras.push(
        "cameras",
        json!({ "name": name, "perspective": { "yfov": 1 } }),
    );
    cameras.json["nodes"] = list(20_000, |_| json!({ "camera": 0 }));
    cameras.json["scenes"] = json!([{ "nodes": list(20_000, |i| json!(i)) }]);
    assert!(refused(&cameras).contains("asks for far more memory"));

    let mut meshes = Doc::triangle();
    let broken = json!({ "attributes": { "POSITION": 0 }, "mode": 0 });
    meshes.json["meshes"] =
        json!([{ "name": name, "primitives": list(20_000, |_| broken.clone()) }]);
    let start = Instant::now();
    meshes.import().unwrap();
    assert!(start.elapsed() < Duration::from_secs(20));

    let mut extensions = Doc::triangle();
    extensions.json["extensionsUsed"] = list(100_000, |i| json!(format!("VENDOR_{i}")));
    extensions.json["extensionsRequired"] = list(100_000, |i| json!(format!("VENDOR_{i}")));
    let start = Instant::now();
    extensions.import().unwrap();
    assert!(start.elapsed() < Duration::from_secs(20));
}

/// Pseudo-random numbers (Steele et al. 2014, "Fast Splittable Pseudorandom Number Generators").
struct SplitMix(u64);

impl SplitMix {
    fn next(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^ (z >> 31)
    }

    fn below(&mut self, end: usize) -> usize {
        (self.next() % end as u64) as usize
    }
}

/// Imports `rounds` copies of `file` with up to 8 bytes changed in each.
fn flip_bytes(name: &str, file: &[u8], rounds: u64) {
    for round in 0..rounds {
        let mut random = SplitMix(round);
        let mut damaged = file.to_vec();
        for _ in 0..=random.below(8) {
            let at = random.below(damaged.len());
            damaged[at] = random.next() as u8;
        }
        let start = Instant::now();
        // Whether it can still be read is not the point; that it comes back is.
        let _ = import_bytes(name, &damaged);
        let elapsed = start.elapsed();
        assert!(
            elapsed < Duration::from_secs(20),
            "round {round}: {elapsed:?}"
        );
    }
}

#[test]
fn random_bytes_do_no_harm() {
    flip_bytes("triangle.glb", &Doc::triangle().glb(), 2_000);
    let mut random = SplitMix(7);
    for length in 0..200 {
        let mut bytes: Vec<u8> = (0..length).map(|_| random.next() as u8).collect();
        let _ = import_bytes("random.gltf", &bytes);
        bytes.splice(0..0, *b"glTF\x02\0\0\0\xff\0\0\0");
        let _ = import_bytes("random.glb", &bytes);
    }
}

#[test]
fn random_changes_of_real_files_do_no_harm() {
    let Some(models) = models() else { return };
    for path in [
        "Box/glTF-Binary/Box.glb",
        "SimpleSkin/glTF-Embedded/SimpleSkin.gltf",
        "SimpleMorph/glTF-Embedded/SimpleMorph.gltf",
        "SimpleSparseAccessor/glTF-Embedded/SimpleSparseAccessor.gltf",
        "SimpleInstancing/glTF-Binary/SimpleInstancing.glb",
        "MeshPrimitiveModes/glTF-Embedded/MeshPrimitiveModes.gltf",
        "RiggedSimple/glTF-Binary/RiggedSimple.glb",
        "BoxTextured/glTF-Embedded/BoxTextured.gltf",
        "meshopt-loadersgl/BoxTextured_meshopt.glb",
    ] {
        let path = models.join("gltf").join(path);
        let name = path.file_name().unwrap().to_str().unwrap();
        flip_bytes(name, &fs::read(&path).unwrap(), 300);
    }
}

/// All numbers of a document.
fn numbers<'a>(value: &'a mut Value, found: &mut Vec<&'a mut Value>) {
    match value {
        Value::Number(_) => found.push(value),
        Value::Array(list) => list.iter_mut().for_each(|entry| numbers(entry, found)),
        Value::Object(map) => map.values_mut().for_each(|entry| numbers(entry, found)),
        _ => {}
    }
}

#[test]
fn wrong_numbers_in_real_documents_do_no_harm() {
    let Some(models) = models() else { return };
    let wrong = [
        json!(0),
        json!(1),
        json!(2),
        json!(3),
        json!(5),
        json!(5121),
        json!(5125),
        json!(255),
        json!(65_535),
        json!(1_000_000),
        json!(u32::MAX),
        json!(u64::MAX),
        json!(-1),
        json!(1e300),
        json!(1e-300),
        json!(0.5),
    ];
    for name in [
        "BoxInterleaved",
        "BoxTextured",
        "Cameras",
        "MeshPrimitiveModes",
        "MultipleScenes",
        "SimpleMorph",
        "SimpleSkin",
        "SimpleSparseAccessor",
    ] {
        let path = models.join(format!("gltf/{name}/glTF-Embedded/{name}.gltf"));
        let document: Value = serde_json::from_slice(&fs::read(&path).unwrap()).unwrap();
        for round in 0..400 {
            let mut random = SplitMix(round);
            let mut damaged = document.clone();
            let mut found = Vec::new();
            numbers(&mut damaged, &mut found);
            for _ in 0..=random.below(3) {
                let at = random.below(found.len());
                *found[at] = wrong[random.below(wrong.len())].clone();
            }
            let start = Instant::now();
            let _ = import_bytes("damaged.gltf", damaged.to_string().as_bytes());
            let elapsed = start.elapsed();
            assert!(
                elapsed < Duration::from_secs(20),
                "{name} {round}: {elapsed:?}"
            );
        }
    }
}

#[test]
fn the_number_of_threads_changes_nothing() {
    let Some(models) = models() else { return };
    let path = models.join("gltf/TextureSettingsTest/glTF-Binary/TextureSettingsTest.glb");
    let import = |threads| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads);
        pool.build().unwrap().install(|| {
            let imported = import_model(&path, ImportOptions::default()).unwrap();
            format!("{:?}", imported.scene)
        })
    };
    let one = import(1);
    assert!(one == import(2) && one == import(7));
}
