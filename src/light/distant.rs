//! Parallel light from far away, such as the sun.

use std::f64::consts::{FRAC_PI_2, PI, TAU};

use super::{LightSample, ShadowEnd, has_extent, weigh};
use crate::color::Rgb;
use crate::math::{Frame, UnitVec3, Vec2, Vec3};
use crate::sampling::square_to_cone;

/// Parallel light from far away, such as the sun.
#[derive(Clone, Copy, Debug)]
pub struct DistantLight {
    /// The way the light travels.
    pub direction: UnitVec3,
    /// Irradiance on a surface that faces the light, W/m².
    pub irradiance: Rgb,
    /// Full angle that the light covers in the sky, radians; 0 for a hard shadow.
    pub angle_radians: f32,
    /// Shadow rays per shading point.
    pub samples: u32,
}

impl DistantLight {
    /// See [`super::Light::sample`]. With an angle it is a cap of the sky of constant radiance.
    pub fn sample(&self, _point: Vec3, u: Vec2) -> Option<LightSample> {
        let center = -self.direction;
        if self.is_delta() {
            return Some(LightSample {
                wi: center,
                weight: weigh(self.irradiance, 1.0)?,
                density: 0.0,
                shadow: ShadowEnd::Direction(center),
            });
        }
        let one_minus_cos = self.one_minus_cos();
        let weight = self.radiance_times_solid_angle();
        let local = square_to_cone(u, one_minus_cos).as_vec3();
        let wi = UnitVec3::normalize(Frame::around(center).to_world(local))?;
        Some(LightSample {
            wi,
            weight: weigh(self.irradiance, weight)?,
            density: 1.0 / (TAU * one_minus_cos),
            shadow: ShadowEnd::Direction(wi),
        })
    }

    /// 1 less the cosine of half the angle that it covers.
    fn one_minus_cos(&self) -> f64 {
        2.0 * (0.5 * self.half_angle()).sin().powi(2)
    }

    fn half_angle(&self) -> f64 {
        (0.5 * f64::from(self.angle_radians)).min(PI)
    }

    /// For an irradiance of 1.
    fn radiance_times_solid_angle(&self) -> f64 {
        // Radiance L on a facing surface: E = π L sin²a, and π L where the cap is more than the
        // hemisphere. The cap's solid angle is 2π (1 - cos a).
        if self.half_angle() < FRAC_PI_2 {
            2.0 / (2.0 - self.one_minus_cos())
        } else {
            2.0 * self.one_minus_cos()
        }
    }

    /// See [`super::Light::density`].
    pub fn density(&self) -> f64 {
        if self.is_delta() {
            0.0
        } else {
            1.0 / (TAU * self.one_minus_cos())
        }
    }

    /// Radiance of the sky in the direction `wi`, as far as this light makes it.
    pub fn radiance_from(&self, wi: UnitVec3) -> Rgb {
        if self.is_delta() {
            return Rgb::BLACK;
        }
        // 1 - cos without cancellation: for unit vectors |v - w|² / 2.
        let off = 0.5 * wi.as_dvec3().distance_squared(-self.direction.as_dvec3());
        if off > self.one_minus_cos() {
            return Rgb::BLACK;
        }
        let radiance = self.radiance_times_solid_angle() * self.density();
        self.irradiance.map(|c| (f64::from(c) * radiance) as f32)
    }

    /// See [`super::Light::is_delta`].
    pub fn is_delta(&self) -> bool {
        !has_extent(self.angle_radians)
    }
}
