//! FLIP's differences of edges and points.

use std::f32::consts::FRAC_1_SQRT_2;

use rayon::prelude::*;

use super::PIXELS_PER_DEGREE;
use super::space::luminance;
use crate::color::Rgb;
use crate::math::UVec2;
use crate::report::metrics::plane::Plane;

/// Width of an edge that the eye tells best, degrees.
const EDGE_WIDTH: f32 = 0.082;

/// How much the edges and points around every pixel differ, in `[0, 1]`.
pub fn differences(size: UVec2, test: &[Rgb], reference: &[Rgb]) -> Vec<f32> {
    let (test, reference) = (features(size, test), features(size, reference));
    let both = test.par_iter().zip(&reference);
    both.map(|(a, b)| {
        let larger = (a.edge - b.edge).abs().max((a.point - b.point).abs());
        (FRAC_1_SQRT_2 * larger).sqrt().min(1.0)
    })
    .collect()
}

/// What stands out at a pixel.
struct Feature {
    /// Length of the gradient of luminance.
    edge: f32,
    /// Length of its second derivatives along x and y.
    point: f32,
}

fn features(size: UVec2, colors: &[Rgb]) -> Vec<Feature> {
    let luminances = colors.par_iter().map(|&c| luminance(c)).collect();
    let plane = Plane::new(size, luminances);
    let [smooth, slope, curvature] = lines();
    let smooth_rows = plane.filtered_across(&smooth);
    let derivatives = |line: &[f32]| {
        let along_x = plane.filtered_across(line).filtered_down(&smooth).values;
        let along_y = smooth_rows.filtered_down(line).values;
        (along_x, along_y)
    };
    let (slope_x, slope_y) = derivatives(&slope);
    let (curvature_x, curvature_y) = derivatives(&curvature);
    (0..colors.len())
        .into_par_iter()
        .map(|i| Feature {
            edge: slope_x[i].hypot(slope_y[i]),
            point: curvature_x[i].hypot(curvature_y[i]),
        })
        .collect()
}

/// A Gaussian and its first and second derivative; the Gaussian has the sum 1, the positive
/// weights of the others as well, and their negative ones −1.
fn lines() -> [Vec<f32>; 3] {
    let deviation = 0.5 * EDGE_WIDTH * PIXELS_PER_DEGREE;
    let radius = (3.0 * deviation).ceil() as i32;
    let line = |factor: fn(f32) -> f32| -> Vec<f32> {
        let at = |i: i32| {
            let x = i as f32 / deviation;
            factor(x) * (-0.5 * x * x).exp()
        };
        let weights: Vec<f32> = (-radius..=radius).map(at).collect();
        let sum = |is_positive: bool| -> f32 {
            let of_sign = weights.iter().filter(|&&w| (w > 0.0) == is_positive);
            of_sign.sum::<f32>().abs()
        };
        let (positive, negative) = (sum(true), sum(false));
        let scaled = |&w: &f32| if w > 0.0 { w / positive } else { w / negative };
        weights.iter().map(scaled).collect()
    };
    [
        // Never negative: its second sum, which nothing is divided by, is 0.
        line(|_| 1.0),
        line(|x| -x),
        line(|x| x * x - 1.0),
    ]
}
