//! The sheen of cloth (Estevez and Kulla 2017, "Production Friendly Microfacet Sheen BRDF"), in the
//! coordinates of a shading frame.

use std::f32::consts::TAU;

use super::albedo;
use crate::color::Rgb;
use crate::math::Vec3;

/// A layer of fibres that stand up.
#[derive(Clone, Copy, Debug)]
pub struct SheenLayer {
    /// Its colour at grazing incidence.
    pub color: Rgb,
    /// Roughness α, above 0.
    pub alpha: f32,
}

/// The smallest α: below it the lobe is but a line along the horizon.
pub const MIN_SHEEN_ALPHA: f32 = 0.0049;

/// Distribution times visibility (Neubelt and Pettineo 2013), of colour 1, for directions above the
/// surface.
pub fn lobe(wo: Vec3, wi: Vec3, alpha: f32) -> f32 {
    let half = (wo + wi).normalize_or(Vec3::Z);
    let sine2 = half.truncate().length_squared().min(1.0);
    let exponent = 1.0 / alpha;
    let distribution = (2.0 + exponent) * sine2.powf(0.5 * exponent) / TAU;
    distribution / (4.0 * (wo.z + wi.z - wo.z * wi.z))
}

impl SheenLayer {
    /// Share of the light that the lobe of colour 1 sends to a viewer, in `[0, 1]`.
    fn albedo(&self, cos: f32) -> f32 {
        albedo::charlie(cos, self.alpha).clamp(0.0, 1.0)
    }

    /// Value, 1/sr. Where the lobe as published would send more than it gets, near the horizon,
    /// it is scaled down, the same for both directions.
    pub fn value(&self, wo: Vec3, wi: Vec3) -> Rgb {
        let most = albedo::charlie(wo.z, self.alpha).max(albedo::charlie(wi.z, self.alpha));
        self.color * (lobe(wo, wi, self.alpha) / most.max(1.0))
    }

    /// What the layer sends to a viewer, per channel at most.
    pub fn share(&self, cos: f32) -> f32 {
        self.color.max_channel() * self.albedo(cos)
    }
}
