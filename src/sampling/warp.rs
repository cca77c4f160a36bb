//! Warps: from the unit square to other shapes, with areas in proportion.

use std::f32::consts::FRAC_PI_4;

use crate::math::{DVec3, Vec2};

/// The unit disk, uniform by area; squares around the middle become circles
/// (Shirley and Chiu 1997, "A Low Distortion Map Between Disk and Square").
pub fn square_to_disk(u: Vec2) -> Vec2 {
    let centered = 2.0 * u - Vec2::ONE;
    let (x, y) = (centered.x, centered.y);
    if x.abs() > y.abs() {
        let (sin, cos) = (FRAC_PI_4 * (y / x)).sin_cos();
        Vec2::new(x * cos, x * sin)
    } else if y != 0.0 {
        let (sin, cos) = (FRAC_PI_4 * (x / y)).sin_cos();
        Vec2::new(y * sin, y * cos)
    } else {
        Vec2::ZERO
    }
}

/// Unit vectors around +z, uniform by solid angle, whose cosine with it is `1 - one_minus_cos`
/// or more: a cone for a number in `(0, 2)`, every direction for 2.
///
/// Their density is `1 / (2π one_minus_cos)`. Cones may be as narrow as `f64` can hold.
pub fn square_to_cone(u: Vec2, one_minus_cos: f64) -> DVec3 {
    // The disk and the sphere's cap by Lambert's equal-area projection: the height falls with the
    // square of the radius.
    let disk = square_to_disk(u).as_dvec2();
    let depth = one_minus_cos * disk.length_squared().min(1.0);
    (disk * (one_minus_cos * (2.0 - depth)).sqrt()).extend(1.0 - depth)
}
