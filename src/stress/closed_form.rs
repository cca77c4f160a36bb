//! Answers that are known without rendering.

use std::f64::consts::PI;

use crate::math::DVec3;

/// L1: the share of a disk of radius 1 that is beyond a straight line at signed distance `-s` from its
/// centre.
pub fn share_beyond(s: f64) -> f64 {
    let s = s.clamp(-1.0, 1.0);
    ((-s).acos() + s * (1.0 - s * s).sqrt()) / PI
}

/// L2: irradiance from a one-sided disk of radiance 1 that faces a parallel surface, `offset` from its axis.
pub fn disk_irradiance(radius: f64, height: f64, offset: f64) -> f64 {
    if offset == 0.0 {
        return PI * radius * radius / (radius * radius + height * height);
    }
    let (h, r) = (height / offset, radius / offset);
    let z = 1.0 + h * h + r * r;
    // Z² - 4ρ² = (Z - 2ρ)(Z + 2ρ), and Z - 2ρ² over the root loses digits where ρ is small.
    let root = ((h * h + (r - 1.0).powi(2)) * (h * h + (r + 1.0).powi(2))).sqrt();
    // (root - Z + 2ρ²) / root with root - Z = -4ρ²/(root + Z).
    0.5 * PI * r * r * (2.0 - 4.0 / (root + z)) / root
}

/// L3: irradiance from a sphere of radiance 1, wholly above the horizon, whose centre is `distance` away at
/// an angle of the cosine `cos` from the normal.
pub fn sphere_irradiance(radius: f64, distance: f64, cos: f64) -> f64 {
    PI * (radius / distance).powi(2) * cos
}

/// L4: irradiance at the origin from a polygon of radiance 1 above the horizon: Lambert's sum over its edges.
pub fn polygon_irradiance(corners: &[DVec3], normal: DVec3) -> f64 {
    let edges = corners.iter().zip(corners.iter().cycle().skip(1));
    0.5 * edges
        .map(|(a, b)| {
            let cross = a.cross(*b);
            cross.length().atan2(a.dot(*b)) * cross.normalize().dot(normal)
        })
        .sum::<f64>()
        .abs()
}

/// L9: share of unpolarised light that a border reflects, from Snell's law and Fresnel's equations
/// for both polarisations by angles (radians); `n` is the index beyond over the index before.
pub fn fresnel(angle: f64, n: f64) -> f64 {
    if angle == 0.0 {
        return ((n - 1.0) / (n + 1.0)).powi(2);
    }
    let beyond = (angle.sin() / n).asin();
    let s = (angle - beyond).sin() / (angle + beyond).sin();
    let p = (angle - beyond).tan() / (angle + beyond).tan();
    0.5 * (s * s + p * p)
}
