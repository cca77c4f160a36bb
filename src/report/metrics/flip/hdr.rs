//! FLIP over exposures (Andersson et al. 2021, "Visualizing Errors in Rendered High Dynamic Range
//! Images").

use super::of_display;
use crate::color::Rgb;
use crate::report::metrics::{ErrorValues, Pair};

/// The ACES curve of FLIP, (a₀x² + a₁x) / (b₀x² + b₁x + b₂): Narkowicz 2015, "ACES Filmic Tone Mapping
/// Curve", at 0.6 of the exposure.
const A: [f32; 2] = [0.6 * 0.6 * 2.51, 0.6 * 0.03];
const B: [f32; 3] = [0.6 * 0.6 * 2.43, 0.6 * 0.59, 0.14];

/// What the curve makes of the brightest exposed value.
const BRIGHT: f32 = 0.85;

/// Far above what the curve tells from white, far below what overflows when it is squared.
const BRIGHTEST: f32 = 1e6;

/// HDR-FLIP of every pixel, in `[0, 1]`: the largest LDR-FLIP over exposures, a stop apart or
/// somewhat less, from that at which the reference's brightest pixel is not yet white to that at
/// which its median is there, tone-mapped with ACES. Negative values count as 0.
pub fn hdr_flip(pair: &Pair) -> ErrorValues {
    let mut largest = vec![0.0f32; pair.test().len()];
    for stops in exposures(pair) {
        let shown = |pixels: &[Rgb]| -> Vec<Rgb> {
            let scale = stops.exp2();
            let show = |pixel: &Rgb| pixel.map(|c| tone_mapped(c * scale));
            pixels.iter().map(show).collect()
        };
        let values = of_display(pair.size(), &shown(pair.test()), &shown(pair.reference()));
        for (largest, value) in largest.iter_mut().zip(values) {
            *largest = largest.max(value);
        }
    }
    ErrorValues::of(pair, largest.into_iter())
}

/// The stops by which the pictures are exposed.
fn exposures(pair: &Pair) -> Vec<f32> {
    let counted = pair.reference().iter().zip(pair.is_counted());
    let mut luminances: Vec<f32> = counted
        .filter(|(_, is_counted)| **is_counted)
        .map(|(pixel, _)| pixel.map(|c| c.max(0.0)).luminance())
        .collect();
    luminances.sort_unstable_by(f32::total_cmp);
    let brightest = luminances.last().copied().unwrap_or(0.0);
    // The upper one of the two in the middle, as in the authors' program.
    let median = luminances.get(luminances.len() / 2).copied().unwrap_or(0.0);
    if brightest <= 0.0 {
        return vec![0.0];
    }
    // Where half of the picture is black the exposures have to end somewhere: 23 stops below 1, as
    // the authors' program has it, or below the brightest pixel of a dark picture.
    let floor = f32::EPSILON * brightest.min(1.0);
    let bright = inverse_tone_map(BRIGHT);
    let start = (bright / brightest).log2();
    let stop = (bright / median.max(floor)).log2();
    let steps = (stop - start).ceil().max(2.0) as usize - 1;
    let step = (stop - start) / steps as f32;
    (0..=steps).map(|i| start + i as f32 * step).collect()
}

fn tone_mapped(x: f32) -> f32 {
    let x = x.clamp(0.0, BRIGHTEST);
    let mapped = (A[0] * x + A[1]) * x / ((B[0] * x + B[1]) * x + B[2]);
    mapped.clamp(0.0, 1.0)
}

/// What the curve maps to `y`: the positive root of its quadratic equation.
fn inverse_tone_map(y: f32) -> f32 {
    let a = A[0] - y * B[0];
    let b = A[1] - y * B[1];
    let c = -y * B[2];
    (-b + (b * b - 4.0 * a * c).sqrt()) / (2.0 * a)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_tone_map_leads_back() {
        for y in [0.1, 0.5, BRIGHT] {
            assert!((tone_mapped(inverse_tone_map(y)) - y).abs() < 1e-5, "{y}");
        }
    }
}
