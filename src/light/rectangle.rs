//! A one-sided rectangle of constant radiance.

use super::LightSample;
use crate::color::Rgb;
use crate::math::{Ray, UnitVec3, Vec2, Vec3};

/// A one-sided rectangle of constant radiance.
#[derive(Clone, Copy, Debug)]
pub struct RectangleLight {
    /// Its centre.
    pub center: Vec3,
    /// Half of one edge. It shines to the side of `half_u × half_v`.
    pub half_u: Vec3,
    /// Half of the other edge, perpendicular to the first or not.
    pub half_v: Vec3,
    /// Radiance, W/(m² sr).
    pub radiance: Rgb,
    /// Whether camera rays see it.
    pub is_visible: bool,
    /// Shadow rays per shading point.
    pub samples: u32,
}

impl RectangleLight {
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
