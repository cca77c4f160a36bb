//! Normals that the file leaves to be computed: smoothing groups, and flat faces beside smooth
//! ones.

use super::geometry::{Geometry, Index, at};
use super::polygon::area_vector;
use crate::math::{DVec3, Vec3};

/// Gives every corner a normal that lacks one and needs it.
///
/// Faces of a smoothing group get, at each vertex, the mean of the normals of the group's faces
/// there, weighted by the angle of each face at the vertex (Thürmer and Wüthrich 1998, "Computing
/// Vertex Normals from Polygonal Facets"). Other corners get their face's own normal where
/// others of their mesh have one; a mesh without any stays without, and is flat.
pub fn complete(geometry: &mut Geometry) {
    if geometry.corners.all_have_normals() && geometry.normals.iter().all(|&n| has_direction(n)) {
        return;
    }
    smooth_groups(geometry);
    let smooth = smooth_parts(geometry);
    for run in 0..geometry.runs.len() {
        if smooth[geometry.runs[run].part as usize] {
            for face in geometry.faces_of(run) {
                fill_flat(geometry, face);
            }
        }
    }
}

/// Whether each part has a corner with a normal.
fn smooth_parts(geometry: &Geometry) -> Vec<bool> {
    let mut is_smooth = vec![false; geometry.parts.len()];
    if geometry.corners.normals.is_empty() {
        return is_smooth;
    }
    for (number, run) in geometry.runs.iter().enumerate() {
        let slot = &mut is_smooth[run.part as usize];
        *slot = *slot
            || geometry
                .faces_of(number)
                .flat_map(|face| geometry.corners_of(face))
                .any(|corner| geometry.corners.get(corner).normal.is_some());
    }
    is_smooth
}

/// Gives the face's own normal to those of its corners that have none, or one without a
/// direction.
fn fill_flat(geometry: &mut Geometry, face: usize) {
    let mut own = None;
    for i in geometry.corners_of(face) {
        let normal = geometry.corners.get(i).normal;
        if normal.is_some_and(|n| has_direction(at(&geometry.normals, n))) {
            continue;
        }
        let index = own.or_else(|| {
            let area = area_vector(&ring(geometry, face));
            push(&mut geometry.normals, area.normalize_or_zero().as_vec3())
        });
        own = index;
        if let Some(index) = index {
            geometry.corners.set_normal(i, index);
        }
    }
}

fn has_direction(normal: Vec3) -> bool {
    normal.is_finite() && normal != Vec3::ZERO
}

/// Adds a normal; `None` where there are more than an [`Index`] can count.
fn push(normals: &mut Vec<Vec3>, normal: Vec3) -> Option<Index> {
    normals.push(normal);
    u32::try_from(normals.len()).ok().and_then(Index::new)
}

fn ring(geometry: &Geometry, face: usize) -> Vec<DVec3> {
    geometry
        .corners_of(face)
        .map(|i| geometry.positions[geometry.corners.vertices[i] as usize])
        .collect()
}

/// Gives the corners of smoothing groups their normals, one group after the other.
fn smooth_groups(geometry: &mut Geometry) {
    let mut runs: Vec<(u32, usize)> = geometry
        .runs
        .iter()
        .enumerate()
        .filter(|(_, run)| run.smoothing != 0)
        .map(|(number, run)| (run.smoothing, number))
        .collect();
    if runs.is_empty() {
        return;
    }
    runs.sort_unstable();
    let mut sums = VertexSums::new(geometry.positions.len());
    for runs in runs.chunk_by(|(a, _), (b, _)| a == b) {
        for &(_, run) in runs {
            for face in geometry.faces_of(run) {
                add_face(geometry, face, &mut sums);
            }
        }
        let base = geometry.normals.len();
        let normals = sums
            .sums
            .iter()
            .map(|sum| sum.normalize_or_zero().as_vec3());
        geometry.normals.extend(normals);
        for &(_, run) in runs {
            for face in geometry.faces_of(run) {
                assign(geometry, face, &sums, base);
            }
        }
        sums.clear();
    }
}

/// Sums of weighted normals at the vertices of one smoothing group.
struct VertexSums {
    /// By vertex: which of `sums` is its own.
    slots: Vec<Option<Index>>,
    vertices: Vec<u32>,
    sums: Vec<DVec3>,
}

impl VertexSums {
    fn new(vertices: usize) -> Self {
        Self {
            slots: vec![None; vertices],
            vertices: Vec::new(),
            sums: Vec::new(),
        }
    }

    fn add(&mut self, vertex: u32, normal: DVec3) {
        let slot = &mut self.slots[vertex as usize];
        let index = slot.or_else(|| Index::new(self.sums.len() as u32 + 1));
        if slot.is_none() {
            *slot = index;
            self.vertices.push(vertex);
            self.sums.push(DVec3::ZERO);
        }
        if let Some(index) = index {
            self.sums[index.get() as usize - 1] += normal;
        }
    }

    fn clear(&mut self) {
        for vertex in self.vertices.drain(..) {
            self.slots[vertex as usize] = None;
        }
        self.sums.clear();
    }
}

/// Adds the normal of a face without normals to the sums at its corners.
fn add_face(geometry: &Geometry, face: usize, sums: &mut VertexSums) {
    let corners = geometry.corners_of(face);
    if corners
        .clone()
        .all(|i| geometry.corners.get(i).normal.is_some())
    {
        return;
    }
    let ring = ring(geometry, face);
    let normal = area_vector(&ring).normalize_or_zero();
    for (place, i) in corners.enumerate() {
        let angle = interior_angle(&ring, place, normal);
        if angle.is_finite() {
            sums.add(geometry.corners.get(i).vertex, angle * normal);
        }
    }
}

/// The angle inside the polygon at corner `place`, radians in `[0, 2π)`.
fn interior_angle(ring: &[DVec3], place: usize, normal: DVec3) -> f64 {
    let here = ring[place];
    let to_next = ring[(place + 1) % ring.len()] - here;
    let to_previous = ring[(place + ring.len() - 1) % ring.len()] - here;
    let sine = to_next.cross(to_previous).dot(normal);
    let angle = sine.atan2(to_next.dot(to_previous));
    if angle < 0.0 {
        angle + std::f64::consts::TAU
    } else {
        angle
    }
}

/// Gives the corners of `face` that have no normal that of their vertex; the normals of `sums`
/// stand behind the first `base`.
fn assign(geometry: &mut Geometry, face: usize, sums: &VertexSums, base: usize) {
    for i in geometry.corners_of(face) {
        let corner = geometry.corners.get(i);
        let slot = sums.slots[corner.vertex as usize];
        let normal = slot.and_then(|slot| slot.checked_add(base as u32));
        if let (None, Some(normal)) = (corner.normal, normal) {
            geometry.corners.set_normal(i, normal);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::PI;

    #[test]
    fn angles_inside_a_concave_polygon_add_up() {
        let l = [
            [0.0, 0.0],
            [3.0, 0.0],
            [3.0, 1.0],
            [1.0, 1.0],
            [1.0, 3.0],
            [0.0, 3.0],
        ];
        let ring = l.map(|[x, y]: [f64; 2]| DVec3::new(x, y, 7.0));
        let normal = area_vector(&ring).normalize();
        let angles: Vec<f64> = (0..6).map(|i| interior_angle(&ring, i, normal)).collect();
        assert!(
            (angles.iter().sum::<f64>() - 4.0 * PI).abs() < 1e-12,
            "{angles:?}"
        );
        assert!((angles[3] - 1.5 * PI).abs() < 1e-12, "{angles:?}");
    }
}
