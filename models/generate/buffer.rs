//! The binary part of a glTF file: numbers, and the accessors that find them.

use glam::{DQuat, DVec3};

/// What a GPU would use a range of bytes for.
#[derive(Clone, Copy)]
pub enum Target {
    Vertices,
    Indices,
    None,
}

/// Bytes, with the views and accessors into them.
#[derive(Default)]
pub struct Buffer {
    pub bytes: Vec<u8>,
    views: Vec<String>,
    accessors: Vec<String>,
}

impl Buffer {
    /// Adds vectors in single precision; gives the number of their accessor.
    pub fn vectors(&mut self, vectors: &[DVec3], target: Target) -> usize {
        let vectors: Vec<[f32; 3]> = vectors.iter().map(|v| v.to_array().map(single)).collect();
        let bytes = vectors.iter().flatten().flat_map(|v| v.to_le_bytes());
        let view = self.view(bytes.collect(), target);
        let bound = |pick: fn(f32, f32) -> f32| -> [f32; 3] {
            std::array::from_fn(|axis| vectors.iter().map(|v| v[axis]).fold(vectors[0][axis], pick))
        };
        let bounds = format!(
            r#","min":{:?},"max":{:?}"#,
            bound(f32::min),
            bound(f32::max)
        );
        self.accessor(view, 5126, "VEC3", vectors.len(), &bounds)
    }

    /// Adds rotations as normalised 16-bit integers; gives the number of their accessor.
    pub fn rotations(&mut self, rotations: impl ExactSizeIterator<Item = DQuat>) -> usize {
        let count = rotations.len();
        let bytes = rotations
            .flat_map(|q| q.to_array())
            .flat_map(|c| ((c * 32767.0).round() as i16).to_le_bytes());
        let view = self.view(bytes.collect(), Target::None);
        self.accessor(view, 5122, "VEC4", count, r#","normalized":true"#)
    }

    /// Adds triangles of a mesh of `vertices` vertices, in 16 bits where that is enough; gives the
    /// number of their accessor.
    pub fn indices(&mut self, triangles: impl Iterator<Item = [u32; 3]>, vertices: usize) -> usize {
        let indices = triangles.flatten();
        // The largest 16-bit index means "restart" to a GPU.
        let (kind, bytes): (u32, Vec<u8>) = if vertices < 0xffff {
            (
                5123,
                indices.flat_map(|i| (i as u16).to_le_bytes()).collect(),
            )
        } else {
            (5125, indices.flat_map(u32::to_le_bytes).collect())
        };
        let count = bytes.len() / if kind == 5123 { 2 } else { 4 };
        let view = self.view(bytes, Target::Indices);
        self.accessor(view, kind, "SCALAR", count, "")
    }

    fn view(&mut self, bytes: Vec<u8>, target: Target) -> usize {
        let (offset, length) = (self.bytes.len(), bytes.len());
        self.bytes.extend(bytes);
        self.bytes.resize(self.bytes.len().next_multiple_of(4), 0);
        let target = match target {
            Target::Vertices => r#","target":34962"#,
            Target::Indices => r#","target":34963"#,
            Target::None => "",
        };
        self.views.push(format!(
            r#"{{"buffer":0,"byteOffset":{offset},"byteLength":{length}{target}}}"#
        ));
        self.views.len() - 1
    }

    fn accessor(&mut self, view: usize, kind: u32, shape: &str, count: usize, more: &str) -> usize {
        self.accessors.push(format!(
            r#"{{"bufferView":{view},"componentType":{kind},"type":"{shape}","count":{count}{more}}}"#
        ));
        self.accessors.len() - 1
    }

    /// The keys of a glTF document that describe it.
    pub fn json(&self) -> String {
        format!(
            r#""accessors":[{}],"bufferViews":[{}],"buffers":[{{"byteLength":{}}}]"#,
            self.accessors.join(","),
            self.views.join(","),
            self.bytes.len(),
        )
    }
}

/// In steps of 2⁻¹⁴ (0.06 mm): sines and cosines, which may differ in their last bits from system
/// to system, give the same bytes everywhere.
fn single(v: f64) -> f32 {
    // Adding 0 turns −0 into 0.
    ((v * 16384.0).round() / 16384.0 + 0.0) as f32
}
