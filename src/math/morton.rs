//! The order in which neighbours in the plane are neighbours in a row, mostly.

use super::UVec2;

/// The column and row whose bits, in turns, are those of `code` (Morton 1966, "A Computer Oriented Geodetic Data Base").
///
/// Each run of 4^k codes from a multiple of it is a square of 2^k by 2^k.
pub fn morton_pixel(code: u32) -> UVec2 {
    UVec2::new(every_other_bit(code), every_other_bit(code >> 1))
}

/// The bits 0, 2, 4, … of `x`, next to each other.
fn every_other_bit(mut x: u32) -> u32 {
    x &= 0x5555_5555;
    x = (x ^ (x >> 1)) & 0x3333_3333;
    x = (x ^ (x >> 2)) & 0x0f0f_0f0f;
    x = (x ^ (x >> 4)) & 0x00ff_00ff;
    (x ^ (x >> 8)) & 0x0000_ffff
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn codes_are_the_bits_of_both_in_turns() {
        for (x, y) in [(0, 0), (1, 0), (0, 1), (0x1234, 0xfedc), (0xffff, 0)] {
            let code = (0..16).fold(0, |code, bit| {
                code | (x >> bit & 1) << (2 * bit) | (y >> bit & 1) << (2 * bit + 1)
            });
            assert_eq!(morton_pixel(code), UVec2::new(x, y));
        }
    }
}
