//! The glTF document: its JSON as typed data, nothing resolved or checked yet.
//!
//! Ours rather than `gltf-json`'s, for two reasons: node transforms keep the double precision
//! that decimal JSON numbers have, and a malformed optional extension costs that extension and
//! not the file. Members that are missing become defaults which later stages refuse by name.

use std::collections::BTreeMap;
use std::fmt;

use serde::Deserialize;
use serde::de::{DeserializeOwned, IgnoredAny};
use serde_json::{Map, Value};

use super::document_material::MaterialEntry;

/// The root object.
#[derive(Debug, Default, Deserialize)]
#[serde(rename_all = "camelCase", default)]
pub struct Document {
    pub asset: Asset,
    pub extensions_used: Vec<String>,
    pub extensions_required: Vec<String>,
    pub scene: Option<usize>,
    pub scenes: Vec<SceneEntry>,
    pub nodes: Vec<Node>,
    pub meshes: Vec<MeshEntry>,
    pub materials: Vec<MaterialEntry>,
    pub accessors: Vec<Accessor>,
    pub buffer_views: Vec<BufferView>,
    pub buffers: Vec<Buffer>,
    pub textures: Vec<TextureEntry>,
    pub samplers: Vec<Sampler>,
    pub images: Vec<ImageEntry>,
    pub skins: Vec<SkinEntry>,
    pub cameras: Vec<CameraEntry>,
    pub animations: Vec<IgnoredAny>,
    pub extensions: Extensions,
}

/// Which version the file is written in.
#[derive(Debug, Default, Deserialize)]
#[serde(rename_all = "camelCase", default)]
pub struct Asset {
    pub version: String,
    pub min_version: Option<String>,
}

/// Roots of what is shown together.
#[derive(Debug, Default, Deserialize)]
#[serde(default)]
pub struct SceneEntry {
    pub nodes: Vec<usize>,
}

/// A place in the hierarchy. Rare and large members are boxed: files have many nodes, and `{}` is one.
#[derive(Debug, Default, Deserialize)]
#[serde(default)]
pub struct Node {
    pub name: Option<Box<str>>,
    pub children: Box<[usize]>,
    pub matrix: Option<Box<[f64; 16]>>,
    pub translation: Option<Box<[f64; 3]>>,
    pub rotation: Option<Box<[f64; 4]>>,
    pub scale: Option<Box<[f64; 3]>>,
    pub mesh: Option<usize>,
    pub skin: Option<usize>,
    pub camera: Option<usize>,
    pub weights: Option<Box<[f32]>>,
    pub extensions: Extensions,
}

/// A mesh: primitives that share morph weights.
#[derive(Debug, Default, Deserialize)]
#[serde(default)]
pub struct MeshEntry {
    pub name: Option<String>,
    pub primitives: Vec<Primitive>,
    pub weights: Vec<f32>,
}

/// Accessors by what they hold, such as `POSITION`.
pub type Attributes = BTreeMap<String, usize>;

/// Geometry of one material.
#[derive(Debug, Default, Deserialize)]
#[serde(default)]
pub struct Primitive {
    pub attributes: Attributes,
    pub indices: Option<usize>,
    pub material: Option<usize>,
    pub mode: Option<u32>,
    pub targets: Vec<Attributes>,
    pub extensions: Extensions,
}

/// How numbers lie in a buffer view.
#[derive(Debug, Default, Deserialize)]
#[serde(rename_all = "camelCase", default)]
pub struct Accessor {
    pub buffer_view: Option<usize>,
    pub byte_offset: u64,
    pub component_type: u32,
    pub normalized: bool,
    pub count: u64,
    #[serde(rename = "type")]
    pub kind: ElementKind,
    pub sparse: Option<Box<Sparse>>,
}

/// The shape of one element.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "UPPERCASE")]
pub enum ElementKind {
    Scalar,
    Vec2,
    Vec3,
    Vec4,
    Mat2,
    Mat3,
    Mat4,
    /// Not one that the specification knows, or missing.
    #[default]
    #[serde(other)]
    Unknown,
}

/// Elements that replace some of an accessor's.
#[derive(Debug, Default, Deserialize)]
#[serde(default)]
pub struct Sparse {
    pub count: u64,
    pub indices: SparseIndices,
    pub values: SparseValues,
}

/// Which elements are replaced.
#[derive(Debug, Default, Deserialize)]
#[serde(rename_all = "camelCase", default)]
pub struct SparseIndices {
    pub buffer_view: Option<usize>,
    pub byte_offset: u64,
    pub component_type: u32,
}

/// What they are replaced with.
#[derive(Debug, Default, Deserialize)]
#[serde(rename_all = "camelCase", default)]
pub struct SparseValues {
    pub buffer_view: Option<usize>,
    pub byte_offset: u64,
}

/// Part of a buffer.
#[derive(Debug, Default, Deserialize)]
#[serde(rename_all = "camelCase", default)]
pub struct BufferView {
    pub buffer: Option<usize>,
    pub byte_offset: u64,
    pub byte_length: u64,
    pub byte_stride: u64,
    pub extensions: Extensions,
}

/// Bytes in a file, in the URI itself, or in the binary part of a `.glb`.
#[derive(Debug, Default, Deserialize)]
#[serde(rename_all = "camelCase", default)]
pub struct Buffer {
    pub uri: Option<String>,
    pub byte_length: u64,
    pub extensions: Extensions,
}

/// An image with a sampler.
#[derive(Debug, Default, Deserialize)]
#[serde(default)]
pub struct TextureEntry {
    pub sampler: Option<usize>,
    pub source: Option<usize>,
    pub extensions: Extensions,
}

/// Wrapping and filtering, as OpenGL's numbers.
#[derive(Debug, Default, Deserialize)]
#[serde(rename_all = "camelCase", default)]
pub struct Sampler {
    pub mag_filter: Option<u32>,
    pub wrap_s: Option<u32>,
    pub wrap_t: Option<u32>,
}

/// An encoded image in a file, a URI or a buffer view.
#[derive(Debug, Default, Deserialize)]
#[serde(rename_all = "camelCase", default)]
pub struct ImageEntry {
    pub name: Option<String>,
    pub uri: Option<String>,
    pub buffer_view: Option<usize>,
}

/// Joints that deform a mesh.
#[derive(Debug, Default, Deserialize)]
#[serde(rename_all = "camelCase", default)]
pub struct SkinEntry {
    pub name: Option<String>,
    pub joints: Vec<usize>,
    pub inverse_bind_matrices: Option<usize>,
}

/// A projection.
#[derive(Debug, Default, Deserialize)]
#[serde(default)]
pub struct CameraEntry {
    pub name: Option<String>,
    pub perspective: Option<PerspectiveEntry>,
    pub orthographic: Option<OrthographicEntry>,
}

/// Of a perspective camera; the near and far planes mean nothing to rays.
#[derive(Debug, Default, Deserialize)]
#[serde(default)]
pub struct PerspectiveEntry {
    pub yfov: f32,
}

/// Of an orthographic camera; the picture's own shape gives the width.
#[derive(Debug, Default, Deserialize)]
#[serde(default)]
pub struct OrthographicEntry {
    pub ymag: f32,
}

/// Extension objects by name; boxed, since most things have none.
#[derive(Debug, Default, Deserialize)]
#[serde(transparent)]
pub struct Extensions(Option<Box<Map<String, Value>>>);

impl Extensions {
    /// Whether an object of this name is there.
    pub fn has(&self, name: &str) -> bool {
        self.get(name).is_some()
    }

    /// The object of this name; `None` where there is none.
    ///
    /// # Errors
    /// Where it has not the shape that the extension demands.
    pub fn read<T: DeserializeOwned>(&self, name: &str) -> Result<Option<T>, String> {
        self.get(name)
            .map(|value| T::deserialize(value).map_err(|error| format!("{name}: {error}")))
            .transpose()
    }

    fn get(&self, name: &str) -> Option<&Value> {
        self.0.as_deref()?.get(name)
    }
}

/// Characters of a name that messages show.
const SHOWN_CHARACTERS: usize = 80;

/// How messages call entry `index` of a list of things of this kind: by its name, if it has one.
pub fn place(kind: &str, index: usize, name: Option<&str>) -> String {
    let Some(name) = name.filter(|name| !name.is_empty()) else {
        return format!("{kind} {index}");
    };
    match name.char_indices().nth(SHOWN_CHARACTERS) {
        Some((end, _)) => format!("{kind} {:?}…", &name[..end]),
        None => format!("{kind} {name:?}"),
    }
}

impl Node {
    /// Whether it is anywhere else than its parent.
    pub fn has_transform(&self) -> bool {
        let (translation, rotation) = (&self.translation, &self.rotation);
        self.matrix.is_some() || translation.is_some() || rotation.is_some() || self.scale.is_some()
    }
}

/// How messages call primitive `primitive` of mesh `index`.
pub fn primitive_place(index: usize, mesh: &MeshEntry, primitive: usize) -> String {
    let mesh = place("mesh", index, mesh.name.as_deref());
    format!("{mesh}, primitive {primitive}")
}

impl Document {
    /// Whether an accessor of `primitive` has no data of its own: zeros, or what a compressed
    /// stream holds.
    pub fn lacks_data(&self, primitive: &Primitive) -> bool {
        let mut accessors = primitive.attributes.values().chain(&primitive.indices);
        let get = |&accessor: &usize| self.accessors.get(accessor);
        accessors.any(|accessor| get(accessor).is_some_and(|a| a.buffer_view.is_none()))
    }

    /// How messages call this node.
    pub fn node_place(&self, index: usize) -> String {
        let name = self.nodes.get(index).and_then(|node| node.name.as_deref());
        place("node", index, name)
    }
}

impl ElementKind {
    /// Numbers of one element; `None` where that is unknown.
    pub fn components(self) -> Option<usize> {
        match self {
            Self::Scalar => Some(1),
            Self::Vec2 => Some(2),
            Self::Vec3 => Some(3),
            Self::Vec4 | Self::Mat2 => Some(4),
            Self::Mat3 => Some(9),
            Self::Mat4 => Some(16),
            Self::Unknown => None,
        }
    }
}

impl fmt::Display for ElementKind {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}", format!("{self:?}").to_ascii_uppercase())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// `{},` is an entry: of 3 bytes of JSON it makes as many as these.
    #[test]
    fn empty_entries_are_small() {
        assert!(size_of::<Node>() <= 136, "{}", size_of::<Node>());
        let material = size_of::<MaterialEntry>();
        assert!(material <= 96, "{material}");
        let primitive = size_of::<Primitive>();
        assert!(primitive <= 136, "{primitive}");
    }
}
