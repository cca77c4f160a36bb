//! Reading the files that a scene is made of.

use std::fs::{self, File};
use std::io::{self, Read, Seek, SeekFrom};
use std::path::Path;
use std::time::SystemTime;

use rayon::prelude::*;

/// Bytes that one thread reads at a time.
const PIECE: usize = 8 << 20;

/// The bytes of a regular file.
///
/// # Errors
/// What the system says, and a word of our own for directories, pipes and devices: those have no
/// end, or none that can be told beforehand.
pub fn read(path: &Path) -> io::Result<Vec<u8>> {
    let metadata = fs::metadata(path)?;
    if metadata.is_dir() {
        return Err(io::Error::new(
            io::ErrorKind::IsADirectory,
            "is a directory, not a file",
        ));
    }
    if !metadata.is_file() {
        return Err(io::Error::new(
            io::ErrorKind::InvalidInput,
            "is not a regular file",
        ));
    }
    match usize::try_from(metadata.len()) {
        Ok(length) if length > PIECE => read_in_pieces(path, length, metadata.modified().ok()),
        _ => fs::read(path),
    }
}

/// A file of `length` bytes that was last written at `modified`, which several threads copy at the same time.
fn read_in_pieces(path: &Path, length: usize, modified: Option<SystemTime>) -> io::Result<Vec<u8>> {
    // Fails in place of ending the program where there is not so much; `vec!` would not.
    let mut bytes = bytemuck::try_zeroed_vec(length).map_err(|()| io::ErrorKind::OutOfMemory)?;
    let pieces = bytes.par_chunks_mut(PIECE).enumerate();
    pieces.try_for_each(|(i, piece)| {
        let mut file = File::open(path)?;
        let metadata = file.metadata()?;
        if metadata.len() != length as u64 || metadata.modified().ok() != modified {
            return Err(io::Error::other("was written to while it was read"));
        }
        file.seek(SeekFrom::Start((i * PIECE) as u64))?;
        file.read_exact(piece)
    })?;
    Ok(bytes)
}
