//! A glossy coat over everything else, with a normal of its own.

use super::albedo;
use super::fresnel::{reflect, schlick_weight};
use super::layered::{MIRROR_ALPHA, Pair};
use super::microfacet::Ggx;
use crate::math::{Frame, UnitVec3, Vec2, Vec3};

/// Reflectance of a coat at normal incidence: an index of 1.5.
const COAT_F0: f32 = 0.04;

/// A glossy coat over everything else (`KHR_materials_clearcoat`).
#[derive(Clone, Copy, Debug)]
pub struct CoatLayer {
    /// How much of the surface it covers, in `[0, 1]`.
    pub share: f32,
    /// Roughness α, at least [`MIRROR_ALPHA`].
    pub alpha: f32,
}

/// Share that a facet of a coat reflects.
pub fn coat_fresnel(cos: f32) -> f32 {
    COAT_F0 + (1.0 - COAT_F0) * schlick_weight(cos)
}

impl CoatLayer {
    /// Share of the light that it sends to a viewer.
    pub fn albedo(&self, cos: f32) -> f32 {
        if self.alpha <= MIRROR_ALPHA {
            return coat_fresnel(cos);
        }
        let table = albedo::ggx(cos, self.alpha);
        COAT_F0 * table.x + table.y
    }

    /// Value, as that of a surface with the coat's own normal.
    pub fn value(&self, pair: &Pair, has_mirrors: bool) -> f32 {
        if self.alpha <= MIRROR_ALPHA && !has_mirrors {
            return 0.0;
        }
        let Some((wo, wi)) = self.in_own_frame(pair) else {
            return 0.0;
        };
        let half = (wo + wi).normalize_or(Vec3::Z);
        let ggx = Ggx::isotropic(self.alpha);
        let lobe = ggx.distribution(half) * ggx.visibility(wo, wi);
        // The cosine that the caller multiplies with is that of the base.
        self.share * coat_fresnel(wo.dot(half)) * lobe * (wi.z / pair.wi.z.max(1e-6))
    }

    /// Density of [`CoatLayer::draw`].
    pub fn pdf(&self, pair: &Pair) -> f32 {
        match self.in_own_frame(pair) {
            Some((wo, wi)) if self.alpha > MIRROR_ALPHA => {
                let half = (wo + wi).normalize_or(Vec3::Z);
                Ggx::isotropic(self.alpha).pdf(wo, half) / (4.0 * wo.dot(half))
            }
            _ => 0.0,
        }
    }

    /// A direction, and its cosine with the facet.
    pub fn draw(&self, wo: Vec3, normal: Vec3, u: Vec2) -> Option<(Vec3, f32)> {
        let frame = Frame::around(UnitVec3::normalize(normal)?);
        let wo = frame.to_local(wo);
        if wo.z <= 0.0 {
            return None;
        }
        let half = match self.alpha > MIRROR_ALPHA {
            true => Ggx::isotropic(self.alpha).sample(wo, u),
            false => Vec3::Z,
        };
        let wi = reflect(wo, half);
        (wi.z > 0.0).then(|| (frame.to_world(wi), wo.dot(half)))
    }

    /// Both directions about the coat's normal; `None` unless both are above it.
    fn in_own_frame(&self, pair: &Pair) -> Option<(Vec3, Vec3)> {
        let frame = Frame::around(UnitVec3::normalize(pair.coat_normal)?);
        let (wo, wi) = (frame.to_local(pair.wo), frame.to_local(pair.wi));
        (wo.z > 0.0 && wi.z > 0.0).then_some((wo, wi))
    }
}
