//! Morph targets at their default weights.

use super::document::Attributes;
use super::geometry::{Geometry, GeometryReader};
use crate::import::Warnings;
use crate::math::{DVec3, Vec3};

/// Weights above 0, with the index of their target.
fn active<'a>(
    targets: &'a [Attributes],
    weights: &'a [f32],
) -> impl Iterator<Item = (&'a Attributes, f64)> {
    let pairs = targets.iter().zip(weights);
    pairs.filter_map(|(target, &w)| (w != 0.0).then_some((target, f64::from(w))))
}

/// Moves the vertices of `geometry` by its weighted targets. A weight for each; those that are
/// missing are 0.
pub fn apply(
    geometry: &mut Geometry,
    reader: &GeometryReader,
    targets: &[Attributes],
    weights: &[f32],
    warnings: &mut Warnings,
) {
    let selection = geometry.selection.clone();
    let vertices = geometry.stored_vertices;
    let mut deltas = |name: &str| -> Vec<(f64, Vec<[f32; 3]>)> {
        active(targets, weights)
            .filter_map(|(target, weight)| {
                let values = reader.vertex_floats(target, name, vertices, &selection, warnings)?;
                Some((weight, values))
            })
            .collect()
    };
    displace(&mut geometry.positions, &deltas("POSITION"));
    if !geometry.normals.is_empty() {
        displace(&mut geometry.normals, &deltas("NORMAL"));
    }
    if !geometry.tangents.is_empty() {
        let deltas = deltas("TANGENT");
        let mut directions: Vec<Vec3> = geometry.tangents.iter().map(xyz).collect();
        displace(&mut directions, &deltas);
        for (tangent, direction) in geometry.tangents.iter_mut().zip(directions) {
            tangent[..3].copy_from_slice(&direction.to_array());
        }
    }
}

/// The direction of a tangent.
pub fn xyz(&[x, y, z, _]: &[f32; 4]) -> Vec3 {
    Vec3::new(x, y, z)
}

/// Adds up in double precision, so that large targets that cancel leave no noise.
fn displace(base: &mut [Vec3], deltas: &[(f64, Vec<[f32; 3]>)]) {
    if deltas.is_empty() {
        return;
    }
    for (vertex, value) in base.iter_mut().enumerate() {
        let sum: DVec3 = deltas
            .iter()
            .map(|(weight, delta)| *weight * Vec3::from(delta[vertex]).as_dvec3())
            .sum();
        *value = (value.as_dvec3() + sum).as_vec3();
    }
}
