//! Owen-scrambled Sobol points in four dimensions.

use crate::math::Vec2;

use super::key::Key;

/// Two of the four dimensions; each pair has good two-dimensional projections.
#[derive(Clone, Copy, Debug)]
pub(super) enum Pair {
    /// The first two: a (0, 2)-sequence, every prefix of 2^k points of which is a net.
    First,
    /// The other two.
    Second,
}

/// Point `index` of the sequence that `key` shuffles and scrambles
/// (Burley 2020, "Practical Hash-based Owen Scrambling").
///
/// Both pairs of one key belong to one four-dimensional sequence. Any prefix of it is a prefix of
/// a scrambled Sobol sequence, and each single point is uniform.
#[inline(always)]
pub(super) fn point(index: u32, pair: Pair, key: Key) -> Vec2 {
    scrambled(shuffled(index, key), pair, key)
}

/// [`point`] of both pairs.
pub(super) fn points(index: u32, key: Key) -> [Vec2; 2] {
    let index = shuffled(index, key);
    [Pair::First, Pair::Second].map(|pair| scrambled(index, pair, key))
}

#[inline(always)]
fn shuffled(index: u32, key: Key) -> u32 {
    scramble_reversed(index.reverse_bits(), key.bits() as u32).reverse_bits()
}

#[inline(always)]
fn scrambled(index: u32, pair: Pair, key: Key) -> Vec2 {
    let scramble = key.with(pair as u64).bits();
    let x_and_y = unscrambled(index, pair);
    let x = scramble_reversed(x_and_y as u32, scramble as u32);
    let y = scramble_reversed((x_and_y >> 32) as u32, (scramble >> 32) as u32);
    Vec2::new(unit_interval(x), unit_interval(y))
}

/// Point `number` of the sequences of `key`; past 2^32 the next independent one begins.
#[inline(always)]
pub(super) fn point_of(key: Key, number: u64, pair: Pair) -> Vec2 {
    point(number as u32, pair, key.with(number >> 32))
}

/// A random permutation of numbers whose bits are in reverse order, in which each bit is turned
/// over by a hash of those below it: Owen's scrambling (Laine and Karras 2011, "Stratified
/// Sampling for Stochastic Transparency", with the factors of Vegdahl 2021, "Building a Better LK Hash").
#[inline(always)]
fn scramble_reversed(mut bits: u32, seed: u32) -> u32 {
    bits ^= bits.wrapping_mul(0x3d20_adea);
    bits = bits.wrapping_add(seed);
    bits = bits.wrapping_mul((seed >> 16) | 1);
    bits ^= bits.wrapping_mul(0x0552_6c56);
    bits ^ bits.wrapping_mul(0x53a2_2864)
}

/// The first 24 bits behind the point of a number whose bits are in reverse order.
#[inline(always)]
fn unit_interval(reversed: u32) -> f32 {
    (reversed.reverse_bits() >> 8) as f32 * (1.0 / (1 << 24) as f32)
}

/// Point `index` of the Sobol sequence (Joe and Kuo 2008, "Constructing Sobol Sequences with
/// Better Two-Dimensional Projections"): x in the lower half of the result and y in the upper,
/// each with the bits behind its point in reverse order.
#[inline(always)]
fn unscrambled(index: u32, pair: Pair) -> u64 {
    match pair {
        Pair::First => u64::from(pascal(index)) << 32 | u64::from(index),
        Pair::Second => {
            let mut sum = 0;
            for k in 0..8 {
                sum ^= TABLE[k][(index >> (4 * k)) as usize & 15];
            }
            sum
        }
    }
}

/// The second dimension, whose direction numbers are the rows of Pascal's triangle modulo 2: the
/// bits of `index` as a polynomial p(x) become those of p(x + 1). From halves on down,
/// x^k h + l becomes (x^k + 1) h + l, for (x + 1)^k is x^k + 1 for each power of two k.
#[inline(always)]
fn pascal(mut index: u32) -> u32 {
    index ^= index >> 16;
    index ^= (index & 0xff00_ff00) >> 8;
    index ^= (index & 0xf0f0_f0f0) >> 4;
    index ^= (index & 0xcccc_cccc) >> 2;
    index ^ (index & 0xaaaa_aaaa) >> 1
}

/// Sums of direction numbers for the 16 values of each of the 8 half bytes of an index.
type Table = [[u64; 16]; 8];

/// The third and fourth dimension: primitive polynomials and first direction numbers.
static TABLE: Table = table(directions(1, &[1, 3]), directions(1, &[1, 3, 1]));

/// Direction numbers from the inner coefficients `a` of the polynomial (as the bits of a number,
/// highest power first) and the first `m`.
const fn directions(a: u32, m: &[u32]) -> [u32; 32] {
    let degree = m.len();
    let mut v = [0; 32];
    let mut k = 0;
    while k < 32 {
        if k < degree {
            v[k] = m[k] << (31 - k);
        } else {
            v[k] = v[k - degree] ^ (v[k - degree] >> degree);
            let mut j = 1;
            while j < degree {
                if a >> (degree - 1 - j) & 1 == 1 {
                    v[k] ^= v[k - j];
                }
                j += 1;
            }
        }
        k += 1;
    }
    v
}

const fn table(x: [u32; 32], y: [u32; 32]) -> Table {
    let mut table = [[0; 16]; 8];
    let mut bit = 0;
    while bit < 32 {
        let both = (y[bit].reverse_bits() as u64) << 32 | x[bit].reverse_bits() as u64;
        let mut value = 0;
        while value < 16 {
            if value >> (bit % 4) & 1 == 1 {
                table[bit / 4][value] ^= both;
            }
            value += 1;
        }
        bit += 1;
    }
    table
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn tables_are_those_of_a_peer() {
        for index in (0..1 << 16).step_by(7) {
            for (pair, dimension) in [(Pair::First, 0), (Pair::Second, 2)] {
                let x_and_y = unscrambled(index, pair);
                let peer = |d| sobol_burley::parts::sobol_rev(index.reverse_bits(), d);
                assert_eq!(x_and_y as u32 & 0xffff, peer(dimension) & 0xffff, "{index}");
                let y = (x_and_y >> 32) as u32;
                assert_eq!(y & 0xffff, peer(dimension + 1) & 0xffff, "{index}");
            }
        }
    }

    /// The peer's tables end at 2^16 points; nets go on to 2^32.
    #[test]
    fn nets_go_on_beyond_the_peer() {
        const POINTS: u32 = 1 << 20;
        for start in [0, POINTS, u32::MAX - POINTS + 1] {
            let mut taken = vec![[false; 3]; POINTS as usize];
            for index in start..=start + (POINTS - 1) {
                let x_and_y = unscrambled(index, Pair::First);
                let x = (x_and_y as u32).reverse_bits();
                let y = ((x_and_y >> 32) as u32).reverse_bits();
                // 2^20 × 1, 2^10 × 2^10 and 1 × 2^20 cells.
                let cells = [x >> 12, (x >> 22) << 10 | y >> 22, y >> 12];
                for (shape, cell) in cells.into_iter().enumerate() {
                    let cell = &mut taken[cell as usize][shape];
                    assert!(!*cell, "{index}, shape {shape}");
                    *cell = true;
                }
            }
        }
    }
}
