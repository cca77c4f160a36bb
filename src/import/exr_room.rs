//! Whether the bytes of an OpenEXR file can hold the pixels that its header claims: memory is asked for by that.

use exr::compression::Compression;
use exr::meta::attribute::SampleType;
use exr::meta::header::Header;
use thiserror::Error;

use crate::scene::MAX_PIXELS;

/// The longest runs of deflate: bytes to one.
const DEFLATE: u64 = 1032;

/// More pixels than there can be.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Error)]
pub enum ExrSizeError {
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

/// Holds all parts of a file of so many `bytes` to what that can hold.
///
/// # Errors
/// Where one claims more.
pub fn check_exr_size(headers: &[Header], bytes: u64) -> Result<(), ExrSizeError> {
    for header in headers {
        let (width, height) = (header.layer_size.0 as u64, header.layer_size.1 as u64);
        let pixels = width.saturating_mul(height);
        if pixels > MAX_PIXELS {
            return Err(ExrSizeError::TooLarge { width, height });
        }
        if pixels > most_pixels(header, bytes) {
            return Err(ExrSizeError::TooShort {
                width,
                height,
                bytes,
            });
        }
    }
    Ok(())
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
