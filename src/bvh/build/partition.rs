//! Reordering primitives so that one side of a split comes first, on several threads.
//!
//! Pieces of fixed size are partitioned each by itself; then what stands on the wrong side of
//! the whole is exchanged. The order that results depends on the input alone.

use rayon::prelude::*;

use super::bounds::Bounds;
use super::part::{PARALLEL, PIECE};
use super::primitive::Primitive;

/// What is where after a partition.
#[derive(Clone, Copy)]
pub(super) struct Sides {
    /// How many are on the left.
    pub left: usize,
    /// Around the centroids of the right and of the left side.
    pub centroids: [Bounds; 2],
}

/// Brings those that are `on_left` to the front.
pub(super) fn partition(
    primitives: &mut [Primitive],
    on_left: impl Fn(&Primitive) -> bool + Sync,
) -> Sides {
    if primitives.len() <= PARALLEL {
        return partition_piece(primitives, &on_left);
    }
    let pieces: Vec<Sides> = primitives
        .par_chunks_mut(PIECE)
        .map(|piece| partition_piece(piece, &on_left))
        .collect();
    let mut all = pieces[0];
    for piece in &pieces[1..] {
        all.left += piece.left;
        all.centroids[0].add(&piece.centroids[0]);
        all.centroids[1].add(&piece.centroids[1]);
    }
    exchange(primitives, &pieces, all.left);
    all
}

/// Without branches on where things go, which cannot be predicted.
fn partition_piece(primitives: &mut [Primitive], on_left: &impl Fn(&Primitive) -> bool) -> Sides {
    let mut left = 0;
    let mut centroids = [Bounds::EMPTY; 2];
    for i in 0..primitives.len() {
        let primitive = primitives[i];
        let side = usize::from(on_left(&primitive));
        centroids[side].add_point(primitive.centroid());
        primitives[i] = primitives[left];
        primitives[left] = primitive;
        left += side;
    }
    Sides { left, centroids }
}

/// Swaps the right ones among the first `left` with the left ones behind.
fn exchange(primitives: &mut [Primitive], pieces: &[Sides], left: usize) {
    let (mut front, mut back) = primitives.split_at_mut(left);
    let (mut rights, mut lefts) = (Vec::new(), Vec::new());
    let mut start = 0;
    for piece in pieces {
        let middle = start + piece.left;
        let end = start + PIECE;
        let in_front = front.len().min(PIECE);
        let (head, rest) = std::mem::take(&mut front).split_at_mut(in_front);
        front = rest;
        rights.push(&mut head[piece.left.min(in_front)..]);
        let in_back = (end - left.clamp(start, end)).min(back.len());
        let (head, rest) = std::mem::take(&mut back).split_at_mut(in_back);
        back = rest;
        lefts.push(&mut head[..middle.saturating_sub(left.max(start)).min(in_back)]);
        start = end;
    }
    pairs(rights, lefts)
        .into_par_iter()
        .for_each(|(a, b)| a.swap_with_slice(b));
}

type Slice<'a> = &'a mut [Primitive];

/// Cuts two lists of slices with the same total length into slices of pairwise equal length.
fn pairs<'a>(a: Vec<Slice<'a>>, b: Vec<Slice<'a>>) -> Vec<(Slice<'a>, Slice<'a>)> {
    let mut pairs = Vec::with_capacity(a.len() + b.len());
    let mut others = b.into_iter();
    let mut other: Slice = &mut [];
    for mut one in a {
        while !one.is_empty() {
            while other.is_empty() {
                let Some(next) = others.next() else {
                    return pairs;
                };
                other = next;
            }
            let length = one.len().min(other.len());
            let (x, rest) = one.split_at_mut(length);
            one = rest;
            let (y, rest) = std::mem::take(&mut other).split_at_mut(length);
            other = rest;
            pairs.push((x, y));
        }
    }
    pairs
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::Vec3A;

    #[test]
    fn both_sides_are_whole() {
        for (count, modulus) in [
            (10, 3),
            (PARALLEL + 1, 2),
            (5 * PIECE, 7),
            (9 * PIECE + 5, 1),
        ] {
            for take in 0..=modulus {
                let place = |i: u32| Vec3A::splat((i.wrapping_mul(2_654_435_761) >> 9) as f32);
                let mut primitives: Vec<_> = (0..count as u32)
                    .map(|i| Primitive::new(place(i), place(i), i))
                    .collect();
                let on_left = |p: &Primitive| p.centroid().x as usize / 64 % modulus < take;
                let sides = partition(&mut primitives, on_left);
                assert!(primitives[..sides.left].iter().all(on_left));
                assert!(!primitives[sides.left..].iter().any(on_left));
                let mut indices: Vec<u32> = primitives.iter().map(Primitive::index).collect();
                indices.sort_unstable();
                assert!(indices.into_iter().eq(0..count as u32));
                let mut left = Bounds::EMPTY;
                let points = primitives[..sides.left].iter().map(Primitive::centroid);
                points.for_each(|p| left.add_point(p));
                assert_eq!(left.min, sides.centroids[1].min);
                assert_eq!(left.max, sides.centroids[1].max);
            }
        }
    }
}
