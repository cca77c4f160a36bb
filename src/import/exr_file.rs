//! OpenEXR files: their colours, and whether their bytes can hold the pixels that a header claims, by which memory is
//! asked for.

use std::io::{Read, Seek};

use exr::compression::Compression;
use exr::meta::attribute::SampleType;
use exr::meta::header::Header;
use exr::prelude::{ReadChannels, ReadLayers, ReadSpecificChannel, Vec2, read};
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

/// Columns and rows of the first layer of `file` with the channels R, G and B, and their values row by row. The headers
/// have been checked ([`check_exr_size`]).
///
/// # Errors
/// Where there is none, or the decoder does not accept it.
pub fn read_exr_colors<C: Copy + From<[f32; 3]> + 'static>(
    file: impl Read + Seek,
) -> exr::error::Result<([u32; 2], Vec<C>)> {
    let image = read()
        .no_deep_data()
        .largest_resolution_level()
        .specific_channels()
        .required("R")
        .required("G")
        .required("B")
        .collect_pixels(
            |size, _| (size, vec![C::from([0.0; 3]); size.area()]),
            |(size, pixels), Vec2(x, y), (r, g, b): (f32, f32, f32)| {
                pixels[y * size.width() + x] = [r, g, b].into();
            },
        )
        .first_valid_layer()
        .all_attributes()
        .from_buffered(file)?;
    let (Vec2(width, height), pixels) = image.layer_data.channel_data.pixels;
    Ok(([width as u32, height as u32], pixels))
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
