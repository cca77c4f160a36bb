//! Lambert plus normalised Phong, with mirror and refraction.

use super::{Bsdf, Glossy, Lookup, Specular};
use crate::color::Rgb;
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
        let reflectance = lookup.rgb(&self.specular);
        Bsdf {
            diffuse: lookup.rgb(&self.diffuse) * lookup.vertex_rgb(),
            glossy: if reflectance.is_black() {
                Glossy::None
            } else {
                Glossy::Phong {
                    reflectance,
                    exponent: lookup.scalar(&self.exponent).max(0.0),
                }
            },
            specular: Specular {
                reflect: self.reflect,
                reflect_grazing: Rgb::BLACK,
                transmit: self.transmit,
                index_of_refraction: self.index_of_refraction,
                is_thin: false,
            },
        }
    }
}
