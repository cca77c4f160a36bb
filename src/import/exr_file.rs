//! Whether the bytes of a file can hold the pixels that its header claims: memory is asked for by that.

use exr::compression::Compression;
use exr::math::Vec2;
use exr::meta::attribute::SampleType;
use exr::meta::header::Header;
use thiserror::Error;

use crate::scene::MAX_PIXELS;

/// The longest runs of deflate: bytes to one.
const DEFLATE: u64 = 1032;

/// More pixels than there can be.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Error)]
pub enum SizeError {
    /// More than a picture may have.
    #[error("{width} × {height} pixels are more than {MAX_PIXELS}")]
    TooLarge {
        /// Columns.
        width: u64,
        /// Rows.
        height: u64,
    },
    /// More than so few bytes can hold.
    #[error("{width} × {height} pixels do not fit into its {bytes} bytes")]
    TooShort {
        /// Columns.
        width: u64,
        /// Rows.
        height: u64,
        /// Length of the file.
        bytes: u64,
    },
}

/// Holds a picture of `width` × `height` pixels to what there may be, and to the `most` that a file of so many `bytes` can
/// hold.
///
/// # Errors
/// Where it has more.
pub fn check_size([width, height]: [u64; 2], most: u64, bytes: u64) -> Result<(), SizeError> {
    let pixels = width.saturating_mul(height);
    if pixels > MAX_PIXELS {
        return Err(SizeError::TooLarge { width, height });
    }
    if pixels > most {
        return Err(SizeError::TooShort {
            width,
            height,
            bytes,
        });
    }
    Ok(())
}

/// Holds all parts of an OpenEXR file of so many `bytes` to what that can hold.
///
/// # Errors
/// Where one claims more.
pub fn check_exr_size(headers: &[Header], bytes: u64) -> Result<(), SizeError> {
    headers.iter().try_for_each(|header| {
        let Vec2(width, height) = header.layer_size;
        let size = [width as u64, height as u64];
        check_size(size, most_pixels(header, bytes), bytes)
    })
}

/// The most pixels that a part with this `header` can have in so many `bytes`.
fn most_pixels(header: &Header, bytes: u64) -> u64 {
    let channels = &header.channels.list;
    match header.compression {
        // One coefficient of a channel stands for the 8 × 8 pixels of a block.
        Compression::DWAA(_) | Compression::DWAB(_) => {
            bytes.saturating_mul(64 * DEFLATE) / (channels.len() as u64).max(1)
        }
        // The shortest of all others that are decoded, so not JPEG 2000, is PXR24, which hands 24 of 32 bits to deflate.
        _ => {
            let of_pixel = channels.iter().map(|channel| match channel.sample_type {
                SampleType::F16 => 2,
                SampleType::F32 | SampleType::U32 => 4,
            });
            bytes.saturating_mul(DEFLATE) / 3 * 4 / of_pixel.sum::<u64>().max(1)
        }
    }
}
