//! The triangle filter: which triangles of a block need the exact test, and which are hit for certain, in `f32`, all at
//! once.

use super::caster::Caster;
use super::layout::Block;
use super::simd::Lanes;
use crate::math::UNIT_ROUNDOFF;

/// What the exact test takes for an edge, in units of e; with room.
const LEAST_WEIGHT_ERROR: f32 = 1.0 / (1 << 27) as f32;

/// Depths of crossings along the main axis, with bounds of their errors.
///
/// With edge functions of sum A the crossing of a triangle at the depths z₁, z₂ and z₃ is at the
/// depth where f(h) = Σ eᵢ (zᵢ − h) = 0. Computed from differences to z₁ it is off by at most
/// 4e (|z₁ − h| + D) + 12u (|A| + 8e)(Z + |h|), e being the error of an edge function and D the
/// largest of the differences.
struct Depth<S> {
    /// Depth of the first corner.
    first: S,
    /// f(z₁), made positive where A is negative.
    beyond_first: S,
    /// |A|: twice the sheared triangle's area.
    area: S,
    /// 4e.
    error: S,
    /// D.
    spread: S,
    /// Z: largest depth of a corner, in magnitude.
    reach: S,
}

impl<S> Depth<S> {
    #[inline(always)]
    fn new<const W: usize>(edges: [S; 3], depths: [S; 3], error: S, reach: S) -> Self
    where
        S: Lanes<W>,
    {
        let [u, v, w] = edges;
        let area = u.add(v.add(w));
        let (to_second, to_third) = (depths[1].sub(depths[0]), depths[2].sub(depths[0]));
        Self {
            first: depths[0],
            beyond_first: v
                .mul_add(to_second, w.mul(to_third))
                .with_sign_flipped_by(area),
            area: area.max_abs(area),
            error: error.mul(S::splat(4.0)),
            spread: to_second.max_abs(to_third),
            reach,
        }
    }

    /// Which crossings are not at `depths` for certain. The sign of A is certain beyond 8e.
    #[inline(always)]
    fn certainly_outside<const W: usize>(&self, [least, most]: [S; 2]) -> u32
    where
        S: Lanes<W>,
    {
        let twice_error = self.error.add(self.error);
        let (value, error) = self.beyond(least, twice_error);
        let before = error.lt(S::splat(0.0).sub(value));
        let (value, error) = self.beyond(most, twice_error);
        (before | error.lt(value)) & twice_error.lt(self.area)
    }

    /// f(`limit`) and its error.
    #[inline(always)]
    fn beyond<const W: usize>(&self, limit: S, twice_error: S) -> (S, S)
    where
        S: Lanes<W>,
    {
        let from_limit = self.first.sub(limit);
        let value = from_limit.mul_add(self.area, self.beyond_first);
        let distance = from_limit.max_abs(from_limit).add(self.spread);
        // In this order an overflow of what the value is made of is one of its error first.
        let rounding = self.area.add(twice_error).mul(S::splat(4.0));
        let size = self.reach.add(limit.max_abs(limit));
        let error = distance
            .mul_add(self.error, S::splat(f32::MIN_POSITIVE))
            .add(size.mul(rounding).mul(S::splat(3.0 * UNIT_ROUNDOFF)));
        (value, error)
    }
}

/// Triangles, sheared so that a ray runs along the last axis.
///
/// The same edge functions as in [`ExactRay::cross`](super::triangle::ExactRay::cross), in `f32`. With R
/// the largest sheared and Z the largest main coordinate, each sheared coordinate is off by at most
/// 2uR + 5uZ, an edge function hence by less than 12uR² + 20uRZ + 60u²Z²; what is compared with,
/// e = 24u(R + 5uZ)(R + Z), is more. A NaN makes nothing certain.
pub(super) struct Seen<S> {
    edges: [S; 3],
    depths: [S; 3],
    /// The least of the edge functions.
    least: S,
    /// The greatest.
    most: S,
    /// e.
    error: S,
    /// Z.
    reach: S,
}

/// Crossings that the exact test is certain to find, wherever they are along the ray.
pub(super) struct Certain<S> {
    /// A bit for each that is.
    pub lanes: u32,
    /// Not beyond the crossing: a depth in the direction of the ray.
    pub near: S,
    /// Not before it.
    pub far: S,
}

/// The nearest of some crossings that are certain.
pub(super) struct Nearest {
    /// Which it is; `None` where none is certain to be nearer than what is known.
    pub lane: Option<usize>,
    /// What is certain to be less far ahead is nearer.
    pub surely: f32,
    /// What is certain to be farther ahead is behind it.
    pub end: f32,
    /// Those that are too close to another one, or to what is known, to tell.
    pub doubtful: u32,
}

impl<S> Certain<S> {
    /// The nearest of the crossings `among`, given bounds as in [`Nearest`] of what is known.
    #[inline(always)]
    pub fn nearest<const W: usize>(&self, mut among: u32, surely: f32, end: f32) -> Nearest
    where
        S: Lanes<W>,
    {
        let (mut near, mut far) = ([0.0; W], [0.0; W]);
        self.near.store(&mut near);
        self.far.store(&mut far);
        let mut nearest = Nearest {
            lane: None,
            surely,
            end,
            doubtful: 0,
        };
        while among != 0 {
            let lane = among.trailing_zeros() as usize % W;
            among &= among - 1;
            if far[lane] < nearest.surely {
                nearest.lane = Some(lane);
                nearest.surely = near[lane];
                nearest.end = far[lane];
            } else if near[lane] <= nearest.end {
                nearest.doubtful |= 1 << lane;
            }
        }
        nearest
    }
}

impl<S> Seen<S> {
    /// Those of the lanes in `among` whose ray is not certain to miss its triangle at these depths: a superset of what the
    /// exact test accepts there.
    ///
    /// A triangle is out where one edge function is certainly negative and another certainly positive.
    #[inline(always)]
    pub fn candidates<const W: usize>(&self, depths: [S; 2], among: u32) -> u32
    where
        S: Lanes<W>,
    {
        let minus_error = S::splat(0.0).sub(self.error);
        let lanes = !(self.least.lt(minus_error) & self.error.lt(self.most)) & among;
        if lanes == 0 {
            return 0;
        }
        lanes & !self.depth().certainly_outside(depths)
    }

    /// Those that the exact test accepts for certain, and bounds of the parameters that it gives them. `is_reversed`
    /// says that rays run towards lower coordinates.
    ///
    /// All three edge functions must be beyond 2e on one side; then they are beyond e, and the area A is
    /// beyond 3e, without rounding, and the test in f64, whose errors E = 2^-49 R(R + Z) are below
    /// 2^-29 e, finds the ray inside, far from what it calls cancelled. It still asks that
    /// the point at its t is in the triangle's box but for 2u|t d|. The true crossing is in that box, and t is off by
    /// at most u for rounding and by 3E(1 + Z/h)/A + 4ε Z/h, relatively, for the sums
    /// behind it, at the depth h: less than u/2 where A h > 2eZ, which is asked for here.
    /// It then is above 2^-49 Z by far, where the test takes it for 0, and the signs of the edge functions are those
    /// that the test finds: there is nothing to clamp.
    ///
    /// The depth h = z₁ + f(z₁)/A is off by at most 10eD/A + 24uZ. What is told has 16eD/A + 64uZ: so much more that crossings
    /// apart by it have parameters that differ when they are rounded, too. Where the sum for h overflows nothing is certain.
    #[inline(always)]
    pub fn certain<const W: usize>(&self, is_reversed: bool) -> Certain<S>
    where
        S: Lanes<W>,
    {
        let depth = self.depth();
        let twice_error = self.error.add(self.error);
        let is_inside = twice_error.lt(self.least) | self.most.lt(S::splat(0.0).sub(twice_error));
        let inverse = S::splat(1.0).div(depth.area);
        let height = depth.beyond_first.mul_add(inverse, depth.first);
        let ahead = if is_reversed {
            S::splat(0.0).sub(height)
        } else {
            height
        };
        let sums = depth.error.mul(inverse).mul(depth.spread);
        let off = sums.mul_add(
            S::splat(4.0),
            self.reach.mul(S::splat(64.0 * UNIT_ROUNDOFF)),
        );
        let (near, far) = (ahead.sub(off), ahead.add(off));
        let least_beyond = twice_error.mul_add(self.reach, S::splat(f32::MIN_POSITIVE));
        let is_ahead = least_beyond.lt(depth.area.mul(near)) & far.lt(S::splat(f32::INFINITY));
        Certain {
            lanes: is_inside & is_ahead,
            near,
            far,
        }
    }

    #[inline(always)]
    fn depth<const W: usize>(&self) -> Depth<S>
    where
        S: Lanes<W>,
    {
        Depth::new(self.edges, self.depths, self.error, self.reach)
    }
}

/// The corners of a block's triangles, their coordinates in the order `axes`.
#[inline(always)]
pub(super) fn corners_in<S: Lanes<W>, const W: usize>(
    block: &Block<W>,
    [x, y, z]: [usize; 3],
) -> [[S; 3]; 3] {
    let [a, b, c] = &block.corners;
    [
        [S::load(&a[x]), S::load(&a[y]), S::load(&a[z])],
        [S::load(&b[x]), S::load(&b[y]), S::load(&b[z])],
        [S::load(&c[x]), S::load(&c[y]), S::load(&c[z])],
    ]
}

/// The constants for the triangle filter, in vectors: of one ray for several triangles, or of several rays
/// that have their order of axes in common.
pub(super) struct Filter<S> {
    /// Second, third and main axis.
    pub axes: [usize; 3],
    /// Origin, in the order `axes`.
    pub origin: [S; 3],
    /// Slopes of the two lesser axes along the main one, each rounded twice.
    pub shear: [S; 2],
    /// Whether rays run towards lower coordinates of the main axis.
    pub is_reversed: bool,
}

impl<S> Filter<S> {
    #[inline(always)]
    pub fn new<const W: usize>(ray: &Caster) -> Self
    where
        S: Lanes<W>,
    {
        Self {
            axes: ray.axes,
            origin: splat(ray.origin),
            shear: [S::splat(ray.shear[0]), S::splat(ray.shear[1])],
            is_reversed: ray.towards_lower[ray.axes[2]],
        }
    }

    /// The triangles that lie behind the origin of the ray for certain: such as the one that it starts on, a few roundings above.
    ///
    /// With the edges g and k from the corner a, and q = a − o, f(0) is −q·(g × k), as much as a product of
    /// three is worth: it is off by less than 12u Σ |qᵢ| (|gⱼ kₖ| + |gₖ kⱼ|), which shrinks with the triangle, where
    /// [`Depth`] has to do with what sheared coordinates are off by. The exact test finds a parameter of 0 there, or
    /// below, which no hit has; where it takes the nearest point of an edge for one just outside, f(0) is another by
    /// at most 2EZ (see [`Seen::certain`]), less than 2^-28 eZ.
    #[inline(always)]
    pub fn certainly_behind<const W: usize>(&self, corners: &[[S; 3]; 3], seen: &Seen<S>) -> u32
    where
        S: Lanes<W>,
    {
        let [a, b, c] = corners;
        let g = [b[0].sub(a[0]), b[1].sub(a[1]), b[2].sub(a[2])];
        let k = [c[0].sub(a[0]), c[1].sub(a[1]), c[2].sub(a[2])];
        let (mut side, mut size) = (S::splat(0.0), S::splat(0.0));
        for (x, y, z) in [(0, 1, 2), (1, 2, 0), (2, 0, 1)] {
            let q = a[x].sub(self.origin[x]);
            let (first, second) = (g[y].mul(k[z]), g[z].mul(k[y]));
            side = q.mul_add(first.sub(second), side);
            let both = first.max_abs(first).add(second.max_abs(second));
            size = q.max_abs(q).mul_add(both, size);
        }
        let area = seen.edges[0].add(seen.edges[1].add(seen.edges[2]));
        let side = side.with_sign_flipped_by(area);
        let behind = if self.is_reversed {
            S::splat(0.0).sub(side)
        } else {
            side
        };
        let clamping = seen
            .error
            .mul(seen.reach)
            .mul_add(S::splat(LEAST_WEIGHT_ERROR), S::splat(f32::MIN_POSITIVE));
        let off = size.mul_add(S::splat(12.0 * UNIT_ROUNDOFF), clamping);
        let area_error = seen.error.mul(S::splat(8.0));
        off.lt(behind) & area_error.lt(area.max_abs(area))
    }

    /// What the rays see of triangles, whose `corners` have their coordinates in the order `axes`.
    #[inline(always)]
    pub fn see<const W: usize>(&self, corners: &[[S; 3]; 3]) -> Seen<S>
    where
        S: Lanes<W>,
    {
        let a = self.shear(&corners[0]);
        let b = self.shear(&corners[1]);
        let c = self.shear(&corners[2]);
        let edges = [edge(c, b), edge(a, c), edge(b, a)];
        let [u, v, w] = edges;
        let x = a[0].max_abs(b[0]).max_abs(c[0]);
        let y = a[1].max_abs(b[1]).max_abs(c[1]);
        let z = a[2].max_abs(b[2]).max_abs(c[2]);
        let r = x.max(y);
        let error = z
            .mul_add(S::splat(5.0 * UNIT_ROUNDOFF), r)
            .mul(S::splat(24.0 * UNIT_ROUNDOFF))
            .mul_add(r.add(z), S::splat(f32::MIN_POSITIVE));
        Seen {
            edges,
            depths: [a[2], b[2], c[2]],
            least: u.min(v).min(w),
            most: u.max(v).max(w),
            error,
            reach: z,
        }
    }

    /// A corner, moved so that the ray starts at the origin and sheared so
    /// that it runs along the last axis.
    #[inline(always)]
    fn shear<const W: usize>(&self, point: &[S; 3]) -> [S; 3]
    where
        S: Lanes<W>,
    {
        let z = point[2].sub(self.origin[2]);
        let x = point[0].sub(self.origin[0]);
        let y = point[1].sub(self.origin[1]);
        [
            z.neg_mul_add(self.shear[0], x),
            z.neg_mul_add(self.shear[1], y),
            z,
        ]
    }
}

/// Twice the area between the origin, `p` and `q`.
#[inline(always)]
fn edge<S: Lanes<W>, const W: usize>(p: [S; 3], q: [S; 3]) -> S {
    p[0].mul_sub(q[1], p[1].mul(q[0]))
}

#[inline(always)]
fn splat<S: Lanes<W>, const W: usize>(v: [f32; 3]) -> [S; 3] {
    [S::splat(v[0]), S::splat(v[1]), S::splat(v[2])]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::bvh::simd::Portable;
    use crate::bvh::triangle::ExactRays;
    use crate::math::{Aabb, Ray, Vec3};

    const WIDTH: usize = 8;

    /// A linear congruential generator.
    struct Random(u64);

    impl Random {
        /// In [-1, 1).
        fn number(&mut self) -> f32 {
            self.0 = self.0.wrapping_mul(0x5851_f42d_4c95_7f2d).wrapping_add(1);
            (self.0 >> 40) as f32 / (1u64 << 23) as f32 - 1.0
        }

        fn point(&mut self) -> Vec3 {
            Vec3::new(self.number(), self.number(), self.number())
        }
    }

    /// Triangles of all shapes and sizes, and a ray through one of them.
    fn some(random: &mut Random, round: usize) -> (Block<WIDTH>, Ray) {
        let scale = 2f32.powi([0, -60, -20, 20, 42, 43, 44, 49][round % 8]);
        let width = [1.0, 1e-2, 1e-4, 1e-6][round / 8 % 4];
        let mut block = Block::EMPTY;
        let mut target = Vec3::ZERO;
        for lane in 0..WIDTH {
            let (a, b) = (random.point(), random.point());
            let c = a + 0.5 * (b - a) + width * random.point();
            target = a + 0.25 * (b - a) + random.number().abs().powi(8) * 0.5 * (c - a);
            let corners = [a, b, c].map(|p| (scale * p).to_array());
            block.set(lane, &corners, lane as u32);
        }
        let origin = 2.0 * random.point();
        let length = 2f32.powi(7 * (round / 32 % 7) as i32 - 21);
        (block, Ray::new(scale * origin, length * (target - origin)))
    }

    #[test]
    fn what_is_certain_is_what_the_exact_test_finds() {
        let mut random = Random(7);
        let mut known = 0;
        for round in 0..20_000 {
            let (block, ray) = some(&mut random, round);
            let points = block.corners.iter().flat_map(|[x, y, z]| {
                let point = |i: usize| Vec3::new(x[i], y[i], z[i]);
                (0..WIDTH).map(point)
            });
            let bounds = Aabb::of_points(points);
            let caster = Caster::new(&ray, &bounds, bounds.reach(), 0.0);
            let Some(caster) = caster else { continue };
            let filter = Filter::<Portable<WIDTH>>::new(&caster);
            let certain = filter
                .see(&corners_in(&block, filter.axes))
                .certain(filter.is_reversed);
            let (mut near, mut far) = ([0.0; WIDTH], [0.0; WIDTH]);
            certain.near.store(&mut near);
            certain.far.store(&mut far);
            let turned = |v: Vec3| filter.axes.map(|k| [v[k]; WIDTH]);
            let (origins, directions) = (turned(ray.origin), turned(ray.direction));
            let corners = block.corners.map(|rows| filter.axes.map(|k| rows[k]));
            let rays = ExactRays {
                origin: origins.each_ref(),
                direction: directions.each_ref(),
            };
            let (asked, told) = (rays.cross::<false>(&corners), rays.cross::<true>(&corners));
            let main = f64::from(ray.direction[filter.axes[2]].abs());
            for lane in (0..WIDTH).filter(|lane| certain.lanes >> lane & 1 != 0) {
                let corners = block.corners_of(lane, filter.axes);
                let crossing = caster.exact().cross_certain(&corners);
                assert_eq!(caster.exact().cross(&corners), Some(crossing), "{ray:?}");
                assert!(asked.is_hit >> lane & 1 != 0, "{ray:?}");
                assert_eq!(asked.get(lane), crossing);
                assert_eq!(told.get(lane), crossing);
                let depth = f64::from(crossing.t) * main;
                assert!(f64::from(near[lane]) < depth && depth < f64::from(far[lane]));
                known += 1;
            }
        }
        assert!(known > 5000, "{known}");
    }
}
