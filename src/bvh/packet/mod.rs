//! Rays that run nearly the same way, in rows, and what each has found so far.
//!
//! Most of what a ray meets is behind something else that it meets, so the exact test, which costs more than all else, is put off:
//! a ray holds the nearest triangle that it is certain to hit ([`Certain`]), between bounds of its depth. Another one that
//! is certain to be nearer takes its place; what is behind it for certain is passed by; and only
//! where the bounds overlap, or where a crossing is not certain, the exact test decides at once. The
//! triangles that are held in the end are tested for all rays at once. So hits are those of single rays, bit for
//! bit. Rays that ask only whether there is any hit are done with the first that is certain.

mod meet;
mod walk;

pub(super) use walk::Together;

use super::beam::{Beam, Course, Interval};
use super::caster::{
    AXES, certain_depths, first_depth, is_ordinary, last_depth, leads, main_axis, may_equal, turned,
};
use super::hit::{Hit, HitRow};
use super::layout::{Block, Tree};
use super::simd::Lanes;
use super::triangle::{Corners, Crossings, ExactRay, ExactRays};
use crate::math::{ROW, RayRow, Row, larger};

/// The most rays of a packet.
pub(super) const SIZE: usize = ROW;

/// Of so many rays at a time, and fewer, each is tested by itself.
const FEW: u32 = 2;

/// Rays that have the main axis in common, coordinates in the order of the course's axes.
///
/// Depths are positions along the main axis from a ray's own origin; those that are said to be ahead
/// are in the direction of the rays.
pub(super) struct Packet<'a> {
    pub course: Course,
    origin: [Row; 3],
    direction: [Row; 3],
    /// Slopes along the main axis, each rounded twice.
    shear: [Row; 2],
    /// Where hits still matter: least and greatest depth.
    depth: [Row; 2],
    /// Which of the two is the far end: 1 where the rays run towards higher coordinates.
    far_end: usize,
    /// What is certain to be farther ahead is in the range of its ray.
    begin: Row,
    /// What is certain to be less far ahead is better than all that was found.
    surely: Row,
    /// The least parameters of the rays' ranges.
    t_min: Row,
    /// The triangles that are held, by their places in the blocks: block times width plus lane.
    held: [u32; SIZE],
    /// A bit for each ray that holds one.
    holds: u64,
    /// A bit for each ray that still looks for something.
    pub live: u64,
    /// As many rays as a vector holds are a group.
    pub groups: usize,
    /// What the exact test found.
    found: &'a mut HitRow,
}

impl<'a> Packet<'a> {
    /// The rays of `rays`, which are to find what is better than `found`. `reach` is the largest coordinate of the tree.
    #[inline(always)]
    pub fn new<const W: usize>(rays: &RayRow, found: &'a mut HitRow, reach: f32) -> Self {
        let count = rays.count();
        let first = rays.get(0);
        let main = main_axis(first.direction.to_array());
        let axes = AXES[main];
        let is_reversed = first.direction[main] < 0.0;
        // No `array::map`, see `triangle`.
        let [x, y, z] = axes;
        let (from, to) = (&rays.origins.0, &rays.directions.0);
        let mut packet = Self {
            course: Course {
                center: turned(first.origin.to_array(), axes),
                axes,
                is_reversed,
                size: reach,
            },
            origin: [from[x], from[y], from[z]],
            direction: [to[x], to[y], to[z]],
            shear: [[0.0; SIZE]; 2],
            depth: [[0.0; SIZE]; 2],
            far_end: usize::from(!is_reversed),
            begin: [0.0; SIZE],
            surely: [0.0; SIZE],
            t_min: rays.t_min,
            held: [0; SIZE],
            holds: 0,
            live: u64::MAX >> (SIZE - count),
            groups: count.div_ceil(W),
            found,
        };
        let mut t_max = packet.found.t;
        // The first ray stands for those that are not there; they look nowhere.
        for row in packet.origin.iter_mut().chain(&mut packet.direction) {
            let first = row[0];
            row[count..].fill(first);
        }
        packet.t_min[count..].fill(0.0);
        t_max[count..].fill(0.0);
        packet.measure(&t_max);
        packet
    }

    /// Finds what follows from rays and their ranges. Without a branch or a bound that the compiler does not know, for
    /// vectors.
    #[inline(always)]
    fn measure(&mut self, t_max: &Row) {
        let (near, far) = (1 - self.far_end, self.far_end);
        let [dx, dy, dz] = &self.direction;
        for i in 0..SIZE {
            let main_inverse = 1.0 / dz[i];
            self.shear[0][i] = dx[i] * main_inverse;
            self.shear[1][i] = dy[i] * main_inverse;
            let t_min = larger(self.t_min[i], 0.0);
            self.t_min[i] = t_min;
            self.depth[near][i] = first_depth(t_min, dz[i]);
            self.depth[far][i] = last_depth(t_max[i], dz[i]);
            [self.begin[i], self.surely[i]] = certain_depths(t_min, t_max[i], dz[i]);
        }
    }

    /// Whether all rays have the main axis in common and are far from all overflow.
    #[inline(always)]
    pub fn are_alike(&self, reach: f32) -> bool {
        let ([ox, oy, oz], [dx, dy, dz]) = (&self.origin, &self.direction);
        let Course {
            axes, is_reversed, ..
        } = self.course;
        let (may_equal, ends) = (may_equal(axes[2]), &self.depth[self.far_end]);
        // Without a branch, for vectors.
        let mut are_alike = true;
        for i in 0..SIZE {
            are_alike &= leads(may_equal, [dx[i], dy[i], dz[i]])
                & ((dz[i] < 0.0) == is_reversed)
                & is_ordinary([ox[i], oy[i], oz[i]], dz[i], reach)
                & !ends[i].is_nan();
        }
        are_alike
    }

    /// Around the rays of a group, and the largest coordinate of their origins.
    #[inline(always)]
    pub fn beam<S: Lanes<W>, const W: usize>(&self, group: usize) -> (Beam, f32) {
        let [x, y, z] = &self.origin;
        let [x, y, z] = [row::<S, W>(x, group), row(y, group), row(z, group)];
        let [a, b, c] = self.course.center;
        let beam = Beam {
            origins: [
                Interval::around(x.sub(S::splat(a))),
                Interval::around(y.sub(S::splat(b))),
                Interval::around(z.sub(S::splat(c))),
            ],
            slopes: [
                Interval::around(row::<S, W>(&self.shear[0], group)),
                Interval::around(row::<S, W>(&self.shear[1], group)),
            ],
        };
        (beam, x.max_abs(y).max_abs(z).greatest())
    }

    /// The depth behind which no ray of a group needs to look, in the direction of the rays.
    #[inline(always)]
    pub fn far<S: Lanes<W>, const W: usize>(&self, group: usize) -> f32 {
        let ends = row::<S, W>(&self.depth[self.far_end], group);
        ends.max_abs(ends).greatest()
    }

    /// The rays of a group that still look for something, a bit for each.
    #[inline(always)]
    pub fn live<const W: usize>(&self, group: usize) -> u32 {
        (self.live >> (group * W)) as u32 & (u32::MAX >> (32 - W))
    }

    /// Ends the search of some rays.
    #[inline(always)]
    fn end(&mut self, mut rays: u64) {
        self.live &= !rays;
        self.found.is_hit |= rays;
        while rays != 0 {
            self.depth[self.far_end][rays.trailing_zeros() as usize % SIZE] = 0.0;
            rays &= rays - 1;
        }
    }

    /// From a depth to one that is ahead, and back.
    #[inline(always)]
    fn ahead(&self, depth: f32) -> f32 {
        if self.course.is_reversed {
            -depth
        } else {
            depth
        }
    }

    #[inline(always)]
    fn exact(&self, i: usize) -> ExactRay {
        let of = |rows: &[Row; 3]| [rows[0][i], rows[1][i], rows[2][i]];
        ExactRay::new(of(&self.origin), of(&self.direction))
    }

    /// The exact test of a triangle for each ray of a group.
    #[inline(always)]
    fn cross<const CERTAIN: bool, const W: usize>(
        &self,
        corners: &Corners<W>,
        group: usize,
    ) -> Crossings<W> {
        let [ox, oy, oz] = &self.origin;
        let [dx, dy, dz] = &self.direction;
        let rays = ExactRays::<W> {
            origin: [array(ox, group), array(oy, group), array(oz, group)],
            direction: [array(dx, group), array(dy, group), array(dz, group)],
        };
        rays.cross::<CERTAIN>(corners)
    }

    /// Keeps `hit` of ray `i` where it is better than what that has; whether it is.
    #[inline(always)]
    fn keep<const ANY: bool>(&mut self, i: usize, hit: &Hit) -> bool {
        let best = self.found.t[i];
        let is_better = hit.t > self.t_min[i]
            && (hit.t < best || (hit.t == best && hit.triangle < self.found.triangle[i]));
        if is_better && ANY {
            self.end(1 << i);
        } else if is_better {
            self.found.set(i, hit);
            let main = self.direction[2][i];
            self.surely[i] = self.ahead(first_depth(hit.t, main));
            self.depth[self.far_end][i] = last_depth(hit.t, main);
        }
        is_better
    }

    /// The exact test of what each of `rays` holds.
    #[inline(never)]
    fn settle<const W: usize>(&mut self, tree: &Tree<W>, mut rays: u64) {
        self.holds &= !rays;
        while rays != 0 {
            let i = rays.trailing_zeros() as usize % SIZE;
            rays &= rays - 1;
            let (block, lane) = self.place::<W>(tree, i);
            let corners = block.corners_of(lane, self.course.axes);
            let crossing = self.exact(i).cross_certain(&corners);
            self.keep::<false>(i, &Hit::of(crossing, 0, block.triangles[lane]));
        }
    }

    /// The exact test of what all rays hold.
    #[inline(always)]
    pub fn settle_all<const W: usize>(&mut self, tree: &Tree<W>) {
        for group in 0..self.groups {
            let held = (self.holds >> (group * W)) as u32 & (u32::MAX >> (32 - W));
            if held.count_ones() <= FEW {
                self.settle(tree, u64::from(held) << (group * W));
                continue;
            }
            let mut corners = [[[0.0; W]; 3]; 3];
            for lane in 0..W {
                let (block, place) = self.place::<W>(tree, group * W + lane);
                let points = block.corners_of(place, self.course.axes);
                for (rows, point) in corners.iter_mut().zip(&points) {
                    for (row, x) in rows.iter_mut().zip(point) {
                        row[lane] = *x;
                    }
                }
            }
            debug_assert_eq!(
                held & !self.cross::<false, W>(&corners, group).is_hit,
                0,
                "what is certain is hit"
            );
            let crossings = self.cross::<true, W>(&corners, group);
            for lane in 0..W {
                let i = group * W + lane;
                if held >> lane & 1 != 0 {
                    let (block, place) = self.place(tree, i);
                    let hit = Hit::of(crossings.get(lane), 0, block.triangles[place]);
                    self.found.set(i, &hit);
                }
            }
        }
        self.holds = 0;
    }

    /// Block and lane of what ray `i` holds.
    #[inline(always)]
    fn place<'t, const W: usize>(&self, tree: &'t Tree<W>, i: usize) -> (&'t Block<W>, usize) {
        let place = self.held[i] as usize;
        (&tree.blocks[place / W], place % W)
    }
}

/// A vector of one number for each ray of a group.
#[inline(always)]
fn row<S: Lanes<W>, const W: usize>(row: &Row, group: usize) -> S {
    S::load(array(row, group))
}

#[inline(always)]
fn array<const W: usize>(row: &Row, group: usize) -> &[f32; W] {
    &row.as_chunks::<W>().0[group]
}
