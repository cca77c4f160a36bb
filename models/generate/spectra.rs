//! The measured spectra of the Cornell box, and how they become three numbers.

/// First wavelength of the reflectances, and the step to the next, in nanometres.
const REFLECTANCE_GRID: (f64, f64) = (400.0, 4.0);

/// Reflectance of the white walls and blocks.
pub const WHITE: [f64; 76] = [
    0.343, 0.445, 0.551, 0.624, 0.665, 0.687, 0.708, 0.723, 0.715, 0.710, 0.745, 0.758, 0.739,
    0.767, 0.777, 0.765, 0.751, 0.745, 0.748, 0.729, 0.745, 0.757, 0.753, 0.750, 0.746, 0.747,
    0.735, 0.732, 0.739, 0.734, 0.725, 0.721, 0.733, 0.725, 0.732, 0.743, 0.744, 0.748, 0.728,
    0.716, 0.733, 0.726, 0.713, 0.740, 0.754, 0.764, 0.752, 0.736, 0.734, 0.741, 0.740, 0.732,
    0.745, 0.755, 0.751, 0.744, 0.731, 0.733, 0.744, 0.731, 0.712, 0.708, 0.729, 0.730, 0.727,
    0.707, 0.703, 0.729, 0.750, 0.760, 0.751, 0.739, 0.724, 0.730, 0.740, 0.737,
];

/// Reflectance of the green wall, which the camera sees on its right.
pub const GREEN: [f64; 76] = [
    0.092, 0.096, 0.098, 0.097, 0.098, 0.095, 0.095, 0.097, 0.095, 0.094, 0.097, 0.098, 0.096,
    0.101, 0.103, 0.104, 0.107, 0.109, 0.112, 0.115, 0.125, 0.140, 0.160, 0.187, 0.229, 0.285,
    0.343, 0.390, 0.435, 0.464, 0.472, 0.476, 0.481, 0.462, 0.447, 0.441, 0.426, 0.406, 0.373,
    0.347, 0.337, 0.314, 0.285, 0.277, 0.266, 0.250, 0.230, 0.207, 0.186, 0.171, 0.160, 0.148,
    0.141, 0.136, 0.130, 0.126, 0.123, 0.121, 0.122, 0.119, 0.114, 0.115, 0.117, 0.117, 0.118,
    0.120, 0.122, 0.128, 0.132, 0.139, 0.144, 0.146, 0.150, 0.152, 0.157, 0.159,
];

/// Reflectance of the red wall, which the camera sees on its left.
pub const RED: [f64; 76] = [
    0.040, 0.046, 0.048, 0.053, 0.049, 0.050, 0.053, 0.055, 0.057, 0.056, 0.059, 0.057, 0.061,
    0.061, 0.060, 0.062, 0.062, 0.062, 0.061, 0.062, 0.060, 0.059, 0.057, 0.058, 0.058, 0.058,
    0.056, 0.055, 0.056, 0.059, 0.057, 0.055, 0.059, 0.059, 0.058, 0.059, 0.061, 0.061, 0.063,
    0.063, 0.067, 0.068, 0.072, 0.080, 0.090, 0.099, 0.124, 0.154, 0.192, 0.255, 0.287, 0.349,
    0.402, 0.443, 0.487, 0.513, 0.558, 0.584, 0.620, 0.606, 0.609, 0.651, 0.612, 0.610, 0.650,
    0.638, 0.627, 0.620, 0.630, 0.628, 0.642, 0.639, 0.657, 0.639, 0.635, 0.642,
];

/// Radiance of the lamp at 400, 500, 600 and 700 nm.
pub const LAMP: [f64; 4] = [0.0, 8.0, 15.6, 18.4];

/// Linear Rec. 709 colour of a reflectance, under light of equal energy at every wavelength; a
/// perfect white is (1, 1, 1).
pub fn reflectance(values: &[f64]) -> [f64; 3] {
    to_rgb(REFLECTANCE_GRID, values)
}

/// Linear Rec. 709 colour of the lamp: a spectrum that is 1 at every wavelength would be (1, 1, 1).
pub fn lamp() -> [f64; 3] {
    to_rgb((400.0, 100.0), &LAMP)
}

fn to_rgb((first, step): (f64, f64), values: &[f64]) -> [f64; 3] {
    let [mut color, mut white] = [[0.0; 3]; 2];
    for nanometres in 400..=700 {
        let wavelength = f64::from(nanometres);
        let place = (wavelength - first) / step;
        let i = (place as usize).min(values.len() - 2);
        let value = values[i] + (place - i as f64) * (values[i + 1] - values[i]);
        let rgb = rec709(color_matching(wavelength));
        for channel in 0..3 {
            color[channel] += rgb[channel] * value;
            white[channel] += rgb[channel];
        }
    }
    std::array::from_fn(|channel| color[channel] / white[channel])
}

/// The CIE 1931 functions x, y, z (the fit of Wyman, Sloan and Shirley 2013, "Simple Analytic
/// Approximations to the CIE XYZ Color Matching Functions").
fn color_matching(wavelength: f64) -> [f64; 3] {
    let lobe = |height: f64, mean: f64, below: f64, above: f64| {
        let width = if wavelength < mean { below } else { above };
        let t = (wavelength - mean) / width;
        height * (-0.5 * t * t).exp()
    };
    [
        lobe(1.056, 599.8, 37.9, 31.0) + lobe(0.362, 442.0, 16.0, 26.7)
            - lobe(0.065, 501.1, 20.4, 26.2),
        lobe(0.821, 568.8, 46.9, 40.5) + lobe(0.286, 530.9, 16.3, 31.1),
        lobe(1.217, 437.0, 11.8, 36.0) + lobe(0.681, 459.0, 26.0, 13.8),
    ]
}

/// From XYZ to linear Rec. 709 (IEC 61966-2-1).
fn rec709([x, y, z]: [f64; 3]) -> [f64; 3] {
    [
        3.2406 * x - 1.5372 * y - 0.4986 * z,
        -0.9689 * x + 1.8758 * y + 0.0415 * z,
        0.0557 * x - 0.2040 * y + 1.0570 * z,
    ]
}
