//! A one-sided rectangle of constant radiance.

use super::spherical_rectangle::SphericalRectangle;
use super::{LightSample, ShadowEnd, plane_hit, shadow_point, unit, weigh};
use crate::color::Rgb;
use crate::math::{DVec2, DVec3, Ray, UnitVec3, Vec2, Vec3};

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

/// The light's edges in double precision.
struct Edges {
    half_u: DVec3,
    half_v: DVec3,
    /// `half_u × half_v`.
    cross: DVec3,
}

impl RectangleLight {
    /// See [`super::Light::sample`]. Uniform by solid angle where the edges are perpendicular,
    /// unless it looks so small that area does as well; by area otherwise.
    pub fn sample(&self, point: Vec3, u: Vec2) -> Option<LightSample> {
        let edges = self.edges()?;
        let point = point.as_dvec3();
        let center = self.center.as_dvec3() - point;
        let quarter_area = edges.cross.length();
        let height = -center.dot(edges.cross) / quarter_area;
        if !(height > 0.0 && height.is_finite()) {
            return None;
        }
        let seen = SphericalRectangle::new(center, edges.half_u, edges.half_v, height);
        let place = match &seen {
            Some(seen) => seen.sample(u),
            None => 2.0 * u.as_dvec2() - DVec2::ONE,
        };
        let to_light = center + edges.half_u * place.x + edges.half_v * place.y;
        let distance = to_light.length();
        let inverse_density = match &seen {
            Some(seen) => seen.solid_angle(),
            None => 4.0 * quarter_area * (height / distance) / distance / distance,
        };
        Some(LightSample {
            wi: unit(to_light / distance),
            weight: weigh(self.radiance, inverse_density)?,
            density: 1.0 / inverse_density,
            shadow: ShadowEnd::Point(shadow_point(point + to_light)),
        })
    }

    /// See [`super::Light::density`].
    pub fn density(&self, point: Vec3, wi: UnitVec3) -> f64 {
        let Some(edges) = self.edges() else {
            return 0.0;
        };
        let center = self.center.as_dvec3() - point.as_dvec3();
        let quarter_area = edges.cross.length();
        let height = -center.dot(edges.cross) / quarter_area;
        if !(height > 0.0 && height.is_finite()) {
            return 0.0;
        }
        match SphericalRectangle::new(center, edges.half_u, edges.half_v, height) {
            Some(seen) => 1.0 / seen.solid_angle(),
            None => {
                // Distance² / (area cos): the distance is the height over the cosine.
                let cos = -wi.as_dvec3().normalize().dot(edges.cross) / quarter_area;
                height * height / (4.0 * quarter_area * cos * cos * cos)
            }
        }
    }

    /// The side that shines, and the area; `None` where there is none.
    pub fn normal_and_area(&self) -> Option<(UnitVec3, f64)> {
        let cross = self.edges()?.cross;
        Some((UnitVec3::normalize_f64(cross)?, 4.0 * cross.length()))
    }

    /// `None` where they enclose no area.
    fn edges(&self) -> Option<Edges> {
        let (half_u, half_v) = (self.half_u.as_dvec3(), self.half_v.as_dvec3());
        let cross = half_u.cross(half_v);
        let has_area = cross != DVec3::ZERO && cross.is_finite();
        has_area.then_some(Edges {
            half_u,
            half_v,
            cross,
        })
    }

    /// See [`super::Light::is_delta`].
    pub fn is_delta(&self) -> bool {
        self.edges().is_none()
    }

    /// See [`super::Light::placed`].
    pub fn placed(&self, scale: f32, offset: Vec3) -> Self {
        Self {
            center: self.center * scale + offset,
            half_u: self.half_u * scale,
            half_v: self.half_v * scale,
            ..*self
        }
    }

    /// See [`super::Light::met`].
    pub fn met(&self, ray: &Ray) -> Option<(f32, Rgb)> {
        let edges = self.edges()?;
        let center = self.center.as_dvec3() - ray.origin.as_dvec3();
        let met = plane_hit(ray, center, edges.cross);
        // from_center = u half_u + v half_v, by Cramer's rule.
        let square = edges.cross.length_squared();
        let u = met.from_center.cross(edges.half_v).dot(edges.cross) / square;
        let v = edges.half_u.cross(met.from_center).dot(edges.cross) / square;
        (met.is_hit && u.abs() <= 1.0 && v.abs() <= 1.0).then_some((met.t, self.radiance))
    }
}
