//! The traversal loop: one for every width, for closest and any hit, for trees and forests.
//!
//! Children are visited nearest first; those left behind wait on a stack with their distance
//! and are dropped when a hit nearer than that has been found meanwhile.

use super::caster::{Caster, FAR_PAD, PRODUCT_PAD, Window};
use super::count::Counter;
use super::layout::{ChildRef, Node};
use super::simd::{Entry, Lanes, Stack, StackSpace, prefetch};

/// A ray's constants for the box test, in vectors.
struct BoxTest<S> {
    axes: [AxisTest<S>; 3],
}

/// Those for one axis.
struct AxisTest<S> {
    near_side: usize,
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
        let start = S::splat(ray.start[axis]);
        let pad = S::splat(ray.pad[axis]);
        let near_inverse = S::splat(ray.inverse[axis]);
        let far_inverse = near_inverse.mul(S::splat(FAR_PAD));
        let near = start.mul(near_inverse);
        let far = start.mul(far_inverse);
        Self {
            near_side: ray.near_side[axis],
            near_inverse,
            far_inverse,
            near_offset: near
                .max_abs(near)
                .mul_add(S::splat(PRODUCT_PAD), near.add(pad)),
            far_offset: far
                .max_abs(far)
                .neg_mul_add(S::splat(PRODUCT_PAD), far.sub(pad)),
        }
    }

    #[inline(always)]
    fn enter<const W: usize>(&self, node: &Node<W>, axis: usize) -> S
    where
        S: Lanes<W>,
    {
        let plane = S::load(&node.planes[self.near_side][axis]);
        plane.mul_sub(self.near_inverse, self.near_offset)
    }

    #[inline(always)]
    fn leave<const W: usize>(&self, node: &Node<W>, axis: usize) -> S
    where
        S: Lanes<W>,
    {
        let plane = S::load(&node.planes[1 - self.near_side][axis]);
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
        let enter = x.enter(node, 0).max(y.enter(node, 1));
        let enter = enter.max(z.enter(node, 2).max(near));
        let leave = x.leave(node, 0).min(y.leave(node, 1));
        let leave = leave.min(z.leave(node, 2).min(far));
        (enter.le(leave), enter)
    }
}

/// What is done at a leaf.
pub(super) trait Visitor<C> {
    /// Looks at `leaf`, narrows `window` to what may still hold a better hit, and says whether
    /// the search is over. Must be `#[inline(always)]`: a function of its own, such as a
    /// closure may become, would lack the instruction set of the walk.
    fn visit(&mut self, leaf: ChildRef, window: &mut Window, counter: &mut C) -> bool;

    /// Is told that `leaf` will be visited soon. `#[inline(always)]`, too.
    fn announce(&self, leaf: ChildRef);
}

/// Walks from the first of `nodes` to the leaves that may hold a better hit, nearest first.
#[inline(always)]
pub(super) fn walk<S, const ANY: bool, const W: usize, C: Counter>(
    nodes: &[Node<W>],
    ray: &Caster,
    mut window: Window,
    counter: &mut C,
    visitor: &mut impl Visitor<C>,
) where
    S: Lanes<W>,
{
    let boxes = BoxTest::<S>::new(ray);
    let near = S::splat(window.near);
    let mut space = StackSpace::new();
    let mut stack = Stack::new(&mut space);
    let mut current = ChildRef::node(0);
    loop {
        if current.is_leaf() {
            if visitor.visit(current, &mut window, counter) {
                return;
            }
        } else {
            counter.node();
            let node = &nodes[current.index()];
            let (mask, enter) = boxes.test(node, near, S::splat(window.far));
            let announce = |entry: Entry| match entry.child() {
                leaf if leaf.is_leaf() => visitor.announce(leaf),
                child => prefetch(nodes, child.index()),
            };
            if let Some(child) = nearest_child::<S, ANY, W>(node, mask, enter, &mut stack, announce) {
                current = child;
                continue;
            }
        }
        loop {
            match stack.pop() {
                Some(entry) if entry.distance() <= window.far => {
                    current = entry.child();
                    break;
                }
                Some(_) => {}
                None => return,
            }
        }
    }
}

/// The nearest of the children in `mask`; pushes the others, farthest first.
///
/// Where any hit will do (`ANY`) the order matters little: only the first two are sorted.
#[inline(always)]
fn nearest_child<S, const ANY: bool, const W: usize>(
    node: &Node<W>,
    mask: u32,
    enter: S,
    stack: &mut Stack,
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
