//! The unit square cut into m × n cells, and their order.

use crate::math::{ONE_MINUS_EPSILON, Vec2};

use super::key::Key;

/// m × n equal cells of the unit square.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Cells {
    columns: u32,
    rows: u32,
}

impl Cells {
    /// The fewest cells, `count` or more, in rows and columns whose numbers differ by at most 2:
    /// ⌊√count⌋ rows and as many columns as it takes. 81 gives 9 × 9, 10 gives 4 × 3.
    pub fn at_least(count: u32) -> Self {
        let count = count.max(1);
        let rows = count.isqrt();
        Self {
            columns: count.div_ceil(rows),
            rows,
        }
    }

    /// Their number. No overflow: 2^32 − 1 = 65,537 × 65,535.
    pub fn count(self) -> u32 {
        self.columns * self.rows
    }

    /// A point of the cell that comes at place `index` in the random order of `key`: its centre,
    /// or anywhere in it where `is_jittered`. Past the last cell another order begins.
    pub fn point(self, key: Key, index: u32, is_jittered: bool) -> Vec2 {
        let round = index / self.count();
        let key = key.with(u64::from(round));
        let cell = permute(index - round * self.count(), self.count(), key);
        let inside = if is_jittered {
            key.with(u64::from(index)).point()
        } else {
            Vec2::splat(0.5)
        };
        Vec2::new(
            coordinate(cell % self.columns, inside.x, self.columns),
            coordinate(cell / self.columns, inside.y, self.rows),
        )
    }
}

/// In double precision, so that a point stays in its cell; the last step may still round up to 1.
fn coordinate(cell: u32, inside: f32, cells: u32) -> f32 {
    let x = (f64::from(cell) + f64::from(inside)) / f64::from(cells);
    (x as f32).min(ONE_MINUS_EPSILON)
}

/// Where a random permutation of `0..count` puts `index`.
///
/// A bijection of the next power of two is repeated until it lands below `count` (cycle walking,
/// as in Kensler 2013, "Correlated Multi-Jittered Sampling"). The rotation at the end makes every
/// place equally likely for every index, whatever the quality of the bijection.
fn permute(index: u32, count: u32, key: Key) -> u32 {
    if count == 1 {
        return 0;
    }
    let bits = u32::BITS - (count - 1).leading_zeros();
    let mask = u32::MAX >> (u32::BITS - bits);
    let words = key.bits();
    let (a, b) = (words as u32, (words >> 32) as u32);
    let shift = (bits / 2).max(1);
    // Four rounds: with three, some pairs of places are 20 % more likely than others.
    let rounds = [
        (a, b),
        (b >> 9, a >> 7),
        (a >> 19, b >> 17),
        (a >> 13, b >> 5),
    ];
    let mut x = index;
    loop {
        // Odd factors carry low bits up, shifts carry high bits down; each step is a bijection.
        for (toggle, factor) in rounds {
            x = (x ^ toggle) & mask;
            x = x.wrapping_mul(factor | 1) & mask;
            x ^= x >> shift;
            x = x.wrapping_add(toggle >> 4) & mask;
        }
        if x < count {
            break;
        }
    }
    // Not the key of any index: those place the points inside their cells.
    let rotation = (u64::from(key.with(u64::MAX).bits() as u32) * u64::from(count)) >> 32;
    ((u64::from(x) + rotation) % u64::from(count)) as u32
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_place_is_taken_once() {
        for count in [1, 2, 3, 7, 12, 64, 81, 1000, 1025] {
            for seed in 0..20 {
                let key = Key::new(seed);
                let mut places: Vec<_> = (0..count).map(|i| permute(i, count, key)).collect();
                places.sort_unstable();
                assert!(places.into_iter().eq(0..count), "{count}, seed {seed}");
            }
        }
    }

    /// Any two cells are equally often the first two: what a prefix of the order needs.
    #[test]
    fn pairs_of_places_are_equally_likely() {
        const SEEDS: u64 = 60_000;
        for count in [3, 6, 8, 9] {
            let mut pairs = vec![0u32; (count * count) as usize];
            for seed in 0..SEEDS {
                let key = Key::new(seed);
                pairs[(permute(0, count, key) * count + permute(1, count, key)) as usize] += 1;
            }
            let expected = SEEDS as f64 / f64::from(count * (count - 1));
            for (pair, &n) in pairs.iter().enumerate() {
                let is_same = pair as u32 / count == pair as u32 % count;
                let share = f64::from(n) / expected;
                assert!(
                    if is_same {
                        n == 0
                    } else {
                        (share - 1.0).abs() < 0.25
                    },
                    "{count} cells, pair {pair}: {share} of what is expected"
                );
            }
        }
    }

    #[test]
    fn cells_are_nearly_square_and_not_overflowing() {
        for count in (0..2000).chain([1 << 24, u32::MAX - 1, u32::MAX]) {
            let cells = Cells::at_least(count);
            assert!(cells.count() >= count.max(1));
            assert!(cells.columns.abs_diff(cells.rows) <= 2, "{cells:?}");
            assert_eq!(Cells::at_least(cells.count()), cells, "for {count}");
        }
    }
}
