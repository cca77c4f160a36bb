//! Facets of metal and of opaque dielectrics.

use super::fresnel::schlick;
use super::iridescence::Film;
use crate::color::Rgb;
use crate::math::Vec2;

/// Facets that reflect by Schlick's formula.
#[derive(Clone, Copy, Debug)]
pub struct Facets {
    /// Share of the surface, in `[0, 1]`.
    pub share: f32,
    /// Reflectance at normal incidence.
    pub f0: Rgb,
    /// Reflectance at grazing incidence.
    pub f90: f32,
    /// The most that films make of `f0`.
    pub bound: Rgb,
}

impl Facets {
    /// Reflectance at a cosine with the facet.
    pub fn fresnel(&self, film: Option<&Film>, cos: f32) -> Rgb {
        let plain = schlick(self.f0, self.f90, cos);
        film.map_or(plain, |film| film.over(self.f0, plain, cos))
    }

    /// Share of the light between facets that leaves them in the end: of `white`, the mean
    /// albedo of white facets (Kulla and Conty 2017).
    pub fn returned(&self, white: f32) -> Rgb {
        let mean = (self.bound * 20.0 + Rgb::splat(self.f90)) / 21.0;
        mean.map(|f| f * f * white / (1.0 - f * (1.0 - white)))
    }

    /// Share that what lies below does not get, of all channels the most; linear in `albedo`,
    /// which is that of [`albedo::ggx`].
    pub fn hidden(&self, albedo: Vec2, returned: f32) -> f32 {
        let f0 = self.bound.max_channel();
        let once = f0 * albedo.x + self.f90 * albedo.y;
        (once + returned * (1.0 - albedo.x - albedo.y)).clamp(0.0, 1.0)
    }
}
