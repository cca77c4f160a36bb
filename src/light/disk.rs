//! A one-sided disk of constant radiance.

use super::LightSample;
use crate::color::Rgb;
use crate::math::{Ray, UnitVec3, Vec2, Vec3};

/// A one-sided disk of constant radiance.
#[derive(Clone, Copy, Debug)]
pub struct DiskLight {
    /// Its centre.
    pub center: Vec3,
    /// The side it shines to.
    pub normal: UnitVec3,
    /// Its radius.
    pub radius: f32,
    /// Radiance, W/(m² sr).
    pub radiance: Rgb,
    /// Whether camera rays see it.
    pub is_visible: bool,
    /// Shadow rays per shading point.
    pub samples: u32,
}

impl DiskLight {
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
