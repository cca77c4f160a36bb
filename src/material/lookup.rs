//! What a material reads at one point of a surface.

use crate::color::Rgb;
use crate::math::Vec2;
use crate::texture::{Encoding, Image, Texture, TextureRef, TexturedRgb, TexturedScalar};

/// Sets of texture coordinates that a surface point carries.
pub const MAX_UV_SETS: usize = 4;

/// What a material reads at one point of a surface.
#[derive(Clone, Copy, Debug)]
pub struct Lookup<'a> {
    /// The scene's textures.
    pub textures: &'a [Texture],
    /// The scene's images.
    pub images: &'a [Image],
    /// Texture coordinates; zero for sets that the mesh lacks.
    pub uvs: [Vec2; MAX_UV_SETS],
    /// Interpolated vertex colour and opacity; white where the mesh has none.
    pub color: [f32; 4],
}

impl Lookup<'_> {
    /// The texture's value here, linear red, green, blue, alpha.
    pub fn texel(&self, reference: &TextureRef, encoding: Encoding) -> [f32; 4] {
        let texture = &self.textures[reference.texture.0 as usize];
        let uv = self.uvs[usize::from(reference.uv_set).min(MAX_UV_SETS - 1)];
        let uv = reference.transform.transform_point2(uv);
        texture.eval(&self.images[texture.image.0 as usize], uv, encoding)
    }

    /// A colour's value here.
    pub fn rgb(&self, value: &TexturedRgb) -> Rgb {
        match &value.texture {
            None => value.factor,
            Some(texture) => {
                let [r, g, b, _] = self.texel(texture, Encoding::Srgb);
                value.factor * Rgb::new(r, g, b)
            }
        }
    }

    /// A number's value here.
    pub fn scalar(&self, value: &TexturedScalar) -> f32 {
        match &value.texture {
            None => value.factor,
            Some(texture) => {
                let texel = self.texel(texture, Encoding::Linear);
                value.factor * texel[usize::from(value.channel & 3)]
            }
        }
    }

    /// Vertex colour without opacity.
    pub fn vertex_rgb(&self) -> Rgb {
        let [r, g, b, _] = self.color;
        Rgb::new(r, g, b)
    }
}
