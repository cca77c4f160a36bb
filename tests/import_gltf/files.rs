//! Files: wrappings, names, what is missing, and extensions that a file requires.

use std::fs;
use std::path::Path;

use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use halfshade::import::{ImportOptions, WarningCode, import_model};
use serde_json::json;

use super::builder::{Doc, import_bytes, warned, write};

/// The triangle as JSON, with its buffer under `uri`.
fn beside(uri: &str) -> (Vec<u8>, Vec<u8>) {
    let mut doc = Doc::triangle();
    doc.json["buffers"] = json!([{ "uri": uri, "byteLength": doc.bytes.len() }]);
    (doc.json.to_string().into_bytes(), doc.bytes)
}

/// The text of the error, from the name of the file on.
fn error(folder: &Path, name: &str) -> String {
    let error = import_model(&folder.join(name), ImportOptions::default()).unwrap_err();
    let text = error.to_string();
    let start = text.find(name).expect("the file's name");
    text[start..].to_owned()
}

#[test]
fn buffers_lie_beside_the_file_or_inside() {
    let data = STANDARD.encode(&Doc::triangle().bytes);
    let cases = [
        ("cat.bin", "cat.bin"),
        ("my%20cat%20%E2%9D%A4.bin", "my cat \u{2764}.bin"),
        ("my cat \u{2764}.bin", "my cat \u{2764}.bin"),
        ("100%.bin", "100%.bin"),
        ("deep\\cat.bin", "deep/cat.bin"),
        ("deep/../cat.bin", "cat.bin"),
        ("../beside.bin", "../beside.bin"),
        (
            &format!("data:application/octet-stream;base64,{data}"),
            "unused",
        ),
    ];
    for (uri, file) in cases {
        let folder = tempfile::tempdir().unwrap();
        let folder = folder.path().join("model");
        fs::create_dir_all(folder.join("deep")).unwrap();
        let (text, bytes) = beside(uri);
        write(&folder, "cat.gltf", &text);
        write(&folder, file, &bytes);
        let path = folder.join("cat.gltf");
        let imported = import_model(&path, ImportOptions::default()).unwrap();
        assert_eq!(imported.scene.triangle_count(), 1, "{uri}");
    }
}

#[test]
fn a_byte_order_mark_is_passed_over() {
    let (text, _) = beside("data:;base64,");
    let mut marked = b"\xef\xbb\xbf".to_vec();
    marked.extend(text);
    let error = import_bytes("cat.gltf", &marked).unwrap_err().to_string();
    assert!(error.contains("buffer 0 (data URI): cut short"), "{error}");
}

#[test]
fn what_cannot_be_read_is_named() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    fs::create_dir(folder.join("folder.bin")).unwrap();
    fs::create_dir(folder.join("folder.gltf")).unwrap();
    write(folder, "short.bin", &[0; 4]);
    write(folder, "text.gltf", b"hello");
    write(folder, "empty.glb", b"");
    write(folder, "object.gltf", b"{}");
    write(folder, "old.gltf", br#"{"asset":{"version":"1.0"}}"#);
    write(
        folder,
        "index.gltf",
        br#"{"asset":{"version":"2.0"},"nodes":[{"mesh":-1}]}"#,
    );
    let uris = [
        ("gone.bin", "buffer 0 (gone.bin): "),
        (
            "folder.bin",
            "buffer 0 (folder.bin): is a directory, not a file",
        ),
        (
            "short.bin",
            "buffer 0 (short.bin): cut short: it should have 36 bytes and has 4",
        ),
        (
            "/dev/zero",
            "buffer 0 (/dev/zero): \"/dev/zero\" is an absolute path",
        ),
        (
            "https://a.b/c",
            "buffer 0 (https://a.b/c): \"https://a.b/c\" is not a path",
        ),
    ];
    for (uri, expected) in uris {
        write(folder, "cat.gltf", &beside(uri).0);
        let error = error(folder, "cat.gltf");
        assert!(
            error.starts_with(&format!("cat.gltf, {expected}")),
            "{error}"
        );
    }
    let cases = [
        ("gone.gltf", "gone.gltf: "),
        ("folder.gltf", "folder.gltf: is a directory, not a file"),
        (
            "text.gltf",
            "text.gltf: not a glTF document: expected value at line 1 column 1",
        ),
        ("empty.glb", "empty.glb: not a glTF document: EOF"),
        (
            "object.gltf",
            "object.gltf: not a glTF document: it has no asset.version",
        ),
        ("old.gltf", "old.gltf: glTF version 1.0 is not supported"),
        (
            "index.gltf",
            "index.gltf: not a glTF document: invalid value: integer `-1`",
        ),
    ];
    for (name, expected) in cases {
        let error = error(folder, name);
        assert!(error.starts_with(expected), "{error}");
    }
}

#[test]
fn a_file_cut_short_anywhere_is_an_error() {
    let glb = Doc::triangle().glb();
    for length in 0..glb.len() {
        let error = import_bytes("cut.glb", &glb[..length]);
        assert!(error.is_err(), "{length} of {} bytes", glb.len());
    }
    assert!(import_bytes("whole.glb", &glb).is_ok());
}

#[test]
fn required_extensions_that_we_lack_are_warnings_or_in_strict_mode_errors() {
    let mut doc = Doc::triangle();
    doc.json["extensionsRequired"] =
        json!(["KHR_materials_volume_scatter", "KHR_texture_transform"]);
    doc.json["extensionsUsed"] = json!(["KHR_materials_volume_scatter", "VENDOR_new", "KHR_xmp"]);
    let imported = doc.import().unwrap();
    let warnings: Vec<_> = imported.warnings.iter().collect();
    assert_eq!(warnings.len(), 2);
    assert_eq!(warnings[0].code, WarningCode::RequiredExtension);
    let expected =
        "KHR_materials_volume_scatter is required and not supported: volumes do not scatter light";
    assert_eq!(warnings[0].message, expected);
    assert_eq!(warnings[1].code, WarningCode::IgnoredExtension);
    let expected = "VENDOR_new is not supported: what it adds is left out";
    assert_eq!(warnings[1].message, expected);

    let folder = tempfile::tempdir().unwrap();
    write(folder.path(), "cat.glb", &doc.glb());
    let strict = ImportOptions {
        is_strict: true,
        ..ImportOptions::default()
    };
    let error = import_model(&folder.path().join("cat.glb"), strict).unwrap_err();
    assert!(
        error
            .to_string()
            .ends_with("cat.glb: KHR_materials_volume_scatter is not supported")
    );
}

#[test]
fn broken_compressed_data_are_an_error_unless_there_is_a_plain_copy() {
    let mut draco = Doc::triangle();
    draco.primitive()["extensions"] = json!({ "KHR_draco_mesh_compression": {} });
    draco.json["extensionsUsed"] = json!(["KHR_draco_mesh_compression"]);
    let imported = draco.import().unwrap();
    assert_eq!(imported.scene.triangle_count(), 1);
    assert!(imported.warnings.is_empty());
    let accessor = draco.json["accessors"][0].as_object_mut().unwrap();
    accessor.remove("bufferView");
    let expected = ", mesh \"tail\", primitive 0: KHR_draco_mesh_compression: ";
    assert!(draco.error().starts_with(expected), "{}", draco.error());
    let stream = draco.view(b"DRACO\x02\x02\x01\x01\0\0\xff\xff");
    draco.primitive()["extensions"]["KHR_draco_mesh_compression"] =
        json!({ "bufferView": stream, "attributes": { "POSITION": 0 } });
    assert!(draco.error().starts_with(expected), "{}", draco.error());

    for name in ["EXT_meshopt_compression", "KHR_meshopt_compression"] {
        let mut meshopt = Doc::triangle();
        let stream = json!({
            "buffer": 0, "byteLength": 36, "byteStride": 12, "count": 3, "mode": "ATTRIBUTES"
        });
        meshopt.json["bufferViews"][0]["extensions"] = json!({ name: stream });
        assert_eq!(meshopt.import().unwrap().scene.triangle_count(), 1);
        meshopt.json["buffers"] = json!([
            { "byteLength": 36 },
            { "byteLength": 36, "extensions": { name: { "fallback": true } } },
        ]);
        meshopt.json["bufferViews"][0]["buffer"] = json!(1);
        let place = format!(", mesh \"tail\", primitive 0: bufferView 0: {name}: ");
        let expected = format!("{place}it is of a version that is not known");
        assert_eq!(meshopt.error(), expected);
        // Room for decoded data need not say what it is.
        meshopt.json["buffers"][1] = json!({ "byteLength": 36 });
        assert_eq!(meshopt.error(), expected);
        meshopt.json["bufferViews"][0]["extensions"][name]["count"] = json!(4);
        let expected = format!("{place}its mode, filter, stride, count and length do not fit");
        assert_eq!(meshopt.error(), expected);
        meshopt.json["bufferViews"][0]["extensions"] = json!({});
        let expected = ", buffer 1: has no data";
        assert_eq!(meshopt.error(), expected);
    }
}

#[test]
fn an_unknown_binary_chunk_is_passed_over() {
    let mut doc = Doc::new();
    doc.push("nodes", json!({}));
    doc.push("scenes", json!({ "nodes": [0] }));
    let mut glb = doc.glb();
    let kind = glb.len() - 4;
    glb[kind..].copy_from_slice(b"XTRA");
    let imported = import_bytes("model.glb", &glb).unwrap();
    assert_eq!(imported.scene.bounds(), None);
    assert_eq!(warned(&imported, WarningCode::BadValue), 0);
}
