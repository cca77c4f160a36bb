//! How far a picture is from its reference, in figures and pixel by pixel.
//!
//! A [`Pair`] checks once that the two can be compared; every metric is then a function of it
//! that cannot fail. [`Figures`] holds all of them. RMSE, relMSE and MAE are over linear values; PSNR,
//! SSIM and FLIP over what a screen shows (clipped to `[0, 1]`, sRGB-encoded); HDR-FLIP over
//! all exposures. Sums are in double precision and in a fixed order, so that the figures are
//! the same bits for any number of threads.

mod error_values;
mod figures;
mod flip;
mod pair;
mod pixelwise;
mod plane;
mod ssim;

pub use error_values::ErrorValues;
pub use figures::{Figures, Metric};
pub use flip::{flip, hdr_flip};
pub use pair::{NonFinite, Pair, PairError};
pub use pixelwise::{WorstPixel, mae, psnr, relative_error, relmse, rmse, worst_pixels};
pub use ssim::ssim;

use crate::color::{Rgb, linear_to_srgb};

/// What a screen shows of a linear colour: clipped to `[0, 1]` and sRGB-encoded.
fn displayed(color: Rgb) -> Rgb {
    color.map(|c| linear_to_srgb(c.clamp(0.0, 1.0)))
}
