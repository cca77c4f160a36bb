//! Packets: rays that run nearly the same way go through a tree together.
//!
//! The tree is walked once for all of them, by what their [`Beam`](crate::bvh::beam::Beam) may meet. At the leaves the beams of
//! groups, as many rays as a vector holds, sort out triangles, and each that is left is tested against all rays
//! of its group at once.

use super::{Packet, SIZE};
use crate::bvh::beam::BeamTest;
use crate::bvh::hit::HitRow;
use crate::bvh::layout::{ChildRef, Tree};
use crate::bvh::simd::{Entry, Job, Lanes, Waiting, prefetch};
use crate::bvh::traverse::nearest_child;
use crate::math::RayRow;

/// The most groups of a packet: of 8 rays.
const GROUPS: usize = SIZE / 8;

/// Slopes that differ by more are not traced together: the beam would hold much that no ray meets.
const MOST_SPREAD: f32 = 0.6;

/// Packets that have been to so many leaves and are not done are broken up: what the beam holds is too much of too small triangles.
const MOST_LOOKS: usize = 80;

/// The same for rays that end at any hit, with what waits to be visited: little of that will be behind a hit.
const MOST_WORK: usize = 28;

/// The way of some rays through a tree, to be compiled for each kind of vectors.
///
/// With `ANY` each ray's first hit, wherever it is, ends its search, and only [`HitRow::is_hit`] is told.
pub(in crate::bvh) struct Together<'a, const ANY: bool, const W: usize> {
    pub tree: &'a Tree<W>,
    /// Largest coordinate of the tree.
    pub reach: f32,
    /// At least one.
    pub rays: &'a RayRow,
    /// What they find.
    pub found: &'a mut HitRow,
}

impl<const ANY: bool, const W: usize> Job<W> for Together<'_, ANY, W> {
    /// The rays whose search is to be gone on with one by one, a bit for each: all of them where they do not run
    /// the same way.
    type Output = u64;

    #[inline(always)]
    fn run<S: Lanes<W>>(self) -> u64 {
        let Self {
            tree,
            reach,
            rays,
            found,
        } = self;
        let mut packet = Packet::new::<W>(rays, found, reach);
        if !packet.are_alike(reach) {
            return u64::MAX;
        }
        let groups = packet.groups;
        let (mut all, size) = packet.beam::<S, W>(0);
        let mut beams = [all; GROUPS];
        packet.course.size = if size > reach { size } else { reach };
        for (group, kept) in beams.iter_mut().enumerate().take(groups).skip(1) {
            let (beam, size) = packet.beam::<S, W>(group);
            all = all.union(&beam);
            *kept = beam;
            if size > packet.course.size {
                packet.course.size = size;
            }
        }
        let is_narrow = all.slopes[0].high - all.slopes[0].low <= MOST_SPREAD
            && all.slopes[1].high - all.slopes[1].low <= MOST_SPREAD;
        if !is_narrow {
            return packet.live;
        }

        for beam in &mut beams {
            *beam = beam.widened(&packet.course);
        }
        let beam = BeamTest::<S>::new(&packet.course, &all.widened(&packet.course));
        let mut fars = [0.0; GROUPS];
        for (group, far) in fars.iter_mut().enumerate().take(groups) {
            *far = packet.far::<S, W>(group);
        }
        let mut far = greatest(&fars);
        let mut looks = 0;
        let mut rest = 0;
        let mut waiting = Waiting::new();
        let mut stack = waiting.stack();
        stack.push(Entry::new(0.0, ChildRef::node(0)));
        while let Some(entry) = stack.pop() {
            if entry.distance() > far {
                continue;
            }
            let mut current = entry.child();
            while !current.is_leaf() {
                let node = &tree.nodes[current.index()];
                let (mask, enter) = beam.children(node, S::splat(far));
                let announce = |entry: Entry| match entry.child() {
                    leaf if leaf.is_leaf() => prefetch(&tree.blocks, leaf.index()),
                    child => prefetch(&tree.nodes, child.index()),
                };
                match nearest_child::<S, false, W>(node, mask, enter, &mut stack, announce) {
                    Some(child) => current = child,
                    None => break,
                }
            }
            if !current.is_leaf() {
                continue;
            }
            let block = &tree.blocks[current.index()];
            let there = u32::MAX >> (32 - current.count());
            let mut bounds = None;
            for group in 0..groups {
                if packet.live::<W>(group) == 0 {
                    continue;
                }
                let test = BeamTest::<S>::new(&packet.course, &beams[group]);
                let triangles = there & test.triangles(block, S::splat(fars[group]));
                if triangles == 0 {
                    continue;
                }
                let place = current.index();
                let is_found = packet.meet::<S, ANY, W>(tree, place, triangles, group, &mut bounds);
                if is_found {
                    fars[group] = packet.far::<S, W>(group);
                    far = greatest(&fars);
                }
            }
            if ANY && packet.live == 0 {
                break;
            }
            looks += 1;
            let is_too_much = if ANY {
                looks + stack.len() > MOST_WORK
            } else {
                looks > MOST_LOOKS
            };
            if is_too_much {
                rest = packet.live;
                break;
            }
        }
        if !ANY {
            packet.settle_all(tree);
        }
        rest
    }
}

#[inline(always)]
fn greatest(fars: &[f32; GROUPS]) -> f32 {
    let mut greatest = 0.0;
    for &far in fars {
        if far > greatest {
            greatest = far;
        }
    }
    greatest
}
