//! The colour spaces of FLIP, for linear Rec. 709 colours under D65.
//!
//! The white is (1, 1, 1) in linear Rec. 709, so tristimulus values are divided by the sums of the
//! matrix' rows.

use crate::color::Rgb;
use crate::math::Vec3;

/// From linear Rec. 709 to CIE XYZ, rows.
const TO_XYZ: [Vec3; 3] = [
    Vec3::new(0.412_386_56, 0.357_591_5, 0.180_450_49),
    Vec3::new(0.212_636_82, 0.715_183, 0.072_180_2),
    Vec3::new(0.019_330_62, 0.119_197_16, 0.950_372_6),
];

/// Its inverse, rows.
const FROM_XYZ: [Vec3; 3] = [
    Vec3::new(3.241_003_2, -1.537_399, -0.498_615_9),
    Vec3::new(-0.969_224_3, 1.875_93, 0.041_554_226),
    Vec3::new(0.055_639_42, -0.204_011_2, 1.057_149),
];

/// XYZ of white.
const WHITE: Vec3 = Vec3::new(0.950_428_55, 1.0, 1.088_900_4);

fn times(rows: &[Vec3; 3], v: Vec3) -> Vec3 {
    Vec3::new(rows[0].dot(v), rows[1].dot(v), rows[2].dot(v))
}

/// XYZ over that of white.
fn relative_xyz(color: Rgb) -> Vec3 {
    times(&TO_XYZ, Vec3::from(color.channels())) / WHITE
}

/// Luminance over that of white.
pub fn luminance(color: Rgb) -> f32 {
    TO_XYZ[1].dot(Vec3::from(color.channels()))
}

/// The linear opponent space YCxCz in which contrast sensitivity is known.
pub fn to_ycxcz(color: Rgb) -> [f32; 3] {
    let Vec3 { x, y, z } = relative_xyz(color);
    [116.0 * y - 16.0, 500.0 * (x - y), 200.0 * (y - z)]
}

/// Back from YCxCz; may lie outside of `[0, 1]`.
pub fn from_ycxcz([y, cx, cz]: [f32; 3]) -> Rgb {
    let y = (y + 16.0) / 116.0;
    let xyz = Vec3::new(y + cx / 500.0, y, y - cz / 200.0) * WHITE;
    Rgb::from(times(&FROM_XYZ, xyz).to_array())
}

/// CIELAB whose a and b shrink with lightness, after Hunt: dark colours look less colourful.
pub fn to_hunt_lab(color: Rgb) -> Vec3 {
    const DELTA: f32 = 6.0 / 29.0;
    let root = |t: f32| {
        if t > DELTA.powi(3) {
            t.cbrt()
        } else {
            t / (3.0 * DELTA * DELTA) + 4.0 / 29.0
        }
    };
    let relative = relative_xyz(color);
    let (x, y, z) = (root(relative.x), root(relative.y), root(relative.z));
    let lightness = 116.0 * y - 16.0;
    let hunt = 0.01 * lightness;
    Vec3::new(lightness, hunt * 500.0 * (x - y), hunt * 200.0 * (y - z))
}

/// Distance of two colours of [`to_hunt_lab`] that is large (Abasi et al. 2020, "Distance Metrics
/// for Very Large Color Differences").
pub fn hyab(a: Vec3, b: Vec3) -> f32 {
    let d = a - b;
    d.x.abs() + d.y.hypot(d.z)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ycxcz_leads_back() {
        for color in [[0.2, 0.5, 0.9], [0.0, 0.0, 0.0], [1.0, 0.0, 0.3]] {
            let back = from_ycxcz(to_ycxcz(color.into())).channels();
            for (a, b) in back.into_iter().zip(color) {
                assert!((a - b).abs() < 1e-5, "{back:?} for {color:?}");
            }
        }
    }

    #[test]
    fn white_is_white_and_grey_has_no_colour() {
        let white = to_hunt_lab(Rgb::WHITE);
        assert!(
            (white - Vec3::new(100.0, 0.0, 0.0)).length() < 1e-3,
            "{white}"
        );
        let grey = to_hunt_lab(Rgb::splat(0.184_186_5));
        // L* of that grey is 50 (CIE 15).
        assert!((grey - Vec3::new(50.0, 0.0, 0.0)).length() < 1e-3, "{grey}");
    }
}
