//! The traversal loop: one for every width, for closest and any hit, for trees and forests.
//!
//! Children are visited nearest first; those left behind wait on a stack with their distance
//! and are dropped when a hit nearer than that has been found meanwhile.

use super::caster::{Caster, Window};
use super::count::Counter;
use super::hit::{Hit, Search, key};
use super::layout::{Block, ChildRef, Node};
use super::simd::{Entry, Lanes, Stack, StackSpace, prefetch};
use crate::math::UNIT_ROUNDOFF;

/// A ray's constants for the box test, in vectors.
struct BoxTest<S> {
    near_inverse: [S; 3],
    far_inverse: [S; 3],
    near_offset: [S; 3],
    far_offset: [S; 3],
    near_side: [usize; 3],
}

impl<S> BoxTest<S> {
    #[inline(always)]
    fn new<const W: usize>(ray: &Caster) -> Self
    where
        S: Lanes<W>,
    {
        Self {
            near_inverse: splat(ray.near_inverse),
            far_inverse: splat(ray.far_inverse),
            near_offset: splat(ray.near_offset),
            far_offset: splat(ray.far_offset),
            near_side: ray.near_side,
        }
    }

    /// Which children the ray may meet within `near` to `far`, and where it enters them.
    #[inline(always)]
    fn test<const W: usize>(&self, node: &Node<W>, near: S, far: S) -> (u32, S)
    where
        S: Lanes<W>,
    {
        let enter = |axis: usize| {
            let plane = S::load(&node.planes[self.near_side[axis]][axis]);
            plane.mul_sub(self.near_inverse[axis], self.near_offset[axis])
        };
        let leave = |axis: usize| {
            let plane = S::load(&node.planes[1 - self.near_side[axis]][axis]);
            plane.mul_sub(self.far_inverse[axis], self.far_offset[axis])
        };
        // In pairs: the next step of the walk waits for the result.
        let enter = enter(0).max(enter(1)).max(enter(2).max(near));
        let leave = leave(0).min(leave(1)).min(leave(2).min(far));
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
pub(super) fn walk<S, const W: usize, C: Counter>(
    nodes: &[Node<W>],
    ray: &Caster,
    mut window: Window,
    counter: &mut C,
    mut visitor: impl Visitor<C>,
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
            if let Some(child) = nearest_child(node, mask, enter, &mut stack, announce) {
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
#[inline(always)]
fn nearest_child<S, const W: usize>(
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

/// A ray's constants for the triangle filter, in vectors.
pub(super) struct Filter<S> {
    axes: [usize; 3],
    origin: [S; 3],
    shear: [S; 2],
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
        }
    }

    /// The triangles of `block` that are not certain to be missed: a superset of those that
    /// [`ExactRay::cross`](super::triangle::ExactRay::cross) accepts within the window.
    ///
    /// The same sheared edge functions as there, in `f32`. With R the largest sheared and Z
    /// the largest main coordinate, each sheared coordinate is off by at most 2uR + 4uZ, an
    /// edge function hence by less than 12uR² + 16uRZ + 32u²Z²; what is compared with,
    /// e = 20u(R + 4uZ)(R + Z), is more. A triangle is out where one edge function is certainly
    /// negative and another certainly positive. A NaN makes nothing certain.
    #[inline(always)]
    pub fn test<const W: usize>(&self, block: &Block<W>, count: u32, window: &Window) -> u32
    where
        S: Lanes<W>,
    {
        let a = self.shear(&block.corners[0]);
        let b = self.shear(&block.corners[1]);
        let c = self.shear(&block.corners[2]);
        let (u, v, w) = (edge(c, b), edge(a, c), edge(b, a));

        let x = a[0].max_abs(b[0]).max_abs(c[0]);
        let y = a[1].max_abs(b[1]).max_abs(c[1]);
        let z = a[2].max_abs(b[2]).max_abs(c[2]);
        let r = x.max(y);
        let error = z
            .mul_add(S::splat(4.0 * UNIT_ROUNDOFF), r)
            .mul(S::splat(20.0 * UNIT_ROUNDOFF))
            .mul_add(r.add(z), S::splat(f32::MIN_POSITIVE));
        let negative = u.min(v).min(w).lt(S::splat(0.0).sub(error));
        let positive = error.lt(u.max(v).max(w));
        let lanes = !(negative & positive) & (u32::MAX >> (32 - count));
        if lanes == 0 {
            return 0;
        }

        let depth = u.mul_add(a[2], v.mul_add(b[2], w.mul(c[2])));
        let area = u.add(v.add(w));
        lanes & !Self::certainly_outside(depth, area, error, z, window)
    }

    /// Which crossings, at depth `depth / area`, are not in the window for certain.
    ///
    /// Where a triangle is crossed its edge functions have one sign, up to their error e. Then
    /// the computed area A is off by at most 4e + 2u|A|, which leaves its sign certain beyond
    /// 8e, and `depth`, a sum of edge functions times main coordinates of at most Z, by at most
    /// Z(4e + 5u|A|). So the difference of depth·sgn A and h|A| is off by less than
    /// (Z + |h|)(4e + 5u|A|); what is compared with is twice that.
    #[inline(always)]
    fn certainly_outside<const W: usize>(
        depth: S,
        area: S,
        error: S,
        z: S,
        window: &Window,
    ) -> u32
    where
        S: Lanes<W>,
    {
        let size = area.max_abs(area);
        let depth = depth.with_sign_flipped_by(area);
        let doubt = size
            .mul(S::splat(10.0 * UNIT_ROUNDOFF))
            .add(error.mul(S::splat(8.0)));
        let [low, high] = window.depth;
        let room = |limit: f32| {
            z.add(S::splat(limit.abs()))
                .mul_add(doubt, S::splat(f32::MIN_POSITIVE))
        };
        let before = room(low).lt(size.mul_sub(S::splat(low), depth));
        let beyond = room(high).lt(size.neg_mul_add(S::splat(high), depth));
        (before | beyond) & doubt.lt(size)
    }

    /// One corner of each triangle, moved so that the ray starts at the origin and sheared so
    /// that it runs along the last axis.
    #[inline(always)]
    fn shear<const W: usize>(&self, points: &[[f32; W]; 3]) -> [S; 3]
    where
        S: Lanes<W>,
    {
        let z = S::load(&points[self.axes[2]]).sub(self.origin[2]);
        let x = S::load(&points[self.axes[0]]).sub(self.origin[0]);
        let y = S::load(&points[self.axes[1]]).sub(self.origin[1]);
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

/// Looks at the first `count` triangles of a block for hits that are better than the best, and
/// narrows `window` to them; returns whether the search is over.
///
/// With `ANY` the first hit that `accept` likes ends it.
#[inline(always)]
#[allow(clippy::too_many_arguments)] // the state of one loop, kept in registers
pub(super) fn search_block<S, const W: usize, const ANY: bool, C: Counter>(
    block: &Block<W>,
    count: u32,
    ray: &Caster,
    filter: &Filter<S>,
    search: &mut Search,
    window: &mut Window,
    instance: u32,
    accept: &impl Fn(&Hit) -> bool,
    counter: &mut C,
) -> bool
where
    S: Lanes<W>,
{
    counter.leaf();
    let mut lanes = filter.test(block, count, window);
    while lanes != 0 {
        let lane = lanes.trailing_zeros() as usize % W;
        lanes &= lanes - 1;
        counter.triangle();
        let corners = block.corners_of(lane, ray.axes);
        let Some(crossing) = ray.exact().cross(&corners) else {
            continue;
        };
        let triangle = block.triangles[lane];
        if !search.is_better(crossing.t, key(instance, triangle)) {
            continue;
        }
        let hit = Hit {
            t: crossing.t,
            u: crossing.u,
            v: crossing.v,
            triangle,
            instance,
        };
        if accept(&hit) {
            search.keep(hit);
            if ANY {
                return true;
            }
            *window = ray.window(search);
        }
    }
    false
}
