//! A tree over boxes: which of them may a ray enter?
//!
//! What is in a box is the caller's: instances of a tree, surfaces of lights.

use super::build::build_over_boxes;
use super::caster::{Caster, Window};
use super::count::Silent;
use super::layout::{ChildRef, Node};
use super::simd::{Job, Lanes, Level, Run};
use super::traverse::{Leaves, Stop, Walk};
use crate::math::{Aabb, Ray};

/// Children of a node.
const WIDTH: usize = 8;

/// A tree over boxes, each with something in it.
#[derive(Debug)]
pub struct BoxTree {
    nodes: Vec<Node<WIDTH>>,
    /// What box is at each leaf of `nodes`.
    leaves: Vec<u32>,
    bounds: Aabb,
    /// That of `bounds`, [`Aabb::reach`].
    reach: f32,
    level: Level,
}

impl BoxTree {
    /// Over `boxes`; rays never enter those that are empty.
    pub fn new(boxes: &[Aabb]) -> Self {
        let (nodes, leaves) = build_over_boxes(boxes);
        let bounds = boxes.iter().copied().fold(Aabb::EMPTY, Aabb::union);
        Self {
            nodes,
            leaves,
            bounds,
            reach: bounds.reach(),
            level: Level::best(),
        }
    }

    /// Around all.
    pub fn bounds(&self) -> Aabb {
        self.bounds
    }

    /// Bytes on the heap.
    pub fn memory_bytes(&self) -> usize {
        self.nodes.capacity() * size_of::<Node<WIDTH>>() + self.leaves.capacity() * size_of::<u32>()
    }

    /// That of [`Self::bounds`], [`Aabb::reach`].
    pub fn reach(&self) -> f32 {
        self.reach
    }

    /// Calls `visit` with the index of each box, grown by `slack` on all sides, that `ray` may enter between its
    /// `t_min` and `t_max`, near ones first for the most part. It returns the `t` from which on nothing matters any
    /// more, `None` to end the search.
    pub fn visit(&self, ray: &Ray, slack: f32, mut visit: impl FnMut(u32) -> Option<f32>) {
        // A little more than `slack`: the caster rounds what it makes of it.
        let Some(caster) = Caster::new(ray, &self.bounds, self.reach, 1.001 * slack) else {
            return;
        };
        let root = match (self.nodes.is_empty(), self.leaves.is_empty()) {
            (false, _) => ChildRef::node(0),
            (true, false) => ChildRef::leaf(0, 1), // where there are two there is a node
            (true, true) => return,
        };
        let mut walk = Walk::new(root, caster.window(ray.t_min, ray.t_max));
        let mut end = ray.t_max;
        while let Some(stop) = self.level.run(Step {
            nodes: &self.nodes,
            ray: &caster,
            walk: &mut walk,
        }) {
            match visit(self.leaves[stop.leaf.index()]) {
                Some(t_max) if t_max != end => {
                    end = t_max;
                    caster.narrow(&mut walk.window, end);
                }
                Some(_) => {}
                None => return,
            }
        }
    }
}

/// A walk to the next box, to be compiled for each kind of vectors.
struct Step<'a> {
    nodes: &'a [Node<WIDTH>],
    ray: &'a Caster,
    walk: &'a mut Walk,
}

impl Job<WIDTH> for Step<'_> {
    type Output = Option<Stop>;

    #[inline(always)]
    fn run<S: Lanes<WIDTH>>(self) -> Option<Stop> {
        let Self { nodes, ray, walk } = self;
        walk.next::<S, false, WIDTH, _>(nodes, ray, &mut Boxes, &mut Silent)
    }
}

/// The leaves of the tree: each is worth a look.
struct Boxes;

impl Leaves<WIDTH> for Boxes {
    type Test<S> = ();

    #[inline(always)]
    fn constants<S: Lanes<WIDTH>>(&self) {}

    #[inline(always)]
    fn test<S: Lanes<WIDTH>>(&mut self, (): &(), _: ChildRef, _: &mut Window) -> u32 {
        1
    }

    #[inline(always)]
    fn announce(&self, _: ChildRef) {}
}
