//! From triangles to a tree.
//!
//! A wide node is made directly: its range of primitives is split in two, then the part with
//! the largest box again, until there is a part for each child. Subtrees are built in
//! parallel; where a split falls and how nodes are numbered depends on the triangles alone,
//! so the tree is the same for any number of threads.

mod primitive;
mod split;

use rayon::prelude::*;
use serde::{Deserialize, Serialize};

use super::layout::{Block, ChildRef, MAX_DEPTH, Node, Tree};
use crate::math::{Aabb, Vec3};
use primitive::{Part, Primitive, corners, primitives};
use split::{split_median, split_sah};

/// How a tree is built.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
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

/// Levels of nodes below which the surface area heuristic gives way to halving, which bounds
/// the depth: halving needs log_W(2^31) < 11 more levels for any W of 8 or more.
const SAH_DEPTH: usize = MAX_DEPTH - 11;

/// Parts of up to so many primitives are built by one thread.
const SERIAL_PART: usize = 1 << 13;

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
    let fragment = match builder {
        Builder::None => Fragment {
            nodes: Vec::new(),
            leaves: primitives.chunks(W).map(make_block).collect(),
        },
        Builder::Median => Maker::new(MEDIAN_LEAF, 0, make_block).make_all(&mut primitives),
        Builder::Balanced => Maker::new(W, SAH_DEPTH, make_block).make_all(&mut primitives),
    };
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
        Maker::new(1, SAH_DEPTH, |leaf: &[Primitive]| leaf[0].index()).make_all(&mut primitives);
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
    /// Nodes at this depth and below are split by halving.
    sah_depth: usize,
    make_leaf: F,
}

impl<F> Maker<F> {
    fn new(leaf_size: usize, sah_depth: usize, make_leaf: F) -> Self {
        Self {
            leaf_size,
            sah_depth,
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

    /// Makes the node, or the leaf, of `part`.
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
        if part.primitives.len() > self.leaf_size {
            return self.make_node(part, depth, out);
        }
        out.leaves.push((self.make_leaf)(part.primitives));
        ChildRef::leaf(out.leaves.len() - 1, part.primitives.len())
    }

    fn make_node<const W: usize, L>(
        &self,
        part: Part<'_>,
        depth: usize,
        out: &mut Fragment<W, L>,
    ) -> ChildRef
    where
        L: Send,
        F: Fn(&[Primitive]) -> L + Sync,
    {
        debug_assert!(depth < MAX_DEPTH);
        let parallel = part.primitives.len() > SERIAL_PART;
        let parts = self.split::<W>(part, depth < self.sah_depth);
        let boxes: Vec<_> = parts.iter().map(|part| part.bounds.to_aabb()).collect();
        let index = out.nodes.len();
        out.nodes.push(Node::EMPTY);
        let children: Vec<ChildRef> = if parallel {
            let subtrees: Vec<_> = parts
                .into_par_iter()
                .map(|part| {
                    let mut fragment = Fragment::new();
                    let root = self.make(part, depth + 1, &mut fragment);
                    (fragment, root)
                })
                .collect();
            let append = |(fragment, root)| out.append(fragment, root);
            subtrees.into_iter().map(append).collect()
        } else {
            let make = |part| self.make(part, depth + 1, out);
            parts.into_iter().map(make).collect()
        };
        for (lane, (bounds, child)) in boxes.iter().zip(children).enumerate() {
            out.nodes[index].set(lane, bounds, child);
        }
        ChildRef::node(index)
    }

    /// Splits into at most `W` parts: by area and heuristic, or into equal halves.
    fn split<'a, const W: usize>(&self, part: Part<'a>, by_area: bool) -> Vec<Part<'a>> {
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
            let (left, right) = if by_area {
                split_sah(part, self.leaf_size)
            } else {
                split_median(part)
            };
            parts.extend([left, right]);
        }
        parts
    }
}
