//! Colours for errors: black, violet, red, orange, pale yellow.
//!
//! Lightness grows evenly with the value, so that equal steps look equal, in print without colours
//! too. Computed in Oklab (Ottosson 2020, "A perceptual color space for image processing") from a hue
//! that turns evenly and a chroma that is as large as the display allows.

use std::f32::consts::PI;
use std::sync::LazyLock;

use crate::color::Rgb;
use crate::math::Vec3;

/// Lightness of the largest value; that of 0 is 0.
const LIGHTEST: f32 = 0.97;
/// Hues of 0 and of the largest value, degrees: by way of 360, red.
const HUES: (f32, f32) = (285.0, 468.0);
/// The largest chroma that any value gets.
const MOST_CHROMA: f32 = 0.2;

/// The linear colour of a value in `[0, 1]`; what lies outside takes the colour of the end.
pub fn color(value: f32) -> Rgb {
    static TABLE: LazyLock<[Rgb; 256]> =
        LazyLock::new(|| std::array::from_fn(|i| computed(i as f32 / 255.0)));
    TABLE[(value.clamp(0.0, 1.0) * 255.0).round() as usize]
}

fn computed(value: f32) -> Rgb {
    let hue = (HUES.0 + (HUES.1 - HUES.0) * value).to_radians();
    let of_chroma = |chroma: f32| {
        let (sin, cos) = hue.sin_cos();
        from_oklab(Vec3::new(LIGHTEST * value, chroma * cos, chroma * sin))
    };
    let is_shown = |c: Rgb| c.channels().iter().all(|c| (-1e-4..=1.0001).contains(c));
    let wanted = MOST_CHROMA * (PI * value).sin().powf(0.7);
    let (mut inside, mut outside) = (0.0, wanted);
    if is_shown(of_chroma(wanted)) {
        inside = wanted;
    }
    // Where the display cannot show it, the nearest chroma that it can.
    for _ in 0..20 {
        let middle = 0.5 * (inside + outside);
        if is_shown(of_chroma(middle)) {
            inside = middle;
        } else {
            outside = middle;
        }
    }
    of_chroma(inside).map(|c| c.clamp(0.0, 1.0))
}

fn from_oklab(lab: Vec3) -> Rgb {
    let l = lab.dot(Vec3::new(1.0, 0.396_337_78, 0.215_803_76)).powi(3);
    let m = lab
        .dot(Vec3::new(1.0, -0.105_561_346, -0.063_854_17))
        .powi(3);
    let s = lab.dot(Vec3::new(1.0, -0.089_484_18, -1.291_485_5)).powi(3);
    Rgb::new(
        4.076_741_7 * l - 3.307_711_6 * m + 0.230_969_93 * s,
        -1.268_438 * l + 2.609_757_4 * m - 0.341_319_38 * s,
        -0.004_196_086_3 * l - 0.703_418_6 * m + 1.707_614_7 * s,
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lightness_grows_evenly() {
        // CIE lightness, which Oklab's was not made from.
        let lightness = |value: f32| 116.0 * color(value).luminance().cbrt() - 16.0;
        let steps: Vec<f32> = (1..16)
            .map(|i| lightness((i + 1) as f32 / 16.0) - lightness(i as f32 / 16.0))
            .collect();
        assert!(steps.iter().all(|s| (3.0..10.0).contains(s)), "{steps:?}");
    }

    #[test]
    fn ends_are_black_and_nearly_white() {
        assert!(color(0.0).max_channel() < 1e-3);
        assert_eq!(color(-3.0), color(0.0));
        assert_eq!(color(7.0), color(1.0));
        assert!(color(1.0).luminance() > 0.85);
    }
}
