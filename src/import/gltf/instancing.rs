//! Many placements of one node's mesh (`EXT_mesh_gpu_instancing`).

use serde::Deserialize;

use super::accessor::{AccessorReader, Selection};
use super::document::{Attributes, Node};
use super::extensions::INSTANCING;
use super::graph::unit_rotation;
use crate::import::Problem;
use crate::math::{DAffine3, DQuat, DVec3};

/// The extension's object in a node.
#[derive(Deserialize)]
struct Instancing {
    #[serde(default)]
    attributes: Attributes,
}

/// The transforms of a node's instances, relative to the node; `None` where it has no such list.
///
/// # Errors
/// Where the lists cannot be read, or are not of one length.
pub fn transforms(
    accessors: &AccessorReader,
    node: &Node,
) -> Result<Option<Vec<DAffine3>>, Problem> {
    let instancing = node.extensions.read::<Instancing>(INSTANCING);
    let Some(instancing) = instancing.map_err(Problem::Invalid)? else {
        return Ok(None);
    };
    let attributes = &instancing.attributes;
    let translations = floats::<3>(accessors, attributes, "TRANSLATION")?;
    let rotations = floats::<4>(accessors, attributes, "ROTATION")?;
    let scales = floats::<3>(accessors, attributes, "SCALE")?;
    let counts = [
        translations.as_ref().map(Vec::len),
        rotations.as_ref().map(Vec::len),
        scales.as_ref().map(Vec::len),
    ];
    let Some(&count) = counts.iter().flatten().next() else {
        return Ok(None);
    };
    if counts.iter().flatten().any(|&other| other != count) {
        let what = format!("{INSTANCING}: its attributes differ in length");
        return Err(Problem::Invalid(what));
    }
    accessors
        .budget
        .take(count as u64 * size_of::<DAffine3>() as u64)?;
    let vector = |list: &Option<Vec<[f32; 3]>>, i: usize, default: DVec3| {
        list.as_ref()
            .map_or(default, |list| DVec3::from(list[i].map(f64::from)))
    };
    let rotation = |i: usize| {
        let Some(rotations) = &rotations else {
            return Some(DQuat::IDENTITY);
        };
        unit_rotation(DQuat::from_array(rotations[i].map(f64::from)))
    };
    let transform = |i: usize| {
        let transform = DAffine3::from_scale_rotation_translation(
            vector(&scales, i, DVec3::ONE),
            rotation(i).unwrap_or(DQuat::NAN),
            vector(&translations, i, DVec3::ZERO),
        );
        transform.is_finite().then_some(transform).ok_or_else(|| {
            Problem::Invalid(format!(
                "{INSTANCING}: instance {i} has no finite transform"
            ))
        })
    };
    (0..count)
        .map(transform)
        .collect::<Result<_, _>>()
        .map(Some)
}

fn floats<const N: usize>(
    accessors: &AccessorReader,
    attributes: &Attributes,
    name: &str,
) -> Result<Option<Vec<[f32; N]>>, Problem> {
    let read = |&accessor| accessors.floats(accessor, &Selection::All);
    attributes.get(name).map(read).transpose()
}
