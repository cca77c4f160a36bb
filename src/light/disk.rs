//! A one-sided disk of constant radiance.

use super::spherical_ellipse::SphericalEllipse;
use super::{
    LightSample, LightSampleRow, ShadowEnd, has_extent, plane_hit, shadow_point, unit, weigh,
};
use crate::color::Rgb;
use crate::math::{DVec3, ROW, Ray, RowJob, UnitVec3, Vec2, Vec3, VectorRow, widely};

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
    /// See [`super::Light::sample`]. Nearly uniform by solid angle, so that the weights hardly
    /// vary, and are bounded however near the disk is.
    pub fn sample(&self, point: Vec3, u: Vec2) -> Option<LightSample> {
        self.sample_across(self.exact_normal(), point, u)
    }

    /// [`Self::sample`] of each point of a row.
    pub(super) fn sample_row(&self, points: &VectorRow, u: &[Vec2; ROW]) -> LightSampleRow {
        widely(SampleRow {
            light: self,
            points,
            u,
        })
    }

    #[inline(always)]
    fn sample_across(&self, normal: DVec3, point: Vec3, u: Vec2) -> Option<LightSample> {
        let point = point.as_dvec3();
        let center = self.center.as_dvec3() - point;
        let seen = SphericalEllipse::of_disk(center, normal, self.radius.into())?;
        let sample = seen.sample(u);
        let weight = weigh(self.radiance, sample.inverse_density);
        weight.map(|weight| LightSample {
            wi: unit(sample.direction),
            weight,
            density: 1.0 / sample.inverse_density,
            shadow: ShadowEnd::Point(shadow_point(point + sample.on_disk)),
        })
    }

    /// See [`super::Light::density`].
    pub fn density(&self, point: Vec3, wi: UnitVec3) -> f64 {
        let center = self.center.as_dvec3() - point.as_dvec3();
        SphericalEllipse::of_disk(center, self.exact_normal(), self.radius.into())
            .map_or(0.0, |seen| seen.density(wi.as_dvec3().normalize()))
    }

    /// Of length 1 to double precision.
    fn exact_normal(&self) -> DVec3 {
        self.normal.as_dvec3().normalize()
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
    #[inline(always)]
    pub fn met(&self, ray: &Ray) -> Option<(f32, Rgb)> {
        let center = self.center.as_dvec3() - ray.origin.as_dvec3();
        let met = plane_hit(ray, center, self.normal.as_dvec3());
        let radius = f64::from(self.radius);
        let is_inside = met.from_center.length_squared() <= radius * radius;
        (met.is_hit & is_inside & !self.is_delta()).then_some((met.t, self.radiance))
    }
}

struct SampleRow<'a> {
    light: &'a DiskLight,
    points: &'a VectorRow,
    u: &'a [Vec2; ROW],
}

impl RowJob for SampleRow<'_> {
    type Output = LightSampleRow;

    #[inline(always)]
    fn call(self) -> LightSampleRow {
        let Self { light, points, u } = self;
        let normal = light.exact_normal();
        let mut samples = LightSampleRow::NONE;
        for (i, u) in u.iter().enumerate() {
            samples.set(i, light.sample_across(normal, points.get(i), *u));
        }
        samples
    }
}
