//! A tree of one mesh, in the width that suits the processor.

use super::build::{Builder, build};
use super::caster::{Caster, Window};
use super::count::{Counter, Silent, TraversalCounts};
use super::hit::{Accept, Every, Hit, Search};
use super::layout::{Block, ChildRef, Node, Tree};
use super::simd::{Job, Lanes, Level};
use super::stats::TreeStats;
use super::leaf::Leaves;
use super::traverse::{Visitor, walk};
use crate::math::{Aabb, Ray, Vec3};

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
        let bounds = bvh.bounds();
        bvh.reach = bounds.min.abs().max(bounds.max.abs()).max_element();
        bvh
    }

    /// The first hit along `ray` in `t_min < t < t_max`; among several at the same `t` the
    /// lowest triangle. `None` where there is none.
    pub fn closest_hit(&self, ray: &Ray) -> Option<Hit> {
        self.search::<false, _>(ray, &Every, &mut Silent)
    }

    /// The first hit that `accept` does not turn down.
    ///
    /// `accept` may be asked in any order, and not of hits behind an accepted one.
    pub fn closest_hit_if(&self, ray: &Ray, accept: impl Fn(&Hit) -> bool) -> Option<Hit> {
        self.search::<false, _>(ray, &accept, &mut Silent)
    }

    /// Whether anything is hit in `t_min < t < t_max`.
    pub fn any_hit(&self, ray: &Ray) -> bool {
        self.search::<true, _>(ray, &Every, &mut Silent).is_some()
    }

    /// Whether there is a hit that `accept` does not turn down.
    pub fn any_hit_if(&self, ray: &Ray, accept: impl Fn(&Hit) -> bool) -> bool {
        self.search::<true, _>(ray, &accept, &mut Silent).is_some()
    }

    /// [`Bvh::closest_hit`], adding to `counts` what it looked at.
    pub fn closest_hit_counted(&self, ray: &Ray, counts: &mut TraversalCounts) -> Option<Hit> {
        self.search::<false, _>(ray, &Every, counts)
    }

    /// [`Bvh::any_hit`], adding to `counts` what it looked at.
    pub fn any_hit_counted(&self, ray: &Ray, counts: &mut TraversalCounts) -> bool {
        self.search::<true, _>(ray, &Every, counts)
            .is_some()
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
        accept: &impl Accept,
        counter: &mut C,
    ) -> Option<Hit> {
        let mut search = Search::new(ray.t_min, ray.t_max);
        self.cast::<ANY, _>(ray, &mut search, 0, accept, counter);
        search.hit
    }

    /// Looks for a hit better than that of `search`, as instance `instance`.
    pub(super) fn cast<const ANY: bool, C: Counter>(
        &self,
        ray: &Ray,
        search: &mut Search,
        instance: u32,
        accept: &impl Accept,
        counter: &mut C,
    ) {
        match &self.body {
            Body::Eight(tree) => self.level.run8(Cast::<ANY, 8, _, _> {
                tree,
                reach: self.reach,
                ray,
                search,
                instance,
                accept,
                counter,
            }),
            Body::Sixteen(tree) => self.level.run16(Cast::<ANY, 16, _, _> {
                tree,
                reach: self.reach,
                ray,
                search,
                instance,
                accept,
                counter,
            }),
        }
    }
}

/// A search in one tree, to be compiled for each kind of vectors.
struct Cast<'a, const ANY: bool, const W: usize, A, C> {
    tree: &'a Tree<W>,
    reach: f32,
    ray: &'a Ray,
    search: &'a mut Search,
    instance: u32,
    accept: &'a A,
    counter: &'a mut C,
}

impl<const ANY: bool, const W: usize, A, C> Job<W> for Cast<'_, ANY, W, A, C>
where
    A: Accept,
    C: Counter,
{
    type Output = ();

    #[inline(always)]
    fn run<S: Lanes<W>>(self) {
        let Self {
            tree,
            reach,
            ray,
            search,
            instance,
            accept,
            counter,
        } = self;
        // In here, so that its arithmetic, too, is compiled for the instruction set.
        let Some(ray) = &Caster::new(ray, &tree.bounds, reach, 0.0) else {
            return;
        };
        let window = ray.window(search.t_min, search.t_best);
        let mut leaves = Leaves::<ANY, W, S, A>::new(&tree.blocks, ray, search, instance, accept);
        visit_all(tree, ray, window, &mut leaves, counter);
        if !leaves.finish(counter) {
            let mut leaves = leaves.without_delay();
            visit_all(tree, ray, window, &mut leaves, counter);
        }
    }
}

/// Has `leaves` visit all that may matter.
#[inline(always)]
fn visit_all<const ANY: bool, const W: usize, S, A, C>(
    tree: &Tree<W>,
    ray: &Caster,
    mut window: Window,
    leaves: &mut Leaves<'_, ANY, W, S, A>,
    counter: &mut C,
) where
    S: Lanes<W>,
    A: Accept,
    C: Counter,
{
    if !tree.nodes.is_empty() {
        walk::<S, ANY, W, C>(&tree.nodes, ray, window, counter, leaves);
        return;
    }
    let mut left = tree.triangles;
    for block in 0..tree.blocks.len() {
        let child = ChildRef::leaf(block, left.min(W));
        left -= left.min(W);
        if leaves.visit(child, &mut window, counter) {
            return;
        }
    }
}
