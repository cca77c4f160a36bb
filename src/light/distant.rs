//! Parallel light from far away, such as the sun.

use std::f64::consts::{FRAC_PI_2, PI};

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
                shadow: ShadowEnd::Direction(center),
            });
        }
        let half_angle = (0.5 * f64::from(self.angle_radians)).min(PI);
        let one_minus_cos = 2.0 * (0.5 * half_angle).sin().powi(2);
        // Radiance L on a facing surface: E = π L sin²a, and π L where the cap is more than the
        // hemisphere. The weight is L times the cap's solid angle, 2π (1 - cos a).
        let weight = if half_angle < FRAC_PI_2 {
            2.0 / (2.0 - one_minus_cos)
        } else {
            2.0 * one_minus_cos
        };
        let local = square_to_cone(u, one_minus_cos).as_vec3();
        let wi = UnitVec3::normalize(Frame::around(center).to_world(local))?;
        Some(LightSample {
            wi,
            weight: weigh(self.irradiance, weight)?,
            shadow: ShadowEnd::Direction(wi),
        })
    }

    /// See [`super::Light::is_delta`].
    pub fn is_delta(&self) -> bool {
        !has_extent(self.angle_radians)
    }
}
