//! Compressed buffer views (`KHR_meshopt_compression`, `EXT_meshopt_compression`).
//!
//! Written from appendices A and B of the KHR extension's text. What the EXT extension allows is a
//! part of that, and one decoder reads both.

mod attributes;
mod filters;
mod indices;
mod reader;
mod triangles;

use serde::Deserialize;

/// What is wrong with a stream.
pub type Fault = &'static str;

/// The extension's object in a buffer view.
#[derive(Debug, Deserialize)]
#[serde(rename_all = "camelCase")]
pub struct CompressedView {
    /// Which buffer the stream lies in.
    pub buffer: usize,
    /// Where it begins.
    #[serde(default)]
    pub byte_offset: u64,
    /// Its bytes.
    pub byte_length: u64,
    byte_stride: usize,
    count: usize,
    mode: Mode,
    #[serde(default)]
    filter: Filter,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "UPPERCASE")]
enum Mode {
    Attributes,
    Triangles,
    Indices,
}

#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "UPPERCASE")]
enum Filter {
    #[default]
    None,
    Octahedral,
    Quaternion,
    Exponential,
    Color,
}

impl CompressedView {
    /// Bytes that come out; `None` where the object does not fit together, or not into a view of
    /// `view_length` bytes.
    pub fn decoded_length(&self, view_length: u64) -> Option<usize> {
        let stride = self.byte_stride;
        let fits_mode = match self.mode {
            Mode::Attributes => stride.is_multiple_of(4) && (4..=256).contains(&stride),
            Mode::Triangles => matches!(stride, 2 | 4) && self.count.is_multiple_of(3),
            Mode::Indices => matches!(stride, 2 | 4),
        };
        let fits_filter = match self.filter {
            Filter::None => true,
            _ if self.mode != Mode::Attributes => false,
            Filter::Octahedral | Filter::Color => matches!(stride, 4 | 8),
            Filter::Quaternion => stride == 8,
            Filter::Exponential => stride.is_multiple_of(4),
        };
        let length = self.count.checked_mul(stride);
        length.filter(|&length| fits_mode && fits_filter && length as u64 == view_length)
    }

    /// What `stream` holds, as many bytes as [`Self::decoded_length`] says.
    ///
    /// # Errors
    /// Where the stream is not one, or not of this many elements.
    pub fn decode(&self, stream: &[u8]) -> Result<Vec<u8>, Fault> {
        let (count, stride) = (self.count, self.byte_stride);
        let mut bytes = match self.mode {
            Mode::Attributes => attributes::decode(stream, count, stride)?,
            Mode::Triangles => in_width(&triangles::decode(stream, count)?, stride),
            Mode::Indices => in_width(&indices::decode(stream, count)?, stride),
        };
        match self.filter {
            Filter::None => {}
            Filter::Octahedral => filters::octahedral(&mut bytes, stride),
            Filter::Quaternion => filters::quaternion(&mut bytes),
            Filter::Exponential => filters::exponential(&mut bytes),
            Filter::Color => filters::color(&mut bytes, stride),
        }
        Ok(bytes)
    }
}

/// Indices in `stride` bytes each, 2 or 4; what does not fit wraps round.
fn in_width(indices: &[u32], stride: usize) -> Vec<u8> {
    let low_bytes = |index: &u32| index.to_le_bytes().into_iter().take(stride);
    indices.iter().flat_map(low_bytes).collect()
}

#[cfg(test)]
mod tests;
