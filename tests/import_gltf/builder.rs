//! Builds small `.glb` files.

use std::fs;
use std::path::Path;

use halfshade::import::{ImportError, ImportOptions, Imported, WarningCode, import_model};
use serde_json::{Value, json};

/// A document under construction, with one buffer.
#[derive(Clone)]
pub struct Doc {
    pub json: Value,
    pub bytes: Vec<u8>,
}

impl Doc {
    /// Without anything.
    pub fn new() -> Self {
        Self {
            json: json!({ "asset": { "version": "2.0" } }),
            bytes: Vec::new(),
        }
    }

    /// One triangle with corners (0,0,0), (1,0,0), (0,1,0), in a node of a scene.
    pub fn triangle() -> Self {
        let mut doc = Self::new();
        let positions = doc.floats("VEC3", &[0., 0., 0., 1., 0., 0., 0., 1., 0.]);
        doc.json["meshes"] = json!([{ "name": "tail", "primitives": [{ "attributes": { "POSITION": positions } }] }]);
        doc.json["nodes"] = json!([{ "name": "cat", "mesh": 0 }]);
        doc.json["scenes"] = json!([{ "nodes": [0] }]);
        doc
    }

    /// Adds an entry to a list of the root; its index.
    pub fn push(&mut self, list: &str, entry: Value) -> usize {
        let root = self.json.as_object_mut().unwrap();
        let list = root.entry(list).or_insert_with(|| json!([]));
        let list = list.as_array_mut().unwrap();
        list.push(entry);
        list.len() - 1
    }

    /// Adds a buffer view with these bytes.
    pub fn view(&mut self, bytes: &[u8]) -> usize {
        self.bytes.resize(self.bytes.len().next_multiple_of(4), 0);
        let offset = self.bytes.len();
        self.bytes.extend(bytes);
        let entry = json!({ "buffer": 0, "byteOffset": offset, "byteLength": bytes.len() });
        self.push("bufferViews", entry)
    }

    /// Adds an accessor of its own bytes.
    pub fn accessor(&mut self, kind: &str, component: u32, count: usize, bytes: &[u8]) -> usize {
        let view = self.view(bytes);
        let entry = json!({
            "bufferView": view, "componentType": component, "count": count, "type": kind
        });
        self.push("accessors", entry)
    }

    /// Adds an accessor of floats.
    pub fn floats(&mut self, kind: &str, values: &[f32]) -> usize {
        let components = match kind {
            "SCALAR" => 1,
            "VEC2" => 2,
            "VEC3" => 3,
            "VEC4" => 4,
            "MAT4" => 16,
            other => panic!("{other}"),
        };
        let bytes: Vec<u8> = values.iter().flat_map(|v| v.to_le_bytes()).collect();
        self.accessor(kind, 5126, values.len() / components, &bytes)
    }

    /// The first primitive of the first mesh.
    pub fn primitive(&mut self) -> &mut Value {
        &mut self.json["meshes"][0]["primitives"][0]
    }

    /// The whole as a `.glb`.
    pub fn glb(&self) -> Vec<u8> {
        let mut root = self.json.clone();
        if !self.bytes.is_empty() && root.get("buffers").is_none() {
            root["buffers"] = json!([{ "byteLength": self.bytes.len() }]);
        }
        let mut text = root.to_string().into_bytes();
        text.resize(text.len().next_multiple_of(4), b' ');
        let mut binary = self.bytes.clone();
        binary.resize(binary.len().next_multiple_of(4), 0);
        let mut glb = b"glTF\x02\0\0\0\0\0\0\0".to_vec();
        for (kind, chunk) in [(b"JSON", text), (b"BIN\0", binary)] {
            glb.extend((chunk.len() as u32).to_le_bytes());
            glb.extend(kind);
            glb.extend(chunk);
        }
        let length = glb.len() as u32;
        glb[8..12].copy_from_slice(&length.to_le_bytes());
        glb
    }

    /// Imports it from a folder of its own.
    pub fn import(&self) -> Result<Imported, ImportError> {
        import_bytes("model.glb", &self.glb())
    }

    /// The text of the error that importing it gives.
    pub fn error(&self) -> String {
        let error = self.import().expect_err("an error").to_string();
        let (_, after) = error.split_once("model.glb").expect("the file's name");
        after.into()
    }
}

/// Imports a file with these bytes from a folder of its own.
pub fn import_bytes(name: &str, bytes: &[u8]) -> Result<Imported, ImportError> {
    import_bytes_with(name, bytes, ImportOptions::default())
}

/// As [`import_bytes`], in another way.
pub fn import_bytes_with(
    name: &str,
    bytes: &[u8],
    options: ImportOptions,
) -> Result<Imported, ImportError> {
    let folder = tempfile::tempdir().unwrap();
    write(folder.path(), name, bytes);
    import_model(&folder.path().join(name), options)
}

/// Writes a file.
pub fn write(folder: &Path, name: &str, bytes: &[u8]) {
    fs::write(folder.join(name), bytes).unwrap();
}

/// How often warnings of this kind were met.
pub fn warned(imported: &Imported, code: WarningCode) -> u64 {
    let all = imported.warnings.iter();
    all.filter(|w| w.code == code).map(|w| w.count).sum()
}
