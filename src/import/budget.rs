//! A bound on the memory that a file may ask for.
//!
//! A few bytes can ask for any amount of memory: an accessor of glTF without data, one mesh in a
//! thousand skins, a million instances, images of one colour. What is made from a file is charged
//! to a budget in proportion to the bytes that were read, before it is allocated.

use std::cell::Cell;

use super::Problem;

/// What the geometry of every file may use, however small it is.
const GEOMETRY_FLOOR_BYTES: u64 = 64 << 20;

/// What the pixels of every file may use: eight images of one colour, 4096 pixels square, which
/// are common and have next to no bytes.
const PIXELS_FLOOR_BYTES: u64 = 8 * 4096 * 4096 * 4;

/// What a file may use per byte of its own, beyond the floor. Single-byte components grow to
/// sixteen times their size as `f32`s with padding; the rest is for sharing.
const FACTOR: u64 = 64;

/// Zeros that an accessor without data may stand for, beyond the same factor.
const ZEROS_FLOOR_BYTES: u64 = 1 << 20;

/// Memory that may still be taken.
#[derive(Debug)]
pub struct Budget {
    file_bytes: Cell<u64>,
    left: Cell<u64>,
}

impl Budget {
    /// For all but the images of a document that has, with its buffers, `file_bytes` bytes.
    pub fn for_geometry(file_bytes: u64) -> Self {
        Self::new(GEOMETRY_FLOOR_BYTES, file_bytes)
    }

    /// For the pixels of images that have `file_bytes` bytes together.
    pub fn for_pixels(file_bytes: u64) -> Self {
        Self::new(PIXELS_FLOOR_BYTES, file_bytes)
    }

    fn new(floor: u64, file_bytes: u64) -> Self {
        Self {
            file_bytes: Cell::new(file_bytes),
            left: Cell::new(floor.saturating_add(FACTOR.saturating_mul(file_bytes))),
        }
    }

    /// Allows what a further file of `file_bytes` bytes may use.
    pub fn add_file(&self, file_bytes: u64) {
        let more = FACTOR.saturating_mul(file_bytes);
        self.left.set(self.left.get().saturating_add(more));
        let total = self.file_bytes.get().saturating_add(file_bytes);
        self.file_bytes.set(total);
    }

    /// Bytes that may still be taken.
    #[cfg(feature = "draco")]
    pub fn left(&self) -> u64 {
        self.left.get()
    }

    /// Takes `bytes`.
    ///
    /// # Errors
    /// Where there are not that many left.
    pub fn take(&self, bytes: u64) -> Result<(), Problem> {
        let left = self
            .left
            .get()
            .checked_sub(bytes)
            .ok_or_else(|| self.refuse())?;
        self.left.set(left);
        Ok(())
    }

    /// Whether `bytes` of zeros, which files may leave out, are in proportion to this one.
    ///
    /// # Errors
    /// Where they are not.
    pub fn check_zeros(&self, bytes: u64) -> Result<(), Problem> {
        let allowed =
            ZEROS_FLOOR_BYTES.saturating_add(FACTOR.saturating_mul(self.file_bytes.get()));
        if bytes > allowed {
            return Err(self.refuse());
        }
        Ok(())
    }

    fn refuse(&self) -> Problem {
        Problem::Invalid(format!(
            "asks for far more memory than its {} bytes account for",
            self.file_bytes.get()
        ))
    }
}
