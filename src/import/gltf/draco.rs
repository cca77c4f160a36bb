//! Compressed primitives (`KHR_draco_mesh_compression`).
//!
//! What they hold becomes buffers, buffer views and accessors of the document, before anything reads
//! it: nothing after this knows that they were compressed. Primitives with a copy that is not
//! compressed are left as they are, and so are those of meshes that nothing shows.

use std::collections::{BTreeMap, BTreeSet};

use draco_core::{DataType, DecodeLimits, DecoderBuffer, MeshDecoder, PointAttribute, PointIndex};
use serde::Deserialize;

use super::buffers::Buffers;
use super::component::code;
use super::document::{Accessor, Document, ElementKind, primitive_place};
use super::extensions::DRACO;
use super::meshes::Misplaced;
use super::topology::Mode;
use crate::import::Problem;
use crate::import::budget::Budget;

/// The extension's object in a primitive.
#[derive(Deserialize)]
#[serde(rename_all = "camelCase")]
struct Compressed {
    buffer_view: usize,
    attributes: BTreeMap<String, u32>,
}

/// Decodes the primitives of `meshes`.
///
/// # Errors
/// Where one is broken.
pub fn decompress(
    document: &mut Document,
    buffers: &mut Buffers,
    budget: &Budget,
    meshes: BTreeSet<usize>,
) -> Result<(), Misplaced> {
    for mesh in meshes {
        let count = document.meshes.get(mesh).map_or(0, |m| m.primitives.len());
        for primitive in 0..count {
            let done = decompress_primitive(document, buffers, budget, mesh, primitive);
            done.map_err(|problem| Misplaced {
                place: primitive_place(mesh, &document.meshes[mesh], primitive),
                problem,
            })?;
        }
    }
    Ok(())
}

fn decompress_primitive(
    document: &mut Document,
    buffers: &mut Buffers,
    budget: &Budget,
    mesh: usize,
    primitive: usize,
) -> Result<(), Problem> {
    let entry = &document.meshes[mesh].primitives[primitive];
    if !entry.extensions.has(DRACO) || !document.lacks_data(entry) {
        return Ok(());
    }
    let compressed = entry.extensions.read::<Compressed>(DRACO);
    let compressed = compressed.map_err(Problem::Invalid)?;
    let compressed = compressed.ok_or_else(|| Problem::Invalid(format!("{DRACO}: is empty")))?;
    let problem = |what: String| Problem::Invalid(format!("{DRACO}: {what}"));
    let mut names = entry.attributes.clone();
    let indices = entry.indices;

    let stream = buffers.view(document, compressed.buffer_view)?;
    let decoded = decode(stream, budget).map_err(problem)?;
    let points = decoded.num_points();
    // Those that are not in the stream have data of their own.
    names.retain(|name, _| compressed.attributes.contains_key(name));
    for (name, accessor) in names {
        let id = compressed.attributes[&name];
        let values = decoded
            .attribute_by_unique_id(id)
            .ok_or_else(|| problem(format!("{name}: there is no attribute {id}")))?;
        let bytes =
            in_point_order(values, points).map_err(|what| problem(format!("{name}: {what}")))?;
        budget.take(bytes.len() as u64)?;
        let kind = document.accessors.get(accessor).map(|entry| entry.kind);
        let components = usize::from(values.num_components());
        if kind.and_then(ElementKind::components) != Some(components) {
            let what = format!(
                "{name}: {components} numbers do not make an element of accessor {accessor}"
            );
            return Err(problem(what));
        }
        let component_type = component_type(values.data_type()).map_err(problem)?;
        fill(document, buffers, accessor, component_type, points, bytes);
    }
    let corners: Vec<u8> = (decoded.faces().iter().flatten())
        .flat_map(|point| point.0.to_le_bytes())
        .collect();
    budget.take(corners.len() as u64)?;
    let count = 3 * decoded.num_faces();
    let indices = indices.unwrap_or_else(|| {
        document.accessors.push(Accessor {
            kind: ElementKind::Scalar,
            ..Accessor::default()
        });
        document.accessors.len() - 1
    });
    fill(document, buffers, indices, code::U32, count, corners);
    let entry = &mut document.meshes[mesh].primitives[primitive];
    entry.indices = Some(indices);
    entry.mode = Some(Mode::DEFAULT_CODE);
    Ok(())
}

fn decode(stream: &[u8], budget: &Budget) -> Result<draco_core::Mesh, String> {
    let left = budget.left();
    let limits = DecodeLimits::default()
        .with_max_decoded_bytes(left)
        .with_max_points(left / 4)
        .with_max_faces(left / 12);
    let mut buffer = DecoderBuffer::new(stream).with_limits(limits);
    let mut mesh = draco_core::Mesh::new();
    let decoded = MeshDecoder::new().decode(&mut buffer, &mut mesh);
    decoded.map_err(|error| error.to_string())?;
    Ok(mesh)
}

/// The values of all points, packed.
fn in_point_order(values: &PointAttribute, points: usize) -> Result<Vec<u8>, String> {
    let size = values.data_type().byte_length() * usize::from(values.num_components());
    let stride = usize::try_from(values.byte_stride()).unwrap_or(0);
    let data = values.buffer().data();
    let mut packed = Vec::with_capacity(points * size);
    for point in 0..points {
        let index = values.mapped_index(PointIndex(point as u32)).0 as usize;
        let start = index.checked_mul(stride);
        let value = start.and_then(|start| data.get(start..)?.get(..size));
        packed.extend_from_slice(value.ok_or_else(|| format!("point {point} has no value"))?);
    }
    Ok(packed)
}

fn component_type(kind: DataType) -> Result<u32, String> {
    match kind {
        DataType::Int8 => Ok(code::I8),
        DataType::Uint8 | DataType::Bool => Ok(code::U8),
        DataType::Int16 => Ok(code::I16),
        DataType::Uint16 => Ok(code::U16),
        DataType::Uint32 => Ok(code::U32),
        DataType::Float32 => Ok(code::F32),
        other => Err(format!("glTF has no numbers of type {other:?}")),
    }
}

/// Gives accessor `index`, if it is there, `count` elements with these bytes.
fn fill(
    document: &mut Document,
    buffers: &mut Buffers,
    index: usize,
    component_type: u32,
    count: usize,
    bytes: Vec<u8>,
) {
    let view = buffers.add_view(document, bytes);
    if let Some(accessor) = document.accessors.get_mut(index) {
        accessor.buffer_view = Some(view);
        accessor.byte_offset = 0;
        accessor.component_type = component_type;
        accessor.count = count as u64;
    }
}
