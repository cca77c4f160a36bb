//! Metrics that look at one pixel at a time.

use std::cmp::Ordering;

use super::{ErrorValues, Pair, displayed};
use crate::color::Rgb;
use crate::math::UVec2;

/// Keeps relative errors finite where the reference is black (Rousselle et al. 2011, "Adaptive
/// Sampling and Reconstruction using Greedy Error Minimization").
const DARK: f64 = 0.01;

/// Root of the mean squared difference over pixels and channels, of linear values.
pub fn rmse(pair: &Pair) -> f64 {
    channel_mean(pair, |test, reference| (test - reference).powi(2)).sqrt()
}

/// Mean over pixels and channels of (a − b)² / (b² + 0.01), where b is the reference; of linear
/// values.
pub fn relmse(pair: &Pair) -> f64 {
    channel_mean(pair, relative_square)
}

/// Mean absolute difference over pixels and channels, of linear values.
pub fn mae(pair: &Pair) -> f64 {
    channel_mean(pair, |test, reference| (test - reference).abs())
}

/// Peak signal-to-noise ratio in dB, of displayed values (clipped to `[0, 1]`, sRGB-encoded, not
/// rounded to levels), with a peak of 1. Infinite where they are the same.
pub fn psnr(pair: &Pair) -> f64 {
    let squares = |pixels: (&Rgb, &Rgb)| {
        let (test, reference) = (displayed(*pixels.0), displayed(*pixels.1));
        squared_difference(test, reference)
    };
    // Pixels that do not count are black in both.
    let sum: f64 = pair.test().iter().zip(pair.reference()).map(squares).sum();
    -10.0 * (sum / (3 * pair.counted()) as f64).log10()
}

/// Per pixel the root of its share of [`relmse`].
pub fn relative_error(pair: &Pair) -> ErrorValues {
    ErrorValues::of(pair, relative_errors(pair).map(|error| error as f32))
}

/// A pixel with a large error.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct WorstPixel {
    /// Which pixel.
    pub pixel: UVec2,
    /// Its colour in the picture that is measured.
    pub test: Rgb,
    /// Its colour in the reference.
    pub reference: Rgb,
    /// Its [`relative_error`].
    pub relative_error: f64,
}

/// The `count` pixels with the largest [`relative_error`], the largest first, and of equal ones
/// the upper left first. Pixels without an error are left out.
pub fn worst_pixels(pair: &Pair, count: usize) -> Vec<WorstPixel> {
    let mut errors: Vec<(usize, f64)> = relative_errors(pair)
        .enumerate()
        .filter(|(_, error)| *error > 0.0)
        .collect();
    let by_error = |a: &(usize, f64), b: &(usize, f64)| -> Ordering {
        b.1.total_cmp(&a.1).then(a.0.cmp(&b.0))
    };
    if count < errors.len() {
        errors.select_nth_unstable_by(count, by_error);
        errors.truncate(count);
    }
    errors.sort_unstable_by(by_error);
    let worst = errors.into_iter().map(|(i, relative_error)| WorstPixel {
        pixel: pair.place(i),
        test: pair.test()[i],
        reference: pair.reference()[i],
        relative_error,
    });
    worst.collect()
}

fn relative_errors(pair: &Pair) -> impl Iterator<Item = f64> {
    let both = pair.test().iter().zip(pair.reference());
    both.map(|(test, reference)| (channel_sum(*test, *reference, relative_square) / 3.0).sqrt())
}

fn relative_square(test: f64, reference: f64) -> f64 {
    (test - reference).powi(2) / (reference.powi(2) + DARK)
}

fn squared_difference(test: Rgb, reference: Rgb) -> f64 {
    channel_sum(test, reference, |a, b| (a - b).powi(2))
}

/// The mean of `error(test, reference)`, which is 0 for two zeros.
fn channel_mean(pair: &Pair, error: impl Fn(f64, f64) -> f64) -> f64 {
    let both = pair.test().iter().zip(pair.reference());
    // Pixels that do not count are black in both.
    let sum: f64 = both
        .map(|(test, reference)| channel_sum(*test, *reference, &error))
        .sum();
    sum / (3 * pair.counted()) as f64
}

fn channel_sum(test: Rgb, reference: Rgb, error: impl Fn(f64, f64) -> f64) -> f64 {
    let both = test.channels().into_iter().zip(reference.channels());
    both.map(|(test, reference)| error(f64::from(test), f64::from(reference)))
        .sum()
}
