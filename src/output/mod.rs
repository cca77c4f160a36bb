//! Pictures to files: PNG to look at, EXR to measure.
//!
//! What comes in is plain data, row by row from the top, in linear Rec. 709; nothing here knows
//! of films or scenes. A file appears whole under its name or not at all ([`write_whole`]).

mod cryptomatte;
pub mod denoise;
mod exposure;
pub mod exr;
#[cfg(feature = "exr")]
mod header;
pub mod png;
mod tone_map;
mod whole_file;

use std::io;
use std::path::{Path, PathBuf};

use thiserror::Error;

pub use cryptomatte::Cryptomatte;
pub use exposure::automatic_exposure;
pub use tone_map::tone_mapped;
pub use whole_file::{check_writable, discard_unfinished, write_whole};

/// Why a file could not be written.
#[derive(Debug, Error)]
#[error("{}: {problem}", path.display())]
pub struct OutputError {
    /// The file.
    pub path: PathBuf,
    /// What is wrong.
    #[source]
    pub problem: OutputProblem,
}

/// What is wrong with a file that was to be written.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum OutputProblem {
    /// The folder that it was to be put into is not there.
    #[error("the folder \"{}\" does not exist", .0.display())]
    MissingFolder(PathBuf),
    /// There is a folder of that name.
    #[error("is a folder")]
    IsFolder,
    /// There is a file of that name that says it must not be changed.
    #[error("exists and is write-protected")]
    WriteProtected,
    /// The system, or the encoder, could not write it.
    #[error("could not be written: {0}")]
    Io(#[from] io::Error),
}

impl OutputError {
    fn new(path: &Path, problem: impl Into<OutputProblem>) -> Self {
        Self {
            path: path.to_owned(),
            problem: problem.into(),
        }
    }
}

/// What a file name asks for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ImageFormat {
    /// Encoded for a screen, 8 or 16 bits a channel.
    Png,
    /// Linear radiance in single precision, with layers.
    Exr,
}

impl ImageFormat {
    /// The format that the extension of `path` names, in any case; `None` where there is none
    /// of that name.
    pub fn of_path(path: &Path) -> Option<Self> {
        let extension = path.extension()?.to_str()?.to_ascii_lowercase();
        match extension.as_str() {
            "png" => Some(Self::Png),
            "exr" => Some(Self::Exr),
            _ => None,
        }
    }

    /// The feature that this build lacks to write it; `None` where it can.
    pub fn needed_feature(self) -> Option<&'static str> {
        match self {
            Self::Png if !cfg!(feature = "png") => Some("png"),
            Self::Exr if !cfg!(feature = "exr") => Some("exr"),
            _ => None,
        }
    }
}

#[cfg(not(all(feature = "png", feature = "exr")))]
fn not_built(format: ImageFormat) -> io::Error {
    let feature = format.needed_feature().unwrap_or("");
    let what = format!("the feature \"{feature}\" is not part of this build");
    io::Error::new(io::ErrorKind::Unsupported, what)
}
