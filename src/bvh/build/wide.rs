//! Wide nodes from splits.
//!
//! A node over many primitives is made directly: its part is split in two, then the one with the
//! largest box again, until there is a part for each child. These are built in parallel. Small
//! parts become binary trees that are collapsed (`collapse`).

use rayon::prelude::*;

use super::collapse::{Branch, Branches};
use super::fragment::Fragment;
use super::median::split_median;
use super::part::Part;
use super::primitive::Primitive;
use super::{SAH_DEPTH, SMALL, SMALL_SAH_DEPTH};
use crate::bvh::layout::{ChildRef, Node};

/// A way to cut parts in two.
pub(super) trait Splitter: Sync {
    /// Parts of at most so many primitives become leaves.
    fn leaf_size(&self) -> usize;

    /// Parts of at most so many primitives are built by one thread, and collapsed.
    fn small(&self) -> usize {
        SMALL
    }

    /// Cuts `part`, which is larger than a leaf; gives it back where it should be halved.
    fn split<'a>(&self, part: Part<'a>) -> Result<(Part<'a>, Part<'a>), Part<'a>>;

    /// The binary tree of a small part.
    fn grow_small<const W: usize>(&self, part: Part<'_>) -> Branches<W>
    where
        Self: Sized,
    {
        grow_tree(part, self)
    }

    /// Adds what becomes of a part that is no larger than a leaf; returns the place of its root.
    fn grow_leaf<const W: usize>(
        &self,
        part: Part<'_>,
        _depth: usize,
        out: &mut Branches<W>,
    ) -> usize {
        out.add_leaf(part.bounds, part.primitives().iter().map(Primitive::index))
    }
}

/// The whole tree; no node where one leaf is enough, nothing where there are no primitives.
pub(super) fn make_tree<const W: usize>(part: Part<'_>, splitter: &impl Splitter) -> Fragment<W> {
    let mut fragment = Fragment::new();
    if part.len() > 0 {
        make(part, splitter, 0, &mut fragment);
    }
    fragment
}

/// Makes the subtree of `part`.
fn make<const W: usize>(
    part: Part<'_>,
    splitter: &impl Splitter,
    depth: usize,
    out: &mut Fragment<W>,
) -> ChildRef {
    if part.len() > splitter.small() {
        make_large(part, splitter, depth, out)
    } else {
        make_small(part, splitter, out)
    }
}

fn make_large<const W: usize>(
    part: Part<'_>,
    splitter: &impl Splitter,
    depth: usize,
    out: &mut Fragment<W>,
) -> ChildRef {
    let parts = split_widely::<W>(part, splitter, depth < SAH_DEPTH);
    let boxes: Vec<_> = parts.iter().map(|part| part.bounds.to_aabb()).collect();
    let subtrees: Vec<_> = parts
        .into_par_iter()
        .map(|part| {
            let mut fragment = Fragment::new();
            let root = make(part, splitter, depth + 1, &mut fragment);
            (fragment, root)
        })
        .collect();
    let index = out.nodes.len();
    out.nodes.push(Node::EMPTY);
    for (lane, (bounds, (fragment, root))) in boxes.iter().zip(subtrees).enumerate() {
        let child = out.append(fragment, root);
        out.nodes[index].set(lane, bounds, child);
    }
    ChildRef::node(index)
}

/// Splits into at most `W` parts: the largest by area, or, once the tree is too deep, in halves
/// by number.
fn split_widely<'a, const W: usize>(
    part: Part<'a>,
    splitter: &impl Splitter,
    by_area: bool,
) -> Vec<Part<'a>> {
    let weight = |part: &Part<'_>| {
        if by_area {
            part.bounds.half_area()
        } else {
            part.len() as f64
        }
    };
    let mut parts = vec![part];
    while parts.len() < W {
        let largest = (0..parts.len())
            .filter(|&i| parts[i].len() > splitter.leaf_size())
            .max_by(|&i, &j| weight(&parts[i]).total_cmp(&weight(&parts[j])));
        let Some(largest) = largest else { break };
        let (left, right) = split(parts.swap_remove(largest), splitter, by_area);
        parts.extend([left, right]);
    }
    parts
}

fn split<'a>(part: Part<'a>, splitter: &impl Splitter, by_area: bool) -> (Part<'a>, Part<'a>) {
    if by_area {
        splitter.split(part).unwrap_or_else(split_median)
    } else {
        split_median(part)
    }
}

fn make_small<const W: usize>(
    part: Part<'_>,
    splitter: &impl Splitter,
    out: &mut Fragment<W>,
) -> ChildRef {
    let branches = splitter.grow_small(part);
    emit(&branches, branches.root(), out)
}

/// The binary tree of a small part by nothing but splits.
pub(super) fn grow_tree<const W: usize>(part: Part<'_>, splitter: &impl Splitter) -> Branches<W> {
    let mut branches = Branches::new(&part.bounds);
    grow(part, splitter, 0, &mut branches);
    branches
}

/// Adds the binary tree of `part`; returns the place of its root.
pub(super) fn grow<const W: usize>(
    part: Part<'_>,
    splitter: &impl Splitter,
    depth: usize,
    out: &mut Branches<W>,
) -> usize {
    if part.len() <= splitter.leaf_size() {
        return splitter.grow_leaf(part, depth, out);
    }
    let bounds = part.bounds;
    let (left, right) = split(part, splitter, depth < SMALL_SAH_DEPTH);
    let left = grow(left, splitter, depth + 1, out);
    let right = grow(right, splitter, depth + 1, out);
    out.add_node(bounds, [left, right])
}

/// Writes the collapsed subtree of `branch`.
fn emit<const W: usize>(
    branches: &Branches<W>,
    branch: &Branch<W>,
    out: &mut Fragment<W>,
) -> ChildRef {
    if branch.is_leaf() {
        return out.add_leaf(&branches.order[branch.range.clone()]);
    }
    let index = out.nodes.len();
    out.nodes.push(Node::EMPTY);
    for (lane, slot) in branches.slots_of(branch).into_iter().enumerate() {
        let child = emit(branches, slot, out);
        out.nodes[index].set(lane, &slot.bounds.to_aabb(), child);
    }
    ChildRef::node(index)
}
