//! A range of primitives on its way to becoming a node or a leaf.

use rayon::prelude::*;

use super::bounds::Bounds;
use super::primitive::Primitive;

/// Some primitives and what splits need to know of them.
#[derive(Debug)]
pub(super) struct Part<'a> {
    pub primitives: &'a mut [Primitive],
    /// Around the primitives.
    pub bounds: Bounds,
    /// Around their centroids.
    pub centroids: Bounds,
}

/// Ranges longer than this are scanned by several threads, in pieces of [`PIECE`]; what they
/// compute does not depend on the number of threads.
pub(super) const PARALLEL: usize = 1 << 15;

/// See [`PARALLEL`].
pub(super) const PIECE: usize = 1 << 13;

impl<'a> Part<'a> {
    /// Scans `primitives`.
    pub fn new(primitives: &'a mut [Primitive]) -> Self {
        let (bounds, centroids) = scan(primitives);
        Self {
            primitives,
            bounds,
            centroids,
        }
    }

    /// How many primitives there are.
    pub fn len(&self) -> usize {
        self.primitives.len()
    }
}

fn scan(primitives: &[Primitive]) -> (Bounds, Bounds) {
    let empty = (Bounds::EMPTY, Bounds::EMPTY);
    let scan_piece = |piece: &[Primitive]| {
        piece.iter().fold(empty, |(mut bounds, mut centroids), p| {
            bounds.add(&p.bounds());
            centroids.add_point(p.centroid());
            (bounds, centroids)
        })
    };
    if primitives.len() <= PARALLEL {
        return scan_piece(primitives);
    }
    primitives.par_chunks(PIECE).map(scan_piece).reduce(
        || empty,
        |(mut bounds, mut centroids), (b, c)| {
            bounds.add(&b);
            centroids.add(&c);
            (bounds, centroids)
        },
    )
}
