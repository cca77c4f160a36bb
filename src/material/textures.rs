//! The places of a material in which a texture may stand.

use super::{
    Anisotropy, Clearcoat, DiffuseTransmission, Iridescence, Material, MetallicRoughness,
    NormalMap, Phong, Sheen, Surface,
};
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
    /// Share of a coat.
    Clearcoat,
    /// Roughness of a coat.
    ClearcoatRoughness,
    /// Bumps of a coat.
    ClearcoatNormal,
    /// Colour of fibres.
    SheenColor,
    /// Roughness of fibres.
    SheenRoughness,
    /// Direction and strength of long highlights.
    Anisotropy,
    /// Share of a thin film.
    Iridescence,
    /// Thickness of a thin film.
    IridescenceThickness,
    /// Share of light that a matte surface lets through.
    DiffuseTransmission,
    /// Its colour.
    DiffuseTransmissionColor,
}

impl TextureSlot {
    /// All of them, each at its own number.
    pub const ALL: [Self; 22] = [
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
        Self::Clearcoat,
        Self::ClearcoatRoughness,
        Self::ClearcoatNormal,
        Self::SheenColor,
        Self::SheenRoughness,
        Self::Anisotropy,
        Self::Iridescence,
        Self::IridescenceThickness,
        Self::DiffuseTransmission,
        Self::DiffuseTransmissionColor,
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
                dispersion: _,
                is_glossiness: _,
                clearcoat,
                sheen,
                anisotropy,
                iridescence,
                diffuse_transmission,
            } = &mut **parameters;
            retain(TextureSlot::BaseColor, &mut base_color.texture);
            retain(TextureSlot::Metallic, &mut metallic.texture);
            retain(TextureSlot::Roughness, &mut roughness.texture);
            retain(TextureSlot::Occlusion, &mut occlusion.texture);
            retain(TextureSlot::Specular, &mut specular.texture);
            retain(TextureSlot::SpecularColor, &mut specular_color.texture);
            retain(TextureSlot::Transmission, &mut transmission.texture);
            retain(TextureSlot::Thickness, &mut thickness.texture);
            if let Some(Clearcoat {
                factor,
                roughness,
                normal_map,
            }) = clearcoat
            {
                retain(TextureSlot::Clearcoat, &mut factor.texture);
                retain(TextureSlot::ClearcoatRoughness, &mut roughness.texture);
                let mut texture = normal_map.map(|map| map.texture);
                retain(TextureSlot::ClearcoatNormal, &mut texture);
                *normal_map = normal_map
                    .zip(texture)
                    .map(|(map, texture)| NormalMap { texture, ..map });
            }
            if let Some(Sheen { color, roughness }) = sheen {
                retain(TextureSlot::SheenColor, &mut color.texture);
                retain(TextureSlot::SheenRoughness, &mut roughness.texture);
            }
            if let Some(Anisotropy {
                strength: _,
                rotation: _,
                texture,
            }) = anisotropy
            {
                retain(TextureSlot::Anisotropy, texture);
            }
            if let Some(Iridescence {
                factor,
                index_of_refraction: _,
                thickness: _,
                thickness_texture,
            }) = iridescence
            {
                retain(TextureSlot::Iridescence, &mut factor.texture);
                retain(TextureSlot::IridescenceThickness, thickness_texture);
            }
            if let Some(DiffuseTransmission { factor, color }) = diffuse_transmission {
                retain(TextureSlot::DiffuseTransmission, &mut factor.texture);
                retain(TextureSlot::DiffuseTransmissionColor, &mut color.texture);
            }
        }
        Surface::Unlit(color) => retain(TextureSlot::BaseColor, &mut color.texture),
    }
}
