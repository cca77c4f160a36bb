//! Small subtrees: split in two down to the leaves, then collapsed to wide nodes at the least
//! expected cost.
//!
//! Cutting straight into `W` parts leaves the lowest nodes nearly empty wherever the number of
//! triangles is a little above what one more level would hold. Dynamic programming over the
//! binary tree finds the wide tree with the least total area of nodes instead (Ylitie, Karras
//! and Laine 2017, "Efficient Incoherent Ray Traversal on GPUs Through Compressed Wide BVHs").

use std::ops::Range;

use super::primitive::{Bounds, Part};

/// A node or leaf of the binary tree.
pub(super) struct Branch<const W: usize> {
    pub bounds: Bounds,
    /// The primitives below, counted from the first of the subtree.
    pub range: Range<usize>,
    /// Places in [`Branches`]; `None` in a leaf.
    children: Option<[usize; 2]>,
    /// How many of a wide node's `W` slots go to the first child.
    own_slots: usize,
    /// Least cost of everything below when it may take up to `i + 1` slots of a node above.
    costs: [f64; W],
    /// How many of `i + 1` slots go to the first child; 0 where one slot less does as well.
    slots: [u8; W],
}

/// The binary tree of a small part.
pub(super) struct Branches<const W: usize> {
    branches: Vec<Branch<W>>,
}

impl<const W: usize> Branches<W> {
    /// Splits `part` with `split` (told the depth) until `leaf_size` or fewer are left.
    pub fn grow(
        part: Part<'_>,
        leaf_size: usize,
        split: &impl for<'p> Fn(Part<'p>, usize) -> (Part<'p>, Part<'p>),
    ) -> Self {
        let mut tree = Self {
            branches: Vec::with_capacity(1 + 4 * part.primitives.len() / leaf_size),
        };
        tree.add(part, 0, 0, leaf_size, split);
        tree
    }

    /// The top.
    pub fn root(&self) -> &Branch<W> {
        &self.branches[self.branches.len() - 1]
    }

    fn add(
        &mut self,
        part: Part<'_>,
        first: usize,
        depth: usize,
        leaf_size: usize,
        split: &impl for<'p> Fn(Part<'p>, usize) -> (Part<'p>, Part<'p>),
    ) -> usize {
        let bounds = part.bounds;
        let range = first..first + part.primitives.len();
        let branch = if range.len() <= leaf_size {
            Branch::leaf(bounds, range)
        } else {
            let (left, right) = split(part, depth);
            let middle = first + left.primitives.len();
            let children = [
                self.add(left, first, depth + 1, leaf_size, split),
                self.add(right, middle, depth + 1, leaf_size, split),
            ];
            let [left, right] = children.map(|i| &self.branches[i].costs);
            let (costs, slots, own_slots) = share_slots(bounds.half_area(), left, right);
            Branch {
                bounds,
                range,
                children: Some(children),
                own_slots,
                costs,
                slots,
            }
        };
        self.branches.push(branch);
        self.branches.len() - 1
    }

    /// What fills the slots of the wide node of `branch`; nothing where that is a leaf.
    pub fn slots_of(&self, branch: &Branch<W>) -> Vec<&Branch<W>> {
        let mut found = Vec::with_capacity(W);
        if let Some([left, right]) = branch.children {
            self.collect(left, branch.own_slots, &mut found);
            self.collect(right, W - branch.own_slots, &mut found);
        }
        found
    }

    /// Adds what `branches[at]` puts into `count` slots.
    fn collect<'a>(&'a self, at: usize, count: usize, found: &mut Vec<&'a Branch<W>>) {
        let branch = &self.branches[at];
        match (branch.children, count) {
            (None, _) | (_, 1) => found.push(branch),
            (Some([left, right]), _) => match usize::from(branch.slots[count - 1]) {
                0 => self.collect(at, count - 1, found),
                share => {
                    self.collect(left, share, found);
                    self.collect(right, count - share, found);
                }
            },
        }
    }
}

impl<const W: usize> Branch<W> {
    /// All leaves are tested as a whole, so each costs its area however it is placed.
    fn leaf(bounds: Bounds, range: Range<usize>) -> Self {
        Self {
            bounds,
            range,
            children: None,
            own_slots: 0,
            costs: [bounds.half_area(); W],
            slots: [0; W],
        }
    }

    /// Whether it holds primitives rather than children.
    pub fn is_leaf(&self) -> bool {
        self.children.is_none()
    }
}

/// Costs and slots of a branch of that area over children with those costs, and the share of
/// the first child where the branch is a wide node itself.
fn share_slots<const W: usize>(
    area: f64,
    left: &[f64; W],
    right: &[f64; W],
) -> ([f64; W], [u8; W], usize) {
    let best_share = |count: usize| {
        (1..count)
            .map(|share| (left[share - 1] + right[count - share - 1], share))
            .fold((f64::INFINITY, 1), |best, next| {
                if next.0 < best.0 { next } else { best }
            })
    };
    let (below, own_slots) = best_share(W);
    let mut costs = [below + area; W];
    let mut slots = [0; W];
    for count in 2..=W {
        let (cost, share) = if count == W {
            (below, own_slots)
        } else {
            best_share(count)
        };
        costs[count - 1] = costs[count - 2];
        if cost < costs[count - 1] {
            costs[count - 1] = cost;
            slots[count - 1] = share as u8;
        }
    }
    (costs, slots, own_slots)
}
