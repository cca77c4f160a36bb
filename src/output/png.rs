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
/// # Errors
/// Where the file cannot be written.
pub fn write(
    path: &Path,
    size: UVec2,
    pixels: &[Rgb],
    options: PngOptions,
) -> Result<(), OutputError> {
    write_whole(path, |file| encode(file, size, pixels, options))
}

/// The bytes of a PNG, to any writer.
///
/// # Errors
/// Where `writer` fails, or `size` has no pixels.
#[cfg(feature = "png")]
pub fn encode(
    writer: impl Write,
    size: UVec2,
    pixels: &[Rgb],
    options: PngOptions,
) -> io::Result<()> {
    debug_assert_eq!(pixels.len(), size.x as usize * size.y as usize);
    let mut encoder = ::png::Encoder::new(writer, size.x, size.y);
    encoder.set_color(::png::ColorType::Rgb);
    encoder.set_depth(match options.bits {
        PngBits::Eight => ::png::BitDepth::Eight,
        PngBits::Sixteen => ::png::BitDepth::Sixteen,
    });
    // Readers that do not know the sRGB chunk go by the other two, which mean nearly the same.
    encoder.set_source_srgb(::png::SrgbRenderingIntent::Perceptual);
    encoder.set_source_gamma(::png::ScaledFloat::from_scaled(45_455));
    encoder.set_source_chromaticities(rec_709());
    let mut header = encoder.write_header().map_err(io_error)?;
    let mut rows = header.stream_writer().map_err(io_error)?;
    let mut bytes = Vec::new();
    for row in pixels.chunks_exact(size.x.max(1) as usize) {
        bytes.clear();
        row.iter()
            .for_each(|&pixel| push(&mut bytes, pixel, options));
        rows.write_all(&bytes)?;
    }
    rows.finish().map_err(io_error)?;
    header.finish().map_err(io_error)
}

/// As above, of a build that cannot.
#[cfg(not(feature = "png"))]
pub fn encode(_: impl Write, _: UVec2, _: &[Rgb], _: PngOptions) -> io::Result<()> {
    Err(super::not_built(super::ImageFormat::Png))
}

#[cfg(feature = "png")]
fn push(bytes: &mut Vec<u8>, pixel: Rgb, options: PngOptions) {
    for encoded in encoded(pixel, options).channels() {
        match options.bits {
            PngBits::Eight => bytes.push((encoded * 255.0).round() as u8),
            PngBits::Sixteen => {
                bytes.extend(((encoded * 65535.0).round() as u16).to_be_bytes());
            }
        }
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
