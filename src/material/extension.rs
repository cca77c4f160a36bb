//! Layers and properties that extensions of glTF add to its metallic-roughness model.

use super::NormalMap;
use crate::color::Rgb;
use crate::texture::{TextureRef, TexturedRgb, TexturedScalar};

/// `KHR_materials_clearcoat`: a clear coat of index 1.5 over everything else.
#[derive(Clone, Debug)]
pub struct Clearcoat {
    /// Share of the surface that it covers (red channel).
    pub factor: TexturedScalar,
    /// Perceptual roughness (green channel).
    pub roughness: TexturedScalar,
    /// Its own bumps; without them it is as smooth as the mesh.
    pub normal_map: Option<NormalMap>,
}

/// `KHR_materials_sheen`: fibres, as of cloth.
#[derive(Clone, Debug)]
pub struct Sheen {
    /// Colour; black for none.
    pub color: TexturedRgb,
    /// Perceptual roughness (alpha channel).
    pub roughness: TexturedScalar,
}

/// `KHR_materials_anisotropy`: highlights that are longer one way.
#[derive(Clone, Debug)]
pub struct Anisotropy {
    /// How much so, in `[0, 1]`.
    pub strength: f32,
    /// Direction in which they are long, radians from the tangent towards the bitangent.
    pub rotation: f32,
    /// Direction in red and green, `2c - 1`, and a factor of the strength in blue.
    pub texture: Option<TextureRef>,
}

/// `KHR_materials_iridescence`: a film as thin as the waves of light.
#[derive(Clone, Debug)]
pub struct Iridescence {
    /// Share of the reflection that it changes (red channel).
    pub factor: TexturedScalar,
    /// Index of refraction of the film.
    pub index_of_refraction: f32,
    /// Its thickness where the texture is 0 and where it is 1 (green channel), nm.
    pub thickness: [f32; 2],
    /// Where between both it is; at the second where there is none.
    pub thickness_texture: Option<TextureRef>,
}

/// `KHR_materials_diffuse_transmission`: a thin matte surface that light passes.
#[derive(Clone, Debug)]
pub struct DiffuseTransmission {
    /// Share of the matte base that lets light through (alpha channel).
    pub factor: TexturedScalar,
    /// Colour of that light.
    pub color: TexturedRgb,
}

impl Default for Clearcoat {
    fn default() -> Self {
        Self {
            factor: TexturedScalar::constant(0.0),
            roughness: TexturedScalar::constant(0.0),
            normal_map: None,
        }
    }
}

impl Default for Sheen {
    fn default() -> Self {
        Self {
            color: TexturedRgb::constant(Rgb::BLACK),
            roughness: TexturedScalar::constant(0.0),
        }
    }
}

impl Default for Iridescence {
    fn default() -> Self {
        Self {
            factor: TexturedScalar::constant(0.0),
            index_of_refraction: 1.3,
            thickness: [100.0, 400.0],
            thickness_texture: None,
        }
    }
}

impl Default for DiffuseTransmission {
    fn default() -> Self {
        Self {
            factor: TexturedScalar::constant(0.0),
            color: TexturedRgb::constant(Rgb::WHITE),
        }
    }
}
