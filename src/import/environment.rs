//! Pictures of the surroundings: OpenEXR, Radiance HDR, and all that textures may be.

#[cfg(feature = "exr")]
use std::io::Cursor;
use std::path::Path;

#[cfg(feature = "exr")]
use exr::prelude::{MetaData, Vec2};

#[cfg(feature = "exr")]
use super::exr_file::{check_exr_size, read_exr_colors};
use super::{ImportError, files, images};
use crate::color::{Rgb, srgb8_to_linear};
use crate::light::Environment;
use crate::texture::Pixels;

/// The first bytes of an OpenEXR file.
const EXR: &[u8] = &[0x76, 0x2f, 0x31, 0x01];

/// A picture of the surroundings in a file of its own.
pub struct EnvironmentFile<'a> {
    path: &'a Path,
    bytes: Vec<u8>,
}

impl<'a> EnvironmentFile<'a> {
    /// The bytes of the file at `path`.
    ///
    /// # Errors
    /// Where it cannot be read.
    pub fn read(path: &'a Path) -> Result<Self, ImportError> {
        let bytes = files::read(path).map_err(|error| ImportError::io(path, error))?;
        Ok(Self { path, bytes })
    }

    /// Columns and rows of an OpenEXR file.
    #[cfg(feature = "exr")]
    fn exr_size(&self) -> Result<Option<[usize; 2]>, ImportError> {
        if !self.bytes.starts_with(EXR) {
            return Ok(None);
        }
        let metadata = MetaData::read_from_buffered(Cursor::new(&self.bytes), false)
            .map_err(|error| self.damaged(&error.to_string()))?;
        let bytes = self.bytes.len() as u64;
        check_exr_size(&metadata.headers, bytes).map_err(|e| self.damaged(&e.to_string()))?;
        let sizes = metadata.headers.iter().map(|header| header.layer_size);
        let size = sizes.max_by_key(|size| size.area()).unwrap_or(Vec2(0, 0));
        Ok(Some([size.0, size.1]))
    }

    /// Bytes of memory that the environment will take, from the file's header alone; 0 where that
    /// does not tell.
    pub fn decoded_bytes(&self) -> u64 {
        let pixel = size_of::<[f32; 3]>() as u64;
        match self.exr_size() {
            Ok(Some([width, height])) => (width * height) as u64 * pixel,
            // Four channels, of a byte or of four.
            _ => images::decoded_bytes(&self.bytes, "").unwrap_or(0),
        }
    }

    /// The environment, times `factor`, turned about y; `None` where that is black.
    ///
    /// # Errors
    /// Where the file is none that is known, or damaged.
    pub fn decode(
        &self,
        factor: Rgb,
        rotate_radians: f64,
    ) -> Result<Option<Environment>, ImportError> {
        let name = self.path.file_name().unwrap_or_default();
        let name = name.to_string_lossy().into_owned();
        let (size, pixels) = match self.exr_size()? {
            Some(_) => self.exr_pixels()?,
            None => self.image_pixels(&name)?,
        };
        Ok(Environment::new(name, size, pixels, factor, rotate_radians))
    }

    #[cfg(feature = "exr")]
    fn exr_pixels(&self) -> Result<([u32; 2], Vec<[f32; 3]>), ImportError> {
        read_exr_colors(Cursor::new(&self.bytes)).map_err(|error| self.damaged(&error.to_string()))
    }

    /// Of a build that cannot read such files.
    #[cfg(not(feature = "exr"))]
    fn exr_size(&self) -> Result<Option<[usize; 2]>, ImportError> {
        match self.bytes.starts_with(EXR) {
            true => Err(super::not_built(self.path, "OpenEXR", "exr")),
            false => Ok(None),
        }
    }

    /// Of a build that cannot read such files.
    #[cfg(not(feature = "exr"))]
    fn exr_pixels(&self) -> Result<([u32; 2], Vec<[f32; 3]>), ImportError> {
        Err(super::not_built(self.path, "OpenEXR", "exr"))
    }

    fn image_pixels(&self, name: &str) -> Result<([u32; 2], Vec<[f32; 3]>), ImportError> {
        let image = images::decode(&self.bytes, name).map_err(|what| {
            // The sentence begins with the name, which the error has already.
            let what = what.strip_prefix(name).unwrap_or(&what);
            self.damaged(what.trim_start_matches([':', ' ']))
        })?;
        let pixels = match image.pixels {
            Pixels::Rgba32F(pixels) => pixels.iter().map(|&[r, g, b, _]| [r, g, b]).collect(),
            Pixels::Rgba8(pixels) => pixels
                .iter()
                .map(|&[r, g, b, _]| [r, g, b].map(srgb8_to_linear))
                .collect(),
        };
        Ok(([image.width, image.height], pixels))
    }

    fn damaged(&self, what: &str) -> ImportError {
        ImportError::invalid(
            self.path,
            format!("could not be read as a picture of the surroundings: {what}"),
        )
    }
}
