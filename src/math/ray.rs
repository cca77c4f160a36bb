//! Rays.

use glam::Vec3;

/// A half-line `origin + t * direction` that is looked at for `t_min < t < t_max`.
///
/// `direction` need not be of length 1: a shadow ray towards a point has the whole way as its
/// direction and `t_max` just below 1.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ray {
    /// Where it starts.
    pub origin: Vec3,
    /// Where it goes; not zero.
    pub direction: Vec3,
    /// Hits nearer than this, or at it, do not count.
    pub t_min: f32,
    /// Hits farther than this, or at it, do not count.
    pub t_max: f32,
}

impl Ray {
    /// A ray without an end.
    #[inline(always)]
    pub fn new(origin: Vec3, direction: Vec3) -> Self {
        Self {
            origin,
            direction,
            t_min: 0.0,
            t_max: f32::INFINITY,
        }
    }

    /// The point at parameter `t`.
    pub fn at(&self, t: f32) -> Vec3 {
        self.origin + t * self.direction
    }
}
