//! A glTF document that has everything which can be left out.

use std::fs;
use std::io::Cursor;
use std::path::{Path, PathBuf};

use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use image::{DynamicImage, ImageFormat, RgbaImage};
use serde_json::{Value, json};

/// Pixels along an image's side.
pub const SIDE: u32 = 4;

/// Images of the document, by what they are for.
pub const IMAGES: [&str; 9] = [
    "base",
    "metal",
    "normal",
    "occlusion",
    "emission",
    "hidden",
    "unnamed",
    "dark",
    "broken",
];

/// Writes `everything.gltf` to `folder`: a square that faces the camera, with every attribute and
/// textures in most slots, and beside it what nothing shows.
pub fn write(folder: &Path) -> PathBuf {
    let mut document = Document::default();
    let corners = [[-1., -1.], [1., -1.], [1., 1.], [-1., 1.]];
    let positions = corners.map(|[x, y]| [x, y, 0.0]).concat();
    let attributes = json!({
        "POSITION": document.floats("VEC3", &positions),
        "NORMAL": document.floats("VEC3", &[[0.1, 0.2, 1.0]; 4].concat()),
        "TANGENT": document.floats("VEC4", &[[0.8, 0.6, 0.0, 1.0]; 4].concat()),
        "TEXCOORD_0": document.floats("VEC2", &corners.concat()),
        "TEXCOORD_1": document.floats("VEC2", &corners.map(|[x, y]| [y, x]).concat()),
        "COLOR_0": document.floats("VEC4", &[[0.9, 0.5, 0.7, 1.0]; 4].concat()),
    });
    let indices = document.indices(&[0, 1, 2, 0, 2, 3]);
    let square = |material| {
        let primitive =
            json!({ "attributes": attributes, "indices": indices, "material": material });
        json!({ "primitives": [primitive] })
    };
    let images: Vec<Value> = (0u8..)
        .zip(IMAGES)
        .map(|(i, name)| image(i, name))
        .collect();
    let textures: Vec<Value> = (0..images.len()).map(|i| json!({ "source": i })).collect();
    let root = json!({
        "asset": { "version": "2.0" },
        "scene": 0,
        "scenes": [{ "nodes": [0, 2] }, { "nodes": [1] }],
        "nodes": [{ "mesh": 0 }, { "mesh": 1 }, { "camera": 0, "translation": [0, 0, 3] }],
        "meshes": [square(0), square(1)],
        "cameras": [{ "type": "perspective", "perspective": { "yfov": 0.7, "znear": 0.1 } }],
        "materials": [
            {
                "pbrMetallicRoughness": {
                    "baseColorTexture": { "index": 0 },
                    "metallicRoughnessTexture": { "index": 1 },
                },
                "normalTexture": { "index": 2, "texCoord": 1 },
                "occlusionTexture": { "index": 3 },
                "emissiveTexture": { "index": 4 },
                "emissiveFactor": [0.5, 0.25, 1.0],
                "extensions": {
                    "KHR_materials_transmission": {
                        "transmissionFactor": 0, "transmissionTexture": { "index": 7 },
                    },
                },
            },
            { "pbrMetallicRoughness": { "baseColorTexture": { "index": 5 } } },
        ],
        "textures": textures,
        "images": images,
        "accessors": document.accessors,
        "bufferViews": document.views,
        "buffers": [{ "byteLength": document.bytes.len(), "uri": uri("application/octet-stream", &document.bytes) }],
    });
    let path = folder.join("everything.gltf");
    fs::write(&path, root.to_string()).unwrap();
    path
}

/// A PNG of its own colours; one has a header and next to nothing else.
fn image(number: u8, name: &str) -> Value {
    let pixel = |x, y| image::Rgba([40 * x as u8 + number, 255 - 50 * y as u8, 20 * number, 255]);
    let pixels = DynamicImage::ImageRgba8(RgbaImage::from_fn(SIDE, SIDE, pixel));
    let mut bytes = Cursor::new(Vec::new());
    pixels.write_to(&mut bytes, ImageFormat::Png).unwrap();
    let mut bytes = bytes.into_inner();
    if name == "broken" {
        bytes.truncate(45);
    }
    json!({ "name": name, "uri": uri("image/png", &bytes) })
}

fn uri(media_type: &str, bytes: &[u8]) -> String {
    format!("data:{media_type};base64,{}", STANDARD.encode(bytes))
}

/// The buffer of a document, and what lies in it.
#[derive(Default)]
struct Document {
    bytes: Vec<u8>,
    views: Vec<Value>,
    accessors: Vec<Value>,
}

impl Document {
    fn floats(&mut self, kind: &str, values: &[f32]) -> usize {
        let components = 4.min(kind.as_bytes()[3] - b'0');
        let bytes: Vec<u8> = values.iter().flat_map(|v| v.to_le_bytes()).collect();
        self.accessor(kind, 5126, values.len() / usize::from(components), &bytes)
    }

    fn indices(&mut self, values: &[u32]) -> usize {
        let bytes: Vec<u8> = values.iter().flat_map(|v| v.to_le_bytes()).collect();
        self.accessor("SCALAR", 5125, values.len(), &bytes)
    }

    fn accessor(&mut self, kind: &str, component: u32, count: usize, bytes: &[u8]) -> usize {
        self.views.push(json!({
            "buffer": 0, "byteOffset": self.bytes.len(), "byteLength": bytes.len()
        }));
        self.bytes.extend(bytes);
        self.accessors.push(json!({
            "bufferView": self.views.len() - 1, "componentType": component, "count": count, "type": kind
        }));
        self.accessors.len() - 1
    }
}
