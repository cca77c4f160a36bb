//! Where single-precision coordinates are counted from.

use super::geometry::{Geometry, at};
use crate::math::{DVec3, Vec3};

/// How many times its own size a model may be away from the origin before it is recentred: up to
/// here the rounding of its coordinates is at most 8 times that of a model at the origin.
const FARTHEST: f64 = 8.0;

/// The origin of the meshes' coordinates, in the world. It is a double-precision point that is
/// subtracted before coordinates become single precision.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Anchor(pub DVec3);

impl Anchor {
    /// The world's own origin where the faces of `geometry` are near it for their size, else the
    /// middle of the box around them. The choice is the same at every scale.
    pub fn of(geometry: &Geometry) -> Self {
        let mut min = DVec3::INFINITY;
        let mut max = DVec3::NEG_INFINITY;
        for &vertex in geometry.corners.vertices() {
            let p = at(&geometry.positions, vertex);
            if p.is_finite() {
                min = min.min(p);
                max = max.max(p);
            }
        }
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
