//! glTF's metallic-roughness model.

use super::{Bsdf, Glossy, Lookup, Specular};
use crate::color::Rgb;
use crate::texture::Encoding;
use crate::texture::{TexturedRgb, TexturedScalar};

/// The parameters of a glTF material, with those extensions that change its base layer.
#[derive(Clone, Debug)]
pub struct MetallicRoughness {
    /// Base colour; the alpha of the same texture is the material's opacity.
    pub base_color: TexturedRgb,
    /// 0 dielectric, 1 metal (blue channel).
    pub metallic: TexturedScalar,
    /// Perceptual roughness; its square is GGX's α (green channel).
    pub roughness: TexturedScalar,
    /// Share of ambient light that arrives (red channel); the factor is the strength: occlusion
    /// is `1 + strength (texture - 1)`.
    pub occlusion: TexturedScalar,
    /// `KHR_materials_ior`; 1.5 by default.
    pub index_of_refraction: f32,
    /// `KHR_materials_specular`: strength of the dielectric reflection (alpha channel).
    pub specular: TexturedScalar,
    /// `KHR_materials_specular`: its colour at normal incidence.
    pub specular_color: TexturedRgb,
    /// `KHR_materials_transmission` (red channel).
    pub transmission: TexturedScalar,
    /// `KHR_materials_volume`: thickness in the mesh's units (green channel); 0 is thin-walled.
    pub thickness: TexturedScalar,
    /// `KHR_materials_volume`: colour of white light after `attenuation_distance`.
    pub attenuation_color: Rgb,
    /// `KHR_materials_volume`, in world units; infinite for a clear medium.
    pub attenuation_distance: f32,
}

impl Default for MetallicRoughness {
    /// What the glTF specification says of a material that says nothing.
    fn default() -> Self {
        Self {
            base_color: TexturedRgb::constant(Rgb::WHITE),
            metallic: TexturedScalar::constant(1.0),
            roughness: TexturedScalar::constant(1.0),
            occlusion: TexturedScalar::constant(1.0),
            index_of_refraction: 1.5,
            specular: TexturedScalar::constant(1.0),
            specular_color: TexturedRgb::constant(Rgb::WHITE),
            transmission: TexturedScalar::constant(0.0),
            thickness: TexturedScalar::constant(0.0),
            attenuation_color: Rgb::WHITE,
            attenuation_distance: f32::INFINITY,
        }
    }
}

/// Below this roughness a `whitted` picture shows mirror images, fading in as it falls to 0.
const MIRROR_ROUGHNESS: f32 = 0.3;

/// The smallest α of the microfacet lobe: a perfect mirror shows no point light at all.
const MIN_ALPHA: f32 = 1e-4;

impl MetallicRoughness {
    /// How it scatters light where `lookup` is.
    ///
    /// Diffuse base under GGX, after appendix B of the glTF 2.0 specification. Rough reflection
    /// of the surroundings is left to `ambient`; smooth surfaces mirror them.
    pub fn bsdf(&self, lookup: &Lookup) -> Bsdf {
        let base = lookup.rgb(&self.base_color) * lookup.vertex_rgb();
        let metallic = lookup.scalar(&self.metallic).clamp(0.0, 1.0);
        let roughness = lookup.scalar(&self.roughness).clamp(0.0, 1.0);
        let strength = lookup.scalar(&self.specular).clamp(0.0, 1.0);
        let ratio = (self.index_of_refraction - 1.0) / (self.index_of_refraction + 1.0);
        let dielectric = lookup.rgb(&self.specular_color) * (ratio * ratio);
        let dielectric = dielectric.map(|c| c.min(1.0)) * strength;
        let f0 = dielectric.lerp(base, metallic);
        let f90 = strength + (1.0 - strength) * metallic;

        let transmission = lookup.scalar(&self.transmission).clamp(0.0, 1.0);
        // Glass gets its mirror image from Fresnel's equations on what it transmits.
        let solid = (1.0 - metallic) * (1.0 - transmission);
        let solid_f0 = base * metallic + dielectric * solid;
        let solid_f90 = metallic + strength * solid;
        let mirror = (1.0 - roughness / MIRROR_ROUGHNESS).max(0.0).powi(2);
        Bsdf {
            diffuse: base * solid,
            glossy: Glossy::Ggx {
                f0,
                f90,
                alpha: (roughness * roughness).max(MIN_ALPHA),
                dielectric: [dielectric.max_channel(), strength],
                opaque: (solid_f0, solid_f90),
                unmirrored: (solid_f0 * (1.0 - mirror), solid_f90 * (1.0 - mirror)),
            },
            specular: Specular {
                reflect: solid_f0 * mirror,
                reflect_grazing: (Rgb::splat(solid_f90) - solid_f0) * mirror,
                transmit: base * ((1.0 - metallic) * transmission),
                index_of_refraction: self.index_of_refraction,
                is_thin: self.thickness.factor == 0.0,
            },
        }
    }

    /// Absorption inside the body, per world unit: `KHR_materials_volume`. `None` in a thin wall
    /// and in what is clear.
    pub fn absorption(&self) -> Option<Rgb> {
        let is_body = self.thickness.factor > 0.0 && self.transmission.factor > 0.0;
        let is_clear =
            self.attenuation_distance.is_infinite() || self.attenuation_color == Rgb::WHITE;
        (is_body && !is_clear).then(|| {
            // A colour of 0 would be infinite, and infinite × no way at all is not a number.
            let least = f32::MIN_POSITIVE;
            self.attenuation_color
                .map(|c| -c.max(least).ln() / self.attenuation_distance)
        })
    }

    /// Share of ambient light that arrives where `lookup` is, in `[0, 1]`.
    pub fn occlusion(&self, lookup: &Lookup) -> f32 {
        match &self.occlusion.texture {
            None => 1.0,
            Some(texture) => {
                let texel = lookup.texel(texture, Encoding::Linear)[0];
                1.0 + self.occlusion.factor * (texel - 1.0)
            }
        }
    }
}
