//! Shading frames.

use glam::Vec3;

use super::UnitVec3;

/// A right-handed orthonormal basis around a normal; in its own coordinates the normal is z.
#[derive(Clone, Copy, Debug)]
pub struct Frame {
    /// First axis.
    pub tangent: Vec3,
    /// Second axis.
    pub bitangent: Vec3,
    /// Third axis.
    pub normal: UnitVec3,
}

impl Frame {
    /// Any basis around `normal`, without a branch
    /// (Duff et al. 2017, "Building an Orthonormal Basis, Revisited").
    pub fn around(normal: UnitVec3) -> Self {
        let (tangent, bitangent) = normal.any_orthonormal_pair();
        Self {
            tangent,
            bitangent,
            normal,
        }
    }

    /// From the frame's coordinates to the world's.
    pub fn to_world(&self, v: Vec3) -> Vec3 {
        self.tangent * v.x + self.bitangent * v.y + self.normal.get() * v.z
    }

    /// From the world's coordinates to the frame's.
    pub fn to_local(&self, v: Vec3) -> Vec3 {
        Vec3::new(
            self.tangent.dot(v),
            self.bitangent.dot(v),
            self.normal.dot(v),
        )
    }
}
