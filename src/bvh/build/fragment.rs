//! Pieces of a tree, built apart and put together.

use rayon::prelude::*;

use super::primitive::corners;
use crate::bvh::layout::{Block, ChildRef, Node};
use crate::math::Vec3;

/// Nodes and leaves of a subtree, numbered from 0 in depth-first order.
pub(super) struct Fragment<const W: usize> {
    pub nodes: Vec<Node<W>>,
    /// How many primitives each leaf has.
    pub leaves: Vec<u8>,
    /// Numbers of the primitives, leaf by leaf.
    pub order: Vec<u32>,
}

impl<const W: usize> Fragment<W> {
    /// Without anything.
    pub fn new() -> Self {
        Self {
            nodes: Vec::new(),
            leaves: Vec::new(),
            order: Vec::new(),
        }
    }

    /// Adds a leaf of the primitives with those numbers; returns where it is.
    pub fn add_leaf(&mut self, numbers: &[u32]) -> ChildRef {
        self.leaves.push(numbers.len() as u8);
        self.order.extend_from_slice(numbers);
        ChildRef::leaf(self.leaves.len() - 1, numbers.len())
    }

    /// Appends `other`, whose root is `root`; returns where that is now.
    pub fn append(&mut self, other: Self, root: ChildRef) -> ChildRef {
        let (nodes, leaves) = (self.nodes.len(), self.leaves.len());
        self.nodes.extend(other.nodes.into_iter().map(|mut node| {
            node.children = node.children.map(|child| child.moved(nodes, leaves));
            node
        }));
        self.leaves.extend(other.leaves);
        self.order.extend(other.order);
        root.moved(nodes, leaves)
    }

    /// The leaves as blocks of triangles.
    pub fn blocks(&self, positions: &[Vec3], indices: &[[u32; 3]]) -> Vec<Block<W>> {
        let mut end = 0;
        let ranges: Vec<_> = self
            .leaves
            .iter()
            .map(|&count| {
                let start = end;
                end += usize::from(count);
                start as u32..end as u32
            })
            .collect();
        let make_block = |range: &std::ops::Range<u32>| {
            let mut block = Block::EMPTY;
            let numbers = &self.order[range.start as usize..range.end as usize];
            // The last one again fills up the block, whose box is then that of its triangles.
            for lane in 0..W {
                let triangle = numbers[lane.min(numbers.len() - 1)];
                let corners = corners(positions, indices[triangle as usize]);
                let [a, b, c] = corners;
                block.set(lane, &[a.to_array(), b.to_array(), c.to_array()], triangle);
            }
            block
        };
        ranges.par_iter().with_min_len(64).map(make_block).collect()
    }
}
