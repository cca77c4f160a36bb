//! From triangles to a tree.
//!
//! `wide` makes nodes out of splits of `part`s of the primitives; a builder is a way to split.
//! Where a split falls and how nodes are numbered depends on the triangles alone, so the tree is
//! the same for any number of threads. Until all leaves are known they are lists of numbers:
//! the primitives are gone when the blocks of triangles are made.

mod binned;
mod bounds;
mod builder;
mod clip;
mod clusters;
mod collapse;
mod fragment;
mod median;
mod memory;
mod morton;
mod part;
mod partition;
mod primitive;
mod spatial;
mod wide;

pub use builder::Builder;

use super::layout::{MAX_DEPTH, Node, Tree};
use crate::math::{Aabb, Vec3};
use binned::Binned;
use clusters::make_clustered_tree;
use fragment::Fragment;
use glam::Vec3A;
use part::{PARALLEL, Part, scan};
use primitive::{Primitive, primitives};
use spatial::Spatial;
use wide::{Splitter, make_tree};

/// Leaves of [`Builder::Median`] hold at most so many triangles.
const MEDIAN_LEAF: usize = 4;

/// How many more references to triangles [`Builder::Quality`] may make.
const ROOM_PERCENT: usize = 25;

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
    let (bounds, centroids) = scan(&primitives);
    let mut fragment = match builder {
        Builder::None => leaves_only(&primitives),
        Builder::Median => make_tree(Part::new(&mut primitives), &Halves),
        // Few triangles in many cells would leave leaves empty.
        Builder::Fast if triangles > PARALLEL => {
            make_clustered_tree(std::mem::take(&mut primitives), &centroids)
        }
        Builder::Fast | Builder::Balanced => {
            make_tree(Part::new(&mut primitives), &Binned { leaf_size: W })
        }
        Builder::Quality => {
            let room = primitives.len() * ROOM_PERCENT / 100;
            let (count, filler) = (
                primitives.len(),
                Primitive::new(Vec3A::ZERO, Vec3A::ZERO, 0),
            );
            primitives.resize(count + room, filler);
            let splitter = Spatial::new(positions, indices, &bounds, W);
            make_tree(Part::with_room(&mut primitives, count), &splitter)
        }
    };
    drop(primitives);
    fragment.nodes.shrink_to_fit();
    Tree {
        bounds: bounds.to_aabb(),
        blocks: fragment.blocks(positions, indices),
        nodes: fragment.nodes,
        triangles,
    }
}

/// Nodes over numbered boxes, one box a leaf, and the number in each leaf.
pub(super) fn build_over_boxes<const W: usize>(boxes: &[Aabb]) -> (Vec<Node<W>>, Vec<u32>) {
    let mut primitives: Vec<_> = (0..)
        .zip(boxes)
        .filter(|(_, bounds)| !bounds.is_empty())
        .map(|(i, bounds)| Primitive::new(bounds.min.into(), bounds.max.into(), i))
        .collect();
    let fragment = make_tree(Part::new(&mut primitives), &Binned { leaf_size: 1 });
    (fragment.nodes, fragment.order)
}

fn leaves_only<const W: usize>(primitives: &[Primitive]) -> Fragment<W> {
    let mut fragment = Fragment::new();
    for leaf in primitives.chunks(W) {
        let numbers: Vec<u32> = leaf.iter().map(Primitive::index).collect();
        fragment.add_leaf(&numbers);
    }
    fragment
}

/// [`Builder::Median`].
struct Halves;

impl Splitter for Halves {
    fn leaf_size(&self) -> usize {
        MEDIAN_LEAF
    }

    fn split<'a>(&self, part: Part<'a>) -> Result<(Part<'a>, Part<'a>), Part<'a>> {
        Err(part)
    }
}
