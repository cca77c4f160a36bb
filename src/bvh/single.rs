//! One ray goes through a tree.
//!
//! As in packets the exact test is put off: the ray holds the nearest triangle that it is certain to hit
//! ([`Certain`](super::filter::Certain)), and most rays take the test once, at the end of their walk. Only where crossings
//! are too close to tell apart, or not certain, the walk pauses for it.

use super::caster::{Caster, Window};
use super::count::Counter;
use super::filter::{Filter, corners_in};
use super::hit::{Hit, Search, key};
use super::layout::{Block, ChildRef, Node, Tree};
use super::simd::{Job, Lanes, Level, Run, prefetch};
use super::traverse::{Leaves, Stop, Walk};
use crate::math::Ray;

/// Said of a block in the place of its triangles, where any hit will do: one is certain. No lane has this bit.
const CERTAIN: u32 = 1 << 31;

/// What a ray goes through.
pub(super) struct Target<'a, const W: usize> {
    pub tree: &'a Tree<W>,
    pub level: Level,
    /// Largest magnitude of a coordinate of the tree's bounds.
    pub reach: f32,
    /// As which instance the tree is hit.
    pub instance: u32,
}

impl<const W: usize> Target<'_, W>
where
    Level: Run<W>,
{
    /// Looks for a hit better than that of `search` that `accept` likes; with `ANY` the first one ends it, and it returns
    /// whether there is one.
    ///
    /// With `SURE` it is not asked, and to like all: the exact test is put off. With both `search` does not hear of hits
    /// that are certain without it.
    #[inline(always)]
    pub fn search<const ANY: bool, const SURE: bool, C: Counter>(
        &self,
        ray: &Ray,
        search: &mut Search,
        accept: &impl Fn(&Hit) -> bool,
        counter: &mut C,
    ) -> bool {
        let tree = self.tree;
        let Some(ray) = &Caster::new(ray, &tree.bounds, self.reach, 0.0) else {
            return false;
        };
        // Without nodes all blocks in turn.
        let walks = match tree.nodes.is_empty() {
            true => tree.triangles.div_ceil(W),
            false => 1,
        };
        for i in 0..walks {
            let root = match tree.nodes.is_empty() {
                true => ChildRef::leaf(i, W.min(tree.triangles - i * W)),
                false => ChildRef::node(0),
            };
            let mut walk = Walk::new(root, ray.window(search.t_min, search.t_best));
            let mut held = Held::better_than::<SURE>(search, ray);
            loop {
                let stop = self.level.run(Step {
                    nodes: &tree.nodes,
                    blocks: Blocks::<ANY, SURE, W> {
                        blocks: &tree.blocks,
                        ray,
                        held: &mut held,
                    },
                    walk: &mut walk,
                    counter,
                });
                if ANY && SURE && matches!(&stop, Some(stop) if stop.lanes == CERTAIN) {
                    return true;
                }
                if let Some(place) = held.place {
                    counter.triangle();
                    self.keep(&tree.blocks[place / W], place % W, ray, search);
                }
                let Some(stop) = stop else {
                    break;
                };
                let block = &tree.blocks[stop.leaf.index()];
                if self.look::<ANY>(block, stop.lanes, ray, search, accept, counter) {
                    return true;
                }
                ray.narrow(&mut walk.window, search.t_best);
                held = Held::better_than::<SURE>(search, ray);
            }
        }
        false
    }

    /// Makes the triangle in a lane of a block, which was held, what is found.
    #[inline(always)]
    fn keep(&self, block: &Block<W>, lane: usize, ray: &Caster, search: &mut Search) {
        let crossing = ray.exact().cross_certain(&block.corners_of(lane, ray.axes));
        let hit = Hit::of(crossing, self.instance, block.triangles[lane]);
        debug_assert!(search.is_better(hit.t, hit.key()));
        search.keep(hit);
    }

    /// The exact test of some triangles of a block.
    #[inline(always)]
    fn look<const ANY: bool>(
        &self,
        block: &Block<W>,
        mut lanes: u32,
        ray: &Caster,
        search: &mut Search,
        accept: &impl Fn(&Hit) -> bool,
        counter: &mut impl Counter,
    ) -> bool {
        while lanes != 0 {
            let lane = lanes.trailing_zeros() as usize % W;
            lanes &= lanes - 1;
            counter.triangle();
            let Some(crossing) = ray.exact().cross(&block.corners_of(lane, ray.axes)) else {
                continue;
            };
            let triangle = block.triangles[lane];
            if !search.is_better(crossing.t, key(self.instance, triangle)) {
                continue;
            }
            let hit = Hit::of(crossing, self.instance, triangle);
            if accept(&hit) {
                search.keep(hit);
                if ANY {
                    return true;
                }
            }
        }
        false
    }
}

/// The nearest triangle so far that a ray is certain to hit. Depths are ahead: in the direction of the ray.
struct Held {
    /// What is certain to be farther ahead is in the range of the ray.
    begin: f32,
    /// What is certain to be less far ahead is better than all that was found.
    surely: f32,
    /// Where it is: block times width plus lane.
    place: Option<usize>,
}

impl Held {
    /// Nothing so far.
    #[inline(always)]
    fn better_than<const SURE: bool>(search: &Search, ray: &Caster) -> Self {
        let [begin, surely] = match SURE {
            true => ray.certain_depths(search.t_min, search.t_best),
            false => [0.0; 2],
        };
        Self {
            begin,
            surely,
            place: None,
        }
    }
}

/// A walk to the next block that needs the exact test, to be compiled for each kind of vectors.
struct Step<'a, const ANY: bool, const SURE: bool, const W: usize, C> {
    nodes: &'a [Node<W>],
    blocks: Blocks<'a, ANY, SURE, W>,
    walk: &'a mut Walk,
    counter: &'a mut C,
}

impl<const ANY: bool, const SURE: bool, const W: usize, C: Counter> Job<W>
    for Step<'_, ANY, SURE, W, C>
{
    type Output = Option<Stop>;

    #[inline(always)]
    fn run<S: Lanes<W>>(mut self) -> Option<Stop> {
        let (ray, walk) = (self.blocks.ray, self.walk);
        walk.next::<S, ANY, W, _>(self.nodes, ray, &mut self.blocks, self.counter)
    }
}

/// The leaves of a tree over triangles.
struct Blocks<'a, const ANY: bool, const SURE: bool, const W: usize> {
    blocks: &'a [Block<W>],
    ray: &'a Caster,
    held: &'a mut Held,
}

impl<const ANY: bool, const SURE: bool, const W: usize> Leaves<W> for Blocks<'_, ANY, SURE, W> {
    type Test<S> = Filter<S>;

    #[inline(always)]
    fn constants<S: Lanes<W>>(&self) -> Filter<S> {
        Filter::new(self.ray)
    }

    /// The triangles of a block that need the exact test, but for those that are certainly behind the origin.
    #[inline(always)]
    fn test<S: Lanes<W>>(
        &mut self,
        filter: &Filter<S>,
        leaf: ChildRef,
        window: &mut Window,
    ) -> u32 {
        let corners = corners_in::<S, W>(&self.blocks[leaf.index()], filter.axes);
        let depths = [S::splat(window.depth[0]), S::splat(window.depth[1])];
        let seen = filter.see(&corners);
        let mut lanes = seen.candidates(depths, u32::MAX >> (32 - leaf.count()));
        if lanes == 0 {
            return 0;
        }
        if SURE {
            let held = &mut *self.held;
            let certain = seen.certain(filter.is_reversed);
            let sure = lanes & certain.lanes & S::splat(held.begin).lt(certain.near);
            if ANY {
                if sure & certain.far.lt(S::splat(held.surely)) != 0 {
                    return CERTAIN;
                }
            } else if sure != 0 {
                let nearest = certain.nearest(sure, held.surely, self.ray.end_ahead(window));
                if let Some(lane) = nearest.lane {
                    held.place = Some(leaf.index() * W + lane);
                    held.surely = nearest.surely;
                    self.ray.narrow_to_depth(window, nearest.end);
                }
                lanes = lanes & !sure | nearest.doubtful;
                if lanes == 0 {
                    return 0;
                }
            }
        }
        lanes & !filter.certainly_behind(&corners, &seen)
    }

    #[inline(always)]
    fn announce(&self, leaf: ChildRef) {
        prefetch(self.blocks, leaf.index());
    }
}
