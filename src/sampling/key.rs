//! Random numbers without state: a hash of everything that names the number.

use crate::math::Vec2;

/// The hash of a list of words; another word gives another, unrelated key.
///
/// The numbers `key.with(0)`, `key.with(1)`, … are the SplitMix64 sequence that starts at `key`
/// (Steele et al. 2014, "Fast Splittable Pseudorandom Number Generators").
#[derive(Clone, Copy, Debug)]
pub(super) struct Key(u64);

impl Key {
    /// Of no words.
    pub const ZERO: Self = Self(0);

    /// The key of one word.
    pub fn new(word: u64) -> Self {
        Self::ZERO.with(word)
    }

    /// The key of this one's words and one more.
    #[inline(always)]
    pub fn with(self, word: u64) -> Self {
        const GOLDEN_RATIO: u64 = 0x9e37_79b9_7f4a_7c15;
        let weyl = word.wrapping_add(1).wrapping_mul(GOLDEN_RATIO);
        Self(mix(self.0.wrapping_add(weyl)))
    }

    /// 64 random bits.
    #[inline(always)]
    pub fn bits(self) -> u64 {
        self.0
    }

    /// A point that is uniform in `[0, 1)²`, on a lattice of 2^-24.
    pub fn point(self) -> Vec2 {
        Vec2::new(unit_interval(self.0 >> 32), unit_interval(self.0))
    }
}

/// The upper 24 of the lower 32 bits as a number in `[0, 1)`: 24 bits fit an `f32`, so that
/// nothing rounds up to 1.
fn unit_interval(bits: u64) -> f32 {
    ((bits as u32) >> 8) as f32 * (1.0 / (1 << 24) as f32)
}

/// A bijection of 64 bits in which each bit depends on all (Stafford 2011, "Better Bit Mixing", variant 13).
#[inline(always)]
pub fn mix(mut x: u64) -> u64 {
    x = (x ^ (x >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    x = (x ^ (x >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    x ^ (x >> 31)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_largest_number_is_below_1() {
        assert!(unit_interval(u64::MAX) < 1.0);
        assert_eq!(unit_interval(0), 0.0);
    }

    /// Each bit of the words turns over half of the bits of the key.
    #[test]
    fn one_bit_changes_half_of_the_bits() {
        for bit in 0..64 {
            let mut changed = [0; 2];
            for word in 0..256 {
                let key = Key::new(word).with(7);
                let first = Key::new(word ^ (1 << bit)).with(7);
                let last = Key::new(word).with(7 ^ (1 << bit));
                changed[0] += (key.bits() ^ first.bits()).count_ones();
                changed[1] += (key.bits() ^ last.bits()).count_ones();
            }
            // 256 × 64 tosses have a standard deviation of 64.
            for changed in changed {
                assert!(changed.abs_diff(128 * 64) < 320, "bit {bit}: {changed}");
            }
        }
    }
}
