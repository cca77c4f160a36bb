//! Parallel light from far away, such as the sun.

use super::LightSample;
use crate::color::Rgb;
use crate::math::{Ray, UnitVec3, Vec2, Vec3};

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
    /// See [`super::Light::sample`].
    pub fn sample(&self, point: Vec3, u: Vec2) -> Option<LightSample> {
        todo!("{point} {u}")
    }

    /// See [`super::Light::is_delta`].
    pub fn is_delta(&self) -> bool {
        todo!()
    }

    /// See [`super::Light::placed`].
    pub fn placed(&self, scale: f32, offset: Vec3) -> Self {
        todo!("{scale} {offset}")
    }

    /// See [`super::Light::emitted`].
    pub fn emitted(&self, ray: &Ray) -> Option<(f32, Rgb)> {
        todo!("{ray:?}")
    }
}
