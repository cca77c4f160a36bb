//! Encoded images (PNG, JPEG, WebP, TGA, BMP, GIF, Radiance HDR, KTX2) to [`Image`]s.
//!
//! Formats of more than 8 bits a channel that hold sRGB-encoded or plain numbers (16-bit PNG) are
//! rounded to 8 bits, since [`Pixels::Rgba32F`] means linear values; HDR keeps its floats. The
//! format is told by the first bytes, and by the name only where those do not say (TGA).

use std::io::Cursor;

use image::{DynamicImage, ImageDecoder, ImageFormat, ImageReader, Limits};

#[cfg(feature = "obj")]
use super::budget::Budget;
#[cfg(feature = "ktx2")]
use super::ktx2;
use crate::texture::{Image, Pixels};

/// Decoded bytes that any image may have, however small its file: 8192 × 8192 pixels.
const ALWAYS_ALLOWED_BYTES: u64 = 8192 * 8192 * 4;

/// Decoded bytes per byte of the file that are allowed beyond [`ALWAYS_ALLOWED_BYTES`].
const ALLOWED_EXPANSION: u64 = 64;

/// Decodes the bytes of a file called `name`, whose pixels are charged to `budget`.
///
/// # Errors
/// A sentence that begins with `name`, where it cannot be decoded, or with the images before it
/// holds more pixels than their files account for.
#[cfg(feature = "obj")]
pub fn decode_within(bytes: &[u8], name: &str, budget: &Budget) -> Result<Image, String> {
    budget.add_file(bytes.len() as u64);
    let needed = decoded_bytes(bytes, name)?;
    budget
        .take(needed)
        .map_err(|problem| format!("{name}: {problem}"))?;
    decode(bytes, name)
}

/// Decodes the bytes of a file called `name`.
///
/// # Errors
/// A sentence that begins with `name`. An image that would decode to more than 256 MiB and 64
/// times its file is refused before memory is taken for it.
pub fn decode(bytes: &[u8], name: &str) -> Result<Image, String> {
    #[cfg(feature = "ktx2")]
    if ktx2::is_ktx2(bytes) {
        return decode_ktx2(bytes, name);
    }
    let problem = |error: image::ImageError| format!("{name}: {error}");
    let mut decoder = decoder(bytes, name).map_err(problem)?;
    let (width, height) = decoder.dimensions();
    let allowed = check_size(bytes, name, (width, height), pixel_bytes(&decoder))?;
    let mut limits = Limits::default();
    // Decoders keep a copy in their own pixel format, up to twice as deep as ours.
    limits.max_alloc = Some(4 * allowed);
    decoder.set_limits(limits).map_err(problem)?;
    let decoded = DynamicImage::from_decoder(decoder).map_err(problem)?;
    Ok(Image {
        name: name.to_owned(),
        width,
        height,
        pixels: pixels(decoded),
    })
}

#[cfg(feature = "ktx2")]
fn decode_ktx2(bytes: &[u8], name: &str) -> Result<Image, String> {
    let problem = |what: String| format!("{name}: {what}");
    let (width, height) = ktx2::size(bytes).map_err(problem)?;
    let needed = 4 * u64::from(width) * u64::from(height);
    check_size(bytes, name, (width, height), needed)?;
    let pixels = ktx2::decode(bytes).map_err(problem)?;
    Ok(Image {
        name: name.to_owned(),
        width,
        height,
        pixels: Pixels::Rgba8(in_fours(pixels)),
    })
}

/// How many bytes the pixels of a file may take, if that is no fewer than are `needed`.
fn check_size(
    bytes: &[u8],
    name: &str,
    (width, height): (u32, u32),
    needed: u64,
) -> Result<u64, String> {
    let allowed = ALWAYS_ALLOWED_BYTES + ALLOWED_EXPANSION * bytes.len() as u64;
    if needed > allowed {
        return Err(format!(
            "{name}: {width} × {height} pixels are too many for a file of {} bytes",
            bytes.len()
        ));
    }
    if needed == 0 {
        return Err(format!("{name}: has no pixels"));
    }
    Ok(allowed)
}

/// Bytes of memory that the pixels will take, from the header alone.
///
/// # Errors
/// As for [`decode`].
pub fn decoded_bytes(bytes: &[u8], name: &str) -> Result<u64, String> {
    #[cfg(feature = "ktx2")]
    if ktx2::is_ktx2(bytes) {
        let size = ktx2::size(bytes).map_err(|what| format!("{name}: {what}"))?;
        return Ok(4 * u64::from(size.0) * u64::from(size.1));
    }
    decoder(bytes, name)
        .map(|decoder| pixel_bytes(&decoder))
        .map_err(|error| format!("{name}: {error}"))
}

fn decoder<'a>(bytes: &'a [u8], name: &str) -> image::ImageResult<impl ImageDecoder + 'a> {
    let mut reader = ImageReader::new(Cursor::new(bytes)).with_guessed_format()?;
    if reader.format().is_none()
        && let Ok(format) = ImageFormat::from_path(name)
    {
        reader.set_format(format);
    }
    reader.into_decoder()
}

fn pixel_bytes(decoder: &impl ImageDecoder) -> u64 {
    let (width, height) = decoder.dimensions();
    let bytes_per_channel = if is_float(decoder.color_type()) { 4 } else { 1 };
    u64::from(width)
        .saturating_mul(u64::from(height))
        .saturating_mul(4 * bytes_per_channel)
}

fn is_float(color: image::ColorType) -> bool {
    matches!(color, image::ColorType::Rgb32F | image::ColorType::Rgba32F)
}

fn pixels(image: DynamicImage) -> Pixels {
    if is_float(image.color()) {
        Pixels::Rgba32F(in_fours(image.into_rgba32f().into_raw()))
    } else {
        Pixels::Rgba8(in_fours(image.into_rgba8().into_raw()))
    }
}

/// The channels of each pixel together; copies only where the vector has room to spare.
fn in_fours<T: bytemuck::Pod>(channels: Vec<T>) -> Vec<[T; 4]> {
    bytemuck::try_cast_vec(channels)
        .unwrap_or_else(|(_, channels)| channels.as_chunks::<4>().0.to_vec())
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]

    use super::*;

    fn encoded(image: &DynamicImage, format: ImageFormat) -> Vec<u8> {
        let mut bytes = Cursor::new(Vec::new());
        image.write_to(&mut bytes, format).unwrap();
        bytes.into_inner()
    }

    fn rgba8(image: &Image) -> &[[u8; 4]] {
        match &image.pixels {
            Pixels::Rgba8(pixels) => pixels,
            Pixels::Rgba32F(_) => &[],
        }
    }

    #[test]
    fn sixteen_bits_are_rounded_to_eight() {
        let image = image::ImageBuffer::from_fn(2, 1, |x, _| {
            image::Rgb([0u16, 257 * 100 + 100, 65535 - 100 * x as u16])
        });
        let bytes = encoded(&DynamicImage::ImageRgb16(image), ImageFormat::Png);
        let image = decode(&bytes, "deep.png").unwrap();
        assert_eq!((image.width, image.height), (2, 1));
        assert_eq!(rgba8(&image), [[0, 100, 255, 255], [0, 100, 255, 255]]);
    }

    #[test]
    fn a_grey_image_is_grey_in_all_channels() {
        let image = image::GrayImage::from_fn(1, 2, |_, y| image::Luma([7 + y as u8]));
        for format in [ImageFormat::Png, ImageFormat::Bmp, ImageFormat::Tga] {
            let bytes = encoded(&DynamicImage::ImageLuma8(image.clone()), format);
            let name = format!("grey.{}", format.extensions_str()[0]);
            let image = decode(&bytes, &name).unwrap();
            assert_eq!(rgba8(&image), [[7, 7, 7, 255], [8, 8, 8, 255]], "{name}");
        }
    }

    #[test]
    fn a_small_file_cannot_claim_gigabytes() {
        let mut bytes = encoded(&DynamicImage::new_rgb8(1, 1), ImageFormat::Png);
        bytes[16..24].copy_from_slice(&[0, 1, 0, 0, 0, 1, 0, 0]);
        let checksum = png_crc(&bytes[12..29]);
        bytes[29..33].copy_from_slice(&checksum.to_be_bytes());
        let error = decode(&bytes, "bomb.png").unwrap_err();
        assert!(
            error.contains("65536 × 65536 pixels are too many"),
            "{error}"
        );
    }

    /// CRC-32 of PNG (ISO 15948, annex D), bit by bit.
    fn png_crc(bytes: &[u8]) -> u32 {
        !bytes.iter().fold(!0, |crc: u32, &byte| {
            (0..8).fold(crc ^ u32::from(byte), |c, _| {
                if c & 1 == 1 {
                    0xedb8_8320 ^ (c >> 1)
                } else {
                    c >> 1
                }
            })
        })
    }

    #[test]
    fn images_together_cannot_take_more_than_their_files_account_for() {
        let bytes = encoded(&DynamicImage::new_luma8(1024, 1024), ImageFormat::Png);
        let budget = Budget::for_pixels(0);
        assert!(decode_within(&bytes, "plain.png", &budget).is_ok());
        while budget.take(1 << 20).is_ok() {}
        let error = decode_within(&bytes, "plain.png", &budget).unwrap_err();
        let expected = format!(
            "asks for far more memory than its {} bytes",
            2 * bytes.len()
        );
        assert!(error.contains(&expected), "{error}");
    }

    #[test]
    fn broken_bytes_are_an_error_that_names_the_file() {
        let good = encoded(&DynamicImage::new_rgba8(5, 5), ImageFormat::Png);
        for length in 0..good.len() {
            if let Err(error) = decode(&good[..length], "cut.png") {
                assert!(error.starts_with("cut.png: "), "{error}");
            }
        }
        assert!(decode(&good[..good.len() / 2], "cut.png").is_err());
        assert!(decode(b"not an image", "x").is_err());
    }
}
