//! A point light; with a radius it casts soft shadows.

use super::LightSample;
use crate::color::Rgb;
use crate::math::{Ray, UnitVec3, Vec2, Vec3};

/// A point light; with a radius it casts soft shadows.
#[derive(Clone, Copy, Debug)]
pub struct PointLight {
    /// Where it is.
    pub position: Vec3,
    /// Radiant intensity, W/sr.
    pub intensity: Rgb,
    /// Radius of the disk that shadow rays aim at, centred on the light and facing the shading
    /// point; 0 for a hard shadow. Direction and falloff are those of the centre.
    pub radius: f32,
    /// Shadow rays per shading point.
    pub samples: u32,
    /// How the light weakens with distance.
    pub falloff: Falloff,
}

impl PointLight {
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
}
