//! The traversal loop: one for every width, for closest and any hit, for trees and forests.
//!
//! Children are visited nearest first; those left behind wait on a stack with their distance
//! and are dropped when a hit nearer than that has been found meanwhile.

use super::caster::{Caster, Window};
use super::count::Counter;
use super::layout::{ChildRef, Node};
use super::simd::{Entry, Lanes, Stack, Waiting, prefetch};

/// A ray's constants for the box test, in vectors.
struct BoxTest<S> {
    axes: [AxisTest<S>; 3],
}

/// Those for one axis.
struct AxisTest<S> {
    near_row: usize,
    far_row: usize,
    near_inverse: S,
    far_inverse: S,
    /// What is subtracted from a near plane times `near_inverse`.
    near_offset: S,
    /// What is subtracted from a far plane times `far_inverse`.
    far_offset: S,
}

impl<S> AxisTest<S> {
    #[inline(always)]
    fn new<const W: usize>(ray: &Caster, axis: usize) -> Self
    where
        S: Lanes<W>,
    {
        Self {
            near_row: axis + 3 * usize::from(ray.towards_lower[axis]),
            far_row: axis + 3 * usize::from(!ray.towards_lower[axis]),
            near_inverse: S::splat(ray.near_inverse[axis]),
            far_inverse: S::splat(ray.far_inverse[axis]),
            near_offset: S::splat(ray.near_offset[axis]),
            far_offset: S::splat(ray.far_offset[axis]),
        }
    }

    #[inline(always)]
    fn enter<const W: usize>(&self, node: &Node<W>) -> S
    where
        S: Lanes<W>,
    {
        let plane = S::load(&node.planes[self.near_row]);
        plane.mul_sub(self.near_inverse, self.near_offset)
    }

    #[inline(always)]
    fn leave<const W: usize>(&self, node: &Node<W>) -> S
    where
        S: Lanes<W>,
    {
        let plane = S::load(&node.planes[self.far_row]);
        plane.mul_sub(self.far_inverse, self.far_offset)
    }
}

impl<S> BoxTest<S> {
    #[inline(always)]
    fn new<const W: usize>(ray: &Caster) -> Self
    where
        S: Lanes<W>,
    {
        Self {
            axes: [
                AxisTest::new(ray, 0),
                AxisTest::new(ray, 1),
                AxisTest::new(ray, 2),
            ],
        }
    }

    /// Which children the ray may meet within `near` to `far`, and where it enters them.
    #[inline(always)]
    fn test<const W: usize>(&self, node: &Node<W>, near: S, far: S) -> (u32, S)
    where
        S: Lanes<W>,
    {
        let [x, y, z] = &self.axes;
        // In pairs: the next step of the walk waits for the result.
        let enter = x.enter(node).max(y.enter(node));
        let enter = enter.max(z.enter(node).max(near));
        let leave = x.leave(node).min(y.leave(node));
        let leave = leave.min(z.leave(node).min(far));
        (enter.le(leave), enter)
    }
}

/// What stands at the leaves of a walk.
pub(super) trait Leaves<const W: usize> {
    /// A ray's constants for it, in vectors.
    type Test<S>;
    /// Makes them. As all of these functions `#[inline(always)]`: one of its own, such as a
    /// closure may become, would lack the instruction set of the walk.
    fn constants<S: Lanes<W>>(&self) -> Self::Test<S>;
    /// Which things in `leaf` may be hit within `window`, which it may narrow: where there are any the walk pauses.
    fn test<S: Lanes<W>>(
        &mut self,
        test: &Self::Test<S>,
        leaf: ChildRef,
        window: &mut Window,
    ) -> u32;
    /// Is told that `leaf` will be visited soon.
    fn announce(&self, leaf: ChildRef);
}

/// A pause of a walk.
pub(super) struct Stop {
    /// The leaf it came to.
    pub leaf: ChildRef,
    /// What [`Leaves::test`] said of it.
    pub lanes: u32,
}

/// A walk through a tree, nearest children first, that pauses at leaves with something in them.
///
/// It pauses so that what is done there, which is scalar and much longer, is compiled apart and
/// does not crowd the loop's constants out of the registers.
pub(super) struct Walk {
    waiting: Waiting,
    /// Where hits still matter. To be narrowed at leaves and in a pause.
    pub window: Window,
}

impl Walk {
    /// From `root` down.
    #[inline(always)]
    pub fn new(root: ChildRef, window: Window) -> Self {
        let mut waiting = Waiting::new();
        let mut stack = waiting.stack();
        stack.push(Entry::new(window.near, root));
        stack.keep();
        Self { waiting, window }
    }

    /// Goes on to the next leaf that has something in it; `None` at the end, which ends the walk for good.
    ///
    /// With `ANY` children are not sorted beyond the first two.
    #[inline(always)]
    pub fn next<S, const ANY: bool, const W: usize, L: Leaves<W>>(
        &mut self,
        nodes: &[Node<W>],
        ray: &Caster,
        leaves: &mut L,
        counter: &mut impl Counter,
    ) -> Option<Stop>
    where
        S: Lanes<W>,
    {
        let boxes = BoxTest::<S>::new(ray);
        let test = leaves.constants::<S>();
        let near = S::splat(self.window.near);
        let mut stack = self.waiting.stack();
        loop {
            let mut current = loop {
                let entry = stack.pop()?;
                if entry.distance() <= self.window.far {
                    break entry.child();
                }
            };
            let far = S::splat(self.window.far);
            while !current.is_leaf() {
                counter.node();
                let node = &nodes[current.index()];
                let (mask, enter) = boxes.test(node, near, far);
                let announce = |entry: Entry| match entry.child() {
                    leaf if leaf.is_leaf() => leaves.announce(leaf),
                    child => prefetch(nodes, child.index()),
                };
                match nearest_child::<S, ANY, W>(node, mask, enter, &mut stack, announce) {
                    Some(child) => current = child,
                    None => break,
                }
            }
            if current.is_leaf() {
                counter.leaf();
                let lanes = leaves.test(&test, current, &mut self.window);
                if lanes != 0 {
                    stack.keep();
                    return Some(Stop {
                        leaf: current,
                        lanes,
                    });
                }
            }
        }
    }
}

/// The nearest of the children in `mask`; pushes the others, farthest first.
///
/// Where any hit will do (`ANY`) the order matters little: only the first two are sorted.
#[inline(always)]
pub(super) fn nearest_child<S, const ANY: bool, const W: usize>(
    node: &Node<W>,
    mask: u32,
    enter: S,
    stack: &mut Stack<'_>,
    announce: impl Fn(Entry),
) -> Option<ChildRef>
where
    S: Lanes<W>,
{
    if mask == 0 {
        return None;
    }
    let mut rest = mask;
    let mut next_lane = || {
        let lane = rest.trailing_zeros() as usize % W;
        rest &= rest - 1;
        (lane, rest == 0)
    };
    let (first, last) = next_lane();
    if last {
        return Some(node.children[first]);
    }
    let mut distances = [0.0; W];
    enter.store(&mut distances);
    let entry = |lane: usize| Entry::new(distances[lane], node.children[lane]);
    let (second, last) = next_lane();
    // Two and three are most frequent and are sorted without branches.
    let (a, b) = in_order(entry(first), entry(second));
    announce(b);
    if last {
        stack.push(b);
        return Some(a.child());
    }
    if ANY {
        stack.push(b);
        loop {
            let (lane, last) = next_lane();
            stack.push(entry(lane));
            if last {
                return Some(a.child());
            }
        }
    }
    let (third, mut last) = next_lane();
    let (b, c) = in_order(b, entry(third));
    let (a, b) = in_order(a, b);
    let base = stack.len();
    stack.push(c);
    stack.push(b);
    let mut nearest = a;
    while !last {
        let (lane, ended) = next_lane();
        let (near, far) = in_order(nearest, entry(lane));
        nearest = near;
        stack.insert(base, far);
        last = ended;
    }
    Some(nearest.child())
}

/// The nearer, then the farther.
#[inline(always)]
fn in_order(a: Entry, b: Entry) -> (Entry, Entry) {
    (a.min(b), a.max(b))
}
