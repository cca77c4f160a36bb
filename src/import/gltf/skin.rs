//! Skins at the rest pose: meshes bent by joints, baked into world-space vertices.

use super::accessor::{AccessorReader, Selection};
use super::document::{Attributes, Document};
use super::geometry::{Geometry, GeometryReader};
use super::graph::Graph;
use super::morph::xyz;
use crate::import::{Problem, WarningCode, Warnings};
use crate::math::{DAffine3, DMat4, DVec3, Vec3};

/// A skin in its pose.
#[derive(Debug)]
pub struct Skin {
    /// The origin that baked vertices are relative to: one for all primitives of a skin, so that
    /// vertices that coincide still do so after rounding.
    pub anchor: DVec3,
    /// From the mesh's coordinates at binding to the world's, less the anchor.
    joints: Vec<DAffine3>,
}

impl Skin {
    /// Skin `index` of the document; `None` where a joint has no finite place.
    ///
    /// # Errors
    /// Where it names nodes that are not there, or its matrices cannot be read.
    pub fn read(
        accessors: &AccessorReader,
        graph: &Graph,
        index: usize,
    ) -> Result<Option<Self>, Problem> {
        let document: &Document = accessors.document;
        let count = document.skins.len();
        let skin = document.skins.get(index).ok_or_else(|| {
            Problem::Invalid(format!("skin {index} is not there: there are only {count}"))
        })?;
        let problem = |what: String| Problem::Invalid(format!("skin {index}: {what}"));
        let binds = match skin.inverse_bind_matrices {
            Some(accessor) => accessors.floats::<16>(accessor, &Selection::All)?,
            None => Vec::new(),
        };
        if skin.inverse_bind_matrices.is_some() && binds.len() < skin.joints.len() {
            let (matrices, joints) = (binds.len(), skin.joints.len());
            return Err(problem(format!("{matrices} matrices for {joints} joints")));
        }
        let mut joints = Vec::with_capacity(skin.joints.len());
        for (i, &node) in skin.joints.iter().enumerate() {
            if node >= document.nodes.len() {
                return Err(problem(format!("its joint {node} is not there")));
            }
            let Some(world) = graph.world(node) else {
                return Ok(None);
            };
            let bind = binds.get(i).map_or(DAffine3::IDENTITY, bind_matrix);
            joints.push((*world, bind));
        }
        let anchor = joints.first().map_or(DVec3::ZERO, |(w, _)| w.translation);
        let joints: Vec<_> = joints
            .into_iter()
            .map(|(world, bind)| DAffine3::from_translation(-anchor) * world * bind)
            .collect();
        let is_finite = joints.iter().all(|joint| joint.is_finite());
        Ok((is_finite && !joints.is_empty()).then_some(Self { anchor, joints }))
    }

    /// Bends `geometry`; its vertices are then in world coordinates, less the anchor.
    ///
    /// `false`, with a warning, where it has no joints and weights to bend it with.
    ///
    /// # Errors
    /// Where a vertex names a joint that is not there.
    pub fn apply(
        &self,
        geometry: &mut Geometry,
        reader: &GeometryReader,
        attributes: &Attributes,
        warnings: &mut Warnings,
    ) -> Result<bool, Problem> {
        let influences = influences(geometry, reader, attributes, warnings);
        if influences.is_empty() {
            let message = format!("{}: it has a skin but no joints or weights", reader.place);
            warnings.add(WarningCode::BadAttribute, message);
            return Ok(false);
        }
        let mut mirrored = 0;
        for vertex in 0..geometry.positions.len() {
            let blend = self.blend(&influences, vertex)?;
            let determinant = blend.matrix3.determinant();
            mirrored += usize::from(determinant < 0.0);
            let position = geometry.positions[vertex].as_dvec3();
            geometry.positions[vertex] = blend.transform_point3(position).as_vec3();
            if let Some(normal) = geometry.normals.get_mut(vertex) {
                *normal = transform_normal(&blend, determinant, *normal);
            }
            if let Some(tangent) = geometry.tangents.get_mut(vertex) {
                let direction = blend.transform_vector3(xyz(tangent).as_dvec3()).as_vec3();
                tangent[..3].copy_from_slice(&direction.to_array());
                tangent[3] *= if determinant < 0.0 { -1.0 } else { 1.0 };
            }
        }
        // What was mirrored shows its other side; nothing after this knows that it was.
        if 2 * mirrored > geometry.positions.len() {
            for corners in &mut geometry.triangles {
                corners.swap(1, 2);
            }
        }
        Ok(true)
    }

    /// The weighted mean of the joints of a vertex.
    fn blend(&self, influences: &[Influences], vertex: usize) -> Result<DAffine3, Problem> {
        let mut sum = DAffine3::ZERO;
        let mut total = 0.0;
        let mut first = None;
        for set in influences {
            for (&joint, &weight) in set.joints[vertex].iter().zip(&set.weights[vertex]) {
                let transform = self.joints.get(joint as usize);
                first = first.or(transform);
                // Unused places of the four may hold anything.
                if weight == 0.0 {
                    continue;
                }
                let Some(transform) = transform else {
                    let count = self.joints.len();
                    return Err(Problem::Invalid(format!(
                        "vertex {vertex} follows joint {joint}, but there are only {count}"
                    )));
                };
                let weight = f64::from(weight);
                sum.matrix3 += transform.matrix3 * weight;
                sum.translation += transform.translation * weight;
                total += weight;
            }
        }
        // Quantised weights hardly ever add up to 1, and without any the first joint holds all.
        if total > 0.0 {
            sum.matrix3 *= total.recip();
            sum.translation /= total;
            Ok(sum)
        } else {
            Ok(first.copied().unwrap_or(DAffine3::IDENTITY))
        }
    }
}

/// Four joints of each vertex.
struct Influences {
    joints: Vec<[u32; 4]>,
    weights: Vec<[f32; 4]>,
}

/// All sets of joints and weights.
fn influences(
    geometry: &Geometry,
    reader: &GeometryReader,
    attributes: &Attributes,
    warnings: &mut Warnings,
) -> Vec<Influences> {
    let selection = geometry.selection.clone();
    let vertices = geometry.stored_vertices;
    let mut sets = Vec::new();
    loop {
        let set = sets.len();
        let (joints, weights) = (format!("JOINTS_{set}"), format!("WEIGHTS_{set}"));
        let joints = reader.vertex_integers(attributes, &joints, vertices, &selection, warnings);
        let Some(joints) = joints else { return sets };
        let weights = reader.vertex_floats(attributes, &weights, vertices, &selection, warnings);
        let Some(weights) = weights else { return sets };
        sets.push(Influences { joints, weights });
    }
}

fn bind_matrix(matrix: &[f32; 16]) -> DAffine3 {
    DAffine3::from_mat4(DMat4::from_cols_array(&matrix.map(f64::from)))
}

/// By the inverse transpose, up to a positive factor; that of the cofactors also exists where
/// the matrix has no inverse.
fn transform_normal(transform: &DAffine3, determinant: f64, normal: Vec3) -> Vec3 {
    let m = transform.matrix3;
    let [x, y, z] = [m.x_axis, m.y_axis, m.z_axis];
    let n = normal.as_dvec3();
    let cofactors = y.cross(z) * n.x + z.cross(x) * n.y + x.cross(y) * n.z;
    let outward = if determinant < 0.0 {
        -cofactors
    } else {
        cofactors
    };
    outward.normalize_or_zero().as_vec3()
}
