//! Materials: glTF's metallic-roughness model and the extensions that change its base layer.

use super::document::{Extensions, place};
use super::document_material::{
    AlphaModeEntry, EmissiveStrength, Ior, MaterialEntry, PbrMetallicRoughness, Specular,
    SpecularGlossiness, TextureInfo, TextureTransform, Transmission, Volume,
};
use super::extensions::{SPECULAR_GLOSSINESS, TEXTURE_TRANSFORM, TRANSMISSION, VOLUME};
use super::geometry::MAX_UV_SETS;
use super::texture::Textures;
use crate::color::Rgb;
use crate::import::{WarningCode, Warnings};
use crate::material::{AlphaMode, Material, MetallicRoughness, NormalMap, Surface};
use crate::math::{Affine2, Vec2};
use crate::texture::{TextureRef, TexturedRgb, TexturedScalar};

/// Channels of textures.
pub const RED: u8 = 0;
pub const GREEN: u8 = 1;
pub const BLUE: u8 = 2;
pub const ALPHA: u8 = 3;

/// What a primitive without a material is made of (glTF 2.0, section 3.7.2.1).
pub fn default_material() -> Material {
    Material {
        name: "default".into(),
        surface: Surface::MetallicRoughness(Box::default()),
        emission: TexturedRgb::constant(Rgb::BLACK),
        alpha_mode: AlphaMode::Opaque,
        opacity: TexturedScalar::constant(1.0),
        normal_map: None,
        is_double_sided: false,
    }
}

/// Material `index` of a document.
pub fn material(
    index: usize,
    entry: &MaterialEntry,
    textures: &Textures,
    warnings: &mut Warnings,
) -> Material {
    let place = place("material", index, entry.name.as_deref());
    let default = PbrMetallicRoughness::default();
    let mut reader = MaterialReader {
        entry,
        base: entry.pbr_metallic_roughness.as_deref().unwrap_or(&default),
        textures,
        place,
        warnings,
    };
    reader.material()
}

/// Reads one material.
pub struct MaterialReader<'a> {
    pub(super) entry: &'a MaterialEntry,
    base: &'a PbrMetallicRoughness,
    textures: &'a Textures,
    place: String,
    warnings: &'a mut Warnings,
}

impl MaterialReader<'_> {
    fn material(&mut self) -> Material {
        let entry = self.entry;
        let name = entry.name.as_deref().unwrap_or_default().to_owned();
        let old: Option<SpecularGlossiness> = self.optional(&entry.extensions, SPECULAR_GLOSSINESS);
        if let Some(old) = old {
            return self.specular_glossiness(&old, name);
        }
        let base_color = self.base_color();
        let alpha_mode = self.alpha_mode();
        let opacity = self.opacity(base_color.texture);
        if entry.extensions.has("KHR_materials_unlit") {
            return Material {
                name,
                surface: Surface::Unlit(base_color),
                alpha_mode,
                opacity,
                is_double_sided: entry.double_sided,
                ..default_material()
            };
        }
        Material {
            name,
            surface: Surface::MetallicRoughness(Box::new(self.surface(base_color))),
            emission: self.emission(),
            alpha_mode,
            opacity,
            normal_map: self.normal_map(),
            is_double_sided: entry.double_sided,
        }
    }

    fn base_color(&mut self) -> TexturedRgb {
        let pbr = self.base;
        let [r, g, b, _] = pbr.base_color_factor;
        TexturedRgb {
            factor: self.color("baseColorFactor", [r, g, b], 1.0),
            texture: self.texture(pbr.base_color_texture.as_ref()),
        }
    }

    fn opacity(&mut self, texture: Option<TextureRef>) -> TexturedScalar {
        let [.., alpha] = self.base.base_color_factor;
        TexturedScalar {
            factor: self.number("the alpha of baseColorFactor", alpha, 0.0, 1.0),
            texture,
            channel: ALPHA,
        }
    }

    fn alpha_mode(&mut self) -> AlphaMode {
        match self.entry.alpha_mode {
            AlphaModeEntry::Opaque => AlphaMode::Opaque,
            AlphaModeEntry::Blend => AlphaMode::Blend,
            AlphaModeEntry::Mask => {
                let cutoff = self.entry.alpha_cutoff.unwrap_or(0.5);
                // Above 1 is legal, and hides the surface altogether.
                let cutoff = self.number("alphaCutoff", cutoff, 0.0, f32::MAX);
                AlphaMode::Mask { cutoff }
            }
            AlphaModeEntry::Unknown => {
                self.warn("its alphaMode is not known; it is opaque");
                AlphaMode::Opaque
            }
        }
    }

    fn emission(&mut self) -> TexturedRgb {
        let strength: EmissiveStrength = self.extension("KHR_materials_emissive_strength");
        let strength = strength.emissive_strength;
        let strength = self.number("emissiveStrength", strength, 0.0, f32::MAX);
        let factor = self.color("emissiveFactor", self.entry.emissive_factor, f32::MAX);
        TexturedRgb {
            factor: factor * strength,
            texture: self.texture(self.entry.emissive_texture.as_deref()),
        }
    }

    fn normal_map(&mut self) -> Option<NormalMap> {
        self.bumps("normalTexture", self.entry.normal_texture.as_deref())
    }

    pub(super) fn bumps(&mut self, what: &str, info: Option<&TextureInfo>) -> Option<NormalMap> {
        let info = info?;
        let scale = format!("the scale of {what}");
        Some(NormalMap {
            texture: self.texture(Some(info))?,
            scale: self.number(&scale, info.scale, f32::MIN, f32::MAX),
            is_height: false,
        })
    }

    /// The model that came before metallic-roughness: a matte colour under a dielectric whose
    /// reflectance at normal incidence is given as it is, which is what an index of 0 stands for.
    fn specular_glossiness(&mut self, old: &SpecularGlossiness, name: String) -> Material {
        let entry = self.entry;
        let [r, g, b, alpha] = old.diffuse_factor;
        let diffuse = TexturedRgb {
            factor: self.color("diffuseFactor", [r, g, b], 1.0),
            texture: self.texture(old.diffuse_texture.as_ref()),
        };
        let texture = self.texture(old.specular_glossiness_texture.as_ref());
        let surface = MetallicRoughness {
            base_color: diffuse,
            metallic: TexturedScalar::constant(0.0),
            roughness: TexturedScalar {
                factor: self.number("glossinessFactor", old.glossiness_factor, 0.0, 1.0),
                texture,
                channel: ALPHA,
            },
            is_glossiness: true,
            index_of_refraction: 0.0,
            specular_color: TexturedRgb {
                factor: self.color("specularFactor", old.specular_factor, 1.0),
                texture,
            },
            occlusion: self.occlusion(),
            ..MetallicRoughness::default()
        };
        Material {
            name,
            surface: Surface::MetallicRoughness(Box::new(surface)),
            emission: self.emission(),
            alpha_mode: self.alpha_mode(),
            opacity: TexturedScalar {
                factor: self.number("the alpha of diffuseFactor", alpha, 0.0, 1.0),
                texture: diffuse.texture,
                channel: ALPHA,
            },
            normal_map: self.normal_map(),
            is_double_sided: entry.double_sided,
        }
    }

    fn surface(&mut self, base_color: TexturedRgb) -> MetallicRoughness {
        let pbr = self.base;
        let specular: Specular = self.extension("KHR_materials_specular");
        let transmission: Transmission = self.extension(TRANSMISSION);
        let volume: Volume = self.extension(VOLUME);
        let texture = self.texture(pbr.metallic_roughness_texture.as_ref());
        let scalar = |factor, texture, channel| TexturedScalar {
            factor,
            texture,
            channel,
        };
        MetallicRoughness {
            base_color,
            metallic: scalar(
                self.number("metallicFactor", pbr.metallic_factor, 0.0, 1.0),
                texture,
                BLUE,
            ),
            roughness: scalar(
                self.number("roughnessFactor", pbr.roughness_factor, 0.0, 1.0),
                texture,
                GREEN,
            ),
            occlusion: self.occlusion(),
            index_of_refraction: self.index_of_refraction(),
            specular: scalar(
                self.number("specularFactor", specular.specular_factor, 0.0, 1.0),
                self.texture(specular.specular_texture.as_ref()),
                ALPHA,
            ),
            specular_color: TexturedRgb {
                factor: self.color(
                    "specularColorFactor",
                    specular.specular_color_factor,
                    f32::MAX,
                ),
                texture: self.texture(specular.specular_color_texture.as_ref()),
            },
            transmission: scalar(
                self.number(
                    "transmissionFactor",
                    transmission.transmission_factor,
                    0.0,
                    1.0,
                ),
                self.texture(transmission.transmission_texture.as_ref()),
                RED,
            ),
            thickness: scalar(
                self.number("thicknessFactor", volume.thickness_factor, 0.0, f32::MAX),
                self.texture(volume.thickness_texture.as_ref()),
                GREEN,
            ),
            attenuation_color: self.color("attenuationColor", volume.attenuation_color, 1.0),
            attenuation_distance: self.attenuation_distance(volume.attenuation_distance),
            dispersion: self.dispersion(),
            is_glossiness: false,
            clearcoat: self.clearcoat(),
            sheen: self.sheen(),
            anisotropy: self.anisotropy(),
            iridescence: self.iridescence(),
            diffuse_transmission: self.diffuse_transmission(),
        }
    }

    fn occlusion(&mut self) -> TexturedScalar {
        let info = self.entry.occlusion_texture.as_deref();
        let strength = info.map_or(1.0, |info| info.strength);
        TexturedScalar {
            factor: self.number("the strength of occlusionTexture", strength, 0.0, 1.0),
            texture: self.texture(info),
            channel: RED,
        }
    }

    fn index_of_refraction(&mut self) -> f32 {
        let Ior { ior } = self.extension("KHR_materials_ior");
        // The extension gives 0 a meaning of its own: everything is reflected.
        if ior == 0.0 {
            return ior;
        }
        self.number("ior", ior, 1.0, f32::MAX)
    }

    fn attenuation_distance(&mut self, distance: f32) -> f32 {
        if distance > 0.0 {
            return distance;
        }
        self.warn("its attenuationDistance is not above 0; the volume is clear");
        f32::INFINITY
    }

    /// One use of a texture; `None` where there is none, or it could not be read.
    pub(super) fn texture(&mut self, info: Option<&TextureInfo>) -> Option<TextureRef> {
        let info = info?;
        let Some(id) = self.textures.ids.get(info.index) else {
            self.warn("one of its textures is not there");
            return None;
        };
        let texture = (*id)?;
        let change: Option<TextureTransform> = self.optional(&info.extensions, TEXTURE_TRANSFORM);
        let change = change.unwrap_or_default();
        let set = change.tex_coord.unwrap_or(info.tex_coord);
        if set as usize >= MAX_UV_SETS {
            self.warn(&format!(
                "one of its textures uses TEXCOORD_{set}, of which only {MAX_UV_SETS} are kept; it is left out"
            ));
            return None;
        }
        let transform = texture_transform(&change);
        if !transform.is_finite() {
            self.warn("the transform of one of its textures is not finite; it is left out");
            return None;
        }
        Some(TextureRef {
            texture,
            uv_set: set as u8,
            transform,
        })
    }

    /// An extension of the material; its defaults where it is not there, or not well-formed.
    pub(super) fn extension<T: serde::de::DeserializeOwned + Default>(&mut self, name: &str) -> T {
        self.optional(&self.entry.extensions, name)
            .unwrap_or_default()
    }

    pub(super) fn optional<T: serde::de::DeserializeOwned>(
        &mut self,
        extensions: &Extensions,
        name: &str,
    ) -> Option<T> {
        extensions.read(name).unwrap_or_else(|what| {
            self.warn(&what);
            None
        })
    }

    pub(super) fn color(&mut self, what: &str, channels: [f32; 3], max: f32) -> Rgb {
        Rgb::from(channels.map(|channel| self.number(what, channel, 0.0, max)))
    }

    /// `value`, or the nearest legal one with a warning.
    pub(super) fn number(&mut self, what: &str, value: f32, min: f32, max: f32) -> f32 {
        if (min..=max).contains(&value) {
            return value;
        }
        let legal = value.max(min).min(max);
        self.warn(&format!("{what} is {value}; {legal} is used"));
        legal
    }

    fn warn(&mut self, what: &str) {
        let message = format!("{}: {what}", self.place);
        self.warnings.add(WarningCode::BadValue, message);
    }
}

/// `KHR_texture_transform`: scale, then turn, then move. A positive angle turns from +u towards
/// -v, which is counter-clockwise in an image whose v grows downwards.
fn texture_transform(change: &TextureTransform) -> Affine2 {
    Affine2::from_scale_angle_translation(
        Vec2::from(change.scale),
        -change.rotation,
        Vec2::from(change.offset),
    )
}
