//! glTF's metallic-roughness model.

use crate::color::Rgb;
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
