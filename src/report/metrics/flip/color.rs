//! FLIP's differences of colour.

use std::f32::consts::PI;
use std::sync::LazyLock;

use rayon::prelude::*;

use super::PIXELS_PER_DEGREE;
use super::space::{from_ycxcz, hyab, to_hunt_lab, to_ycxcz};
use crate::color::Rgb;
use crate::math::{UVec2, Vec3};
use crate::report::metrics::plane::Plane;

/// Differences are raised to this power.
const EXPONENT: f32 = 0.7;
/// This share of the largest difference …
const KNEE: f32 = 0.4;
/// … is mapped to this value, so that what is above it takes the rest of `[0, 1]`.
const KNEE_VALUE: f32 = 0.95;

/// Contrast sensitivity of each channel of YCxCz as a sum of Gaussians over the eye's angle: pairs of
/// height and width (table 1 of the paper; those of height 0 are left out).
const LUMINANCE: &[(f32, f32)] = &[(1.0, 0.0047)];
const RED_GREEN: &[(f32, f32)] = &[(1.0, 0.0053)];
const BLUE_YELLOW: &[(f32, f32)] = &[(34.1, 0.04), (13.5, 0.025)];
const WIDEST: f32 = 0.04;

/// The difference of every pixel's colour, in `[0, 1]`, as seen from the viewing distance.
pub fn differences(size: UVec2, test: &[Rgb], reference: &[Rgb]) -> Vec<f32> {
    let (test, reference) = (seen(size, test), seen(size, reference));
    let both = test.par_iter().zip(&reference);
    both.map(|(&a, &b)| redistributed(hyab(a, b))).collect()
}

/// The colours that are left after the eye's blur, in the space of [`to_hunt_lab`].
fn seen(size: UVec2, colors: &[Rgb]) -> Vec<Vec3> {
    let channel = |i: usize, gaussians| {
        let values = colors.par_iter().map(|&c| to_ycxcz(c)[i]).collect();
        blurred(&Plane::new(size, values), gaussians)
    };
    let y = channel(0, LUMINANCE);
    let cx = channel(1, RED_GREEN);
    let cz = channel(2, BLUE_YELLOW);
    (0..colors.len())
        .into_par_iter()
        .map(|i| {
            let color = from_ycxcz([y[i], cx[i], cz[i]]);
            to_hunt_lab(color.map(|c| c.clamp(0.0, 1.0)))
        })
        .collect()
}

/// The plane under a sum of Gaussians, which together have a weight of 1.
fn blurred(plane: &Plane<f32>, gaussians: &[(f32, f32)]) -> Vec<f32> {
    let lines: Vec<Vec<f32>> = gaussians.iter().map(|&(_, width)| line(width)).collect();
    let weights: Vec<f32> = gaussians
        .iter()
        .zip(&lines)
        .map(|(&(height, width), line)| {
            height * (PI / width).sqrt() * line.iter().sum::<f32>().powi(2)
        })
        .collect();
    let total: f32 = weights.iter().sum();
    let mut sum = vec![0.0; plane.values.len()];
    for (line, weight) in lines.iter().zip(weights) {
        let line_sum: f32 = line.iter().sum();
        let line: Vec<f32> = line.iter().map(|w| w / line_sum).collect();
        let blurred = plane.filtered(&line, &line);
        for (sum, value) in sum.iter_mut().zip(blurred.values) {
            *sum += weight / total * value;
        }
    }
    sum
}

/// exp(−π² x² / width) at the pixels of a row, x in degrees; as far as three deviations of the
/// widest.
fn line(width: f32) -> Vec<f32> {
    let radius = (3.0 * (WIDEST / (2.0 * PI * PI)).sqrt() * PIXELS_PER_DEGREE).ceil() as i32;
    (-radius..=radius)
        .map(|i| {
            let x = i as f32 / PIXELS_PER_DEGREE;
            (-PI * PI * x * x / width).exp()
        })
        .collect()
}

/// Spreads a difference over `[0, 1]` so that the common ones take most of it.
fn redistributed(difference: f32) -> f32 {
    static LARGEST: LazyLock<f32> = LazyLock::new(|| {
        let [green, blue] = [[0.0, 1.0, 0.0], [0.0, 0.0, 1.0]].map(|c| to_hunt_lab(c.into()));
        hyab(green, blue).powf(EXPONENT)
    });
    let raised = difference.powf(EXPONENT);
    let knee = KNEE * *LARGEST;
    if raised < knee {
        raised * KNEE_VALUE / knee
    } else {
        let above = (raised - knee) / (*LARGEST - knee);
        (KNEE_VALUE + above * (1.0 - KNEE_VALUE)).min(1.0)
    }
}
