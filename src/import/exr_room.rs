//! How many pixels the bytes of an OpenEXR file can hold: memory is asked for by what its header says.

use exr::compression::Compression;
use exr::meta::attribute::SampleType;
use exr::meta::header::Header;
use exr::prelude::Vec2;

/// The longest runs of deflate: bytes to one.
const DEFLATE: u64 = 1032;

/// The most pixels that a part with this `header` can have in a file of so many `bytes`.
pub fn most_pixels(header: &Header, bytes: u64) -> u64 {
    match header.compression {
        // One coefficient stands for the 8 × 8 pixels of a block.
        Compression::DWAA(_) | Compression::DWAB(_) => bytes.saturating_mul(64 * DEFLATE),
        // The shortest of all others is PXR24, which hands 24 of 32 bits to deflate.
        _ => (bytes.saturating_mul(DEFLATE) / 3 * 4) / sample_bytes(header).max(1),
    }
}

/// Bytes of the samples that every pixel has.
fn sample_bytes(header: &Header) -> u64 {
    let channels = header.channels.list.iter();
    let of_all = channels.filter(|channel| channel.sampling == Vec2(1, 1));
    of_all
        .map(|channel| match channel.sample_type {
            SampleType::F16 => 2,
            SampleType::F32 | SampleType::U32 => 4,
        })
        .sum()
}
