//! From triangles to a tree.
//!
//! A wide node over many primitives is made directly: its range is split in two, then the part
//! with the largest box again, until there is a part for each child. These are built in
//! parallel. Small parts become binary trees that are collapsed (`collapse`). Where a split falls and how nodes are numbered depends on the triangles alone,
//! so the tree is the same for any number of threads.

mod collapse;
mod primitive;
mod split;

use rayon::prelude::*;

use super::layout::{Block, ChildRef, MAX_DEPTH, Node, Tree};
use crate::math::{Aabb, Vec3};
use collapse::{Branch, Branches};
use primitive::{Part, Primitive, corners, primitives};
use split::{split_median, split_sah};

/// How a tree is built.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Builder {
    /// At the median of the longest axis, at most 4 triangles a leaf: the baseline.
    Median,
    /// Surface area heuristic over bins: the default.
    #[default]
    Balanced,
    /// No tree: every ray meets every triangle.
    None,
}

impl Builder {
    /// All of them.
    pub const ALL: [Self; 3] = [Self::Median, Self::Balanced, Self::None];

    /// As in files and on the command line.
    pub fn name(self) -> &'static str {
        match self {
            Self::Median => "median",
            Self::Balanced => "balanced",
            Self::None => "none",
        }
    }
}

impl std::fmt::Display for Builder {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(self.name())
    }
}

impl std::str::FromStr for Builder {
    type Err = String;

    /// The error lists the names there are.
    fn from_str(name: &str) -> Result<Self, String> {
        Self::ALL
            .into_iter()
            .find(|builder| builder.name() == name)
            .ok_or_else(|| {
                let names = Self::ALL.map(Self::name).join(", ");
                format!("\"{name}\" is none of {names}")
            })
    }
}

/// Leaves of [`Builder::Median`] hold at most so many triangles.
const MEDIAN_LEAF: usize = 4;

/// Parts of up to so many primitives are built by one thread, and collapsed.
const SMALL: usize = 1 << SMALL_BITS;
const SMALL_BITS: usize = 12;

/// Levels of nodes over large parts below which the surface area heuristic gives way to
/// halving, which bounds the depth: a node of 8 children or more takes 3 bits off the size.
const SAH_DEPTH: usize = 16;

/// The same for levels of binary splits in small parts.
const SMALL_SAH_DEPTH: usize = 24;

const _: () =
    assert!(SAH_DEPTH + (31 - SMALL_BITS).div_ceil(3) + SMALL_SAH_DEPTH + SMALL_BITS <= MAX_DEPTH);

/// Builds the tree of all triangles that can be hit.
pub(super) fn build<const W: usize>(
    positions: &[Vec3],
    indices: &[[u32; 3]],
    builder: Builder,
) -> Tree<W> {
    let mut primitives = primitives(positions, indices);
    let triangles = primitives.len();
    let make_block = |primitives: &[Primitive]| {
        let mut block = Block::EMPTY;
        for (lane, primitive) in primitives.iter().enumerate() {
            let triangle = primitive.index();
            let corners = corners(positions, indices[triangle as usize]);
            block.set(lane, &corners.map(|p| p.to_array()), triangle);
        }
        block
    };
    let bounds = Part::new(&mut primitives).bounds.to_aabb();
    let mut fragment = match builder {
        Builder::None => Fragment {
            nodes: Vec::new(),
            leaves: primitives.chunks(W).map(make_block).collect(),
        },
        Builder::Median => Maker::new(MEDIAN_LEAF, false, make_block).make_all(&mut primitives),
        Builder::Balanced => Maker::new(W, true, make_block).make_all(&mut primitives),
    };
    fragment.nodes.shrink_to_fit();
    fragment.leaves.shrink_to_fit();
    Tree {
        bounds,
        nodes: fragment.nodes,
        blocks: fragment.leaves,
        triangles,
    }
}

/// Nodes over numbered boxes, one box a leaf, and the number in each leaf.
pub(super) fn build_over_boxes<const W: usize>(boxes: &[Aabb]) -> (Vec<Node<W>>, Vec<u32>) {
    let mut primitives: Vec<_> = (0..)
        .zip(boxes)
        .filter(|(_, bounds)| !bounds.is_empty())
        .map(|(i, bounds)| Primitive::new(bounds.min, bounds.max, i))
        .collect();
    let fragment =
        Maker::new(1, true, |leaf: &[Primitive]| leaf[0].index()).make_all(&mut primitives);
    (fragment.nodes, fragment.leaves)
}

/// Nodes and leaves of a subtree, numbered from 0 in depth-first order.
struct Fragment<const W: usize, L> {
    nodes: Vec<Node<W>>,
    leaves: Vec<L>,
}

impl<const W: usize, L> Fragment<W, L> {
    fn new() -> Self {
        Self {
            nodes: Vec::new(),
            leaves: Vec::new(),
        }
    }

    /// Appends `other`, whose root is `root`; returns where that is now.
    fn append(&mut self, other: Self, root: ChildRef) -> ChildRef {
        let (nodes, leaves) = (self.nodes.len(), self.leaves.len());
        self.nodes.extend(other.nodes.into_iter().map(|mut node| {
            node.children = node.children.map(|child| child.moved(nodes, leaves));
            node
        }));
        self.leaves.extend(other.leaves);
        root.moved(nodes, leaves)
    }
}

/// Makes nodes by splitting, and leaves with `make_leaf`.
struct Maker<F> {
    /// Ranges of at most so many primitives become leaves.
    leaf_size: usize,
    /// Whether splits go by the surface area heuristic, or halve.
    by_area: bool,
    make_leaf: F,
}

impl<F> Maker<F> {
    fn new(leaf_size: usize, by_area: bool, make_leaf: F) -> Self {
        Self {
            leaf_size,
            by_area,
            make_leaf,
        }
    }

    /// The whole tree; no node where one leaf is enough, nothing where there are no primitives.
    fn make_all<const W: usize, L>(&self, primitives: &mut [Primitive]) -> Fragment<W, L>
    where
        L: Send,
        F: Fn(&[Primitive]) -> L + Sync,
    {
        let mut fragment = Fragment::new();
        if !primitives.is_empty() {
            self.make(Part::new(primitives), 0, &mut fragment);
        }
        fragment
    }

    /// Makes the subtree of `part`.
    fn make<const W: usize, L>(
        &self,
        part: Part<'_>,
        depth: usize,
        out: &mut Fragment<W, L>,
    ) -> ChildRef
    where
        L: Send,
        F: Fn(&[Primitive]) -> L + Sync,
    {
        if part.primitives.len() > SMALL {
            self.make_large(part, depth, out)
        } else {
            self.make_small(part, out)
        }
    }

    fn make_large<const W: usize, L>(
        &self,
        part: Part<'_>,
        depth: usize,
        out: &mut Fragment<W, L>,
    ) -> ChildRef
    where
        L: Send,
        F: Fn(&[Primitive]) -> L + Sync,
    {
        let parts = self.split_widely::<W>(part, self.by_area && depth < SAH_DEPTH);
        let boxes: Vec<_> = parts.iter().map(|part| part.bounds.to_aabb()).collect();
        let subtrees: Vec<_> = parts
            .into_par_iter()
            .map(|part| {
                let mut fragment = Fragment::new();
                let root = self.make(part, depth + 1, &mut fragment);
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

    fn make_small<const W: usize, L>(&self, part: Part<'_>, out: &mut Fragment<W, L>) -> ChildRef
    where
        F: Fn(&[Primitive]) -> L,
    {
        let Part {
            primitives,
            bounds,
            centroids,
        } = part;
        let part = Part {
            primitives: &mut *primitives,
            bounds,
            centroids,
        };
        let branches = Branches::<W>::grow(part, self.leaf_size, &|part, depth| {
            self.split(part, self.by_area && depth < SMALL_SAH_DEPTH)
        });
        self.emit(&branches, branches.root(), primitives, out)
    }

    /// Writes the collapsed subtree of `branch`, whose tree is over `primitives`.
    fn emit<const W: usize, L>(
        &self,
        branches: &Branches<W>,
        branch: &Branch<W>,
        primitives: &[Primitive],
        out: &mut Fragment<W, L>,
    ) -> ChildRef
    where
        F: Fn(&[Primitive]) -> L,
    {
        if branch.is_leaf() {
            let leaf = &primitives[branch.range.clone()];
            out.leaves.push((self.make_leaf)(leaf));
            return ChildRef::leaf(out.leaves.len() - 1, leaf.len());
        }
        let index = out.nodes.len();
        out.nodes.push(Node::EMPTY);
        for (lane, slot) in branches.slots_of(branch).into_iter().enumerate() {
            let child = self.emit(branches, slot, primitives, out);
            out.nodes[index].set(lane, &slot.bounds.to_aabb(), child);
        }
        ChildRef::node(index)
    }

    /// Splits in two.
    fn split<'a>(&self, part: Part<'a>, by_area: bool) -> (Part<'a>, Part<'a>) {
        if by_area {
            split_sah(part, self.leaf_size)
        } else {
            split_median(part)
        }
    }

    /// Splits into at most `W` parts: by area and heuristic, or into equal halves.
    fn split_widely<'a, const W: usize>(&self, part: Part<'a>, by_area: bool) -> Vec<Part<'a>> {
        let weight = |part: &Part<'_>| {
            if by_area {
                part.bounds.half_area()
            } else {
                part.primitives.len() as f64
            }
        };
        let mut parts = vec![part];
        while parts.len() < W {
            let largest = (0..parts.len())
                .filter(|&i| parts[i].primitives.len() > self.leaf_size)
                .max_by(|&i, &j| weight(&parts[i]).total_cmp(&weight(&parts[j])));
            let Some(largest) = largest else { break };
            let part = parts.swap_remove(largest);
            let (left, right) = self.split(part, by_area);
            parts.extend([left, right]);
        }
        parts
    }
}
