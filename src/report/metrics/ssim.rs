//! Structural similarity (Wang et al. 2004, "Image Quality Assessment: From Error Visibility to
//! Structural Similarity").

use super::plane::Plane;
use super::{Pair, displayed};
use crate::color::Rgb;
use crate::math::UVec2;

/// Half a window's side, less the middle: 11 × 11 pixels.
const RADIUS: u32 = 5;
/// Standard deviation of its Gaussian weights, pixels.
const SIGMA: f64 = 1.5;
/// (K₁ L)² and (K₂ L)² with K₁ = 0.01, K₂ = 0.03 and a range L of 1.
const C1: f64 = 0.0001;
const C2: f64 = 0.0009;

/// Mean structural similarity; 1 where the pictures look the same.
///
/// As Wang et al.: windows of 11 × 11 pixels with Gaussian weights (σ = 1.5), K₁ = 0.01, K₂ =
/// 0.03, variances without Bessel's correction, and only windows that lie inside of the picture. Of
/// displayed values (clipped to `[0, 1]`, sRGB-encoded, not rounded to levels), as the mean over
/// red, green and blue. `None` where the picture holds no window, or none around a pixel that counts.
pub fn ssim(pair: &Pair) -> Option<f64> {
    let size = pair.size();
    if size.min_element() <= 2 * RADIUS {
        return None;
    }
    let inside = inside(pair);
    if inside.is_empty() {
        return None;
    }
    let channels: [fn(Rgb) -> f32; 3] = [|c| c.r, |c| c.g, |c| c.b];
    let sum: f64 = channels
        .into_iter()
        .map(|channel| {
            let values = |pixels: &[Rgb]| -> Vec<f64> {
                let channel = |&pixel: &Rgb| f64::from(channel(displayed(pixel)));
                pixels.iter().map(channel).collect()
            };
            let map = similarities(size, &values(pair.test()), &values(pair.reference()));
            inside.iter().map(|&i| map[i]).sum::<f64>()
        })
        .sum();
    Some(sum / (3 * inside.len()) as f64)
}

/// Indices of the pixels that count and whose window lies inside of the picture.
fn inside(pair: &Pair) -> Vec<usize> {
    let UVec2 { x, y } = pair.size() - RADIUS;
    let is_inside = |place: UVec2| (RADIUS..x).contains(&place.x) && (RADIUS..y).contains(&place.y);
    let counted = pair.is_counted().iter().enumerate();
    counted
        .filter(|&(i, &is_counted)| is_counted && is_inside(pair.place(i)))
        .map(|(i, _)| i)
        .collect()
}

/// The similarity of every window of one channel (equation 13).
fn similarities(size: UVec2, a: &[f64], b: &[f64]) -> Vec<f64> {
    let weights = weights();
    let mean = |values: Vec<f64>| Plane::new(size, values).filtered(&weights, &weights).values;
    let mean_of_product =
        |a: &[f64], b: &[f64]| mean(a.iter().zip(b).map(|(a, b)| a * b).collect());
    let (mean_a, mean_b) = (mean(a.to_vec()), mean(b.to_vec()));
    let (square_a, square_b) = (mean_of_product(a, a), mean_of_product(b, b));
    let product = mean_of_product(a, b);
    (0..a.len())
        .map(|i| {
            let (ma, mb) = (mean_a[i], mean_b[i]);
            let variances = square_a[i] - ma * ma + square_b[i] - mb * mb;
            let covariance = product[i] - ma * mb;
            (2.0 * ma * mb + C1) * (2.0 * covariance + C2)
                / ((ma * ma + mb * mb + C1) * (variances + C2))
        })
        .collect()
}

fn weights() -> Vec<f64> {
    let radius = f64::from(RADIUS);
    let gaussian = |i: u32| (-0.5 * ((f64::from(i) - radius) / SIGMA).powi(2)).exp();
    let weights: Vec<f64> = (0..=2 * RADIUS).map(gaussian).collect();
    let sum: f64 = weights.iter().sum();
    weights.into_iter().map(|w| w / sum).collect()
}
