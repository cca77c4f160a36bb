//! Where single-precision coordinates are counted from.

use rayon::prelude::*;

use super::geometry::Geometry;
use crate::math::{DVec3, Vec3};

/// How many times its own size a model may be away from the origin before it is recentred: up to
/// here the rounding of its coordinates is at most 8 times that of a model at the origin.
const FARTHEST: f64 = 8.0;

/// Corners that one thread takes at a time. Fewer in all need no second one.
const CHUNK: usize = 1 << 16;

const EMPTY: [DVec3; 2] = [DVec3::INFINITY, DVec3::NEG_INFINITY];

/// The origin of the meshes' coordinates, in the world. It is a double-precision point that is
/// subtracted before coordinates become single precision.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Anchor(pub DVec3);

impl Anchor {
    /// The world's own origin where the faces of `geometry` are near it for their size, else the
    /// middle of the box around them. The choice is the same at every scale.
    pub fn of(geometry: &Geometry) -> Self {
        let around = |vertices: &[u32]| {
            let positions = vertices.iter().map(|&v| geometry.positions[v as usize]);
            positions
                .filter(|p| p.is_finite())
                .fold(EMPTY, |[min, max], p| [min.min(p), max.max(p)])
        };
        let vertices = &geometry.corners.vertices;
        let boxes: Vec<_> = if vertices.len() > CHUNK {
            vertices.par_chunks(CHUNK).map(around).collect()
        } else {
            vec![around(vertices)]
        };
        let [min, max] = boxes
            .into_iter()
            .fold(EMPTY, |a, b| [a[0].min(b[0]), a[1].max(b[1])]);
        let extent = (max - min).max_element();
        let farthest = min.abs().max(max.abs()).max_element();
        // Without any finite vertex the extent is negative and the farthest coordinate infinite.
        if farthest <= FARTHEST * extent || !farthest.is_finite() {
            Self(DVec3::ZERO)
        } else {
            Self(0.5 * min + 0.5 * max)
        }
    }

    /// The point `p` of the world in the meshes' coordinates.
    pub fn local(self, p: DVec3) -> Vec3 {
        (p - self.0).as_vec3()
    }
}
