//! How varied the samples of each half of each pixel are: what says where more of them are needed.

use rayon::prelude::*;

use super::tile::Halves;
use crate::film::{Moments, Pixel, Rect, relative_weights};

/// What a half has seen in its pixel counts like this many samples less than the neighbours' mean where it is more than
/// that: a bright thing that only some samples meet.
const HIGH: f32 = 4.0;

/// The same where it is less.
///
/// Many, since a half that has been unlucky has seen little variance too: the other stays small, and where both missed
/// the same, they agree while the error is larger than their difference says. Neighbours have no part in that.
const LOW: f32 = 32.0;

/// Nothing counts as more varied: neither the sum over the pixels around nor the product with a number of samples, which
/// is below 2^32, overflows.
const MOST: f32 = 1e28;

/// How varied the samples of each half of each pixel are, over what the metric divides by; finite, and not below 0.
pub(super) struct Difficulty {
    /// By pixel, row by row, as all that follow.
    halves: Vec<[f32; 2]>,
    /// The mean over both halves of the pixels around.
    around: Vec<f32>,
}

impl Difficulty {
    /// Of the `pixels` that fill `film`.
    pub fn of(film: Rect, pixels: &[Pixel]) -> Self {
        let halves = variations(film, pixels);
        let both = |i: usize| halves[i][0] + halves[i][1];
        let around = by_nine(
            film,
            |i| [both(i)],
            |i, count, [sum]| {
                let others = 2.0 * (count - 1.0);
                if others > 0.0 {
                    (sum - both(i)).max(0.0) / others
                } else {
                    0.0
                }
            },
        );
        Self { around, halves }
    }

    /// For each half of pixel `i`: what the other half, which has `taken` samples, and the pixels around say.
    pub fn for_halves(&self, i: usize, taken: Halves) -> [f32; 2] {
        let (own, around) = (self.halves[i], self.around[i]);
        [1, 0].map(|other: usize| {
            let (count, own) = (taken[other] as f32, own[other]);
            let neighbours = if own > around { HIGH } else { LOW };
            (count * own + neighbours * around) / (count + neighbours)
        })
    }
}

/// The variance of the samples of a half in units of the metric, summed over the channels; `None` where there is but one.
fn variation(half: &Moments) -> Option<f32> {
    let weights = relative_weights(half.mean());
    let weighted = half.sample_variance().into_iter().zip(weights);
    (half.count() > 1).then(|| held(weighted.map(|(v, w)| v * w).sum::<f64>() as f32))
}

/// Held to [`MOST`], which is what overflows count for as well, be they infinite or NaN.
fn held(variation: f32) -> f32 {
    if variation < MOST {
        variation.max(0.0)
    } else {
        MOST
    }
}

/// How varied the samples of each half are; where it has but one, those of the pixels around.
fn variations(film: Rect, pixels: &[Pixel]) -> Vec<[f32; 2]> {
    let is_known = |pixel: &Pixel| pixel.halves().iter().all(|half| half.count() > 1);
    if pixels.par_iter().all(is_known) {
        let known = |pixel: &Pixel| {
            pixel
                .halves()
                .each_ref()
                .map(|h| variation(h).unwrap_or(0.0))
        };
        return pixels.par_iter().map(known).collect();
    }
    let moments = |i: usize| {
        let [a, b] = pixels[i].halves().each_ref().map(|half| {
            let [r, g, b] = half.mean().map(|c| c as f32);
            [r, g, b, r * r + g * g + b * b]
        });
        [a[0], a[1], a[2], a[3], b[0], b[1], b[2], b[3]]
    };
    by_nine(film, moments, |i, count, sums: [f32; 8]| {
        [0, 1].map(|half| {
            let [r, g, b, squares] = [0, 1, 2, 3].map(|k| sums[4 * half + k]);
            let of_means = (r * r + g * g + b * b) / count;
            let spread = (squares - of_means) / f32::max(count - 1.0, 1.0);
            let half = &pixels[i].halves()[half];
            let weights = || relative_weights(half.mean()).iter().sum::<f64>() / 3.0;
            variation(half).unwrap_or_else(|| held(weights() as f32 * spread))
        })
    })
}

/// What `of` makes, for each pixel, of its number, of how many there are of it and the eight pixels around, and of the sum
/// of the `value`s of these.
fn by_nine<const N: usize, T: Clone + Default + Send>(
    film: Rect,
    value: impl Fn(usize) -> [f32; N] + Sync,
    of: impl Fn(usize, f32, [f32; N]) -> T + Sync,
) -> Vec<T> {
    let (width, height) = (film.width as usize, film.height as usize);
    let mut all = vec![T::default(); width * height];
    let rows = all.par_chunks_mut(width.max(1)).enumerate();
    rows.for_each_init(
        || vec![[0.0; N]; width],
        |columns, (y, row)| {
            let others = y.saturating_sub(1)..(y + 2).min(height);
            columns.fill([0.0; N]);
            for other in others.clone() {
                for (x, sum) in columns.iter_mut().enumerate() {
                    add(sum, &value(other * width + x));
                }
            }
            for (x, result) in row.iter_mut().enumerate() {
                let columns = &columns[x.saturating_sub(1)..(x + 2).min(width)];
                let mut sum = [0.0; N];
                for column in columns {
                    add(&mut sum, column);
                }
                let count = (columns.len() * others.len()) as f32;
                *result = of(y * width + x, count, sum);
            }
        },
    );
    all
}

fn add<const N: usize>(sum: &mut [f32; N], values: &[f32; N]) {
    for (sum, value) in sum.iter_mut().zip(values) {
        *sum += value;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sums_are_those_of_the_pixels_around() {
        for (width, height) in [(1, 1), (1, 4), (5, 1), (4, 3)] {
            let film = Rect {
                x: 7,
                y: 9,
                width,
                height,
            };
            let value = |x: u32, y: u32| (1 + x + 10 * y) as f32;
            let at = |i: usize| [value(i as u32 % width, i as u32 / width)];
            let sums = by_nine(film, at, |_, count, [sum]| [count, sum]);
            for (i, got) in sums.iter().enumerate() {
                let (x, y) = (i as u32 % width, i as u32 / width);
                let (mut expected, mut count) = (0.0, 0.0);
                for row in y.saturating_sub(1)..(y + 2).min(height) {
                    for column in x.saturating_sub(1)..(x + 2).min(width) {
                        expected += value(column, row);
                        count += 1.0;
                    }
                }
                assert_eq!(*got, [count, expected], "{width} × {height}, {x}, {y}");
            }
        }
    }
}
