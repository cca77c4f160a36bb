//! The coordinates that rays live in.

use crate::math::{DAffine3, DVec3, Vec3};

/// From the world in double precision to the single precision that rays live in:
/// `(world - origin) * scale`.
///
/// The scale is a power of two that brings the scene's extent to `[1, 2)`, so a scene of any
/// size uses the same part of the range of `f32`, and a scene scaled by a power of two is
/// traced with the very same numbers.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Placement {
    /// World point that becomes 0.
    pub origin: DVec3,
    /// Prepared units in a world unit; a power of two.
    pub scale: f64,
}

/// The farthest, in extents of the scene, that vertices may be from the world's origin and still
/// keep it as theirs: such scenes lose at most two bits and keep the coordinates of their files.
const NEAR_EXTENTS: f64 = 2.0;

impl Placement {
    /// The placement for a scene between the corners `bounds` ([`crate::scene::Scene::bounds`]).
    pub fn around(bounds: Option<(DVec3, DVec3)>) -> Self {
        let Some((min, max)) = bounds else {
            return Self {
                origin: DVec3::ZERO,
                scale: 1.0,
            };
        };
        let extent = (max - min).max_element();
        let farthest = min.abs().max(max.abs()).max_element();
        // A scene that is one point has no extent of its own.
        let size = if extent > 0.0 { extent } else { farthest };
        let origin = if farthest <= NEAR_EXTENTS * extent {
            DVec3::ZERO
        } else {
            0.5 * min + 0.5 * max
        };
        Self {
            origin,
            scale: power_of_two_below(size).recip(),
        }
    }

    /// A world point in prepared coordinates.
    pub fn point(&self, world: DVec3) -> Vec3 {
        ((world - self.origin) * self.scale).as_vec3()
    }

    /// A transform to the world, continued to prepared coordinates.
    pub fn after(&self, to_world: &DAffine3) -> DAffine3 {
        DAffine3 {
            matrix3: to_world.matrix3 * self.scale,
            translation: (to_world.translation - self.origin) * self.scale,
        }
    }
}

/// The largest power of two not above `x`; 1 where `x` is not a positive normal number, and at
/// least 2^-1000, so that its reciprocal is finite.
fn power_of_two_below(x: f64) -> f64 {
    if x.is_normal() && x > 0.0 {
        f64::from_bits(x.to_bits() & (0x7ff << 52)).max(2f64.powi(-1000))
    } else {
        1.0
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn powers_of_two_are_found_exactly() {
        for (x, expected) in [(1.0, 1.0), (1.99, 1.0), (2.0, 2.0), (0.3, 0.25), (0.0, 1.0)] {
            assert_eq!(power_of_two_below(x), expected, "{x}");
        }
        for k in -40..=40 {
            let s = 2f64.powi(k);
            assert_eq!(power_of_two_below(5.3 * s), 4.0 * s);
        }
    }
}
