//! Tone maps: from linear radiance of any size to `[0, 1]`, before the sRGB curve.

use crate::color::Rgb;
use crate::scene::ToneMap;

/// Far above what any tone map tells from white, far below what overflows when it is squared.
const BRIGHTEST: f32 = 1e9;

/// The linear display colour, in `[0, 1]`, that shows `radiance` (Rec. 709, linear).
///
/// Negative values and those that are not numbers count as 0.
pub fn tone_mapped(radiance: Rgb, tone_map: ToneMap) -> Rgb {
    // A comparison that is false for what is not a number, so that it becomes 0 as well.
    let radiance = radiance.map(|c| if c > 0.0 { c.min(BRIGHTEST) } else { 0.0 });
    let shown = match tone_map {
        ToneMap::None => radiance,
        ToneMap::Aces => radiance.map(aces),
        ToneMap::Agx => agx(radiance),
        ToneMap::PbrNeutral => pbr_neutral(radiance),
    };
    shown.map(|c| c.clamp(0.0, 1.0))
}

/// Narkowicz 2015, "ACES Filmic Tone Mapping Curve", per channel.
fn aces(x: f32) -> f32 {
    (x * (2.51 * x + 0.03)) / (x * (2.43 * x + 0.59) + 0.14)
}

/// Khronos PBR Neutral (Khronos Group 2024, "Khronos PBR Neutral Tone Mapper Specification").
///
/// Base colours below 0.8 come out as they went in under white light, less the 4 % that
/// dielectrics reflect on top of them; what is brighter is compressed and desaturated.
fn pbr_neutral(color: Rgb) -> Rgb {
    const NORMAL_REFLECTANCE: f32 = 0.04;
    const START: f32 = 0.8 - NORMAL_REFLECTANCE;
    const DESATURATION: f32 = 0.15;
    let least = color.r.min(color.g).min(color.b);
    let offset = if least < 2.0 * NORMAL_REFLECTANCE {
        least - least * least / (4.0 * NORMAL_REFLECTANCE)
    } else {
        NORMAL_REFLECTANCE
    };
    let color = color.map(|c| c - offset);
    let peak = color.max_channel();
    if peak < START {
        return color;
    }
    let room = 1.0 - START;
    let new_peak = 1.0 - room * room / (peak + room - START);
    let whiteness = 1.0 - 1.0 / (DESATURATION * (peak - new_peak) + 1.0);
    (color * (new_peak / peak)).lerp(Rgb::splat(new_peak), whiteness)
}

/// Exposures that AgX shows, in stops about middle grey.
const AGX_STOPS: [f32; 2] = [-10.0, 6.5];
const MIDDLE_GREY: f32 = 0.18;

/// Rows of the matrix that brings the Rec. 709 primaries inwards, so that bright saturated
/// colours go to white, and of its inverse (Sobotka 2022; Wrensch 2023, "Minimal AgX
/// Implementation").
const AGX_INSET: [[f32; 3]; 3] = [
    [0.842_479_06, 0.078_433_6, 0.079_223_745],
    [0.042_328_242, 0.878_468_64, 0.079_166_13],
    [0.042_375_655, 0.078_433_6, 0.879_143],
];
const AGX_OUTSET: [[f32; 3]; 3] = [
    [1.196_879, -0.098_020_88, -0.099_029_74],
    [-0.052_896_852, 1.151_903_1, -0.098_961_18],
    [-0.052_971_64, -0.098_043_45, 1.151_073_7],
];

/// AgX with its default look (Sobotka 2022).
fn agx(color: Rgb) -> Rgb {
    let log_encoded = transformed(&AGX_INSET, color).map(|c| {
        let stops = (c / MIDDLE_GREY).log2();
        ((stops - AGX_STOPS[0]) / (AGX_STOPS[1] - AGX_STOPS[0])).clamp(0.0, 1.0)
    });
    let shown = transformed(&AGX_OUTSET, log_encoded.map(agx_contrast));
    // The curve ends in values for a display of gamma 2.2; ours are linear from here.
    shown.map(|c| c.max(0.0).powf(2.2))
}

fn transformed(rows: &[[f32; 3]; 3], color: Rgb) -> Rgb {
    Rgb::from(rows.map(|[r, g, b]| r * color.r + g * color.g + b * color.b))
}

/// The S-curve of AgX on log-encoded values: slope 2 at middle grey, which comes out as 0.5;
/// a toe and a shoulder that end in (0, 0) and (1, 1).
fn agx_contrast(x: f32) -> f32 {
    const SLOPE: f32 = 2.0;
    const MIDDLE: f32 = 0.5;
    let pivot = -AGX_STOPS[0] / (AGX_STOPS[1] - AGX_STOPS[0]);
    let (reach, sign, power) = if x < pivot {
        (pivot, -1.0, 3.0)
    } else {
        (1.0 - pivot, 1.0, 3.25)
    };
    // h(t) = t / (1 + t^p)^(1/p), scaled so that it has come up to `MIDDLE` at the end.
    let end = SLOPE * reach;
    let scale = end / ((end / MIDDLE).powf(power) - 1.0).powf(1.0 / power);
    let t = SLOPE * (x - pivot).abs() / scale;
    MIDDLE + sign * scale * t / (1.0 + t.powf(power)).powf(1.0 / power)
}

#[cfg(test)]
mod tests {
    use super::*;

    const ALL: [ToneMap; 4] = [
        ToneMap::None,
        ToneMap::Aces,
        ToneMap::Agx,
        ToneMap::PbrNeutral,
    ];

    #[test]
    fn black_stays_black_and_greys_keep_their_order() {
        for tone_map in ALL {
            // AgX ends in a sum that rounds to about 1e-8 before its power of 2.2.
            let black = tone_mapped(Rgb::BLACK, tone_map);
            assert!(black.max_channel() < 1e-9, "{tone_map:?}: {black:?}");
            let mut last = 0.0;
            for step in -60..120 {
                let grey = Rgb::splat(2f32.powf(step as f32 / 6.0));
                let shown = tone_mapped(grey, tone_map).g;
                assert!(
                    shown >= last - 1e-6 && shown <= 1.0,
                    "{tone_map:?} {grey:?}: {last}, {shown}"
                );
                last = shown;
            }
            assert!(last > 0.99, "{tone_map:?} ends at {last}");
        }
    }

    #[test]
    fn greys_stay_grey() {
        for tone_map in ALL {
            for level in [0.01, 0.18, 0.9, 7.0] {
                let [r, g, b] = tone_mapped(Rgb::splat(level), tone_map).channels();
                let spread = (r - g).abs().max((g - b).abs());
                // The published rows of AgX's matrices add up to 1 within 1.4e-4.
                assert!(spread < 5e-4, "{tone_map:?} {level}: {r} {g} {b}");
            }
        }
    }

    #[test]
    fn any_input_gives_a_colour() {
        for tone_map in ALL {
            for c in [f32::NAN, -1.0, f32::MAX, f32::INFINITY, 1e-45] {
                for color in [Rgb::splat(c), Rgb::new(c, 0.0, 1.0)] {
                    let shown = tone_mapped(color, tone_map);
                    let is_shown = |v: f32| (0.0..=1.0).contains(&v);
                    assert!(
                        shown.channels().into_iter().all(is_shown),
                        "{tone_map:?} {color:?}: {shown:?}"
                    );
                }
            }
        }
    }

    #[test]
    fn without_a_tone_map_values_are_clipped() {
        let shown = tone_mapped(Rgb::new(-0.5, 0.3, 2.0), ToneMap::None);
        assert_eq!(shown, Rgb::new(0.0, 0.3, 1.0));
    }

    #[test]
    fn aces_has_its_published_values() {
        // 2.54 / 3.16, and the limit 2.51 / 2.43, which is clipped.
        assert!((tone_mapped(Rgb::WHITE, ToneMap::Aces).r - 0.803_797_5).abs() < 1e-6);
        assert_eq!(tone_mapped(Rgb::splat(1e6), ToneMap::Aces), Rgb::WHITE);
    }

    #[test]
    fn neutral_takes_4_percent_off_and_nothing_else_below_its_start() {
        for color in [Rgb::new(0.5, 0.3, 0.1), Rgb::new(0.79, 0.2, 0.08)] {
            let shown = tone_mapped(color, ToneMap::PbrNeutral);
            for (a, b) in color.channels().into_iter().zip(shown.channels()) {
                assert!((a - b - 0.04).abs() < 1e-6, "{color:?} {shown:?}");
            }
        }
        // Below 0.08 the offset itself is x - 6.25 x², so that black stays black.
        let dark = tone_mapped(Rgb::splat(0.04), ToneMap::PbrNeutral).r;
        assert!((dark - 6.25 * 0.04 * 0.04).abs() < 1e-7);
    }

    #[test]
    fn neutral_compresses_and_desaturates_above_its_start() {
        // By hand, for (2, 0, 0): offset 0, peak 2, room 0.24.
        let new_peak = 1.0 - 0.0576 / 1.48;
        let white = 1.0 - 1.0 / (0.15 * (2.0 - new_peak) + 1.0);
        let shown = tone_mapped(Rgb::new(2.0, 0.0, 0.0), ToneMap::PbrNeutral);
        assert!((shown.r - new_peak).abs() < 1e-6);
        assert!((shown.g - new_peak * white).abs() < 1e-6);
    }

    /// The specification's mapping backwards, solved for the input.
    fn neutral_inverse(shown: Rgb) -> Rgb {
        const F90: f32 = 0.04;
        const KS: f32 = 0.8 - F90;
        let new_peak = shown.max_channel();
        let offset_color = if new_peak <= KS {
            shown
        } else {
            let peak = (1.0 - KS).powi(2) / (1.0 - new_peak) - 1.0 + 2.0 * KS;
            let g = 1.0 / (0.15 * (peak - new_peak) + 1.0);
            shown.map(|c| (c - new_peak * (1.0 - g)) * peak / (new_peak * g))
        };
        let least = offset_color.r.min(offset_color.g).min(offset_color.b);
        let offset = if least <= F90 {
            2.0 * (F90 * least.max(0.0)).sqrt() - least
        } else {
            F90
        };
        offset_color.map(|c| c + offset)
    }

    #[test]
    fn neutral_is_undone_by_the_inverse_of_its_specification() {
        let levels = [0.01, 0.05, 0.3, 0.79, 0.9, 2.0, 7.0];
        for color in levels
            .iter()
            .flat_map(|&r| levels.map(|g| Rgb::new(r, g, 0.6 * g)))
        {
            let back = neutral_inverse(tone_mapped(color, ToneMap::PbrNeutral));
            // Next to a bright channel single precision has little left of a dark one.
            let largest = color.max_channel();
            for (a, b) in color.channels().into_iter().zip(back.channels()) {
                let error = (a - b).abs();
                assert!(error < 1e-4 * largest.max(1.0), "{color:?}: {back:?}");
            }
        }
    }

    /// Entries of the table that is published with AgX (Sobotka 2022, `AgX_Default_Contrast.spi1d`), of 4096.
    #[test]
    fn agx_has_the_curve_of_its_published_table() {
        for (entry, value) in [
            (0, 0.0),
            (1, 0.000_014_2),
            (1446, 0.095_970_1),
            (1447, 0.096_169_0),
            (3540, 0.927_017_7),
            (3544, 0.927_882_5),
            (4085, 0.999_285_7),
            (4090, 0.999_644_7),
            (4095, 1.0),
        ] {
            let curve = agx_contrast(entry as f32 / 4095.0);
            assert!((curve - value).abs() < 3e-6, "{entry}: {curve}, {value}");
        }
    }

    #[test]
    fn agx_shows_middle_grey_at_half_of_gamma_2_2() {
        let shown = tone_mapped(Rgb::splat(0.18), ToneMap::Agx).g;
        assert!((shown.powf(1.0 / 2.2) - 0.5).abs() < 1e-4, "{shown}");
    }

    #[test]
    fn agx_follows_the_published_polynomial() {
        // Wrensch 2023: a fit of the same curve, to about 0.002 (root mean square).
        for step in 0..=100 {
            let x = step as f32 / 100.0;
            let fit = [15.5, -40.14, 31.96, -6.868, 0.4298, 0.1191, -0.00232]
                .into_iter()
                .fold(0.0, |sum, coefficient| sum * x + coefficient);
            let curve = agx_contrast(x);
            assert!((curve - fit).abs() < 0.006, "{x}: {curve}, {fit}");
        }
    }

    #[test]
    fn agx_sends_bright_saturated_colours_to_white() {
        let faint = tone_mapped(Rgb::new(0.2, 0.0, 0.0), ToneMap::Agx);
        let bright = tone_mapped(Rgb::new(2000.0, 0.0, 0.0), ToneMap::Agx);
        assert!(faint.g < 0.3 * faint.r, "{faint:?}");
        assert!(bright.g > 0.6 * bright.r, "{bright:?}");
    }
}
