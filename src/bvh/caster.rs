//! The constants of a ray: what box tests, the triangle filter and the exact test need.
//!
//! # Why no tree shape can lose a hit
//!
//! A hit is what [`ExactRay::cross`] accepts; it depends on ray and triangle alone. Let such a
//! hit have parameter t. `cross` confirms that the point o + t d lies in the triangle's box but
//! for 2u(|o| + |t d|) along each axis, u being the unit roundoff of `f32`. Every box above
//! the triangle holds the triangle's box exactly (boxes are unions, without arithmetic), so
//! the point lies in it with the same slack. Take an axis with d > 0, let i = fl(1/d), and
//! let b be the box's lower plane. Then (b − o)/d ≤ t + 2u|o/d| + 2ut. The box test computes
//! b·i − c with c = o·i + 6u|o·i| (near planes; − 6u|o·i| for far planes), rounded after
//! each operation or fused: its error is at most 4u|o·i| + 3u|(b − o)/d|, roundings of i, c
//! and, unfused, of b·i included. So the near distance is at most t(1 + 6u), whatever the
//! fusing, and likewise the far distance is at least t(1 − 6u). The test `near <= far *`
//! [`FAR_PAD`] therefore passes (compare Ize 2013, "Robust BVH Ray Traversal"), and it still
//! does when near and far are clipped to the ray's range widened by [`RANGE_PAD`]. Underflow
//! is covered by [`TINY`].
//!
//! Components of d below 2^-40 of the largest, zero included, would make i overflow or lose
//! culling. They are raised to 2^-40 of the largest, keeping their sign, and c is widened by
//! T, an upper bound of the parameters at which the ray is inside of the tree's box: the true
//! entry into a slab differs from the computed one by at most T in these units. Extreme
//! directions and coordinates are brought to a range where no product overflows
//! (`unit_of_direction`).

use super::hit::Search;
use super::triangle::ExactRay;
use crate::math::{Aabb, Ray, UNIT_ROUNDOFF};

/// `near <= far * FAR_PAD` is the box test; 1 + 16u.
pub(super) const FAR_PAD: f32 = 1.0 + 16.0 * UNIT_ROUNDOFF;

/// Widens the range of `t` that boxes and the triangle filter let through.
const RANGE_PAD: f64 = 8.0 * UNIT_ROUNDOFF as f64;

/// More than underflow can take away from any distance.
const TINY: f32 = 64.0 * f32::MIN_POSITIVE;

/// Components of the direction are raised to this share of the largest.
const LEAST_SLOPE: f32 = 1.0 / (1u64 << 40) as f32;

/// A ray on its way through a tree.
pub(super) struct Caster {
    /// Second, third and main axis: the main one is that of the largest direction component.
    pub axes: [usize; 3],
    /// Whether the ray runs towards lower coordinates, by axis: index of the near planes.
    pub near_side: [usize; 3],
    /// Reciprocal direction, by axis.
    pub inverse: [f32; 3],
    /// What is subtracted from a near plane times `inverse`.
    pub near_offset: [f32; 3],
    /// What is subtracted from a far plane times `inverse`.
    pub far_offset: [f32; 3],
    /// Origin, in the order `axes`.
    pub origin: [f32; 3],
    /// Slopes of the two lesser axes along the main one.
    pub shear: [f32; 2],
    /// For the test that decides.
    pub exact: ExactRay,
    main_direction: f64,
    /// Box distances are `t * to_distance`; see [`unit_of_direction`].
    to_distance: f64,
}

/// The range of `t` of a [`Search`], widened, in the units of box distances and of depth
/// along the main axis.
#[derive(Clone, Copy)]
pub(super) struct Window {
    /// Least and greatest distance.
    pub near: f32,
    /// See `near`.
    pub far: f32,
    /// Least and greatest depth (position along the main axis from the origin).
    pub depth: [f32; 2],
}

impl Caster {
    /// `None` where `ray` is not finite, has no direction, or leaves `bounds` behind.
    ///
    /// `slack` is a distance in space by which boxes count as larger; finite.
    #[inline(always)]
    pub fn new(ray: &Ray, bounds: &Aabb, slack: f32) -> Option<Self> {
        let (origin, direction) = (ray.origin.to_array(), ray.direction.to_array());
        let size = ray.direction.abs().to_array();
        let main = longest(size);
        let finite = ray.origin.is_finite() && ray.direction.is_finite();
        if !finite || size[main] == 0.0 || bounds.is_empty() {
            return None;
        }
        let axes = [(main + 1) % 3, (main + 2) % 3, main];
        let turned = |v: [f32; 3]| [v[axes[0]], v[axes[1]], v[main]];
        let exact = ExactRay::new(turned(origin), turned(direction));
        let coordinate = ray.origin.abs().max(bounds.min.abs()).max(bounds.max.abs());
        let to_distance = unit_of_direction(size[main], coordinate.max_element());
        let scaled = match to_distance {
            1.0 => direction,
            unit => per_axis(|k| (f64::from(direction[k]) / unit) as f32),
        };
        let way = way_out(origin[main], scaled[main], bounds, main, slack)?;

        let least = LEAST_SLOPE * scaled[main].abs();
        let inverse = per_axis(|k| 1.0 / scaled[k].abs().max(least).copysign(scaled[k]));
        let product = per_axis(|k| origin[k] * inverse[k]);
        let mut pad =
            per_axis(|k| 6.0 * UNIT_ROUNDOFF * product[k].abs() + slack * inverse[k].abs() + TINY);
        for k in 0..3 {
            if scaled[k].abs() < least {
                pad[k] += distance(way, scaled[main]);
            }
        }
        let shear = exact.shear();
        Some(Self {
            axes,
            near_side: per_axis(|k| usize::from(direction[k].is_sign_negative())),
            inverse,
            near_offset: per_axis(|k| product[k] + pad[k]),
            far_offset: per_axis(|k| product[k] - pad[k]),
            origin: turned(origin),
            shear: [shear[0] as f32, shear[1] as f32],
            exact,
            main_direction: f64::from(direction[main]),
            to_distance,
        })
    }

    /// What of the tree may still hold a better hit.
    #[inline(always)]
    pub fn window(&self, search: &Search) -> Window {
        let least = f64::from(search.t_min) * (1.0 - RANGE_PAD);
        let most = f64::from(search.t_best) * (1.0 + RANGE_PAD);
        let (a, b) = (least * self.main_direction, most * self.main_direction);
        Window {
            near: (least * self.to_distance) as f32 - TINY,
            far: (most * self.to_distance) as f32 + TINY,
            depth: [a.min(b) as f32 - TINY, a.max(b) as f32 + TINY],
        }
    }
}

/// `array::map` is not inlined everywhere, see `triangle`.
#[inline(always)]
fn per_axis<T>(f: impl Fn(usize) -> T) -> [T; 3] {
    [f(0), f(1), f(2)]
}

#[inline(always)]
fn longest(size: [f32; 3]) -> usize {
    let second = usize::from(size[1] > size[0]);
    if size[2] > size[second] { 2 } else { second }
}

/// What directions are divided by for box tests, a power of two: 1, but where a direction of
/// length `length` or a coordinate as large as `coordinate` would make products overflow.
///
/// With coordinates up to 2^50 directions of length 2^-30 to 2^30 have products below 2^121
/// (reciprocals are at most 2^70). Larger coordinates get a direction of length 2^42, whose
/// reciprocals are below 1.
#[inline(always)]
fn unit_of_direction(length: f32, coordinate: f32) -> f64 {
    const ORDINARY_LENGTH: std::ops::Range<f32> = 1.0 / (1u64 << 30) as f32..(1u64 << 30) as f32;
    const ORDINARY_COORDINATE: f32 = (1u64 << 50) as f32;
    let exponent = if coordinate > ORDINARY_COORDINATE {
        42.0
    } else if ORDINARY_LENGTH.contains(&length) {
        return 1.0;
    } else {
        0.0
    };
    (f64::from(length).log2().floor() - exponent).exp2()
}

/// How far it is, along the main axis, to where the ray leaves the slab of `bounds`, rounded up;
/// `None` where the slab is behind the origin.
#[inline(always)]
fn way_out(origin: f32, direction: f32, bounds: &Aabb, axis: usize, slack: f32) -> Option<f64> {
    let origin = f64::from(origin);
    let ahead = if direction > 0.0 {
        f64::from(bounds.max[axis]) - origin
    } else {
        origin - f64::from(bounds.min[axis])
    };
    let way = ahead + f64::from(f32::EPSILON) * origin.abs() + f64::from(slack);
    (way >= 0.0).then_some(way)
}

/// `way` in units of `direction`, rounded up. Rare, and apart so that other rays are spared the
/// division.
#[cold]
#[inline(never)]
fn distance(way: f64, direction: f32) -> f32 {
    (way / f64::from(direction.abs()) * (1.0 + RANGE_PAD)) as f32
}
