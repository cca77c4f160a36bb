//! Rays that go together: one walk for up to as many as a vector has lanes.
//!
//! Boxes are tested against all rays at once, by intervals of their origins and reciprocal
//! directions (Boulos, Wald and Shirley 2006, "Geometric and Arithmetic Culling Methods for Entire
//! Ray Packets"), and so are the boxes of a leaf's triangles. What is left of these meets the
//! rays, which now stand in the lanes, in the same filter that a single ray uses for 16
//! triangles; the exact test decides as ever. Hits are therefore the same bit for bit.

use super::caster::{Caster, Window};
use super::count::Silent;
use super::filter::{possible, shear};
use super::hit::{Hit, Search, key};
use super::layout::{Block, ChildRef, Node, Tree};
use super::simd::{Job, Lanes, Level, Run, prefetch};
use super::traverse::{Boxes, Leaves, Stop, Walk};
use crate::math::{Ray, UNIT_ROUNDOFF};

/// Fewer rays than this are traced one by one.
const LEAST_RAYS: usize = 4;

/// Widens intervals of distances. A point of a hit is in its box up to 2u(|o| + |t d|)
/// (`caster`): the widened origins take up the first part, this the second and the four
/// roundings of a distance.
const PAD: f32 = 16.0 * UNIT_ROUNDOFF;

/// Likewise of origins, with their subtraction from a plane.
const ORIGIN_PAD: f32 = 8.0 * UNIT_ROUNDOFF;

/// More than underflow takes away from a distance.
const TINY: f32 = 64.0 * f32::MIN_POSITIVE;

/// Rays in lanes.
struct Bundle<const W: usize> {
    casters: [Option<Caster>; W],
    axes: [usize; 3],
    /// Origins, by axis in the order `axes`.
    origin: [[f32; W]; 3],
    shear: [[f32; W]; 2],
    /// Least and greatest depth that still matters.
    depth: [[f32; W]; 2],
    /// Rays that are not done.
    live: u32,
    span: Span,
}

/// What encloses all rays of a bundle.
#[derive(Clone, Copy)]
struct Span {
    towards_lower: [bool; 3],
    /// Least and greatest origin, by axis, widened.
    origin: [[f32; 2]; 3],
    /// Least and greatest reciprocal direction, by axis.
    inverse: [[f32; 2]; 3],
}

impl<const W: usize> Bundle<W> {
    /// `None` where the rays do not go together: along different axes, or with extreme numbers.
    fn new(tree: &Tree<W>, reach: f32, rays: &[Ray]) -> Option<Self> {
        let first = Caster::new(rays.first()?, &tree.bounds, reach, 0.0)?;
        let mut bundle = Self {
            casters: [const { None }; W],
            axes: first.axes,
            origin: [[0.0; W]; 3],
            shear: [[0.0; W]; 2],
            depth: [[0.0; W]; 2],
            live: u32::MAX >> (32 - rays.len()),
            span: Span {
                towards_lower: first.towards_lower,
                origin: [[f32::INFINITY, f32::NEG_INFINITY]; 3],
                inverse: [[f32::INFINITY, f32::NEG_INFINITY]; 3],
            },
        };
        for (lane, ray) in rays.iter().enumerate() {
            let caster = Caster::new(ray, &tree.bounds, reach, 0.0)?;
            let goes_along = caster.axes == bundle.axes
                && caster.towards_lower == bundle.span.towards_lower
                && caster.is_ordinary();
            if !goes_along {
                return None;
            }
            for k in 0..3 {
                bundle.origin[k][lane] = caster.origin[k];
                bundle.span.add(k, ray.origin[k], caster.near_inverse[k]);
            }
            for k in 0..2 {
                bundle.shear[k][lane] = caster.shear[k];
            }
            bundle.casters[lane] = Some(caster);
        }
        Some(bundle)
    }

    /// Has lane `lane` look only from `window`'s one end to the other.
    fn limit(&mut self, lane: usize, window: &Window) {
        self.depth[0][lane] = window.depth[0];
        self.depth[1][lane] = window.depth[1];
    }
}

impl Span {
    fn add(&mut self, axis: usize, origin: f32, inverse: f32) {
        let pad = ORIGIN_PAD * origin.abs();
        let [low, high] = &mut self.origin[axis];
        (*low, *high) = (low.min(origin - pad), high.max(origin + pad));
        let [low, high] = &mut self.inverse[axis];
        (*low, *high) = (low.min(inverse), high.max(inverse));
    }
}

/// The constants of a [`Span`], in vectors, by axis.
struct SpanTest<S> {
    towards_lower: [bool; 3],
    /// What is subtracted from near planes, and from far planes.
    origin: [[S; 2]; 3],
    inverse: [[S; 2]; 3],
}

impl<S> SpanTest<S> {
    #[inline(always)]
    fn new<const W: usize>(span: &Span) -> Self
    where
        S: Lanes<W>,
    {
        let axis = |k: usize| {
            let (near, far) = if span.towards_lower[k] {
                (0, 1)
            } else {
                (1, 0)
            };
            [span.origin[k][near], span.origin[k][far]]
        };
        let origins = [axis(0), axis(1), axis(2)];
        Self {
            towards_lower: span.towards_lower,
            origin: [pair(origins[0]), pair(origins[1]), pair(origins[2])],
            inverse: [
                pair(span.inverse[0]),
                pair(span.inverse[1]),
                pair(span.inverse[2]),
            ],
        }
    }

    /// Where any ray enters the slab behind `plane` at the earliest.
    #[inline(always)]
    fn enter<const W: usize>(&self, axis: usize, plane: S) -> S
    where
        S: Lanes<W>,
    {
        let way = plane.sub(self.origin[axis][0]);
        let [low, high] = self.inverse[axis];
        way.mul(low).min(way.mul(high))
    }

    /// Where any ray leaves the slab before `plane` at the latest.
    #[inline(always)]
    fn leave<const W: usize>(&self, axis: usize, plane: S) -> S
    where
        S: Lanes<W>,
    {
        let way = plane.sub(self.origin[axis][1]);
        let [low, high] = self.inverse[axis];
        way.mul(low).max(way.mul(high))
    }

    /// Which boxes some ray may meet from `near` to `far`, given their lower and upper planes by
    /// axis, and where it enters them at the earliest.
    #[inline(always)]
    fn boxes<const W: usize>(&self, low: [S; 3], high: [S; 3], near: S, far: S) -> (u32, S)
    where
        S: Lanes<W>,
    {
        let mut enter = near;
        let mut leave = far;
        for k in 0..3 {
            let (first, last) = if self.towards_lower[k] {
                (high[k], low[k])
            } else {
                (low[k], high[k])
            };
            enter = enter.max(self.enter(k, first));
            leave = leave.min(self.leave(k, last));
        }
        let enter = enter.mul(S::splat(1.0 - PAD)).sub(S::splat(TINY));
        let leave = leave.mul_add(S::splat(1.0 + PAD), S::splat(TINY));
        (enter.le(leave), enter)
    }
}

#[inline(always)]
fn pair<S: Lanes<W>, const W: usize>([a, b]: [f32; 2]) -> [S; 2] {
    [S::splat(a), S::splat(b)]
}

impl<S: Lanes<W>, const W: usize> Boxes<S, W> for SpanTest<S> {
    #[inline(always)]
    fn test(&self, node: &Node<W>, near: S, far: S) -> (u32, S) {
        let [a, b, c, d, e, f] = &node.planes;
        let low = [S::load(a), S::load(b), S::load(c)];
        let high = [S::load(d), S::load(e), S::load(f)];
        self.boxes(low, high, near, far)
    }
}

/// Candidates of a leaf: by triangle, the rays.
type Pairs<const W: usize> = [u32; W];

/// Tests the triangles of a leaf against the rays of a bundle.
struct Rays<'a, const W: usize, S> {
    blocks: &'a [Block<W>],
    bundle: &'a Bundle<W>,
    span: &'a SpanTest<S>,
    pairs: &'a mut Pairs<W>,
}

impl<const W: usize, S: Lanes<W>> Rays<'_, W, S> {
    /// The triangles whose boxes some ray may meet.
    #[inline(always)]
    fn near_triangles(&self, block: &Block<W>, window: &Window) -> u32 {
        let [a, b, c] = &block.corners;
        let mut low = [S::splat(0.0); 3];
        let mut high = low;
        for k in 0..3 {
            let (x, y, z) = (S::load(&a[k]), S::load(&b[k]), S::load(&c[k]));
            low[k] = x.min(y).min(z);
            high[k] = x.max(y).max(z);
        }
        let (near, far) = (S::splat(window.near), S::splat(window.far));
        self.span.boxes(low, high, near, far).0
    }
}

impl<const W: usize, S: Lanes<W>> Leaves for Rays<'_, W, S> {
    #[inline(always)]
    fn test(&mut self, leaf: ChildRef, window: &Window) -> u32 {
        let block = &self.blocks[leaf.index()];
        let mut rest = self.near_triangles(block, window) & (u32::MAX >> (32 - leaf.count()));
        let mut found = 0;
        let bundle = self.bundle;
        let origin = [
            S::load(&bundle.origin[0]),
            S::load(&bundle.origin[1]),
            S::load(&bundle.origin[2]),
        ];
        let slopes = [S::load(&bundle.shear[0]), S::load(&bundle.shear[1])];
        let depths = [S::load(&bundle.depth[0]), S::load(&bundle.depth[1])];
        while rest != 0 {
            let lane = rest.trailing_zeros() as usize % W;
            rest &= rest - 1;
            let [a, b, c] = block.corners_of(lane, bundle.axes);
            let corners = [
                shear(splat(a), &origin, &slopes),
                shear(splat(b), &origin, &slopes),
                shear(splat(c), &origin, &slopes),
            ];
            let rays = possible(corners, depths, bundle.live);
            if rays != 0 {
                self.pairs[lane] = rays;
                found |= 1 << lane;
            }
        }
        found
    }

    #[inline(always)]
    fn announce(&self, leaf: ChildRef) {
        prefetch(self.blocks, leaf.index());
    }
}

#[inline(always)]
fn splat<S: Lanes<W>, const W: usize>(v: [f32; 3]) -> [S; 3] {
    [S::splat(v[0]), S::splat(v[1]), S::splat(v[2])]
}

/// A walk to the next block with candidates, to be compiled for each kind of vectors.
struct Step<'a, const ANY: bool, const W: usize> {
    tree: &'a Tree<W>,
    bundle: &'a Bundle<W>,
    walk: &'a mut Walk,
    pairs: &'a mut Pairs<W>,
}

impl<const ANY: bool, const W: usize> Job<W> for Step<'_, ANY, W> {
    type Output = Option<Stop>;

    #[inline(always)]
    fn run<S: Lanes<W>>(self) -> Option<Stop> {
        let span = SpanTest::<S>::new(&self.bundle.span);
        let mut rays = Rays {
            blocks: &self.tree.blocks,
            bundle: self.bundle,
            span: &span,
            pairs: self.pairs,
        };
        self.walk
            .next::<S, ANY, W>(&self.tree.nodes, &span, &mut rays, &mut Silent)
    }
}

/// Finds the hits of `rays`, at most `W`; `false` where they do not go together, and nothing was
/// done. With `ANY` it may be any hit.
pub(super) fn cast_bundle<const ANY: bool, const W: usize>(
    level: Level,
    tree: &Tree<W>,
    reach: f32,
    rays: &[Ray],
    hits: &mut [Option<Hit>],
) -> bool
where
    Level: Run<W>,
{
    if rays.len() < LEAST_RAYS || tree.nodes.is_empty() {
        return false;
    }
    let Some(mut bundle) = Bundle::new(tree, reach, rays) else {
        return false;
    };
    let mut searches = [const { Search::NONE }; W];
    let mut windows = [Window::NONE; W];
    for (lane, caster) in bundle_lanes(&bundle) {
        let search = Search::new(rays[lane].t_min, rays[lane].t_max);
        windows[lane] = caster.window(search.t_min, search.t_best);
        searches[lane] = search;
    }
    for lane in 0..rays.len() {
        bundle.limit(lane, &windows[lane]);
    }
    let mut walk = Walk::new(ChildRef::node(0), around(&windows, bundle.live));
    let mut pairs = [0; W];
    while let Some(stop) = level.run(Step::<ANY, W> {
        tree,
        bundle: &bundle,
        walk: &mut walk,
        pairs: &mut pairs,
    }) {
        let block = &tree.blocks[stop.leaf.index()];
        for lane in bits(stop.lanes) {
            for ray in bits(pairs[lane] & bundle.live) {
                let Some(caster) = &bundle.casters[ray] else {
                    continue;
                };
                let Some(crossing) = caster.exact().cross(&block.corners_of(lane, bundle.axes))
                else {
                    continue;
                };
                let triangle = block.triangles[lane];
                let search = &mut searches[ray];
                if search.is_better(crossing.t, key(0, triangle)) {
                    search.keep(Hit {
                        t: crossing.t,
                        u: crossing.u,
                        v: crossing.v,
                        triangle,
                        instance: 0,
                    });
                    caster.narrow(&mut windows[ray], search.t_best);
                    bundle.limit(ray, &windows[ray]);
                    if ANY {
                        bundle.live &= !(1 << ray);
                    }
                }
            }
        }
        if bundle.live == 0 {
            break;
        }
        walk.window = around(&windows, bundle.live);
    }
    for (hit, search) in hits.iter_mut().zip(searches).take(rays.len()) {
        *hit = search.hit;
    }
    true
}

/// The lanes that hold rays.
fn bundle_lanes<const W: usize>(bundle: &Bundle<W>) -> impl Iterator<Item = (usize, &Caster)> {
    let casters = bundle.casters.iter().enumerate();
    casters.filter_map(|(lane, caster)| Some((lane, caster.as_ref()?)))
}

/// The numbers of the bits that are set.
fn bits(mut mask: u32) -> impl Iterator<Item = usize> {
    std::iter::from_fn(move || {
        let bit = mask.trailing_zeros() as usize;
        (mask != 0).then(|| {
            mask &= mask - 1;
            bit
        })
    })
}

/// From the nearest to the farthest end of the windows of `lanes`. Depths differ from ray to ray
/// and are in the bundle.
fn around<const W: usize>(windows: &[Window; W], lanes: u32) -> Window {
    bits(lanes).fold(Window::NONE, |all, lane| Window {
        near: all.near.min(windows[lane].near),
        far: all.far.max(windows[lane].far),
        ..all
    })
}
