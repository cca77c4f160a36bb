//! Where a group of lights is, which way it shines, how strong it is.

use std::f64::consts::{FRAC_PI_2, PI};

use crate::math::{Aabb, DVec3, UnitVec3, Vec3};

/// Bounds of one light or of many.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LightBounds {
    /// Around all of them.
    pub bounds: Aabb,
    /// The middle of their normals.
    pub axis: UnitVec3,
    /// The largest angle between the axis and a normal, radians; π for what shines to all sides.
    pub normals_radians: f32,
    /// How far from its own normal a light still shines, radians: π/2 for a matte emitter.
    pub emission_radians: f32,
    /// Whether their backs shine as their fronts do.
    pub is_two_sided: bool,
    /// The largest radiant intensity, by luminance, W/sr: radiance times area for what is flat.
    pub intensity: f64,
}

/// What light is chosen for.
#[derive(Clone, Copy, Debug)]
pub struct Receiver {
    /// The point.
    pub point: Vec3,
    /// Its normal, on the side that gathers light; `None` where both sides do.
    pub normal: Option<UnitVec3>,
}

impl LightBounds {
    /// What shines to all sides from within `bounds`.
    pub fn in_all_directions(bounds: Aabb, intensity: f64) -> Self {
        Self {
            bounds,
            axis: UnitVec3::Z,
            normals_radians: PI as f32,
            emission_radians: FRAC_PI_2 as f32,
            is_two_sided: false,
            intensity,
        }
    }

    /// What is flat, with this normal.
    pub fn flat(bounds: Aabb, normal: UnitVec3, is_two_sided: bool, intensity: f64) -> Self {
        Self {
            bounds,
            axis: normal,
            normals_radians: 0.0,
            emission_radians: FRAC_PI_2 as f32,
            is_two_sided,
            intensity,
        }
    }

    /// These, with an intensity of at least `intensity`: what has none is never chosen.
    pub fn with_least(self, intensity: f64) -> Self {
        Self {
            intensity: self.intensity.max(intensity),
            ..self
        }
    }

    /// Around both.
    pub fn union(&self, other: &Self) -> Self {
        let (axis, normals_radians) = self.union_of_normals(other);
        Self {
            bounds: self.bounds.union(other.bounds),
            axis,
            normals_radians,
            emission_radians: self.emission_radians.max(other.emission_radians),
            is_two_sided: self.is_two_sided || other.is_two_sided,
            intensity: self.intensity + other.intensity,
        }
    }

    /// The narrowest cone around the cones of both (algorithm 1 of the paper).
    fn union_of_normals(&self, other: &Self) -> (UnitVec3, f32) {
        let (wide, narrow) = if self.normals_radians >= other.normals_radians {
            (self, other)
        } else {
            (other, self)
        };
        let between = angle(wide.axis.as_dvec3(), narrow.axis.as_dvec3());
        let [wide_angle, narrow_angle] =
            [wide.normals_radians, narrow.normals_radians].map(f64::from);
        if (between + narrow_angle).min(PI) <= wide_angle {
            return (wide.axis, wide.normals_radians);
        }
        // Half a rounding more, since the axis is rounded too.
        let normals = 0.5 * (wide_angle + between + narrow_angle) + 1e-6;
        let across = wide.axis.cross(narrow.axis.get()).as_dvec3().normalize();
        if normals >= PI || !across.is_finite() {
            return (wide.axis, PI as f32);
        }
        let turn = normals - wide_angle;
        let axis = wide.axis.as_dvec3();
        let turned = axis * turn.cos() + across.cross(axis) * turn.sin();
        match UnitVec3::normalize_f64(turned) {
            Some(axis) => (axis, normals as f32),
            None => (wide.axis, PI as f32),
        }
    }
}

fn angle(a: DVec3, b: DVec3) -> f64 {
    // Twice the angle of the halves: exact for angles near 0 and π, where arccosines are not.
    2.0 * (a - b).length().atan2((a + b).length())
}
