//! Materials: what the author said about a surface, and the scattering that follows from it.
//!
//! A [`Material`] is evaluated at an interaction and gives a [`Bsdf`]; one file a kind.

mod albedo;
mod border;
mod bsdf;
mod coat;
mod extension;
mod facets;
mod fresnel;
mod glass;
mod iridescence;
mod layered;
mod lookup;
mod metallic_roughness;
mod microfacet;
mod phong;
mod sample;
mod sheen;
mod textures;

pub use bsdf::{Bsdf, Lobes, Specular, View};
pub use extension::{Anisotropy, Clearcoat, DiffuseTransmission, Iridescence, Sheen};
pub use fresnel::{fresnel_dielectric, reflect, refract};
pub use lookup::{Lookup, MAX_UV_SETS};
pub use metallic_roughness::MetallicRoughness;
pub use phong::Phong;
pub use sample::BsdfSample;
pub use textures::TextureSlot;

use crate::color::Rgb;
use crate::math::Vec2;
use crate::texture::{TextureRef, TexturedRgb, TexturedScalar};

/// Index of a [`Material`] in a scene.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct MaterialId(pub u32);

/// What the author said about a surface.
#[derive(Clone, Debug)]
pub struct Material {
    /// Its name in the file; may be empty.
    pub name: String,
    /// How it scatters light.
    pub surface: Surface,
    /// Radiance that it gives off, W/(m² sr).
    pub emission: TexturedRgb,
    /// What opacity below 1 means.
    pub alpha_mode: AlphaMode,
    /// Opacity in `[0, 1]`; not read where the mode is [`AlphaMode::Opaque`].
    pub opacity: TexturedScalar,
    /// Bumps of the shading normal.
    pub normal_map: Option<NormalMap>,
    /// Whether it is seen from the inside too. A single-sided surface is not there for who looks
    /// at its back (glTF 2.0, section 3.9.6), but casts its shadow all the same.
    pub is_double_sided: bool,
}

/// How a surface scatters light.
#[derive(Clone, Debug)]
pub enum Surface {
    /// Lambert plus normalised Phong, mirror and refraction: MTL files and scene files.
    Phong(Phong),
    /// glTF's metallic-roughness model.
    MetallicRoughness(Box<MetallicRoughness>),
    /// No scattering: the colour as it is, independent of light (`KHR_materials_unlit`).
    Unlit(TexturedRgb),
}

/// What opacity below 1 means.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum AlphaMode {
    /// Nothing: the surface is solid.
    Opaque,
    /// Below the cutoff the surface is not there.
    Mask {
        /// In `[0, 1]`.
        cutoff: f32,
    },
    /// That share of the light is let through.
    Blend,
}

/// A tangent-space normal map.
#[derive(Clone, Copy, Debug)]
pub struct NormalMap {
    /// Its texture; x and y in red and green, `2c - 1`.
    pub texture: TextureRef,
    /// Multiplies x and y.
    pub scale: f32,
    /// Whether it holds heights (MTL `map_Bump`) in place of normals.
    pub is_height: bool,
}

impl Material {
    /// How it scatters light where `lookup` is.
    pub fn bsdf(&self, lookup: &Lookup) -> Bsdf {
        match &self.surface {
            Surface::Phong(phong) => phong.bsdf(lookup),
            Surface::MetallicRoughness(surface) => surface.bsdf(lookup),
            Surface::Unlit(_) => bsdf::BLACK,
        }
    }

    /// Radiance that it gives off where `lookup` is; an unlit surface gives off its colour.
    pub fn emitted(&self, lookup: &Lookup) -> Rgb {
        let emission = lookup.rgb(&self.emission);
        match &self.surface {
            Surface::Unlit(color) => emission + lookup.rgb(color) * lookup.vertex_rgb(),
            _ => emission,
        }
    }

    /// Share of ambient light that arrives where `lookup` is, in `[0, 1]`.
    pub fn occlusion(&self, lookup: &Lookup) -> f32 {
        match &self.surface {
            Surface::MetallicRoughness(surface) => surface.occlusion(lookup),
            Surface::Phong(_) | Surface::Unlit(_) => 1.0,
        }
    }

    /// How it scatters light where that is the same everywhere, and in all that it does: without textures, mirrors, glass,
    /// holes, bumps or light of its own, and seen from both sides.
    pub fn plain(&self) -> Option<Bsdf> {
        let Surface::Phong(phong) = &self.surface else {
            return None;
        };
        let is_alone = self.alpha_mode == AlphaMode::Opaque
            && self.is_double_sided
            && self.normal_map.is_none()
            && self.emission.factor.is_black();
        phong.plain().filter(|_| is_alone)
    }

    /// Diffuse reflectance or base colour where `lookup` is.
    pub fn albedo(&self, lookup: &Lookup) -> Rgb {
        let color = match &self.surface {
            Surface::Phong(phong) => &phong.diffuse,
            Surface::MetallicRoughness(surface) => &surface.base_color,
            Surface::Unlit(color) => color,
        };
        lookup.rgb(color) * lookup.vertex_rgb()
    }

    /// Whether light from its far side is scattered through it.
    pub fn is_translucent(&self) -> bool {
        match &self.surface {
            Surface::MetallicRoughness(surface) => surface.diffuse_transmission.is_some(),
            Surface::Phong(_) | Surface::Unlit(_) => false,
        }
    }

    /// Bumps of its coat; `None` where it has no coat, or a smooth one.
    pub fn coat_normal_map(&self) -> Option<&NormalMap> {
        match &self.surface {
            Surface::MetallicRoughness(surface) => surface.clearcoat.as_ref()?.normal_map.as_ref(),
            Surface::Phong(_) | Surface::Unlit(_) => None,
        }
    }

    /// Whether it has a coat.
    pub fn has_coat(&self) -> bool {
        match &self.surface {
            Surface::MetallicRoughness(surface) => surface.clearcoat.is_some(),
            Surface::Phong(_) | Surface::Unlit(_) => false,
        }
    }

    /// Direction in tangent space in which highlights are long; `None` where they are round.
    pub fn grain(&self, lookup: &Lookup) -> Option<Vec2> {
        match &self.surface {
            Surface::MetallicRoughness(surface) => Some(surface.grain(lookup)?.0),
            Surface::Phong(_) | Surface::Unlit(_) => None,
        }
    }

    /// Whether it reads the tangents of a mesh.
    pub fn reads_tangents(&self) -> bool {
        let has_grain = match &self.surface {
            Surface::MetallicRoughness(surface) => surface.anisotropy.is_some(),
            Surface::Phong(_) | Surface::Unlit(_) => false,
        };
        has_grain || self.normal_map.is_some() || self.coat_normal_map().is_some()
    }

    /// Absorption inside a body of it, per world unit; `None` where light crosses it unchanged.
    pub fn absorption(&self) -> Option<Rgb> {
        match &self.surface {
            Surface::MetallicRoughness(surface) => surface.absorption(),
            Surface::Phong(_) | Surface::Unlit(_) => None,
        }
    }

    /// Opacity in `[0, 1]` where `lookup` is: 0 lets everything pass, and masks are 0 or 1.
    pub fn opacity(&self, lookup: &Lookup) -> f32 {
        let opacity = || lookup.scalar(&self.opacity) * lookup.color[3];
        match self.alpha_mode {
            AlphaMode::Opaque => 1.0,
            AlphaMode::Mask { cutoff } => f32::from(u8::from(opacity() >= cutoff)),
            AlphaMode::Blend => opacity().clamp(0.0, 1.0),
        }
    }

    /// Whether it is seen from the back: glass always is, since light that entered it must get out.
    pub fn is_seen_from_back(&self) -> bool {
        self.is_double_sided || self.is_glass()
    }

    /// Whether it refracts.
    pub fn is_glass(&self) -> bool {
        match &self.surface {
            Surface::Phong(phong) => !phong.transmit.is_black(),
            Surface::MetallicRoughness(surface) => surface.transmission.factor > 0.0,
            Surface::Unlit(_) => false,
        }
    }

    /// Whether no light passes it anywhere: neither holes nor glass.
    pub fn is_opaque(&self) -> bool {
        self.alpha_mode == AlphaMode::Opaque && !self.is_glass()
    }

    /// A matte material of the given reflectance.
    pub fn matte(name: impl Into<String>, reflectance: Rgb) -> Self {
        Self {
            name: name.into(),
            surface: Surface::Phong(Phong::matte(reflectance)),
            emission: TexturedRgb::constant(Rgb::BLACK),
            alpha_mode: AlphaMode::Opaque,
            opacity: TexturedScalar::constant(1.0),
            normal_map: None,
            is_double_sided: true,
        }
    }
}
