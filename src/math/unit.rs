//! Unit vectors.

use std::ops::{Deref, Neg};

use glam::{DVec3, Vec3};

use super::larger;

/// A direction of length 1, up to rounding.
///
/// The only ways in are [`UnitVec3::normalize`] and [`UnitVec3::from_normalized`], so a cosine
/// is never taken with a vector of another length. Dereferences to [`Vec3`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct UnitVec3(Vec3);

impl UnitVec3 {
    /// The y axis.
    pub const Y: Self = Self(Vec3::Y);
    /// The z axis.
    pub const Z: Self = Self(Vec3::Z);

    /// Scales `v` to length 1; `None` where it is zero or not finite.
    ///
    /// Divides by the largest component first, so that neither tiny nor huge vectors lose
    /// their direction to underflow or overflow.
    #[inline(always)]
    pub fn normalize(v: Vec3) -> Option<Self> {
        let largest = larger(larger(v.x.abs(), v.y.abs()), v.z.abs());
        let has_direction = largest > 0.0 && largest < f32::INFINITY && !v.is_nan();
        // Twice by steps that cannot overflow: 1/largest is infinite for subnormal components.
        let scaled = v / largest;
        let unit = Self(scaled / scaled.length());
        // Not an early return: rows of vectors are computed without a branch.
        has_direction.then_some(unit)
    }

    /// As [`UnitVec3::normalize`], for a vector in double precision.
    #[inline(always)]
    pub fn normalize_f64(v: DVec3) -> Option<Self> {
        let largest = larger(larger(v.x.abs(), v.y.abs()), v.z.abs());
        let has_direction = largest > 0.0 && largest < f64::INFINITY && !v.is_nan();
        // Squares of most numbers do not leave double precision, and those of all when scaled so.
        let scale = if largest > 1e150 { 1e-200 } else { 1.0 };
        let scaled = v * if largest < 1e-150 { 1e200 } else { scale };
        let unit = Self((scaled * scaled.length_recip()).as_vec3());
        has_direction.then_some(unit)
    }

    /// Takes `v` as it is. Its length must be 1 within 1e-4 (checked in debug builds).
    #[inline(always)]
    pub fn from_normalized(v: Vec3) -> Self {
        debug_assert!(
            (v.length_squared() - 1.0).abs() < 2e-4,
            "not a unit vector: {v}"
        );
        Self(v)
    }

    /// The plain vector.
    pub fn get(self) -> Vec3 {
        self.0
    }
}

impl Deref for UnitVec3 {
    type Target = Vec3;

    fn deref(&self) -> &Vec3 {
        &self.0
    }
}

impl Neg for UnitVec3 {
    type Output = Self;

    fn neg(self) -> Self {
        Self(-self.0)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn normalize_survives_the_whole_range_of_f32() {
        for scale in [1e-45, 1e-38, 1e-20, 1.0, 1e20, 1e38] {
            let v = UnitVec3::normalize(Vec3::new(scale, scale, 0.0));
            let v = v.unwrap_or(UnitVec3::Z);
            assert!((v.length() - 1.0).abs() < 1e-6, "scale {scale}: {v:?}");
            assert!((v.x - v.y).abs() < 1e-6 && v.z == 0.0, "scale {scale}");
        }
    }

    #[test]
    fn normalize_refuses_what_has_no_direction() {
        for v in [
            Vec3::ZERO,
            Vec3::NAN,
            Vec3::new(0.0, f32::NAN, 1.0),
            Vec3::INFINITY,
        ] {
            assert_eq!(UnitVec3::normalize(v), None, "{v}");
        }
    }
}
