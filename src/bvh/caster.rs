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
//! fusing. Far planes have a reciprocal of their own, larger by [`FAR_PAD`]: likewise their
//! distance is at least t(1 + 16u)(1 − 7u), which is more. The test near <= far therefore passes
//! (compare Ize 2013, "Robust BVH Ray Traversal"), and it still does when near and far are
//! clipped to the ray's range widened by [`RANGE_PAD`]. Underflow is covered by [`TINY`].
//!
//! Components of d below 2^-40 of the largest, zero included, would make i overflow or lose
//! culling. They are raised to 2^-40 of the largest, keeping their sign, and c is widened by
//! T, an upper bound of the parameters at which the ray is inside of the tree's box: the true
//! entry into a slab differs from the computed one by at most T in these units. Extreme
//! directions and coordinates are brought to a range where no product overflows
//! (`unit_of_direction`).

use glam::Vec3A;

use super::triangle::ExactRay;
use crate::math::{Aabb, Ray, UNIT_ROUNDOFF, larger};

/// How much larger reciprocal directions are for far planes; 1 + 16u.
const FAR_PAD: f32 = 1.0 + 16.0 * UNIT_ROUNDOFF;

/// Widens the range of `t` that boxes and the triangle filter let through: 16u, of which
/// computing it takes 3u.
const RANGE_PAD: f32 = 16.0 * UNIT_ROUNDOFF;

/// Relative error of a product of origin and reciprocal direction, with room: 6u.
const PRODUCT_PAD: f32 = 6.0 * UNIT_ROUNDOFF;

/// More than underflow can take away from any distance.
const TINY: f32 = 64.0 * f32::MIN_POSITIVE;

/// Components of the direction are raised to this share of the largest.
const LEAST_SLOPE: f32 = 1.0 / (1u64 << 40) as f32;

/// Parameters below this are rounded to few digits: what the exact test will make of them is not certain.
const LEAST_CERTAIN: f32 = 1.0 / (1u128 << 100) as f32;

/// Lengths of directions and magnitudes of coordinates whose products cannot overflow: slopes
/// are 2^-40 at least, so that reciprocals are at most 2^70 and products at most 2^121.
const ORDINARY_LENGTH: std::ops::Range<f32> = 1.0 / (1u64 << 30) as f32..(1u64 << 30) as f32;
const ORDINARY_COORDINATE: f32 = (1u64 << 50) as f32;

/// A ray on its way through a tree.
pub(super) struct Caster {
    /// Second, third and main axis: the main one is that of the largest direction component.
    pub axes: [usize; 3],
    /// Whether the ray runs towards lower coordinates, by axis.
    pub towards_lower: [bool; 3],
    /// Reciprocal direction, by axis, for near planes.
    pub near_inverse: Vec3A,
    /// Reciprocal direction, by axis, for far planes.
    pub far_inverse: Vec3A,
    /// What is subtracted from a near plane times `near_inverse`.
    pub near_offset: Vec3A,
    /// What is subtracted from a far plane times `far_inverse`.
    pub far_offset: Vec3A,
    /// Origin, in the order `axes`.
    pub origin: [f32; 3],
    /// Slopes of the two lesser axes along the main one, each rounded twice.
    pub shear: [f32; 2],
    /// Direction, in the order `axes`.
    direction: [f32; 3],
    /// One over the main component of the direction, in magnitude.
    inverse_length: f32,
    /// Box distances are `t * to_distance`; see [`unit_of_direction`].
    to_distance: f64,
    /// Whether its slopes are those of the ray: it is far from all overflow, and not along an axis.
    has_own_slopes: bool,
}

/// A range of `t`, widened, in the units of box distances and of depth
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
    /// `None` where `ray` is not finite or has no direction; it may be `None`, too, where it
    /// leaves `bounds` behind.
    ///
    /// `reach` is the largest magnitude of a coordinate in `bounds`. `slack` is a distance in
    /// space by which boxes count as larger; finite.
    #[inline(always)]
    pub fn new(ray: &Ray, bounds: &Aabb, reach: f32, slack: f32) -> Option<Self> {
        let (origin, direction) = (ray.origin.to_array(), ray.direction.to_array());
        // Vectors by hand: what the compiler makes of arrays has numbers in the lanes that nobody needs
        // which underflow, and take a hundred cycles.
        let (from, along) = (Vec3A::from(ray.origin), Vec3A::from(ray.direction));
        let size = along.abs();
        let main = longest(size.to_array());
        let length = size.max_element();
        // Written so that a NaN is not ordinary.
        let ordinary = is_ordinary_length(length, reach)
            & from.abs().cmple(Vec3A::splat(ORDINARY_COORDINATE)).all()
            & size.cmpge(Vec3A::splat(LEAST_SLOPE * length)).all();
        let slopes = if ordinary {
            Slopes {
                direction: along,
                pad: Vec3A::splat(TINY),
                unit: 1.0,
            }
        } else {
            unusual_slopes(ray, main, bounds, reach, slack)?
        };

        let near_inverse = slopes.direction.recip();
        let far_inverse = near_inverse * FAR_PAD;
        let pad = if slack == 0.0 {
            slopes.pad
        } else {
            slopes.pad + slack * far_inverse.abs()
        };
        let (near, far) = (from * near_inverse, from * far_inverse);

        let axes = AXES[main];
        let turned_direction = turned(direction, axes);
        let main_inverse = 1.0 / turned_direction[2];
        Some(Self {
            axes,
            towards_lower: per_axis(|k| direction[k].is_sign_negative()),
            near_inverse,
            far_inverse,
            near_offset: near + (PRODUCT_PAD * near.abs() + pad),
            far_offset: far - (PRODUCT_PAD * far.abs() + pad),
            origin: turned(origin, axes),
            shear: [
                turned_direction[0] * main_inverse,
                turned_direction[1] * main_inverse,
            ],
            direction: turned_direction,
            inverse_length: main_inverse.abs(),
            to_distance: slopes.unit,
            has_own_slopes: ordinary,
        })
    }

    /// [`certain_depths`] of the ray; none where it is near an overflow, or along an axis.
    #[inline(always)]
    pub fn certain_depths(&self, t_min: f32, t_max: f32) -> [f32; 2] {
        if self.has_own_slopes {
            certain_depths(t_min, t_max, self.direction[2])
        } else {
            [f32::INFINITY, f32::NEG_INFINITY]
        }
    }

    /// What of the tree may hold a hit from `t_min` to `t_max`.
    #[inline(always)]
    pub fn window(&self, t_min: f32, t_max: f32) -> Window {
        let least = t_min * (1.0 - RANGE_PAD);
        let mut window = Window {
            near: self.distance(least) - TINY,
            far: 0.0,
            depth: [first_depth(t_min, self.direction[2]); 2],
        };
        self.narrow(&mut window, t_max);
        window
    }

    /// Makes `window` end at `t_max`.
    #[inline(always)]
    pub fn narrow(&self, window: &mut Window, t_max: f32) {
        let most = t_max * (1.0 + RANGE_PAD);
        let main = self.direction[2];
        window.far = self.distance(most) + TINY;
        window.depth[usize::from(main > 0.0)] = last_depth(t_max, main);
    }

    /// Makes `window` end where nothing that is certain to be hit farther ahead than `depth` matters. For rays
    /// that have [`Self::certain_depths`].
    #[inline(always)]
    pub fn narrow_to_depth(&self, window: &mut Window, depth: f32) {
        let main = self.direction[2];
        // Two roundings more than in `narrow`, for which there is room. The depth itself has room already: crossings beyond
        // it have greater parameters, rounded as they are (see `Seen::certain`).
        window.far = depth * self.inverse_length * (1.0 + RANGE_PAD) + TINY;
        window.depth[usize::from(main > 0.0)] = depth.copysign(main);
    }

    /// The depth ahead at which `window` ends.
    #[inline(always)]
    pub fn end_ahead(&self, window: &Window) -> f32 {
        window.depth[usize::from(self.direction[2] > 0.0)].abs()
    }

    #[inline(always)]
    fn distance(&self, t: f32) -> f32 {
        if self.has_own_slopes {
            t
        } else {
            self.distance_of_unusual(t)
        }
    }

    #[cold]
    fn distance_of_unusual(&self, t: f32) -> f32 {
        (f64::from(t) * self.to_distance) as f32
    }

    /// For the test that decides.
    #[inline(always)]
    pub fn exact(&self) -> ExactRay {
        ExactRay::new(self.origin, self.direction)
    }
}

/// Depth before which no hit beyond `t_min` is, for a ray whose main direction component is `main`.
#[inline(always)]
pub(super) fn first_depth(t_min: f32, main: f32) -> f32 {
    t_min * (1.0 - RANGE_PAD) * main - TINY.copysign(main)
}

/// Depth behind which no hit before `t_max` is.
#[inline(always)]
pub(super) fn last_depth(t_max: f32, main: f32) -> f32 {
    t_max * (1.0 + RANGE_PAD) * main + TINY.copysign(main)
}

/// Depths ahead, in the direction of rays whose main direction component is `main`: what is certain to be crossed between
/// them is crossed after `t_min`, which is not negative, and before `t_max`.
#[inline(always)]
pub(super) fn certain_depths(t_min: f32, t_max: f32, main: f32) -> [f32; 2] {
    let sign = 1.0_f32.copysign(main);
    let begin = sign * last_depth(larger(t_min, LEAST_CERTAIN), main);
    [begin, sign * first_depth(t_max, main)]
}

/// The axis that [`Caster`] takes as the main one.
#[inline(always)]
pub(super) fn main_axis(direction: [f32; 3]) -> usize {
    longest(per_axis(|k| direction[k].abs()))
}

/// Whether a direction, whose main component is `main`, and `origin` are far from all overflow.
#[inline(always)]
pub(super) fn is_ordinary(origin: [f32; 3], main: f32, reach: f32) -> bool {
    all_within(origin, ORDINARY_COORDINATE) & is_ordinary_length(main, reach)
}

#[inline(always)]
fn is_ordinary_length(main: f32, reach: f32) -> bool {
    ORDINARY_LENGTH.contains(&main.abs()) & (reach <= ORDINARY_COORDINATE)
}

/// A direction whose reciprocals and their products with coordinates are finite.
struct Slopes {
    direction: Vec3A,
    /// By how much boxes count as larger, in units of the direction.
    pad: Vec3A,
    /// What the ray's direction was divided by.
    unit: f64,
}

/// Of rays with extreme coordinates or directions, or along an axis.
#[cold]
#[inline(never)]
fn unusual_slopes(ray: &Ray, main: usize, bounds: &Aabb, reach: f32, slack: f32) -> Option<Slopes> {
    let (origin, direction) = (ray.origin.to_array(), ray.direction.to_array());
    let length = direction[main].abs();
    let finite = ray.origin.is_finite() && ray.direction.is_finite();
    if !finite || length == 0.0 || bounds.is_empty() {
        return None;
    }
    let unit = unit_of_direction(length, reach.max(ray.origin.abs().max_element()));
    let scaled = match unit {
        1.0 => direction,
        unit => per_axis(|k| (f64::from(direction[k]) / unit) as f32),
    };
    let way = way_out(origin[main], scaled[main], bounds, main, slack)?;
    let stay = (way / f64::from(scaled[main].abs()) * f64::from(FAR_PAD)) as f32;
    let least = LEAST_SLOPE * scaled[main].abs();
    let is_low = per_axis(|k| scaled[k].abs() < least);
    Some(Slopes {
        direction: per_axis(|k| scaled[k].abs().max(least).copysign(scaled[k])).into(),
        pad: per_axis(|k| TINY + if is_low[k] { stay } else { 0.0 }).into(),
        unit,
    })
}

/// `array::map` is not inlined everywhere, see `triangle`.
#[inline(always)]
fn per_axis<T>(f: impl Fn(usize) -> T) -> [T; 3] {
    [f(0), f(1), f(2)]
}

/// By main axis: the second, the third and the main axis.
pub(super) const AXES: [[usize; 3]; 3] = [[1, 2, 0], [2, 0, 1], [0, 1, 2]];

#[inline(always)]
pub(super) fn turned(v: [f32; 3], axes: [usize; 3]) -> [f32; 3] {
    [v[axes[0]], v[axes[1]], v[axes[2]]]
}

/// Whether no component is beyond `limit`, or NaN.
#[inline(always)]
fn all_within(v: [f32; 3], limit: f32) -> bool {
    (v[0].abs() <= limit) & (v[1].abs() <= limit) & (v[2].abs() <= limit)
}

/// Whether the second and the third axis may have components as large as that of `main`: of equal ones the lowest is the
/// main axis.
#[inline(always)]
pub(super) fn may_equal(main: usize) -> [bool; 2] {
    [main < 2, main == 0]
}

/// Whether the last component is that of the [`main_axis`] of a direction, whose components are in the order of its
/// [`AXES`]; the others [`may_equal`] it or not. False of NaN; without a branch.
#[inline(always)]
pub(super) fn leads(may_equal: [bool; 2], turned: [f32; 3]) -> bool {
    let [x, y, z] = per_axis(|k| turned[k].abs());
    ((x < z) | (x == z) & may_equal[0]) & ((y < z) | (y == z) & may_equal[1])
}

#[inline(always)]
fn longest(size: [f32; 3]) -> usize {
    let second = usize::from(size[1] > size[0]);
    if size[2] > size[second] { 2 } else { second }
}

/// What directions are divided by for box tests, a power of two: 1, but where a direction of
/// length `length` or a coordinate as large as `coordinate` would make products overflow.
///
/// Large coordinates get a direction of length 2^42, whose reciprocals are below 1.
fn unit_of_direction(length: f32, coordinate: f32) -> f64 {
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_main_axis_leads_and_no_other() {
        let values = [-1.0, -0.5, 0.0, 0.5, 1.0, f32::NAN];
        let directions = values
            .into_iter()
            .flat_map(|x| values.into_iter().map(move |y| [x, y]))
            .flat_map(|[x, y]| values.into_iter().map(move |z| [x, y, z]));
        let mut led = 0;
        for direction in directions {
            let is_number = !direction.iter().any(|x| x.is_nan());
            for (main, axes) in AXES.into_iter().enumerate() {
                let leads = leads(may_equal(main), turned(direction, axes));
                let expected = is_number && main_axis(direction) == main;
                assert_eq!(leads, expected, "{direction:?}, {main}");
                led += u32::from(leads);
            }
        }
        assert_eq!(led, 5 * 5 * 5, "one axis of each that is a number");
    }
}
