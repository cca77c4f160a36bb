//! A disk as seen from a point: an ellipse on the sphere of directions.

use std::f64::consts::TAU;

use super::hypotenuse;
use crate::math::{DVec3, Vec2, larger, lesser};
use crate::sampling::square_to_cone;

/// The directions from the origin in which a disk is seen.
///
/// Such a cone is elliptic (Guillén et al. 2017, "Area-Preserving Parameterizations for Spherical
/// Ellipses", has its axes). Projected along its axis on the plane through the origin it is an
/// ellipse with the sines of its half angles as half axes. So a circular cone of the wider half
/// angle, uniform by solid angle, becomes this one when one coordinate shrinks by the ratio of the
/// sines: the density stays in closed form, and its inverse is never above that at the axis.
///
/// Everything is a ratio of lengths in a triangle, formed without cancellation: it holds for
/// disks far away and for disks that the origin nearly touches.
#[derive(Clone, Copy, Debug)]
pub(super) struct SphericalEllipse {
    /// Across the wider half angle.
    wide: DVec3,
    /// Across the narrower one.
    narrow: DVec3,
    axis: DVec3,
    /// Of the wider half angle.
    cos: f64,
    one_minus_cos: f64,
    /// The sine of the narrower half angle over that of the wider, in `(0, 1]`.
    squash: f64,
    /// Against the disk's normal.
    toward_plane: DVec3,
    /// Distance of the disk's plane.
    height: f64,
    /// Distance of the disk's farthest point.
    farthest: f64,
}

/// One direction in which the disk is seen.
pub(super) struct DiskSample {
    /// Of length 1.
    pub direction: DVec3,
    /// Steradians per probability: the mean is the solid angle of the disk.
    pub inverse_density: f64,
    /// The disk's point in this direction.
    pub on_disk: DVec3,
}

impl SphericalEllipse {
    /// The disk around `center`; `None` where the origin is not on the side of its unit `normal`,
    /// or the disk has no area.
    ///
    /// Without a branch, for rows of origins: what is `None` is computed too.
    #[inline(always)]
    pub fn of_disk(center: DVec3, normal: DVec3, radius: f64) -> Option<Self> {
        let toward_plane = -normal;
        let height = center.dot(toward_plane);
        let is_seen = height > 0.0 && height < f64::INFINITY && radius > 0.0;
        let (lateral, offset) = lateral(center - toward_plane * height, height, normal);

        // In the plane of the normal and the centre, the disk is the side from `low` to `high` of
        // a triangle whose third corner is the origin.
        let (low, high) = (offset - radius, offset + radius);
        let (to_low, to_high) = (hypotenuse(low, height), hypotenuse(high, height));
        let sum = to_low + to_high;
        // to_low + to_high - 2 radius.
        let gap = if low < 0.0 {
            height * (height / (to_low - low))
        } else {
            to_low + low
        } + height * (height / (to_high + high));

        let share = 1.0 / sum;
        let sin = 2.0 * radius * share;
        let cos = (gap * share * ((sum + 2.0 * radius) * share)).sqrt();
        let squash = lesser(height / ((to_low * to_high).sqrt() * cos), 1.0);
        // Where the bisector of the angle at the origin meets the disk.
        let foot = low * (to_high * share) + high * (to_low * share);
        let unit = 1.0 / hypotenuse(foot, height);
        let (across, along) = (height * unit, foot * unit);
        let seen = Self {
            wide: lateral.cross(toward_plane),
            narrow: lateral * across - toward_plane * along,
            axis: lateral * along + toward_plane * across,
            cos,
            one_minus_cos: sin * sin / (1.0 + cos),
            squash,
            toward_plane,
            height,
            farthest: to_high,
        };
        is_seen.then_some(seen)
    }

    /// The density by solid angle with which [`Self::sample`] takes a direction in which the disk is seen.
    pub fn density(&self, direction: DVec3) -> f64 {
        let z = direction.dot(self.axis);
        let y = direction.dot(self.narrow);
        let round_y = y / self.squash;
        // As in `sample`, the other way round.
        let round_z = (z * z - (round_y - y) * (round_y + y)).max(0.0).sqrt();
        let round_z = round_z.max(self.cos);
        z / (TAU * self.one_minus_cos * self.squash * round_z)
    }

    /// A direction of density `1 / inverse_density` by solid angle.
    #[inline(always)]
    pub fn sample(&self, u: Vec2) -> DiskSample {
        let round = square_to_cone(u, self.one_minus_cos);
        // Rounding must not bring the edge of the cone down to the horizon.
        let round_z = larger(round.z, self.cos);
        let y = round.y * self.squash;
        let z = (round_z * round_z + (round.y - y) * (round.y + y)).sqrt();
        let direction = self.wide * round.x + self.narrow * y + self.axis * z;
        let toward_plane = larger(
            direction.dot(self.toward_plane),
            self.height / self.farthest,
        );
        DiskSample {
            direction,
            inverse_density: TAU * self.one_minus_cos * self.squash * (round_z / z),
            on_disk: direction * (self.height / toward_plane),
        }
    }
}

/// The direction of `offset` and its length; any direction across `normal` where there is no
/// more to it than rounding.
#[inline(always)]
fn lateral(offset: DVec3, height: f64, normal: DVec3) -> (DVec3, f64) {
    let length = offset.length();
    let any = normal.any_orthonormal_vector();
    let along = offset * (1.0 / length);
    if length > 1e-12 * height {
        (along, length)
    } else {
        (any, 0.0)
    }
}
