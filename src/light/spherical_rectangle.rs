//! A rectangle as seen from a point.

use std::f64::consts::TAU;

use super::hypotenuse;
use crate::math::{DVec2, DVec3, Vec2};

/// The directions from the origin in which a rectangle is seen
/// (Ureña et al. 2013, "An Area-Preserving Parametrization for Spherical Rectangles").
///
/// Solid angles are arctangents, which lose nothing when the rectangle is near or seen
/// edge-on, where the paper's arccosines of nearly 1 do.
#[derive(Clone, Copy, Debug)]
pub(super) struct SphericalRectangle {
    /// Corners, with the foot of the perpendicular from the origin at (0, 0).
    min: DVec2,
    max: DVec2,
    /// Distance of the rectangle's plane.
    height: f64,
    solid_angle: f64,
    /// Cosine and sine of the solid angle from x = 0 to `min.x`.
    start: DVec2,
}

impl SphericalRectangle {
    /// Cosine of the angle between edges up to which they count as perpendicular.
    const SKEW: f64 = 1e-6;
    /// Below it (a square of 0.0001 radians across), differences of solid angles are noise.
    const SMALLEST_SOLID_ANGLE: f64 = 1e-8;

    /// `None` where the edges are not perpendicular or the solid angle is tiny. `height` is the distance
    /// of the plane, above 0.
    pub fn new(center: DVec3, half_u: DVec3, half_v: DVec3, height: f64) -> Option<Self> {
        let half = DVec2::new(half_u.length(), half_v.length());
        if half_u.dot(half_v).abs() > Self::SKEW * half.x * half.y {
            return None;
        }
        let middle = DVec2::new(center.dot(half_u), center.dot(half_v)) / half;
        let (min, max) = (middle - half, middle + half);
        let start = strip(min.x, min.y, max.y, height);
        let end = strip(max.x, min.y, max.y, height);
        let between = start.perp_dot(end).atan2(start.dot(end));
        // More than half a turn, of which both ends have a part, one more than a quarter; else it is rounding.
        let is_more = between < 0.0 && min.x < 0.0 && max.x > 0.0 && start.x.min(end.x) < 0.0;
        let solid_angle = if is_more { between + TAU } else { between };
        (solid_angle > Self::SMALLEST_SOLID_ANGLE).then(|| Self {
            min,
            max,
            height,
            solid_angle,
            start: start.normalize(),
        })
    }

    /// In steradians.
    pub fn solid_angle(&self) -> f64 {
        self.solid_angle
    }

    /// A point, uniform by solid angle: its place along both edges, in `[-1, 1]²`.
    pub fn sample(&self, u: Vec2) -> DVec2 {
        let u = u.as_dvec2();
        let angle = DVec2::from_angle(u.x * self.solid_angle);
        let x = self.x_of(self.start.rotate(angle));
        // With x fixed, solid angle is in proportion to the sine of the elevation.
        let distance = hypotenuse(x, self.height);
        let sin = |y: f64| y / hypotenuse(y, distance);
        let elevation = sin(self.min.y) + u.y * (sin(self.max.y) - sin(self.min.y));
        let y = elevation * distance / ((1.0 - elevation) * (1.0 + elevation)).max(0.0).sqrt();
        let place = DVec2::new(x, y).clamp(self.min, self.max);
        ((place - self.min) / (self.max - self.min) * 2.0 - DVec2::ONE)
            .clamp(DVec2::NEG_ONE, DVec2::ONE)
    }

    /// The x up to which the solid angle from x = 0 has this cosine and sine: the inverse of [`strip`]
    /// (the paper's equation for cos θᵤ).
    fn x_of(&self, DVec2 { x: cos, y: sin }: DVec2) -> f64 {
        let to_low = hypotenuse(self.min.y, self.height);
        let (sin_low, cos_low) = (self.min.y / to_low, self.height / to_low);
        let sin_high = self.max.y / hypotenuse(self.max.y, self.height);
        let f = (sin_high - sin_low * cos) / sin;
        // cos θ / sin θ with cos θ = ±1/√(f² + sin_low²).
        let cotangent_squared = 1.0 / ((f - cos_low) * (f + cos_low)).max(0.0);
        self.height * cotangent_squared.sqrt().copysign(f)
    }
}

/// A vector whose angle with the x axis is the solid angle of the rectangle from (0, y_low) to (x, y_high) at
/// distance `height`; negative for negative x.
fn strip(x: f64, y_low: f64, y_high: f64, height: f64) -> DVec2 {
    // That of a rectangle from (0, 0) to (x, y) is the angle of this vector, below a quarter turn; the difference
    // of two angles is that of one vector seen from the other.
    let quadrant = |y: f64| DVec2::new(height * DVec3::new(x, y, height).length(), x * y);
    let (low, high) = (quadrant(y_low), quadrant(y_high));
    DVec2::new(low.dot(high), low.perp_dot(high))
}
