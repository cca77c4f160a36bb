//! A tree of one mesh, in the width that suits the processor.

use super::build::{Builder, build};
use super::caster::{Caster, Window};
use super::count::{Counter, Silent, TraversalCounts};
use super::filter::{CERTAIN, Filter};
use super::hit::{Hit, HitRow, Search, key};
use super::layout::{Block, ChildRef, Node, Tree};
use super::packet::Together;
use super::simd::{Job, Lanes, Level, Run, prefetch};
use super::stats::TreeStats;
use super::traverse::{Leaves, Stop, Walk};
use crate::math::{Aabb, ROW, Ray, RayRow, Vec3};

/// Which vectors a tree is laid out for and traced with. Hits are the same with all.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Width {
    /// 8 children and triangles at a time, in plain arrays: any processor.
    Portable,
    /// 8 at a time with AVX2 and FMA.
    Avx2,
    /// 16 at a time with AVX-512.
    Avx512,
}

impl Width {
    /// Those that this processor can do, best last.
    pub fn available() -> Vec<Self> {
        [Self::Portable, Self::Avx2, Self::Avx512]
            .into_iter()
            .filter(|width| width.level().is_some())
            .collect()
    }

    fn level(self) -> Option<Level> {
        match self {
            Self::Portable => Some(Level::PORTABLE),
            Self::Avx2 => Level::avx2(),
            Self::Avx512 => Level::avx512(),
        }
    }
}

/// Fewer rays are traced one by one.
const LEAST_TOGETHER: usize = 12;

#[derive(Debug, PartialEq)]
enum Body {
    Eight(Tree<8>),
    Sixteen(Tree<16>),
}

/// A bounding volume hierarchy over triangles: finds what a ray hits.
///
/// Two are equal where every node and triangle is.
#[derive(Debug, PartialEq)]
pub struct Bvh {
    body: Body,
    level: Level,
    /// Largest magnitude of a coordinate of the bounds.
    reach: f32,
}

impl Bvh {
    /// Builds a tree of `indices.len()` triangles for this processor, on all threads.
    ///
    /// Every index must be below `positions.len()`. Triangles without area, and those with
    /// coordinates that are not finite, are never hit.
    pub fn build(positions: &[Vec3], indices: &[[u32; 3]], builder: Builder) -> Self {
        [Width::Avx512, Width::Avx2]
            .into_iter()
            .find_map(|width| Self::build_with(positions, indices, builder, width))
            .unwrap_or_else(|| {
                let body = Body::Eight(build(positions, indices, builder));
                Self::new(body, Level::PORTABLE)
            })
    }

    /// Builds a tree for `width`; `None` where the processor cannot do it.
    pub fn build_with(
        positions: &[Vec3],
        indices: &[[u32; 3]],
        builder: Builder,
        width: Width,
    ) -> Option<Self> {
        let level = width.level()?;
        let body = match width {
            Width::Portable | Width::Avx2 => Body::Eight(build(positions, indices, builder)),
            Width::Avx512 => Body::Sixteen(build(positions, indices, builder)),
        };
        Some(Self::new(body, level))
    }

    fn new(body: Body, level: Level) -> Self {
        let mut bvh = Self {
            body,
            level,
            reach: 0.0,
        };
        match &bvh.body {
            Body::Eight(tree) => tree.prefer_large_pages(),
            Body::Sixteen(tree) => tree.prefer_large_pages(),
        }
        bvh.reach = bvh.bounds().reach();
        bvh
    }

    /// The first hit along `ray` in `t_min < t < t_max`; among several at the same `t` the
    /// lowest triangle. `None` where there is none.
    pub fn closest_hit(&self, ray: &Ray) -> Option<Hit> {
        self.closest_hit_if(ray, |_| true)
    }

    /// The first hit that `accept` does not turn down.
    ///
    /// `accept` may be asked in any order, and not of hits behind an accepted one.
    pub fn closest_hit_if(&self, ray: &Ray, accept: impl Fn(&Hit) -> bool) -> Option<Hit> {
        self.search::<false, _>(ray, &accept, &mut Silent)
    }

    /// Whether anything is hit in `t_min < t < t_max`.
    pub fn any_hit(&self, ray: &Ray) -> bool {
        self.is_blocked(ray, &mut Silent)
    }

    /// Whether there is a hit that `accept` does not turn down.
    pub fn any_hit_if(&self, ray: &Ray, accept: impl Fn(&Hit) -> bool) -> bool {
        self.search::<true, _>(ray, &accept, &mut Silent).is_some()
    }

    /// [`Bvh::closest_hit`] of each of `rays`.
    ///
    /// Quicker than one by one where they run nearly the same way.
    pub fn closest_hits(&self, rays: &RayRow) -> HitRow {
        self.search_row::<false>(rays)
    }

    /// [`Bvh::any_hit`] of each of `rays`, a bit for each. As for [`Bvh::closest_hits`].
    pub fn any_hits(&self, rays: &RayRow) -> u64 {
        self.search_row::<true>(rays).is_hit
    }

    fn search_row<const ANY: bool>(&self, rays: &RayRow) -> HitRow {
        let mut hits = HitRow::before(rays);
        let mut rest = match &self.body {
            Body::Eight(tree) => self.search_together::<ANY, 8>(tree, rays, &mut hits),
            Body::Sixteen(tree) => self.search_together::<ANY, 16>(tree, rays, &mut hits),
        };
        while rest != 0 {
            let i = rest.trailing_zeros() as usize;
            rest &= rest - 1;
            let ray = rays.get(i);
            if ANY {
                hits.is_hit |= u64::from(self.is_blocked(&ray, &mut Silent)) << i;
                continue;
            }
            let mut search = Search::beyond(&ray, hits.get(i));
            self.cast::<false, _>(&ray, &mut search, 0, &|_: &Hit| true, &mut Silent);
            if let Some(hit) = &search.hit {
                hits.set(i, hit);
            }
        }
        hits
    }

    /// The rays whose search is to be gone on with one by one, a bit for each.
    #[inline(always)]
    fn search_together<const ANY: bool, const W: usize>(
        &self,
        tree: &Tree<W>,
        rays: &RayRow,
        found: &mut HitRow,
    ) -> u64
    where
        Level: Run<W>,
    {
        let there = u64::MAX
            .checked_shr((ROW - rays.count()) as u32)
            .unwrap_or(0);
        if tree.nodes.is_empty() || rays.count() < LEAST_TOGETHER {
            return there;
        }
        let job = Together::<ANY, W> {
            tree,
            reach: self.reach,
            rays,
            found,
        };
        there & self.level.run(job)
    }

    /// [`Bvh::closest_hit`], adding to `counts` what it looked at.
    pub fn closest_hit_counted(&self, ray: &Ray, counts: &mut TraversalCounts) -> Option<Hit> {
        self.search::<false, _>(ray, &|_: &Hit| true, counts)
    }

    /// [`Bvh::any_hit`], adding to `counts` what it looked at.
    pub fn any_hit_counted(&self, ray: &Ray, counts: &mut TraversalCounts) -> bool {
        self.is_blocked(ray, counts)
    }

    /// Around all triangles that can be hit; empty where there are none.
    pub fn bounds(&self) -> Aabb {
        match &self.body {
            Body::Eight(tree) => tree.bounds,
            Body::Sixteen(tree) => tree.bounds,
        }
    }

    /// Size and shape.
    pub fn stats(&self) -> TreeStats {
        match &self.body {
            Body::Eight(tree) => TreeStats::of(tree),
            Body::Sixteen(tree) => TreeStats::of(tree),
        }
    }

    /// Bytes on the heap.
    pub fn memory_bytes(&self) -> usize {
        fn of<const W: usize>(tree: &Tree<W>) -> usize {
            tree.nodes.capacity() * size_of::<Node<W>>()
                + tree.blocks.capacity() * size_of::<Block<W>>()
        }
        match &self.body {
            Body::Eight(tree) => of(tree),
            Body::Sixteen(tree) => of(tree),
        }
    }

    fn search<const ANY: bool, C: Counter>(
        &self,
        ray: &Ray,
        accept: &impl Fn(&Hit) -> bool,
        counter: &mut C,
    ) -> Option<Hit> {
        let mut search = Search::new(ray.t_min, ray.t_max);
        self.cast::<ANY, _>(ray, &mut search, 0, accept, counter);
        search.hit
    }

    /// Whether there is any hit, whatever it is: most are certain without the exact test.
    fn is_blocked(&self, ray: &Ray, counter: &mut impl Counter) -> bool {
        let mut search = Search::new(ray.t_min, ray.t_max);
        let accept = |_: &Hit| true;
        match &self.body {
            Body::Eight(tree) => {
                self.cast_in::<true, true, 8, _>(tree, ray, &mut search, 0, &accept, counter)
            }
            Body::Sixteen(tree) => {
                self.cast_in::<true, true, 16, _>(tree, ray, &mut search, 0, &accept, counter)
            }
        }
    }

    /// Looks for a hit better than that of `search`, as instance `instance`.
    pub(super) fn cast<const ANY: bool, C: Counter>(
        &self,
        ray: &Ray,
        search: &mut Search,
        instance: u32,
        accept: &impl Fn(&Hit) -> bool,
        counter: &mut C,
    ) {
        match &self.body {
            Body::Eight(tree) => {
                self.cast_in::<ANY, false, 8, _>(tree, ray, search, instance, accept, counter);
            }
            Body::Sixteen(tree) => {
                self.cast_in::<ANY, false, 16, _>(tree, ray, search, instance, accept, counter);
            }
        }
    }

    /// With `ANY` it returns whether there is a hit that `accept` likes. With `SURE`, too, that may be one of which `accept`,
    /// which is to like all, is not asked, and of which `search` does not hear.
    #[inline(always)]
    fn cast_in<const ANY: bool, const SURE: bool, const W: usize, C: Counter>(
        &self,
        tree: &Tree<W>,
        ray: &Ray,
        search: &mut Search,
        instance: u32,
        accept: &impl Fn(&Hit) -> bool,
        counter: &mut C,
    ) -> bool
    where
        Level: Run<W>,
    {
        const { assert!(ANY || !SURE) };
        let Some(ray) = &Caster::new(ray, &tree.bounds, self.reach, 0.0) else {
            return false;
        };
        let certain = match SURE {
            true => ray.certain_depths(search.t_min, search.t_best),
            false => [0.0; 2],
        };
        let mut seek = |root: ChildRef| {
            let mut walk = Walk::new(root, ray.window(search.t_min, search.t_best));
            while let Some(stop) = self.level.run(Step::<ANY, SURE, W, C> {
                blocks: Blocks {
                    blocks: &tree.blocks,
                    certain,
                },
                nodes: &tree.nodes,
                ray,
                walk: &mut walk,
                counter,
            }) {
                if SURE && stop.lanes == CERTAIN {
                    return true;
                }
                let block = &tree.blocks[stop.leaf.index()];
                if search_lanes::<ANY, W>(block, stop.lanes, ray, search, instance, accept, counter)
                {
                    return true;
                }
                ray.narrow(&mut walk.window, search.t_best);
            }
            false
        };
        if !tree.nodes.is_empty() {
            return seek(ChildRef::node(0));
        }
        // All blocks in turn.
        let mut blocks = (0..tree.triangles).step_by(W).enumerate();
        blocks.any(|(block, first)| seek(ChildRef::leaf(block, W.min(tree.triangles - first))))
    }
}

/// Looks at those triangles of a block for hits that are better than the best.
///
/// With `ANY` the first hit that `accept` likes ends the search: then it returns `true`.
#[inline(always)]
fn search_lanes<const ANY: bool, const W: usize>(
    block: &Block<W>,
    mut lanes: u32,
    ray: &Caster,
    search: &mut Search,
    instance: u32,
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
        if !search.is_better(crossing.t, key(instance, triangle)) {
            continue;
        }
        let hit = Hit::of(crossing, instance, triangle);
        if accept(&hit) {
            search.keep(hit);
            if ANY {
                return true;
            }
        }
    }
    false
}

/// A walk to the next block that needs the exact test, to be compiled for each kind of vectors.
struct Step<'a, const ANY: bool, const SURE: bool, const W: usize, C> {
    nodes: &'a [Node<W>],
    blocks: Blocks<'a, SURE, W>,
    ray: &'a Caster,
    walk: &'a mut Walk,
    counter: &'a mut C,
}

impl<const ANY: bool, const SURE: bool, const W: usize, C: Counter> Job<W>
    for Step<'_, ANY, SURE, W, C>
{
    type Output = Option<Stop>;

    #[inline(always)]
    fn run<S: Lanes<W>>(self) -> Option<Stop> {
        let Self {
            nodes,
            blocks,
            ray,
            walk,
            counter,
        } = self;
        walk.next::<S, ANY, W, _>(nodes, ray, &blocks, counter)
    }
}

/// The leaves of a tree over triangles.
struct Blocks<'a, const SURE: bool, const W: usize> {
    blocks: &'a [Block<W>],
    /// See [`Filter::test`].
    certain: [f32; 2],
}

impl<const SURE: bool, const W: usize> Leaves<W> for Blocks<'_, SURE, W> {
    type Test<S> = Filter<S>;

    #[inline(always)]
    fn constants<S: Lanes<W>>(&self, ray: &Caster) -> Filter<S> {
        Filter::new(ray)
    }

    #[inline(always)]
    fn test<S: Lanes<W>>(&self, filter: &Filter<S>, leaf: ChildRef, window: &Window) -> u32 {
        let block = &self.blocks[leaf.index()];
        filter.test::<SURE, W>(block, leaf.count(), window, self.certain)
    }

    #[inline(always)]
    fn announce(&self, leaf: ChildRef) {
        prefetch(self.blocks, leaf.index());
    }
}
