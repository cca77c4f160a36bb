//! KTX2 images (`KHR_texture_basisu`): ETC1S and UASTC, the latter also packed with Zstandard.
//!
//! The header is checked here, in full, before the transcoder sees the file: it allocates what a
//! header says. Of the levels of detail only the finest is decoded.

use basisu::{DecodeFlags, TargetFormat, Transcoder};

const IDENTIFIER: [u8; 12] = *b"\xabKTX 20\xbb\r\n\x1a\n";

/// Where the list of levels begins.
const LEVELS: usize = 80;

/// Whether `bytes` begin as a KTX2 file does.
pub fn is_ktx2(bytes: &[u8]) -> bool {
    bytes.starts_with(&IDENTIFIER)
}

/// Columns and rows, of a file that holds one flat image in a known format.
///
/// # Errors
/// What is wrong with the file, or not supported.
pub fn size(bytes: &[u8]) -> Result<(u32, u32), String> {
    let header = Header { bytes };
    let [format, width, height, depth] = [12, 20, 24, 28].map(|at| header.u32(at));
    let [layers, faces, scheme] = [32, 36, 44].map(|at| header.u32(at));
    let (width, height) = (width?, height?);
    if width == 0 || height == 0 {
        return Err("has no pixels".into());
    }
    if format? != 0 || depth? > 1 || layers? > 1 || faces? != 1 {
        return Err("only flat images of Basis Universal are supported of KTX2".into());
    }
    // Behind the size of the descriptor, vendor and version.
    let model = header.u32(48)?.checked_add(12).map(|at| at as usize);
    let model = model.and_then(|at| bytes.get(at)).ok_or(TOO_SHORT)?;
    let [offset, length, unpacked] = [0, 8, 16].map(|at| header.u64(LEVELS + at));
    let (offset, length, unpacked) = (offset?, length?, unpacked?);
    let end = offset.checked_add(length);
    if end.is_none_or(|end| end > bytes.len() as u64) {
        return Err(TOO_SHORT.into());
    }
    let blocks = u64::from(width.div_ceil(4)) * u64::from(height.div_ceil(4));
    match (model, scheme?) {
        (163, 1) => Ok((width, height)),
        (166, 0) if length == 16 * blocks => Ok((width, height)),
        (166, 2) if unpacked == 16 * blocks => Ok((width, height)),
        (166, 0 | 2) => Err("its level has not the length that its size asks for".into()),
        _ => Err("is KTX2, but neither ETC1S nor UASTC".into()),
    }
}

/// The pixels, row by row, of a file whose [`size`] is known to be in bounds.
///
/// # Errors
/// What is wrong with the file, or not supported.
pub fn decode(bytes: &[u8]) -> Result<Vec<u8>, String> {
    size(bytes)?;
    let problem = |error| format!("cannot be transcoded: {error:?}");
    let transcoder = Transcoder::new(bytes).map_err(problem)?;
    let pixels = transcoder.transcode(0, TargetFormat::Rgba32, DecodeFlags::NONE);
    pixels.map_err(problem)
}

const TOO_SHORT: &str = "is KTX2, but cut short";

struct Header<'a> {
    bytes: &'a [u8],
}

impl Header<'_> {
    fn u32(&self, at: usize) -> Result<u32, &'static str> {
        let bytes = self.bytes.get(at..).and_then(|rest| rest.first_chunk());
        bytes.copied().map(u32::from_le_bytes).ok_or(TOO_SHORT)
    }

    fn u64(&self, at: usize) -> Result<u64, &'static str> {
        let bytes = self.bytes.get(at..).and_then(|rest| rest.first_chunk());
        bytes.copied().map(u64::from_le_bytes).ok_or(TOO_SHORT)
    }
}
