//! A point that shines into a cone.

use super::LightSample;
use crate::color::Rgb;
use crate::math::{Ray, UnitVec3, Vec2, Vec3};

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
    pub falloff: super::Falloff,
}

impl SpotLight {
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
