//! Files to a [`Scene`]: glTF 2.0, OBJ with MTL, scene files, images.
//!
//! What a format means is decided here, once; nothing after this module knows what file a scene
//! came from. A file that cannot be shown is an [`ImportError`] with its path and place; what is
//! legal but not shown as its author meant it is a [`Warning`]. Nothing here prints.

mod files;
mod gltf;
mod images;
mod obj;
mod warning;

use std::fmt;
use std::io;
use std::path::{Path, PathBuf};

use thiserror::Error;

use crate::scene::{Scene, Settings};
pub use warning::{Warning, WarningCode, Warnings};

/// A scene as its file describes it, and what its author should know.
#[derive(Clone, Debug, Default)]
pub struct Imported {
    /// The scene.
    pub scene: Scene,
    /// How it wants to be rendered: the defaults, where the file does not say.
    pub settings: Settings,
    /// What was ignored or repaired.
    pub warnings: Warnings,
}

/// How to import.
#[derive(Clone, Copy, Debug, Default)]
pub struct ImportOptions {
    /// Whether a required extension that we lack is an error.
    pub is_strict: bool,
}

/// Why a file could not be imported: which file, where in it, what is wrong.
#[derive(Debug, Error)]
pub struct ImportError {
    /// The file.
    pub path: PathBuf,
    /// A place in it that a person can find, such as `mesh "tail", triangle 17` or `line 3`.
    pub place: Option<String>,
    /// What is wrong.
    #[source]
    pub problem: Problem,
}

/// What is wrong with a file.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum Problem {
    /// The system could not read it.
    #[error("{0}")]
    Io(#[from] io::Error),
    /// It does not say what its format demands.
    #[error("{0}")]
    Invalid(String),
    /// It is right, and Halfshade cannot show it.
    #[error("{0} is not supported")]
    Unsupported(String),
}

impl fmt::Display for ImportError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}", self.path.display())?;
        if let Some(place) = &self.place {
            write!(f, ", {place}")?;
        }
        write!(f, ": {}", self.problem)
    }
}

impl ImportError {
    /// `what` is wrong with `path` as a whole.
    pub fn invalid(path: &Path, what: impl Into<String>) -> Self {
        Self {
            path: path.to_owned(),
            place: None,
            problem: Problem::Invalid(what.into()),
        }
    }

    /// `what` is wrong at `place` in `path`.
    pub fn invalid_at(path: &Path, place: impl Into<String>, what: impl Into<String>) -> Self {
        Self {
            path: path.to_owned(),
            place: Some(place.into()),
            problem: Problem::Invalid(what.into()),
        }
    }

    /// The system could not read `path`.
    pub fn io(path: &Path, error: io::Error) -> Self {
        Self {
            path: path.to_owned(),
            place: None,
            problem: Problem::Io(error),
        }
    }

    /// `path` needs `what`, which Halfshade lacks.
    pub fn unsupported(path: &Path, what: impl Into<String>) -> Self {
        Self {
            path: path.to_owned(),
            place: None,
            problem: Problem::Unsupported(what.into()),
        }
    }
}

/// Imports a model (`.gltf`, `.glb`, `.obj`) by itself.
///
/// # Errors
/// Where the file, or a file that it cannot do without, cannot be read or is not what its
/// format demands.
pub fn import_model(path: &Path, options: ImportOptions) -> Result<Imported, ImportError> {
    let extension = path.extension().and_then(|e| e.to_str()).unwrap_or("");
    match extension.to_ascii_lowercase().as_str() {
        "gltf" | "glb" => gltf::import(path, options),
        "obj" => obj::import(path),
        _ => Err(ImportError::invalid(
            path,
            "not a model: the name does not end in .gltf, .glb or .obj",
        )),
    }
}
