//! Warps: from the unit square to other shapes, with areas in proportion.

use std::f64::consts::FRAC_PI_4;

use crate::math::{DVec2, DVec3, Vec2, Vec3, lesser};

/// The unit disk, uniform by area; squares around the middle become circles
/// (Shirley and Chiu 1997, "A Low Distortion Map Between Disk and Square").
#[inline(always)]
pub fn square_to_disk(u: Vec2) -> Vec2 {
    exact_disk(u).as_vec2()
}

/// Unit vectors around +z, as many by solid angle as their cosine with it: the disk, raised to the sphere above
/// (Pharr, Jakob and Humphreys 2016, "Physically Based Rendering", 13.6.3, who name Malley for it). Their density is
/// the cosine / π.
#[inline(always)]
pub fn square_to_hemisphere(u: Vec2) -> Vec3 {
    let disk = square_to_disk(u);
    disk.extend((1.0 - disk.length_squared()).max(0.0).sqrt())
}

/// [`square_to_disk`] before it is rounded, without a branch.
#[inline(always)]
fn exact_disk(u: Vec2) -> DVec2 {
    let (x, y) = (2.0 * f64::from(u.x) - 1.0, 2.0 * f64::from(u.y) - 1.0);
    let is_wide = x.abs() > y.abs();
    let (radius, other) = if is_wide { (x, y) } else { (y, x) };
    let turn = other / if radius == 0.0 { 1.0 } else { radius };
    let (sin, cos) = sin_cos(FRAC_PI_4 * turn);
    let (along, across) = (radius * cos, radius * sin);
    if is_wide {
        DVec2::new(along, across)
    } else {
        DVec2::new(across, along)
    }
}

/// Sine and cosine of an angle up to a quarter of π, within 1e-12: the first terms of their series.
#[inline(always)]
fn sin_cos(angle: f64) -> (f64, f64) {
    let square = angle * angle;
    let mut sin = -1.0 / 39_916_800.0;
    for term in [
        1.0 / 362_880.0,
        -1.0 / 5_040.0,
        1.0 / 120.0,
        -1.0 / 6.0,
        1.0,
    ] {
        sin = sin * square + term;
    }
    let mut cos = 1.0 / 479_001_600.0;
    for term in [
        -1.0 / 3_628_800.0,
        1.0 / 40_320.0,
        -1.0 / 720.0,
        1.0 / 24.0,
        -0.5,
        1.0,
    ] {
        cos = cos * square + term;
    }
    (angle * sin, cos)
}

/// Unit vectors around +z, uniform by solid angle, whose cosine with it is `1 - one_minus_cos`
/// or more: a cone for a number in `(0, 2)`, every direction for 2.
///
/// Their density is `1 / (2π one_minus_cos)`. Cones may be as narrow as `f64` can hold.
#[inline(always)]
pub fn square_to_cone(u: Vec2, one_minus_cos: f64) -> DVec3 {
    // The disk and the sphere's cap by Lambert's equal-area projection: the height falls with the
    // square of the radius.
    let disk = exact_disk(u);
    let depth = one_minus_cos * lesser(disk.length_squared(), 1.0);
    (disk * (one_minus_cos * (2.0 - depth)).sqrt()).extend(1.0 - depth)
}
