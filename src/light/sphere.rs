//! A sphere of constant radiance.

use std::f64::consts::TAU;

use super::{LightSample, ShadowEnd, Toward, has_extent, shadow_point, unit, weigh};
use crate::color::Rgb;
use crate::math::{DVec3, Ray, Vec2, Vec3};
use crate::sampling::square_to_cone;

/// A sphere of constant radiance, seen from outside and from inside.
#[derive(Clone, Copy, Debug)]
pub struct SphereLight {
    /// Its centre.
    pub center: Vec3,
    /// Its radius.
    pub radius: f32,
    /// Radiance, W/(m² sr).
    pub radiance: Rgb,
    /// Whether camera rays see it.
    pub is_visible: bool,
    /// Shadow rays per shading point.
    pub samples: u32,
}

impl SphereLight {
    /// See [`super::Light::sample`]. Uniform by solid angle: in the cone that the sphere fills,
    /// or in all directions from inside it.
    pub fn sample(&self, point: Vec3, u: Vec2) -> Option<LightSample> {
        if self.is_delta() {
            return None;
        }
        let radius = f64::from(self.radius);
        let toward = self.toward(point);
        let distance = toward.distance;
        let is_inside = distance <= radius;
        let one_minus_cos = self.one_minus_cos(distance);

        let local = square_to_cone(u, one_minus_cos);
        let (tangent, bitangent) = toward.direction.any_orthonormal_pair();
        let direction = tangent * local.x + bitangent * local.y + toward.direction * local.z;
        // The way along the direction to the surface: the near side from outside, the only one
        // from inside.
        let sin_squared = local.x * local.x + local.y * local.y;
        let half_chord = (radius * radius - distance * distance * sin_squared)
            .max(0.0)
            .sqrt();
        let along = distance * local.z + if is_inside { half_chord } else { -half_chord };
        Some(LightSample {
            wi: unit(direction),
            weight: weigh(self.radiance, TAU * one_minus_cos)?,
            density: 1.0 / (TAU * one_minus_cos),
            shadow: ShadowEnd::Point(shadow_point(point.as_dvec3() + direction * along)),
        })
    }

    /// The way to its centre, at which every axis will do.
    fn toward(&self, point: Vec3) -> Toward {
        Toward::new(point, self.center).unwrap_or(Toward {
            direction: DVec3::Z,
            distance: 0.0,
        })
    }

    /// 1 less the cosine of the half angle under which it is seen from `distance`; 2 from inside.
    fn one_minus_cos(&self, distance: f64) -> f64 {
        let radius = f64::from(self.radius);
        if distance <= radius {
            return 2.0;
        }
        let sin = radius / distance;
        let cos = ((distance - radius) * (distance + radius)).sqrt() / distance;
        sin * sin / (1.0 + cos)
    }

    /// See [`super::Light::density`].
    pub fn density(&self, point: Vec3) -> f64 {
        1.0 / (TAU * self.one_minus_cos(self.toward(point).distance))
    }

    /// See [`super::Light::is_delta`].
    pub fn is_delta(&self) -> bool {
        !has_extent(self.radius)
    }

    /// See [`super::Light::placed`].
    pub fn placed(&self, scale: f32, offset: Vec3) -> Self {
        Self {
            center: self.center * scale + offset,
            radius: self.radius * scale,
            ..*self
        }
    }

    /// See [`super::Light::met`].
    pub fn met(&self, ray: &Ray) -> Option<(f32, Rgb)> {
        if self.is_delta() {
            return None;
        }
        let radius = f64::from(self.radius);
        let direction = ray.direction.as_dvec3();
        let length = direction.length();
        let direction = direction / length;
        let center = self.center.as_dvec3() - ray.origin.as_dvec3();
        let along = center.dot(direction);
        let across = center - direction * along;
        // NaN where the ray misses; no comparison below holds for it.
        let half_chord = (radius * radius - across.length_squared()).sqrt();
        [along - half_chord, along + half_chord]
            .map(|distance| (distance / length) as f32)
            .into_iter()
            .find(|&t| t > ray.t_min && t < ray.t_max)
            .map(|t| (t, self.radiance))
    }
}
