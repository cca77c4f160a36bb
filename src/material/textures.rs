//! The places of a material in which a texture may stand.

use super::{Material, MetallicRoughness, Phong, Surface};
use crate::texture::TextureRef;

/// What a texture of a material modulates.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum TextureSlot {
    /// Diffuse reflectance, base colour, or the colour of an unlit surface.
    BaseColor,
    /// Opacity.
    Opacity,
    /// Emitted radiance.
    Emission,
    /// Normals or heights.
    Normal,
    /// Reflectance of the glossy lobe, or strength of the dielectric reflection.
    Specular,
    /// Colour of the dielectric reflection.
    SpecularColor,
    /// Phong exponent.
    Exponent,
    /// Share of metal.
    Metallic,
    /// Perceptual roughness.
    Roughness,
    /// Share of ambient light that arrives.
    Occlusion,
    /// Share of light that is refracted.
    Transmission,
    /// Thickness of a volume.
    Thickness,
}

impl TextureSlot {
    /// All of them, each at its own number.
    pub const ALL: [Self; 12] = [
        Self::BaseColor,
        Self::Opacity,
        Self::Emission,
        Self::Normal,
        Self::Specular,
        Self::SpecularColor,
        Self::Exponent,
        Self::Metallic,
        Self::Roughness,
        Self::Occlusion,
        Self::Transmission,
        Self::Thickness,
    ];
}

impl Material {
    /// Shows `keep` every texture, to change it, and takes away those that it says no to.
    ///
    /// Fields are listed one by one, so that a new one cannot be forgotten here.
    pub fn retain_textures(&mut self, mut keep: impl FnMut(TextureSlot, &mut TextureRef) -> bool) {
        let Self {
            name: _,
            surface,
            emission,
            alpha_mode: _,
            opacity,
            normal_map,
            is_double_sided: _,
        } = self;
        let mut retain = |slot, texture: &mut Option<TextureRef>| {
            texture.take_if(|texture| !keep(slot, texture));
        };
        retain_in_surface(surface, &mut retain);
        retain(TextureSlot::Emission, &mut emission.texture);
        retain(TextureSlot::Opacity, &mut opacity.texture);
        normal_map.take_if(|map| !keep(TextureSlot::Normal, &mut map.texture));
    }
}

fn retain_in_surface(
    surface: &mut Surface,
    retain: &mut impl FnMut(TextureSlot, &mut Option<TextureRef>),
) {
    match surface {
        Surface::Phong(Phong {
            diffuse,
            specular,
            exponent,
            reflect: _,
            transmit: _,
            index_of_refraction: _,
        }) => {
            retain(TextureSlot::BaseColor, &mut diffuse.texture);
            retain(TextureSlot::Specular, &mut specular.texture);
            retain(TextureSlot::Exponent, &mut exponent.texture);
        }
        Surface::MetallicRoughness(parameters) => {
            let MetallicRoughness {
                base_color,
                metallic,
                roughness,
                occlusion,
                index_of_refraction: _,
                specular,
                specular_color,
                transmission,
                thickness,
                attenuation_color: _,
                attenuation_distance: _,
            } = &mut **parameters;
            retain(TextureSlot::BaseColor, &mut base_color.texture);
            retain(TextureSlot::Metallic, &mut metallic.texture);
            retain(TextureSlot::Roughness, &mut roughness.texture);
            retain(TextureSlot::Occlusion, &mut occlusion.texture);
            retain(TextureSlot::Specular, &mut specular.texture);
            retain(TextureSlot::SpecularColor, &mut specular_color.texture);
            retain(TextureSlot::Transmission, &mut transmission.texture);
            retain(TextureSlot::Thickness, &mut thickness.texture);
        }
        Surface::Unlit(color) => retain(TextureSlot::BaseColor, &mut color.texture),
    }
}
