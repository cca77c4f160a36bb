//! Order along a space-filling curve (Morton 1966; Lauterbach et al. 2009, "Fast BVH Construction
//! on GPUs").

use std::slice::IterMut;

use glam::Vec3A;
use rayon::prelude::*;

use super::bounds::Bounds;

/// Bits of a code along each axis.
const AXIS_BITS: u32 = 10;

/// A place on the curve, then a number that tells keys of the same place apart.
pub(super) type Key = u64;

/// The place of a key.
pub(super) fn code(key: Key) -> u32 {
    (key >> 32) as u32
}

/// The number of a key.
pub(super) fn number(key: Key) -> usize {
    key as u32 as usize
}

/// Cubic cells over a box.
pub(super) struct Curve {
    base: Vec3A,
    scale: f32,
}

impl Curve {
    /// Over `bounds`. The corners get different codes where they are different points.
    pub fn new(bounds: &Bounds) -> Self {
        let extent = (bounds.max - bounds.min).max_element();
        let cells = (1u32 << AXIS_BITS) as f32;
        // A reciprocal that overflows belongs to an extent that is as good as none.
        let scale = (cells / extent).min(f32::MAX);
        Self {
            base: bounds.min,
            scale: if extent > 0.0 { scale } else { 0.0 },
        }
    }

    /// The key of `point` with `number`.
    #[inline(always)]
    pub fn key(&self, point: Vec3A, number: u32) -> Key {
        const LAST: f32 = ((1u32 << AXIS_BITS) - 1) as f32;
        let cell = ((point - self.base) * self.scale).min(Vec3A::splat(LAST));
        let [x, y, z] = cell.to_array().map(|x| spread(x as u32));
        u64::from(x << 2 | y << 1 | z) << 32 | u64::from(number)
    }
}

/// Moves the bits of a number of [`AXIS_BITS`] three places apart.
#[inline(always)]
fn spread(x: u32) -> u32 {
    let x = (x | x << 16) & 0x0300_00ff;
    let x = (x | x << 8) & 0x0300_f00f;
    let x = (x | x << 4) & 0x030c_30c3;
    (x | x << 2) & 0x0924_9249
}

/// Buckets of [`scatter`]: by the highest bits of the code.
const BUCKET_BITS: u32 = 11;
const BUCKETS: usize = 1 << BUCKET_BITS;

fn bucket(key: Key) -> usize {
    (code(key) >> (3 * AXIS_BITS - BUCKET_BITS)) as usize % BUCKETS
}

/// The keys by bucket, in their order otherwise, and the number in each bucket.
///
/// Every piece of the input has a slice of every bucket to itself and fills it in parallel with
/// the others: the first pass of a radix sort.
pub(super) fn scatter(keys: &[Key]) -> (Vec<Key>, Vec<usize>) {
    let piece_size = (1 << 16).max(keys.len().div_ceil(64));
    let counts: Vec<Vec<usize>> = keys
        .par_chunks(piece_size)
        .map(|piece| {
            let mut counts = vec![0; BUCKETS];
            piece.iter().for_each(|&key| counts[bucket(key)] += 1);
            counts
        })
        .collect();
    let mut scattered = vec![0; keys.len()];
    let mut rest = scattered.as_mut_slice();
    let mut targets: Vec<Vec<IterMut<Key>>> =
        counts.iter().map(|_| Vec::with_capacity(BUCKETS)).collect();
    for bucket in 0..BUCKETS {
        for (counts, targets) in counts.iter().zip(&mut targets) {
            let (target, others) = rest.split_at_mut(counts[bucket]);
            rest = others;
            targets.push(target.iter_mut());
        }
    }
    keys.par_chunks(piece_size)
        .zip(targets)
        .for_each(|(piece, mut targets)| {
            for &key in piece {
                if let Some(target) = targets[bucket(key)].next() {
                    *target = key;
                }
            }
        });
    let sizes = (0..BUCKETS).map(|bucket| counts.iter().map(|c| c[bucket]).sum());
    (scattered, sizes.collect())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn codes_interleave_bits() {
        let bounds = Bounds {
            min: Vec3A::splat(-1.0),
            max: Vec3A::ONE,
        };
        let curve = Curve::new(&bounds);
        let code_at = |x, y, z| code(curve.key(Vec3A::new(x, y, z), 7));
        assert_eq!(code_at(-1.0, -1.0, -1.0), 0);
        assert_eq!(code_at(1.0, 1.0, 1.0), (1 << 30) - 1);
        assert_eq!(code_at(0.0, -1.0, -1.0), 1 << 29);
        assert_eq!(code_at(-1.0, 0.0, -1.0), 1 << 28);
        assert_eq!(code_at(-1.0, -1.0, -1.0 + 2.1 / 1024.0), 1);
        assert_eq!(number(curve.key(Vec3A::ZERO, u32::MAX)), u32::MAX as usize);
    }

    #[test]
    fn scattering_sorts_by_bucket() {
        let keys: Vec<Key> = (0..200_000u64)
            .map(|i| (i.wrapping_mul(0x9e37_79b9_7f4a_7c15) >> 34) << 32 | i)
            .collect();
        let (scattered, sizes) = scatter(&keys);
        let mut expected = keys;
        expected.sort_by_key(|&key| bucket(key));
        assert_eq!(scattered, expected);
        assert_eq!(sizes.iter().sum::<usize>(), expected.len());
    }
}
