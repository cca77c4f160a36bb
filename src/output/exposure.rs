//! The exposure that a picture asks for by its own brightness.

use crate::color::Rgb;

/// What the average of a picture is to be on the screen, linear: middle grey.
const MIDDLE_GREY: f64 = 0.18;
/// The share of the pixels at each end of the range of brightness that does not count: lamps, and dark corners.
const TRIM: f64 = 0.05;

/// Stops of exposure, to a hundredth, that bring the geometric mean of the luminance to middle grey (Reinhard et al.
/// 2002, "Photographic Tone Reproduction for Digital Images"); 0 for a picture without light.
///
/// Black pixels do not count, nor do the brightest and the darkest twentieth of the others.
pub fn automatic_exposure(pixels: &[Rgb]) -> f32 {
    let stops = pixels
        .iter()
        .map(|pixel| f64::from(pixel.luminance()).log2());
    let mut stops: Vec<f64> = stops.filter(|stops| stops.is_finite()).collect();
    stops.sort_unstable_by(f64::total_cmp);
    let trim = (TRIM * stops.len() as f64) as usize;
    let counted = &stops[trim..stops.len() - trim];
    if counted.is_empty() {
        return 0.0;
    }
    let mean = counted.iter().sum::<f64>() / counted.len() as f64;
    ((100.0 * (MIDDLE_GREY.log2() - mean)).round() / 100.0) as f32
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_geometric_mean_comes_to_middle_grey() {
        // Three stops below and one above middle grey: one below on average.
        let grey = |stops: f32| Rgb::splat(0.18 * stops.exp2());
        assert_eq!(automatic_exposure(&[grey(-3.0), grey(1.0)]), 1.0);
        assert_eq!(automatic_exposure(&[grey(7.25)]), -7.25);
    }

    #[test]
    fn neither_black_nor_lamps_count() {
        let mut pixels = vec![Rgb::splat(0.09); 90];
        pixels.extend([Rgb::splat(1e6); 5]);
        pixels.extend([Rgb::splat(1e-30); 5]);
        pixels.extend([Rgb::BLACK; 900]);
        pixels.push(Rgb::splat(f32::NAN));
        assert_eq!(automatic_exposure(&pixels), 1.0);
        assert_eq!(automatic_exposure(&[Rgb::BLACK; 9]), 0.0);
        assert_eq!(automatic_exposure(&[]), 0.0);
    }
}
