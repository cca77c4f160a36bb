//! Small subtrees: split in two down to the leaves, then collapsed to wide nodes at the least
//! expected cost.
//!
//! Cutting straight into `W` parts leaves the lowest nodes nearly empty wherever the number of
//! triangles is a little above what one more level would hold. Dynamic programming over the
//! binary tree finds the wide tree with the least total area of nodes instead (Ylitie, Karras
//! and Laine 2017, "Efficient Incoherent Ray Traversal on GPUs Through Compressed Wide BVHs").

use std::ops::Range;

use super::bounds::Bounds;

/// What the visit of a leaf costs, in visits of nodes: measured, by fitting the times of rays to
/// their counts.
const LEAF_COST: f32 = 3.5;

/// A node or leaf of the binary tree.
pub(super) struct Branch<const W: usize> {
    pub bounds: Bounds,
    /// The primitives below, as places in [`Branches::order`].
    pub range: Range<usize>,
    /// Places in [`Branches`]; `None` in a leaf.
    children: Option<[usize; 2]>,
    /// Leaves below, but no more than `W`.
    leaves: usize,
    /// How many of a wide node's `W` slots go to the first child.
    own_slots: usize,
    /// Least cost of everything below when it may take up to `i + 1` slots of a node above.
    costs: [f32; W],
    /// How many of `i + 1` slots go to the first child; 0 where one slot less does as well.
    slots: [u8; W],
}

/// The binary tree of a small part; children come before their parents.
pub(super) struct Branches<const W: usize> {
    branches: Vec<Branch<W>>,
    /// Numbers of the primitives, leaf by leaf.
    pub order: Vec<u32>,
    /// What areas are multiplied by to become costs.
    scale: f64,
}

impl<const W: usize> Branches<W> {
    /// Without branches; `bounds` is around all that will come.
    pub fn new(bounds: &Bounds) -> Self {
        // Areas as shares of the whole are at most 1, as f32 wants it.
        let area = bounds.half_area();
        Self {
            branches: Vec::new(),
            order: Vec::new(),
            scale: if area > 0.0 { 1.0 / area } else { 0.0 },
        }
    }

    /// The branch that was added last: the top.
    pub fn root(&self) -> &Branch<W> {
        &self.branches[self.branches.len() - 1]
    }

    /// Expected cost of a ray that meets the bounds, in visits of nodes.
    pub fn cost(&self) -> f32 {
        self.root().costs[0]
    }

    /// Adds a leaf of the primitives with those numbers; returns its place.
    pub fn add_leaf(&mut self, bounds: Bounds, numbers: impl Iterator<Item = u32>) -> usize {
        let first = self.order.len();
        self.order.extend(numbers);
        // All leaves are tested as a whole, so each costs the same however it is placed.
        let cost = LEAF_COST * (bounds.half_area() * self.scale) as f32;
        self.add(Branch {
            bounds,
            range: first..self.order.len(),
            children: None,
            leaves: 1,
            own_slots: 0,
            costs: [cost; W],
            slots: [0; W],
        })
    }

    /// Adds a node over two branches that are there, the last two subtrees; returns its place.
    pub fn add_node(&mut self, bounds: Bounds, children: [usize; 2]) -> usize {
        let [left, right] = children.map(|i| &self.branches[i]);
        let range = left.range.start..right.range.end;
        let leaves = (left.leaves + right.leaves).min(W);
        let area = (bounds.half_area() * self.scale) as f32;
        let (costs, slots, own_slots) = share_slots(area, left, right);
        self.add(Branch {
            bounds,
            range,
            children: Some(children),
            leaves,
            own_slots,
            costs,
            slots,
        })
    }

    fn add(&mut self, branch: Branch<W>) -> usize {
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
    /// Whether it holds primitives rather than children.
    pub fn is_leaf(&self) -> bool {
        self.children.is_none()
    }
}

/// Costs and slots of a branch of that area over two children, and the share of the first
/// child where the branch is a wide node itself.
fn share_slots<const W: usize>(
    area: f32,
    left: &Branch<W>,
    right: &Branch<W>,
) -> ([f32; W], [u8; W], usize) {
    // More slots than leaves are of no use.
    let best_share = |count: usize| {
        let least = count.saturating_sub(right.leaves).max(1);
        let most = left.leaves.min(count - 1);
        (least..=most)
            .map(|share| {
                (
                    left.costs[share - 1] + right.costs[count - share - 1],
                    share,
                )
            })
            .fold((f32::INFINITY, 1), |best, next| {
                if next.0 < best.0 { next } else { best }
            })
    };
    let leaves = (left.leaves + right.leaves).min(W);
    let (below, own_slots) = best_share(leaves);
    let mut costs = [below + area; W];
    let mut slots = [0; W];
    for count in 2..=W {
        costs[count - 1] = costs[count - 2];
        let (cost, share) = match count {
            _ if count > leaves => continue,
            _ if count == leaves => (below, own_slots),
            _ => best_share(count),
        };
        if cost < costs[count - 1] {
            costs[count - 1] = cost;
            slots[count - 1] = share as u8;
        }
    }
    (costs, slots, own_slots)
}
