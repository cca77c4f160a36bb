//! What a tree looks like in memory: wide nodes and blocks of triangles, each a few whole
//! cache lines, coordinates apart (structure of arrays).

use super::simd::prefer_large_pages;
use crate::math::Aabb;

/// The largest number of levels of nodes that a builder makes.
pub(super) const MAX_DEPTH: usize = 64;

/// What a node's child is: another node, or one block of triangles.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct ChildRef(u32);

const LEAF: u32 = 1 << 31;
const COUNT_BITS: u32 = 4;

impl ChildRef {
    /// The most blocks or nodes of one tree.
    pub const MAX_BLOCKS: usize = 1 << (31 - COUNT_BITS);

    /// Of a child that is not there; its box is never hit.
    pub const NONE: Self = Self(u32::MAX);

    /// A node.
    pub fn node(index: usize) -> Self {
        Self(index as u32)
    }

    /// The first `count` lanes (1 to 16) of a block.
    pub fn leaf(block: usize, count: usize) -> Self {
        debug_assert!((1..=16).contains(&count) && block < Self::MAX_BLOCKS);
        Self(LEAF | (block as u32) << COUNT_BITS | (count as u32 - 1))
    }

    /// From the bits of [`ChildRef::bits`].
    #[inline(always)]
    pub fn from_bits(bits: u32) -> Self {
        Self(bits)
    }

    /// For the traversal stack.
    #[inline(always)]
    pub fn bits(self) -> u32 {
        self.0
    }

    /// Whether it is a block.
    #[inline(always)]
    pub fn is_leaf(self) -> bool {
        self.0 & LEAF != 0
    }

    /// Index of the node or block.
    #[inline(always)]
    pub fn index(self) -> usize {
        if self.is_leaf() {
            ((self.0 & !LEAF) >> COUNT_BITS) as usize
        } else {
            self.0 as usize
        }
    }

    /// Number of triangles in the block.
    #[inline(always)]
    pub fn count(self) -> u32 {
        (self.0 & ((1 << COUNT_BITS) - 1)) + 1
    }

    /// The same child in arrays that begin with so many others.
    pub fn moved(self, nodes: usize, blocks: usize) -> Self {
        if self == Self::NONE {
            self
        } else if self.is_leaf() {
            Self::leaf(self.index() + blocks, self.count() as usize)
        } else {
            Self::node(self.index() + nodes)
        }
    }
}

/// An inner node: the boxes of up to `W` children.
#[derive(Clone, Debug, PartialEq)]
#[repr(C, align(64))]
pub(super) struct Node<const W: usize> {
    /// Lower planes by axis, then upper planes by axis; by child. Absent children have empty
    /// boxes.
    pub planes: [[f32; W]; 6],
    /// The children.
    pub children: [ChildRef; W],
}

impl<const W: usize> Node<W> {
    /// Without children.
    pub const EMPTY: Self = Self {
        planes: [
            [f32::INFINITY; W],
            [f32::INFINITY; W],
            [f32::INFINITY; W],
            [f32::NEG_INFINITY; W],
            [f32::NEG_INFINITY; W],
            [f32::NEG_INFINITY; W],
        ],
        children: [ChildRef::NONE; W],
    };

    /// Sets the child in `lane`.
    pub fn set(&mut self, lane: usize, bounds: &Aabb, child: ChildRef) {
        for axis in 0..3 {
            self.planes[axis][lane] = bounds.min[axis];
            self.planes[3 + axis][lane] = bounds.max[axis];
        }
        self.children[lane] = child;
    }

    /// The children that are there, with their boxes.
    pub fn iter(&self) -> impl Iterator<Item = (Aabb, ChildRef)> {
        (0..W)
            .filter(|&lane| self.children[lane] != ChildRef::NONE)
            .map(|lane| {
                let plane = |row: usize| self.planes[row][lane];
                let bounds = Aabb {
                    min: [plane(0), plane(1), plane(2)].into(),
                    max: [plane(3), plane(4), plane(5)].into(),
                };
                (bounds, self.children[lane])
            })
    }
}

/// Up to `W` triangles.
#[derive(Clone, Debug, PartialEq)]
#[repr(C, align(64))]
pub(super) struct Block<const W: usize> {
    /// By corner; by axis; by triangle.
    pub corners: [[[f32; W]; 3]; 3],
    /// Indices as they were given to the builder.
    pub triangles: [u32; W],
}

impl<const W: usize> Block<W> {
    /// All zero.
    pub const EMPTY: Self = Self {
        corners: [[[0.0; W]; 3]; 3],
        triangles: [0; W],
    };

    /// Sets the triangle in `lane`.
    pub fn set(&mut self, lane: usize, corners: &[[f32; 3]; 3], triangle: u32) {
        for (corner, point) in corners.iter().enumerate() {
            for (axis, &x) in point.iter().enumerate() {
                self.corners[corner][axis][lane] = x;
            }
        }
        self.triangles[lane] = triangle;
    }

    /// The corners of the triangle in `lane`, their coordinates in the order `axes`.
    #[inline(always)]
    pub fn corners_of(&self, lane: usize, axes: [usize; 3]) -> [[f32; 3]; 3] {
        // No `array::map`, see `triangle`.
        let [a, b, c] = &self.corners;
        let [x, y, z] = axes;
        [
            [a[x][lane], a[y][lane], a[z][lane]],
            [b[x][lane], b[y][lane], b[z][lane]],
            [c[x][lane], c[y][lane], c[z][lane]],
        ]
    }
}

/// Nodes over blocks of triangles.
#[derive(Debug, PartialEq)]
pub(super) struct Tree<const W: usize> {
    /// Around everything.
    pub bounds: Aabb,
    /// The root is the first; empty where all blocks are to be looked at in turn.
    pub nodes: Vec<Node<W>>,
    /// Of all leaves.
    pub blocks: Vec<Block<W>>,
    /// Triangles in the blocks.
    pub triangles: usize,
}

impl<const W: usize> Tree<W> {
    /// See [`prefer_large_pages`].
    pub fn prefer_large_pages(&self) {
        prefer_large_pages(&self.nodes);
        prefer_large_pages(&self.blocks);
    }
}
