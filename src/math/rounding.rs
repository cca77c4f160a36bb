//! Rounding-error bounds of single precision.

/// The largest `f32` below 1: what a number in `[0, 1)` is clamped to after rounding.
pub const ONE_MINUS_EPSILON: f32 = 1.0 - f32::EPSILON / 2.0;

/// Half the distance from 1 to the next `f32`: the largest relative error of one operation.
pub const UNIT_ROUNDOFF: f32 = f32::EPSILON / 2.0;

/// Bound of the relative error that `n` roundings in a row can add up to
/// (Higham 2002, "Accuracy and Stability of Numerical Algorithms", section 3.1).
pub const fn gamma(n: u32) -> f32 {
    let nu = n as f32 * UNIT_ROUNDOFF;
    nu / (1.0 - nu)
}
