//! A point that shines into a cone.

use super::point::shadow_end;
use super::{Falloff, LightBounds, LightSample, Toward, has_extent, weigh};
use crate::color::Rgb;
use crate::math::{Aabb, UnitVec3, Vec2, Vec3};

/// A point that shines into a cone.
#[derive(Clone, Copy, Debug)]
pub struct SpotLight {
    /// Where it is.
    pub position: Vec3,
    /// The axis of its cone: the way the light travels.
    pub direction: UnitVec3,
    /// Radiant intensity inside the inner cone, W/sr.
    pub intensity: Rgb,
    /// Half angle of full intensity, radians.
    pub inner_angle_radians: f32,
    /// Half angle beyond which there is none, radians; above the inner one.
    pub outer_angle_radians: f32,
    /// As for a point light.
    pub radius: f32,
    /// Shadow rays per shading point.
    pub samples: u32,
    /// How the light weakens with distance.
    pub falloff: Falloff,
}

impl SpotLight {
    /// See [`super::Light::sample`].
    pub fn sample(&self, point: Vec3, u: Vec2) -> Option<LightSample> {
        let toward = Toward::new(point, self.position)?;
        let wi = toward.unit();
        let attenuation = self.cone_share(wi) * self.falloff.attenuation(toward.distance);
        Some(LightSample {
            wi,
            weight: weigh(self.intensity, attenuation)?,
            density: 0.0,
            shadow: shadow_end(self.position, self.radius, wi, u),
        })
    }

    /// Share of the intensity that leaves against `wi`: 1 in the inner cone, 0 beyond the outer
    /// one, the square of a ramp that is linear in the cosine between them (`KHR_lights_punctual`).
    fn cone_share(&self, wi: UnitVec3) -> f64 {
        // Cosines by their distance from 1, so that cones as narrow as a laser's keep their shape:
        // 1 - cos a = 2 sin²(a/2), and for two unit vectors |v - w|² / 2.
        let one_minus_cos = 0.5 * (-wi.as_dvec3()).distance_squared(self.direction.as_dvec3());
        let inner = one_minus_cos_of(self.inner_angle_radians);
        let outer = one_minus_cos_of(self.outer_angle_radians);
        if one_minus_cos >= outer {
            0.0
        } else if one_minus_cos <= inner {
            1.0
        } else {
            ((outer - one_minus_cos) / (outer - inner)).powi(2)
        }
    }

    /// See [`super::Light::light_bounds`].
    pub fn light_bounds(&self) -> LightBounds {
        let bounds = Aabb::of_points([self.position]);
        LightBounds {
            // Full strength in the inner cone, none beyond the outer one; a little more for rounding.
            normals_radians: self.inner_angle_radians,
            emission_radians: self.outer_angle_radians - self.inner_angle_radians + 1e-5,
            ..LightBounds::flat(
                bounds,
                self.direction,
                false,
                self.intensity.luminance().into(),
            )
        }
    }

    /// See [`super::Light::is_delta`].
    pub fn is_delta(&self) -> bool {
        !has_extent(self.radius)
    }

    /// See [`super::Light::placed`].
    pub fn placed(&self, scale: f32, offset: Vec3) -> Self {
        Self {
            position: self.position * scale + offset,
            radius: self.radius * scale,
            falloff: self.falloff.placed(scale),
            ..*self
        }
    }
}

fn one_minus_cos_of(angle_radians: f32) -> f64 {
    2.0 * (0.5 * f64::from(angle_radians)).sin().powi(2)
}
