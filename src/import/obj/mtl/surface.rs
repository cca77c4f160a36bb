//! What the statements of a material mean to light.
//!
//! Materials with any of the PBR keys (`Pr`, `Pm`, …) are metallic-roughness; the others follow
//! the illumination models of the MTL specification (Wavefront, "Object Files", appendix B1):
//!
//! | `illum` | shown as |
//! |---|---|
//! | 0 | `Kd` itself, without light |
//! | 1 | matte `Kd` |
//! | 2, or none | matte `Kd`, glossy `Ks` with exponent `Ns` |
//! | 3, 5, 8 | as 2, with a mirror of reflectance `Ks` |
//! | 4, 9 | glass: 1 − `d` of the light goes through, tinted by `Tf`, bent by `Ni`; 4 mirrors as 3 does |
//! | 6 | refraction: `Tf`, or 1 − `d` without it, less the mirror's `Ks`, bent by `Ni` |
//! | 7 | as 6, where the mirror is the Fresnel share of what goes through |
//!
//! Elsewhere `d` below 1 is plain see-through, without bending. Colours are linear. `Ka` is left
//! out: ambient light is a property of the scene and multiplies `Kd`.

use std::path::Path;

use super::map::{Channel, Map};
use super::statements::MtlMaterial;
use super::textures::{Textures, has_alpha, looks_like_normals};
use crate::color::Rgb;
use crate::import::{WarningCode, Warnings};
use crate::material::{AlphaMode, Material, MetallicRoughness, NormalMap, Phong, Surface};
use crate::texture::{TextureRef, TexturedRgb, TexturedScalar};

/// Diffuse reflectance where a file says none: a light neutral grey, as most programs have it.
pub const NEUTRAL_REFLECTANCE: Rgb = Rgb::splat(0.8);

/// Exponent of a glossy lobe whose file says none.
const DEFAULT_EXPONENT: f32 = 10.0;

/// Roughness of a physically based material whose file says neither `Pr` nor `Ns`.
const DEFAULT_ROUGHNESS: f32 = 0.5;

/// The material that `mtl` describes; its images are looked for in `folders`.
pub fn material(
    mtl: &MtlMaterial,
    folders: &[&Path],
    textures: &mut Textures,
    warnings: &mut Warnings,
) -> Material {
    let mut maps = Lookup {
        folders,
        textures,
        warnings,
    };
    let see_through = SeeThrough::of(mtl);
    let opacity = maps.opacity(mtl, see_through.opacity);
    let is_solid = opacity.texture.is_none() && opacity.factor >= 1.0;
    Material {
        name: mtl.name.clone(),
        surface: maps.surface(mtl, &see_through),
        emission: maps.color(mtl.emission, &mtl.maps.emission, Rgb::BLACK),
        alpha_mode: if is_solid {
            AlphaMode::Opaque
        } else {
            AlphaMode::Blend
        },
        opacity,
        normal_map: maps.normal_map(mtl),
        is_double_sided: true,
    }
}

/// The ways in which light gets through or off a material without being scattered.
#[derive(Clone, Copy)]
struct SeeThrough {
    /// Let through, bent.
    transmit: Rgb,
    /// Mirrored.
    reflect: Rgb,
    /// What is left of the diffuse reflectance.
    diffuse_share: f32,
    /// What does not pass straight on.
    opacity: f32,
}

impl SeeThrough {
    fn of(mtl: &MtlMaterial) -> Self {
        let specular = mtl.specular.unwrap_or(Rgb::BLACK);
        let solid = mtl.opacity.value();
        let tint = mtl.transmission.unwrap_or(Rgb::WHITE);
        let plain = Self {
            transmit: Rgb::BLACK,
            reflect: Rgb::BLACK,
            diffuse_share: 1.0,
            opacity: solid,
        };
        let glass = Self {
            transmit: tint * (1.0 - solid),
            diffuse_share: solid,
            opacity: 1.0,
            ..plain
        };
        let refracted = match mtl.transmission {
            Some(transmit) => Self {
                transmit,
                opacity: 1.0,
                ..plain
            },
            None => glass,
        };
        match mtl.illumination {
            Some(3 | 5 | 8) => Self {
                reflect: specular,
                ..plain
            },
            Some(4) => Self {
                reflect: specular,
                ..glass
            },
            Some(9) => glass,
            Some(6) => Self {
                reflect: specular,
                transmit: refracted.transmit * specular.map(|s| (1.0 - s).max(0.0)),
                ..refracted
            },
            Some(7) => refracted,
            _ => plain,
        }
    }
}

/// Where the images of a material come from, and where complaints about them go.
struct Lookup<'a> {
    folders: &'a [&'a Path],
    textures: &'a mut Textures,
    warnings: &'a mut Warnings,
}

impl Lookup<'_> {
    fn texture(&mut self, map: &Option<Box<Map>>) -> Option<TextureRef> {
        self.textures
            .get(map.as_ref()?, self.folders, self.warnings)
    }

    /// A factor with its map. A map without a factor is shown as it is; without both there is
    /// `default`.
    fn color(&mut self, factor: Option<Rgb>, map: &Option<Box<Map>>, default: Rgb) -> TexturedRgb {
        let texture = self.texture(map);
        let alone = if texture.is_some() {
            Rgb::WHITE
        } else {
            default
        };
        TexturedRgb {
            factor: factor.unwrap_or(alone),
            texture,
        }
    }

    /// As [`Lookup::color`], for a number.
    fn scalar(
        &mut self,
        factor: Option<f32>,
        map: &Option<Box<Map>>,
        default: f32,
    ) -> TexturedScalar {
        let texture = self.texture(map);
        let alone = if texture.is_some() { 1.0 } else { default };
        TexturedScalar {
            factor: factor.unwrap_or(alone),
            texture,
            channel: match map.as_ref().and_then(|m| m.channel) {
                // Luminance is the red of a grey image.
                None | Some(Channel::Red | Channel::Luminance) => 0,
                Some(Channel::Green) => 1,
                Some(Channel::Blue) => 2,
                Some(Channel::Alpha) => 3,
            },
        }
    }

    fn surface(&mut self, mtl: &MtlMaterial, see_through: &SeeThrough) -> Surface {
        let mut diffuse = self.color(mtl.diffuse, &mtl.maps.diffuse, NEUTRAL_REFLECTANCE);
        if mtl.is_physically_based {
            return Surface::MetallicRoughness(Box::new(self.physical(mtl, diffuse, see_through)));
        }
        if mtl.illumination == Some(0) {
            return Surface::Unlit(diffuse);
        }
        diffuse.factor *= Rgb::splat(see_through.diffuse_share);
        let is_glossy = mtl.illumination != Some(1);
        let glossy = if is_glossy {
            self.color(mtl.specular, &mtl.maps.specular, Rgb::BLACK)
        } else {
            TexturedRgb::constant(Rgb::BLACK)
        };
        Surface::Phong(Phong {
            diffuse,
            specular: glossy,
            exponent: self.scalar(mtl.exponent, &mtl.maps.exponent, DEFAULT_EXPONENT),
            reflect: see_through.reflect,
            transmit: see_through.transmit,
            index_of_refraction: mtl.index_of_refraction.unwrap_or(1.0),
        })
    }

    fn physical(
        &mut self,
        mtl: &MtlMaterial,
        base_color: TexturedRgb,
        see_through: &SeeThrough,
    ) -> MetallicRoughness {
        let roughness = mtl
            .exponent
            .map_or(DEFAULT_ROUGHNESS, roughness_of_exponent);
        MetallicRoughness {
            base_color,
            metallic: self.scalar(mtl.metallic, &mtl.maps.metallic, 0.0),
            roughness: self.scalar(mtl.roughness, &mtl.maps.roughness, roughness),
            index_of_refraction: mtl.index_of_refraction.filter(|&n| n > 1.0).unwrap_or(1.5),
            transmission: TexturedScalar::constant(see_through.transmit.max_channel().min(1.0)),
            ..MetallicRoughness::default()
        }
    }

    fn opacity(&mut self, mtl: &MtlMaterial, factor: f32) -> TexturedScalar {
        let mut opacity = self.scalar(Some(factor), &mtl.maps.opacity, 1.0);
        let is_open = mtl
            .maps
            .opacity
            .as_ref()
            .is_some_and(|m| m.channel.is_none());
        // The image of `map_d` is often that of `map_Kd`, with its alpha.
        if let Some(texture) = opacity.texture.filter(|_| is_open)
            && self.textures.is(&texture, has_alpha)
        {
            opacity.channel = 3;
        }
        opacity
    }

    fn normal_map(&mut self, mtl: &MtlMaterial) -> Option<NormalMap> {
        if let Some(texture) = self.texture(&mtl.maps.normal) {
            let scale = mtl.maps.normal.as_ref().map_or(1.0, |m| m.bump_multiplier);
            return Some(NormalMap {
                texture,
                scale,
                is_height: false,
            });
        }
        let texture = self.texture(&mtl.maps.bump)?;
        let map = mtl.maps.bump.as_ref()?;
        let is_height = !self.textures.is(&texture, looks_like_normals);
        if !is_height {
            let message = format!(
                "bump map {:?} has the colours of a normal map and is shown as one",
                map.file
            );
            self.warnings.add(WarningCode::Approximated, message);
        }
        Some(NormalMap {
            texture,
            scale: map.bump_multiplier,
            is_height,
        })
    }
}

/// The roughness whose microfacets spread light as a Phong lobe of exponent `n` does: α² = 2/(n+2)
/// (Walter et al. 2007, "Microfacet Models for Refraction through Rough Surfaces", section 5.2).
fn roughness_of_exponent(n: f32) -> f32 {
    (2.0 / (n + 2.0)).sqrt().sqrt()
}
