//! A point light; with a radius it casts soft shadows.

use super::{Falloff, LightSample, ShadowEnd, Toward, has_extent, weigh};
use crate::color::Rgb;
use crate::math::{Frame, UnitVec3, Vec2, Vec3};
use crate::sampling::square_to_disk;

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
        let toward = Toward::new(point, self.position)?;
        let wi = toward.unit();
        Some(LightSample {
            wi,
            weight: weigh(self.intensity, self.falloff.attenuation(toward.distance))?,
            density: 0.0,
            shadow: shadow_end(self.position, self.radius, wi, u),
        })
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

/// A point, uniform by area, of the disk of `radius` around `position` across `wi`; `position`
/// itself, whatever `u`, without a radius.
pub(super) fn shadow_end(position: Vec3, radius: f32, wi: UnitVec3, u: Vec2) -> ShadowEnd {
    if !has_extent(radius) {
        return ShadowEnd::Point(position);
    }
    let frame = Frame::around(wi);
    let disk = radius * square_to_disk(u);
    let end = position + frame.tangent * disk.x + frame.bitangent * disk.y;
    // A radius near the largest f32 may overflow here.
    ShadowEnd::Point(end.clamp(Vec3::splat(f32::MIN), Vec3::splat(f32::MAX)))
}
