//! How a point light weakens with distance.

/// Attenuation with distance d: `1 / (constant + linear d + quadratic d²)`, and none beyond `range`.
#[derive(Clone, Copy, Debug)]
pub struct Falloff {
    /// At any distance.
    pub constant: f32,
    /// Per unit of distance.
    pub linear: f32,
    /// Per unit of distance squared.
    pub quadratic: f32,
    /// Distance at which the light has faded to nothing (`KHR_lights_punctual`); infinite for physical lights.
    pub range: f32,
}

impl Falloff {
    /// The inverse square law.
    pub const INVERSE_SQUARE: Self = Self {
        constant: 0.0,
        linear: 0.0,
        quadratic: 1.0,
        range: f32::INFINITY,
    };

    /// Share of the intensity that arrives at `distance` as irradiance; infinite where the
    /// divisor is 0.
    pub(super) fn attenuation(&self, distance: f64) -> f64 {
        let constant = f64::from(self.constant);
        let linear = f64::from(self.linear);
        let quadratic = f64::from(self.quadratic);
        let window = 1.0 - (distance / f64::from(self.range)).powi(4);
        window.clamp(0.0, 1.0) / (constant + linear * distance + quadratic * distance * distance)
    }

    /// The same attenuation at `scale` times the distance. The coefficients stay finite for
    /// scales from 1e-19 to 1e19.
    pub(super) fn placed(&self, scale: f32) -> Self {
        Self {
            constant: self.constant,
            linear: self.linear / scale,
            quadratic: self.quadratic / scale / scale,
            range: self.range * scale,
        }
    }
}
