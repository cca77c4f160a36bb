//! The space that a packet of rays runs through: which boxes and triangles none of them can meet.
//!
//! All rays of a packet run along the same main axis, in the same direction. A hit at depth h of a
//! ray (way along the main axis from the ray's own origin) is, along each of the other two axes, at
//! o + h s, with the origin o and the slope s of the ray. With o and s in the intervals that hold
//! those of all rays, a box whose depths for any of the rays are h₀ to h₁ can only be met where the
//! interval of o + h s over these depths meets the box's own interval, on both axes.
//!
//! # Why no hit is lost
//!
//! The exact test confirms that a hit is in its triangle's box but for 2u(|o| + |t d|) along each axis
//! (`caster`). With R the largest coordinate of boxes and origins that is at most 6uR. Relative to
//! the first ray's origin, coordinates are off by another 4uR; a slope is off by 2u, which moves a
//! point by at most 4uR, and the sums and products by 12uR more. The intervals of the beam are wider
//! by [`PAD`] R, which is more than twice all of this.

use super::layout::{Block, Node};
use super::simd::Lanes;
use crate::math::{UNIT_ROUNDOFF, lesser};

/// By which share of the largest coordinate a beam is wider than its rays.
const PAD: f32 = 64.0 * UNIT_ROUNDOFF;

/// From the least to the greatest.
#[derive(Clone, Copy, Debug)]
pub(super) struct Interval {
    pub low: f32,
    pub high: f32,
}

impl Interval {
    /// Around all numbers of a vector.
    #[inline(always)]
    pub fn around<S: Lanes<W>, const W: usize>(x: S) -> Self {
        Self {
            low: x.least(),
            high: x.greatest(),
        }
    }

    /// Around both.
    #[inline(always)]
    pub fn union(self, other: Self) -> Self {
        Self {
            low: lesser(self.low, other.low),
            high: -lesser(-self.high, -other.high),
        }
    }

    #[inline(always)]
    fn flipped(self) -> Self {
        Self {
            low: -self.high,
            high: -self.low,
        }
    }

    #[inline(always)]
    fn widened(self, by: f32) -> Self {
        Self {
            low: self.low - by,
            high: self.high + by,
        }
    }
}

/// What holds some rays of a packet, coordinates in the packet's order of axes. Once it is
/// [`Beam::widened`], along the main axis in the direction of the rays.
#[derive(Clone, Copy, Debug)]
pub(super) struct Beam {
    /// Of the origins, relative to the packet's centre.
    pub origins: [Interval; 3],
    /// Of the slopes of the two lesser axes along the main one.
    pub slopes: [Interval; 2],
}

impl Beam {
    /// Around both.
    #[inline(always)]
    pub fn union(&self, other: &Self) -> Self {
        let [x, y, z] = self.origins;
        let [u, v] = self.slopes;
        Self {
            origins: [
                x.union(other.origins[0]),
                y.union(other.origins[1]),
                z.union(other.origins[2]),
            ],
            slopes: [u.union(other.slopes[0]), v.union(other.slopes[1])],
        }
    }

    /// Wide enough that rounding loses nothing, and turned so that the rays run upwards.
    #[inline(always)]
    pub fn widened(&self, course: &Course) -> Self {
        let pad = PAD * course.size;
        let [x, y, mut z] = self.origins;
        let [mut u, mut v] = self.slopes;
        if course.is_reversed {
            (z, u, v) = (z.flipped(), u.flipped(), v.flipped());
        }
        Self {
            origins: [x.widened(pad), y.widened(pad), z.widened(pad)],
            slopes: [u, v],
        }
    }
}

/// What the beams of a packet have in common.
#[derive(Clone, Copy, Debug)]
pub(super) struct Course {
    /// What origins are relative to, in the order of `axes`.
    pub center: [f32; 3],
    pub axes: [usize; 3],
    /// Whether the rays run towards lower coordinates of the main axis.
    pub is_reversed: bool,
    /// The largest coordinate of rays and boxes.
    pub size: f32,
}

/// A beam in vectors.
pub(super) struct BeamTest<S> {
    axes: [usize; 3],
    center: [S; 3],
    is_reversed: bool,
    /// Least and greatest.
    origins: [[S; 2]; 3],
    /// Least and greatest.
    slopes: [[S; 2]; 2],
}

impl<S> BeamTest<S> {
    /// Of a beam that is [`Beam::widened`].
    #[inline(always)]
    pub fn new<const W: usize>(course: &Course, beam: &Beam) -> Self
    where
        S: Lanes<W>,
    {
        let [x, y, z] = beam.origins;
        let [u, v] = beam.slopes;
        let [a, b, c] = course.center;
        Self {
            axes: course.axes,
            center: [S::splat(a), S::splat(b), S::splat(c)],
            is_reversed: course.is_reversed,
            origins: [splat(x), splat(y), splat(z)],
            slopes: [splat(u), splat(v)],
        }
    }

    /// The same for each of several rays, by their origins, relative to the packet's centre, and slopes.
    #[inline(always)]
    pub fn of_rays<const W: usize>(course: &Course, origins: [S; 3], slopes: [S; 2]) -> Self
    where
        S: Lanes<W>,
    {
        let pad = S::splat(PAD * course.size);
        let around = |x: S| [x.sub(pad), x.add(pad)];
        let [x, y, z] = origins;
        let [u, v] = slopes;
        let zero = S::splat(0.0);
        let [z, u, v] = if course.is_reversed {
            [zero.sub(z), zero.sub(u), zero.sub(v)]
        } else {
            [z, u, v]
        };
        let [a, b, c] = course.center;
        Self {
            axes: course.axes,
            center: [S::splat(a), S::splat(b), S::splat(c)],
            is_reversed: course.is_reversed,
            origins: [around(x), around(y), around(z)],
            slopes: [[u, u], [v, v]],
        }
    }

    /// The rays that may meet a box, of these least and greatest coordinates, no deeper than `far`.
    #[inline(always)]
    pub fn rays<const W: usize>(&self, bounds: &[[f32; 2]; 3], far: S) -> u32
    where
        S: Lanes<W>,
    {
        let [x, y, z] = self.axes;
        let of = |axis: usize| [S::splat(bounds[axis][0]), S::splat(bounds[axis][1])];
        self.test([of(x), of(y), of(z)], far).0
    }

    /// The children that some ray may meet no deeper than `far`, and the least depths of them.
    #[inline(always)]
    pub fn children<const W: usize>(&self, node: &Node<W>, far: S) -> (u32, S)
    where
        S: Lanes<W>,
    {
        let [x, y, z] = self.axes;
        let bounds = [planes(node, x), planes(node, y), planes(node, z)];
        self.test(bounds, far)
    }

    /// The triangles that some ray may meet no deeper than `far`.
    #[inline(always)]
    pub fn triangles<const W: usize>(&self, block: &Block<W>, far: S) -> u32
    where
        S: Lanes<W>,
    {
        let [x, y, z] = self.axes;
        let bounds = [extent(block, x), extent(block, y), extent(block, z)];
        self.test(bounds, far).0
    }

    /// Boxes from their least and greatest coordinates, by axis.
    #[inline(always)]
    fn test<const W: usize>(&self, bounds: [[S; 2]; 3], far: S) -> (u32, S)
    where
        S: Lanes<W>,
    {
        let [x, y, z] = bounds;
        let low = z[0].sub(self.center[2]);
        let high = z[1].sub(self.center[2]);
        let zero = S::splat(0.0);
        let (first, last) = if self.is_reversed {
            (zero.sub(high), zero.sub(low))
        } else {
            (low, high)
        };
        let enter = first.sub(self.origins[2][1]).max(zero);
        let leave = last.sub(self.origins[2][0]).min(far);
        let mask =
            enter.le(leave) & self.meets(0, x, enter, leave) & self.meets(1, y, enter, leave);
        (mask, enter)
    }

    /// Whether, along one of the lesser axes, rays come to a box somewhere between these depths.
    #[inline(always)]
    fn meets<const W: usize>(&self, axis: usize, bounds: [S; 2], enter: S, leave: S) -> u32
    where
        S: Lanes<W>,
    {
        let [slope_low, slope_high] = self.slopes[axis];
        let [origin_low, origin_high] = self.origins[axis];
        let low = enter
            .mul(slope_low)
            .min(leave.mul(slope_low))
            .add(origin_low);
        let high = enter
            .mul(slope_high)
            .max(leave.mul(slope_high))
            .add(origin_high);
        let least = bounds[0].sub(self.center[axis]);
        let most = bounds[1].sub(self.center[axis]);
        least.le(high) & low.le(most)
    }
}

/// Least and greatest coordinates of all triangles of a block, by axis.
#[inline(always)]
pub(super) fn bounds<S: Lanes<W>, const W: usize>(block: &Block<W>) -> [[f32; 2]; 3] {
    let [x, y, z] = [extent::<S, W>(block, 0), extent(block, 1), extent(block, 2)];
    [
        [x[0].least(), x[1].greatest()],
        [y[0].least(), y[1].greatest()],
        [z[0].least(), z[1].greatest()],
    ]
}

// Functions, not closures: those would lack the instruction set of the walk.

/// Lower and upper planes of all children across an axis.
#[inline(always)]
fn planes<S: Lanes<W>, const W: usize>(node: &Node<W>, axis: usize) -> [S; 2] {
    [S::load(&node.planes[axis]), S::load(&node.planes[axis + 3])]
}

/// Least and greatest coordinates of all triangles along an axis.
#[inline(always)]
fn extent<S: Lanes<W>, const W: usize>(block: &Block<W>, axis: usize) -> [S; 2] {
    let [a, b, c] = &block.corners;
    let (a, b, c) = (S::load(&a[axis]), S::load(&b[axis]), S::load(&c[axis]));
    [a.min(b).min(c), a.max(b).max(c)]
}

#[inline(always)]
fn splat<S: Lanes<W>, const W: usize>(interval: Interval) -> [S; 2] {
    [S::splat(interval.low), S::splat(interval.high)]
}
