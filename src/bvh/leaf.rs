//! What is done at the leaves of one tree: the search for the best hit.

use super::caster::{Caster, Window};
use super::count::Counter;
use super::filter::Filter;
use super::hit::{Accept, Hit, Search, key};
use super::layout::{Block, ChildRef};
use super::simd::{Lanes, prefetch};
use super::traverse::Visitor;
use super::triangle::Crossing;

/// Searches the blocks that a walk comes to.
///
/// # Delay
///
/// The exact test is a long chain of dependent operations, and all that the walk needs of it is
/// a bound of `t`. Where the filter says for certain that a triangle is crossed, nearer than
/// everything before, the walk goes on with the filter's bound, and the exact test is left for
/// the end: by then it is run once, while the processor is already busy with the next ray.
/// Should it then contradict, the search is done again without delay.
pub(super) struct Leaves<'a, const ANY: bool, const W: usize, S, A> {
    blocks: &'a [Block<W>],
    ray: &'a Caster,
    filter: Filter<S>,
    search: &'a mut Search,
    instance: u32,
    accept: &'a A,
    delays: bool,
    delayed: Option<Delayed>,
    /// Whether the exact test contradicted the filter.
    contradicted: bool,
}

/// A crossing whose exact test has been put off.
#[derive(Clone, Copy)]
struct Delayed {
    block: usize,
    lane: usize,
    /// `t` is between these.
    span: [f32; 2],
}

impl<'a, const ANY: bool, const W: usize, S, A> Leaves<'a, ANY, W, S, A>
where
    S: Lanes<W>,
    A: Accept,
{
    /// Looks for hits of `instance` better than that of `search`.
    #[inline(always)]
    pub fn new(
        blocks: &'a [Block<W>],
        ray: &'a Caster,
        search: &'a mut Search,
        instance: u32,
        accept: &'a A,
    ) -> Self {
        Self {
            blocks,
            ray,
            filter: Filter::new(ray),
            search,
            instance,
            accept,
            delays: A::ALL && !ANY,
            delayed: None,
            contradicted: false,
        }
    }

    /// The same, with every exact test at once.
    #[inline(always)]
    pub fn without_delay(self) -> Self {
        Self {
            delays: false,
            contradicted: false,
            ..self
        }
    }

    /// Makes `search` final; returns whether it is right.
    #[inline(always)]
    pub fn finish(&mut self, counter: &mut impl Counter) -> bool {
        self.settle(counter);
        !self.contradicted
    }

    /// Runs the exact test that was put off.
    #[inline(always)]
    fn settle(&mut self, counter: &mut impl Counter) {
        if let Some(Delayed { block, lane, span }) = self.delayed.take() {
            counter.triangle();
            let hit = self.hit(block, lane);
            match hit.filter(|hit| span[0] <= hit.t && hit.t <= span[1]) {
                Some(hit) => self.search.keep(hit),
                None => self.contradicted = true,
            }
        }
    }

    /// Whether the crossing in `lane` can wait: it is certain, within the range of the search,
    /// and nearer than everything found so far.
    #[inline(always)]
    fn delay(&mut self, block: usize, lane: usize, [depth, error]: [f32; 2]) -> bool {
        let span = self.ray.span(depth, error);
        let before = match self.delayed {
            Some(delayed) => delayed.span[0],
            None => self.search.t_best,
        };
        let can_wait = self.search.t_min < span[0] && span[1] < before;
        if can_wait {
            self.delayed = Some(Delayed { block, lane, span });
        }
        can_wait
    }

    #[inline(always)]
    fn hit(&self, block: usize, lane: usize) -> Option<Hit> {
        let block = &self.blocks[block];
        let crossing = cross(self.ray, block, lane)?;
        Some(Hit {
            t: crossing.t,
            u: crossing.u,
            v: crossing.v,
            triangle: block.triangles[lane],
            instance: self.instance,
        })
    }

    /// The upper bound of `t` that is known by now.
    #[inline(always)]
    fn window(&self) -> Window {
        let t_max = match self.delayed {
            Some(delayed) => delayed.span[1],
            None => self.search.t_best,
        };
        self.ray.window(self.search.t_min, t_max)
    }
}

impl<const ANY: bool, const W: usize, S, A, C> Visitor<C> for Leaves<'_, ANY, W, S, A>
where
    S: Lanes<W>,
    A: Accept,
    C: Counter,
{
    #[inline(always)]
    fn visit(&mut self, leaf: ChildRef, window: &mut Window, counter: &mut C) -> bool {
        counter.leaf();
        let block = leaf.index();
        let Some(found) = self
            .filter
            .test(&self.blocks[block], leaf.count(), window)
        else {
            return false;
        };
        let mut lanes = found.lanes;
        if self.delays {
            let lane = lanes.trailing_zeros() as usize % W;
            let only = lanes & (lanes - 1) == 0 && lanes & found.certain != 0;
            if only && self.delay(block, lane, found.depth.get(lane)) {
                *window = self.window();
                return false;
            }
            self.settle(counter);
        }
        while lanes != 0 {
            let lane = lanes.trailing_zeros() as usize % W;
            lanes &= lanes - 1;
            counter.triangle();
            let Some(hit) = self.hit(block, lane) else {
                continue;
            };
            let better = self
                .search
                .is_better(hit.t, key(self.instance, hit.triangle));
            if better && self.accept.accept(&hit) {
                self.search.keep(hit);
                if ANY {
                    return true;
                }
            }
        }
        *window = self.window();
        false
    }

    #[inline(always)]
    fn announce(&self, leaf: ChildRef) {
        prefetch(self.blocks, leaf.index());
    }
}

/// The exact test. Apart, so that its constants do not crowd out those of the walk.
#[inline(never)]
fn cross<const W: usize>(ray: &Caster, block: &Block<W>, lane: usize) -> Option<Crossing> {
    ray.exact().cross(&block.corners_of(lane, ray.axes))
}
