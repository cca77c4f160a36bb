//! A range of primitives on its way to becoming a node or a leaf.

use rayon::prelude::*;

use super::binned::side_cost;
use super::bounds::Bounds;
use super::primitive::Primitive;

/// Some primitives and what splits need to know of them.
#[derive(Debug)]
pub(super) struct Part<'a> {
    /// The primitives, then room for more.
    storage: &'a mut [Primitive],
    count: usize,
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
    /// Scans `primitives`, which leave no room.
    pub fn new(primitives: &'a mut [Primitive]) -> Self {
        let count = primitives.len();
        Self::with_room(primitives, count)
    }

    /// Scans the first `count` of `storage`.
    pub fn with_room(storage: &'a mut [Primitive], count: usize) -> Self {
        let (bounds, centroids) = scan(&storage[..count]);
        Self {
            storage,
            count,
            bounds,
            centroids,
        }
    }

    /// How many primitives there are.
    pub fn len(&self) -> usize {
        self.count
    }

    /// How many more there is room for.
    pub fn room(&self) -> usize {
        self.storage.len() - self.count
    }

    /// The primitives.
    pub fn primitives(&self) -> &[Primitive] {
        &self.storage[..self.count]
    }

    /// The primitives, to be reordered.
    pub fn primitives_mut(&mut self) -> &mut [Primitive] {
        &mut self.storage[..self.count]
    }

    /// The two sides of a split after which the first `left` primitives are the left one;
    /// `bounds` and `centroids` are those of the right and of the left side.
    pub fn cut(self, left: usize, bounds: [Bounds; 2], centroids: [Bounds; 2]) -> (Self, Self) {
        let right = self.count - left;
        let left_room = match self.room() {
            0 => 0,
            room => share_room(room, &bounds, [right, left]),
        };
        let middle = left + left_room;
        if left_room > 0 {
            self.storage.copy_within(left..self.count, middle);
        }
        let (left_storage, right_storage) = self.storage.split_at_mut(middle);
        let [right_bounds, left_bounds] = bounds;
        let [right_centroids, left_centroids] = centroids;
        (
            Self {
                storage: left_storage,
                count: left,
                bounds: left_bounds,
                centroids: left_centroids,
            },
            Self {
                storage: right_storage,
                count: right,
                bounds: right_bounds,
                centroids: right_centroids,
            },
        )
    }

    /// The same storage with other contents: `left`, then `right`, which must fit.
    pub fn refill(&mut self, left: &[Primitive], right: &[Primitive]) {
        self.count = left.len() + right.len();
        let (front, back) = self.storage[..self.count].split_at_mut(left.len());
        front.copy_from_slice(left);
        back.copy_from_slice(right);
    }
}

/// How much of `room` the left side gets. It is shared by the sides' cost, so that it is used
/// where rays are, but a side gets no more than would double it while the other can use it.
fn share_room(room: usize, bounds: &[Bounds; 2], [right, left]: [usize; 2]) -> usize {
    let right_cost = side_cost(&bounds[0], right as u32, 1);
    let left_cost = side_cost(&bounds[1], left as u32, 1);
    let share = left_cost / (left_cost + right_cost).max(f64::MIN_POSITIVE);
    let least = room.saturating_sub(right);
    let most = left.max(least).min(room);
    ((share * room as f64) as usize).clamp(least, most)
}

/// Boxes around primitives and around their centroids.
pub(super) fn scan(primitives: &[Primitive]) -> (Bounds, Bounds) {
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
