//! FLIP: the difference that a person sees who flips between two pictures (Andersson et al. 2020,
//! "FLIP: A Difference Evaluator for Alternating Images").
//!
//! Colours are blurred as far as the eye blurs them and compared ([`color`]); edges and points are
//! compared apart ([`feature`]) and make differences of colour weigh more. [`hdr`] does so over
//! exposures.

mod color;
mod feature;
mod hdr;
mod space;

use rayon::prelude::*;

use super::{ErrorValues, Pair};
use crate::color::Rgb;
use crate::math::UVec2;

pub use hdr::hdr_flip;

/// Pixels in a degree of the eye's angle: a display 0.7 m wide of 3840 pixels, at 0.7 m.
const PIXELS_PER_DEGREE: f32 = 0.7 * 3840.0 / 0.7 * (std::f32::consts::PI / 180.0);

/// LDR-FLIP of every pixel, in `[0, 1]`, of displayed values: clipped to `[0, 1]`, not rounded
/// to levels. For a viewer 0.7 m from a display that is 0.7 m and 3840 pixels wide.
pub fn flip(pair: &Pair) -> ErrorValues {
    let clipped = |pixels: &[Rgb]| -> Vec<Rgb> {
        let clip = |pixel: &Rgb| pixel.map(|c| c.clamp(0.0, 1.0));
        pixels.iter().map(clip).collect()
    };
    let (test, reference) = (clipped(pair.test()), clipped(pair.reference()));
    let values = of_display(pair.size(), &test, &reference);
    ErrorValues::of(pair, values.into_iter())
}

/// LDR-FLIP of linear colours in `[0, 1]`.
fn of_display(size: UVec2, test: &[Rgb], reference: &[Rgb]) -> Vec<f32> {
    let colors = color::differences(size, test, reference);
    let features = feature::differences(size, test, reference);
    let both = colors.par_iter().zip(&features);
    both.map(|(color, feature)| color.powf(1.0 - feature))
        .collect()
}
