//! A tree of one mesh, in the width that suits the processor.

use super::build::{Builder, build};
use super::count::{Counter, Silent, TraversalCounts};
use super::hit::{Hit, HitRow, Search};
use super::layout::{Block, Node, Tree};
use super::packet::Together;
use super::simd::{Level, Run};
use super::single::Target;
use super::stats::TreeStats;
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
        self.first_hit(ray, &mut Silent)
    }

    /// The first hit that `accept` does not turn down.
    ///
    /// `accept` may be asked in any order, and not of hits behind an accepted one.
    pub fn closest_hit_if(&self, ray: &Ray, accept: impl Fn(&Hit) -> bool) -> Option<Hit> {
        let mut search = Search::new(ray.t_min, ray.t_max);
        self.cast::<false, false, _>(ray, &mut search, 0, &accept, &mut Silent);
        search.hit
    }

    /// Whether anything is hit in `t_min < t < t_max`.
    pub fn any_hit(&self, ray: &Ray) -> bool {
        self.is_blocked(ray, &mut Silent)
    }

    /// Whether there is a hit that `accept` does not turn down.
    pub fn any_hit_if(&self, ray: &Ray, accept: impl Fn(&Hit) -> bool) -> bool {
        let mut search = Search::new(ray.t_min, ray.t_max);
        self.cast::<true, false, _>(ray, &mut search, 0, &accept, &mut Silent)
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
            self.look_for::<false, _>(&ray, &mut search, &mut Silent);
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
        self.first_hit(ray, counts)
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

    #[inline(always)]
    fn first_hit(&self, ray: &Ray, counter: &mut impl Counter) -> Option<Hit> {
        let mut search = Search::new(ray.t_min, ray.t_max);
        self.look_for::<false, _>(ray, &mut search, counter);
        search.hit
    }

    #[inline(always)]
    fn is_blocked(&self, ray: &Ray, counter: &mut impl Counter) -> bool {
        let mut search = Search::new(ray.t_min, ray.t_max);
        self.look_for::<true, _>(ray, &mut search, counter)
    }

    /// Looks for any hit, or for one better than that of `search`, whatever it is.
    #[inline(always)]
    fn look_for<const ANY: bool, C: Counter>(
        &self,
        ray: &Ray,
        search: &mut Search,
        counter: &mut C,
    ) -> bool {
        self.cast::<ANY, true, C>(ray, search, 0, &|_: &Hit| true, counter)
    }

    /// See [`Target::search`].
    #[inline(always)]
    pub(super) fn cast<const ANY: bool, const SURE: bool, C: Counter>(
        &self,
        ray: &Ray,
        search: &mut Search,
        instance: u32,
        accept: &impl Fn(&Hit) -> bool,
        counter: &mut C,
    ) -> bool {
        macro_rules! search {
            ($tree:ident) => {{
                let target = Target {
                    tree: $tree,
                    level: self.level,
                    reach: self.reach,
                    instance,
                };
                target.search::<ANY, SURE, C>(ray, search, accept, counter)
            }};
        }
        match &self.body {
            Body::Eight(tree) => search!(tree),
            Body::Sixteen(tree) => search!(tree),
        }
    }
}
