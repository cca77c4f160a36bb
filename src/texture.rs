//! Images and how surfaces look them up.
//!
//! An [`Image`] is decoded pixels; a [`Texture`] adds wrapping and filtering; a [`TextureRef`] is
//! one use of a texture by a material, with its set of texture coordinates. Whether 8-bit
//! pixels are sRGB or plain numbers is the user's to know and is said by [`Encoding`].

use crate::color::{Rgb, srgb8_to_linear};
use crate::math::{Affine2, Vec2};

/// Index of an [`Image`] in a scene.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct ImageId(pub u32);

/// Index of a [`Texture`] in a scene.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct TextureId(pub u32);

/// Decoded pixels, row by row from the top.
#[derive(Clone, Debug)]
pub struct Image {
    /// File name or other name for messages.
    pub name: String,
    /// Pixels in a row; at least 1.
    pub width: u32,
    /// Rows; at least 1.
    pub height: u32,
    /// `width * height` pixels; none of an image that was left out, since nothing reads it.
    pub pixels: Pixels,
}

/// The pixels of an [`Image`].
#[derive(Clone, Debug)]
pub enum Pixels {
    /// Red, green, blue, alpha as 8-bit levels.
    Rgba8(Vec<[u8; 4]>),
    /// Linear red, green, blue, alpha.
    Rgba32F(Vec<[f32; 4]>),
}

/// What the red, green and blue of 8-bit pixels mean. Alpha is always linear.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Encoding {
    /// Colours, to be decoded.
    Srgb,
    /// Plain numbers: normals, roughness, opacity.
    Linear,
}

/// What lies beyond the unit square of texture coordinates.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Wrap {
    /// The image again.
    #[default]
    Repeat,
    /// The image again, every other time mirrored.
    MirroredRepeat,
    /// The image's outermost pixels.
    ClampToEdge,
}

/// What lies between the centres of pixels.
///
/// There are no smaller copies of images for what is far away (mipmaps): a pixel's samples are
/// spread over what it sees of the texture, and their mean is the filter. That has no bias; a mipmap
/// blurs normals and roughness, which do not average. Files' minifying filters are not read.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Filter {
    /// The nearest pixel.
    Nearest,
    /// A weighted mean of the four nearest pixels, of their *decoded* values.
    #[default]
    Linear,
}

/// An image with wrapping and filtering.
#[derive(Clone, Copy, Debug)]
pub struct Texture {
    /// The pixels.
    pub image: ImageId,
    /// Wrapping along u and v.
    pub wrap: [Wrap; 2],
    /// Filtering.
    pub filter: Filter,
}

/// One use of a texture by a material.
#[derive(Clone, Copy, Debug)]
pub struct TextureRef {
    /// Which texture.
    pub texture: TextureId,
    /// Which set of texture coordinates of the mesh.
    pub uv_set: u8,
    /// Applied to the texture coordinates first (`KHR_texture_transform`, MTL `-o` and `-s`).
    pub transform: Affine2,
}

impl TextureRef {
    /// `texture` with the first set of coordinates, as they are.
    pub fn new(texture: TextureId) -> Self {
        Self {
            texture,
            uv_set: 0,
            transform: Affine2::IDENTITY,
        }
    }
}

/// A colour that a texture may modulate.
#[derive(Clone, Copy, Debug)]
pub struct TexturedRgb {
    /// Factor.
    pub factor: Rgb,
    /// Multiplied with the factor.
    pub texture: Option<TextureRef>,
}

impl TexturedRgb {
    /// The same everywhere.
    pub const fn constant(factor: Rgb) -> Self {
        Self {
            factor,
            texture: None,
        }
    }
}

/// A number that one channel of a texture may modulate.
#[derive(Clone, Copy, Debug)]
pub struct TexturedScalar {
    /// Factor.
    pub factor: f32,
    /// Multiplied with the factor.
    pub texture: Option<TextureRef>,
    /// Which channel: 0 red, 1 green, 2 blue, 3 alpha.
    pub channel: u8,
}

impl TexturedScalar {
    /// The same everywhere.
    pub const fn constant(factor: f32) -> Self {
        Self {
            factor,
            texture: None,
            channel: 0,
        }
    }
}

impl Image {
    /// The pixel at column `x` of row `y`, decoded to linear.
    fn texel(&self, x: u32, y: u32, encoding: Encoding) -> [f32; 4] {
        let i = y as usize * self.width as usize + x as usize;
        match (&self.pixels, encoding) {
            (Pixels::Rgba32F(pixels), _) => pixels[i],
            (Pixels::Rgba8(pixels), Encoding::Linear) => pixels[i].map(|c| f32::from(c) / 255.0),
            (Pixels::Rgba8(pixels), Encoding::Srgb) => {
                let [r, g, b, a] = pixels[i];
                [
                    srgb8_to_linear(r),
                    srgb8_to_linear(g),
                    srgb8_to_linear(b),
                    f32::from(a) / 255.0,
                ]
            }
        }
    }

    /// Bytes of the pixels in memory.
    pub fn memory_bytes(&self) -> usize {
        match &self.pixels {
            Pixels::Rgba8(pixels) => size_of_val(pixels.as_slice()),
            Pixels::Rgba32F(pixels) => size_of_val(pixels.as_slice()),
        }
    }
}

impl Wrap {
    /// The pixel column (or row) of `size` that the unwrapped column `i` shows.
    fn index(self, i: i64, size: u32) -> u32 {
        let n = i64::from(size);
        let wrapped = match self {
            Wrap::Repeat => i.rem_euclid(n),
            Wrap::ClampToEdge => i.clamp(0, n - 1),
            Wrap::MirroredRepeat => {
                let j = i.rem_euclid(2 * n);
                j.min(2 * n - 1 - j)
            }
        };
        wrapped as u32
    }
}

impl Texture {
    /// Linear red, green, blue, alpha at texture coordinates `uv`; v grows downwards, as in glTF.
    ///
    /// Coordinates that are not finite read the first pixel.
    pub fn eval(&self, image: &Image, uv: Vec2, encoding: Encoding) -> [f32; 4] {
        // f64: at u = 1000 a single has not enough digits left to interpolate a large image.
        let x = f64::from(uv.x) * f64::from(image.width);
        let y = f64::from(uv.y) * f64::from(image.height);
        let texel = |x: i64, y: i64| {
            image.texel(
                self.wrap[0].index(x, image.width),
                self.wrap[1].index(y, image.height),
                encoding,
            )
        };
        // `as` saturates, and the indices must leave room for the neighbour.
        let cell = |v: f64| (v.floor() as i64).clamp(-(1 << 60), 1 << 60);
        match self.filter {
            Filter::Nearest => texel(cell(x), cell(y)),
            Filter::Linear => {
                let (x, y) = (x - 0.5, y - 0.5);
                let (x0, y0) = (cell(x), cell(y));
                let fraction = |v: f64| {
                    let f = (v - v.floor()) as f32;
                    if f.is_finite() { f } else { 0.0 }
                };
                let (fx, fy) = (fraction(x), fraction(y));
                let [a, b] = [texel(x0, y0), texel(x0 + 1, y0)];
                let [c, d] = [texel(x0, y0 + 1), texel(x0 + 1, y0 + 1)];
                std::array::from_fn(|i| {
                    let top = a[i] + fx * (b[i] - a[i]);
                    let bottom = c[i] + fx * (d[i] - c[i]);
                    top + fy * (bottom - top)
                })
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn checker(filter: Filter, wrap: Wrap) -> (Image, Texture) {
        let image = Image {
            name: "checker".into(),
            width: 2,
            height: 1,
            pixels: Pixels::Rgba8(vec![[0, 0, 0, 255], [255, 255, 255, 255]]),
        };
        let texture = Texture {
            image: ImageId(0),
            wrap: [wrap; 2],
            filter,
        };
        (image, texture)
    }

    #[test]
    fn linear_filtering_averages_decoded_values() {
        let (image, texture) = checker(Filter::Linear, Wrap::ClampToEdge);
        let middle = texture.eval(&image, Vec2::new(0.5, 0.5), Encoding::Srgb);
        assert!((middle[0] - 0.5).abs() < 1e-6, "{middle:?}");
    }

    #[test]
    fn wrapping_continues_the_image() {
        for (wrap, expected) in [
            (Wrap::Repeat, [1.0, 0.0, 1.0, 0.0]),
            (Wrap::MirroredRepeat, [0.0, 0.0, 1.0, 1.0]),
            (Wrap::ClampToEdge, [0.0, 0.0, 1.0, 1.0]),
        ] {
            let (image, texture) = checker(Filter::Nearest, wrap);
            let got = [-0.25, 0.25, 0.75, 1.25]
                .map(|u| texture.eval(&image, Vec2::new(u, 0.5), Encoding::Linear)[0]);
            assert_eq!(got, expected, "{wrap:?}");
        }
    }

    #[test]
    fn coordinates_that_are_not_finite_do_no_harm() {
        for filter in [Filter::Nearest, Filter::Linear] {
            let (image, texture) = checker(filter, Wrap::Repeat);
            for u in [f32::NAN, f32::INFINITY, -1e38] {
                let v = texture.eval(&image, Vec2::splat(u), Encoding::Srgb);
                assert!(v.iter().all(|c| c.is_finite()), "{u}: {v:?}");
            }
        }
    }
}
