//! PNG: pictures encoded for a screen.

use std::io::{self, Write};
use std::path::Path;

#[cfg(feature = "png")]
use super::tone_mapped;
use super::{OutputError, write_whole};
use crate::color::Rgb;
#[cfg(feature = "png")]
use crate::color::linear_to_srgb;
use crate::math::UVec2;
use crate::scene::ToneMap;

/// How radiance becomes levels.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PngOptions {
    /// Bits a channel.
    pub bits: PngBits,
    /// Stops of exposure: radiance is multiplied by 2 to the power of this.
    pub exposure_ev: f32,
    /// What happens to what is too bright.
    pub tone_map: ToneMap,
}

/// Bits a channel of a PNG.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum PngBits {
    /// 256 levels.
    #[default]
    Eight,
    /// 65536 levels.
    Sixteen,
}

impl Default for PngOptions {
    fn default() -> Self {
        Self {
            bits: PngBits::Eight,
            exposure_ev: 0.0,
            tone_map: ToneMap::None,
        }
    }
}

/// Writes `pixels` (linear radiance, row by row from the top) as an sRGB PNG.
///
/// With `alpha`, the share of each pixel that is covered, `pixels` are what the covered shares add
/// (premultiplied), as in EXR. The file then has an opacity, and colours of the covered shares alone: PNG's
/// are not premultiplied.
///
/// # Errors
/// Where the file cannot be written.
pub fn write(
    path: &Path,
    size: UVec2,
    pixels: &[Rgb],
    alpha: Option<&[f32]>,
    options: PngOptions,
) -> Result<(), OutputError> {
    write_whole(path, |file| encode(file, size, pixels, alpha, options))
}

/// The bytes of a PNG, to any writer; as in [`write()`].
///
/// # Errors
/// Where `writer` fails, or `size` has no pixels.
#[cfg(feature = "png")]
pub fn encode(
    writer: impl Write,
    size: UVec2,
    pixels: &[Rgb],
    alpha: Option<&[f32]>,
    options: PngOptions,
) -> io::Result<()> {
    debug_assert_eq!(pixels.len(), size.x as usize * size.y as usize);
    let mut encoder = ::png::Encoder::new(writer, size.x, size.y);
    encoder.set_color(match alpha {
        None => ::png::ColorType::Rgb,
        Some(_) => ::png::ColorType::Rgba,
    });
    encoder.set_depth(match options.bits {
        PngBits::Eight => ::png::BitDepth::Eight,
        PngBits::Sixteen => ::png::BitDepth::Sixteen,
    });
    // The default takes longer than many a render, for files that are not much smaller.
    encoder.set_compression(::png::Compression::Fast);
    // Readers that do not know the sRGB chunk go by the other two, which mean nearly the same.
    encoder.set_source_srgb(::png::SrgbRenderingIntent::Perceptual);
    encoder.set_source_gamma(::png::ScaledFloat::from_scaled(45_455));
    encoder.set_source_chromaticities(rec_709());
    let mut header = encoder.write_header().map_err(io_error)?;
    let mut rows = header.stream_writer().map_err(io_error)?;
    let mut bytes = Vec::new();
    let columns = size.x.max(1) as usize;
    for (y, row) in pixels.chunks_exact(columns).enumerate() {
        bytes.clear();
        match alpha {
            None => row
                .iter()
                .for_each(|&pixel| push(&mut bytes, encoded(pixel, options), options.bits)),
            Some(alpha) => row
                .iter()
                .zip(&alpha[y * columns..])
                .for_each(|(&pixel, &alpha)| push_covered(&mut bytes, pixel, alpha, options)),
        }
        rows.write_all(&bytes)?;
    }
    rows.finish().map_err(io_error)?;
    header.finish().map_err(io_error)
}

/// As above, of a build that cannot.
#[cfg(not(feature = "png"))]
pub fn encode(
    _: impl Write,
    _: UVec2,
    _: &[Rgb],
    _: Option<&[f32]>,
    _: PngOptions,
) -> io::Result<()> {
    Err(super::not_built(super::ImageFormat::Png))
}

#[cfg(feature = "png")]
fn push(bytes: &mut Vec<u8>, encoded: Rgb, bits: PngBits) {
    for channel in encoded.channels() {
        push_level(bytes, channel, bits);
    }
}

#[cfg(feature = "png")]
fn push_covered(bytes: &mut Vec<u8>, pixel: Rgb, alpha: f32, options: PngOptions) {
    let straight = if alpha > 0.0 {
        pixel / alpha
    } else {
        Rgb::BLACK
    };
    push(bytes, encoded(straight, options), options.bits);
    push_level(bytes, alpha.clamp(0.0, 1.0), options.bits);
}

/// A level of what is in `[0, 1]`.
#[cfg(feature = "png")]
fn push_level(bytes: &mut Vec<u8>, value: f32, bits: PngBits) {
    match bits {
        PngBits::Eight => bytes.push((value * 255.0).round() as u8),
        PngBits::Sixteen => bytes.extend(((value * 65535.0).round() as u16).to_be_bytes()),
    }
}

/// Exposure, tone map, sRGB curve; in `[0, 1]`.
#[cfg(feature = "png")]
fn encoded(pixel: Rgb, options: PngOptions) -> Rgb {
    let exposed = pixel * options.exposure_ev.exp2();
    tone_mapped(exposed, options.tone_map).map(|c| linear_to_srgb(c).clamp(0.0, 1.0))
}

#[cfg(feature = "png")]
fn rec_709() -> ::png::SourceChromaticities {
    ::png::SourceChromaticities::new((0.3127, 0.3290), (0.64, 0.33), (0.30, 0.60), (0.15, 0.06))
}

#[cfg(feature = "png")]
fn io_error(error: ::png::EncodingError) -> io::Error {
    match error {
        ::png::EncodingError::IoError(error) => error,
        other => io::Error::other(other.to_string()),
    }
}
