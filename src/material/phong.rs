//! Lambert plus normalised Phong, with mirror and refraction.

use std::f32::consts::{PI, TAU};

use super::fresnel::reflect;
use super::{Bsdf, Lobes, Lookup, Specular};
use crate::color::Rgb;
use crate::math::{Frame, UnitVec3, Vec2, Vec3};
use crate::texture::{TexturedRgb, TexturedScalar};

/// The parameters of MTL files and of `kind = "phong"` in scene files.
#[derive(Clone, Debug)]
pub struct Phong {
    /// Diffuse reflectance (`Kd`).
    pub diffuse: TexturedRgb,
    /// Reflectance of the glossy lobe (`Ks`).
    pub specular: TexturedRgb,
    /// Phong exponent (`Ns`); the lobe is normalised by (n+2)/(2π).
    pub exponent: TexturedScalar,
    /// Reflectance of the perfect mirror.
    pub reflect: Rgb,
    /// Share that is let through, refracted, split from its reflection by Fresnel's equations.
    pub transmit: Rgb,
    /// Index of refraction of the inside against the outside.
    pub index_of_refraction: f32,
}

impl Phong {
    /// Lambert only.
    pub const fn matte(reflectance: Rgb) -> Self {
        Self {
            diffuse: TexturedRgb::constant(reflectance),
            specular: TexturedRgb::constant(Rgb::BLACK),
            exponent: TexturedScalar::constant(1.0),
            reflect: Rgb::BLACK,
            transmit: Rgb::BLACK,
            index_of_refraction: 1.0,
        }
    }

    /// How it scatters light where `lookup` is.
    pub fn bsdf(&self, lookup: &Lookup) -> Bsdf {
        let diffuse = lookup.rgb(&self.diffuse) * lookup.vertex_rgb();
        self.of(
            diffuse,
            lookup.rgb(&self.specular),
            lookup.scalar(&self.exponent),
        )
    }

    /// How it scatters light everywhere, without vertex colours; `None` where that differs from place to place, or where
    /// it mirrors or lets light through.
    pub fn plain(&self) -> Option<Bsdf> {
        let has_textures = self.diffuse.texture.is_some()
            || self.specular.texture.is_some()
            || self.exponent.texture.is_some();
        let is_plain = !has_textures && self.reflect.is_black() && self.transmit.is_black();
        let bsdf = || {
            self.of(
                self.diffuse.factor,
                self.specular.factor,
                self.exponent.factor,
            )
        };
        is_plain.then(bsdf)
    }

    fn of(&self, diffuse: Rgb, reflectance: Rgb, exponent: f32) -> Bsdf {
        Bsdf {
            lobes: Lobes::Phong {
                diffuse,
                reflectance,
                exponent: exponent.max(0.0),
            },
            specular: Specular {
                reflect: self.reflect,
                transmit: self.transmit,
                index_of_refraction: self.index_of_refraction,
                is_thin: false,
                ..Specular::NONE
            },
        }
    }
}

/// Phong's lobe of reflectance 1, 1/sr, about `normal`.
pub fn phong_lobe(normal: Vec3, wo: Vec3, wi: Vec3, exponent: f32) -> f32 {
    // 1 - cos, without the cancellation that would decide the value at large exponents.
    let deviation = 0.5 * (reflect(wi, normal) - wo).length_squared();
    if deviation >= 1.0 {
        return 0.0;
    }
    (exponent + 2.0) / (2.0 * PI) * (exponent * (-deviation).ln_1p()).exp()
}

/// Solid-angle density of [`around_mirror`].
pub fn phong_pdf(wo: Vec3, wi: Vec3, exponent: f32) -> f32 {
    phong_lobe(Vec3::Z, wo, wi, exponent) * ((exponent + 1.0) / (exponent + 2.0))
}

/// A direction around the mirror direction of `wo`, by the cosine with it to the `exponent`, in
/// a frame whose normal is z.
pub fn around_mirror(wo: Vec3, exponent: f32, u: Vec2) -> Vec3 {
    // 1 - cos, as above.
    let depth = -((1.0 - u.x).ln() / (exponent + 1.0)).exp_m1();
    let ring = (depth * (2.0 - depth)).max(0.0).sqrt();
    let (sin, cos) = (TAU * u.y).sin_cos();
    let mirror = UnitVec3::from_normalized(reflect(wo, Vec3::Z));
    Frame::around(mirror).to_world(Vec3::new(ring * cos, ring * sin, 1.0 - depth))
}
