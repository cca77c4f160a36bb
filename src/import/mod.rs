//! Files to a [`Scene`]: glTF 2.0, OBJ with MTL, scene files, images.
//!
//! What a format means is decided here, once; nothing after this module knows what file a scene
//! came from. A file that cannot be shown is an [`ImportError`] with its path and place; what is
//! legal but not shown as its author meant it is a [`Warning`]. Nothing here prints.

mod budget;
mod census;
mod environment;
#[cfg(feature = "exr")]
mod exr_file;
mod files;
#[cfg(feature = "gltf")]
mod gltf;
mod images;
#[cfg(feature = "ktx2")]
mod ktx2;
#[cfg(feature = "obj")]
mod obj;
pub mod scene_file;
mod undecoded;
mod warning;

use std::fmt;
use std::io;
use std::path::{Path, PathBuf};

use thiserror::Error;

use crate::scene::{Keep, LeftOut, Needs, Scene, Settings};
#[cfg(feature = "exr")]
pub use exr_file::{SizeError, check_exr_size, check_size, read_exr_colors};
#[cfg(feature = "gltf")]
pub use gltf::{ExtensionSupport, Support, extension_table};
pub use scene_file::{Defaults, SceneOptions};
use undecoded::Undecoded;
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
    /// The camera and the lights that a scene without any was given by [`import`].
    pub defaults: Option<Defaults>,
    /// What the render does not need.
    pub left_out: Vec<LeftOut>,
}

/// A model as its file describes it, with images that are not decoded yet.
#[derive(Debug, Default)]
struct Model {
    scene: Scene,
    undecoded: Vec<Undecoded>,
    warnings: Warnings,
    left_out: Vec<LeftOut>,
}

/// A moment of an animation. Models without animations are always at rest.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Pose {
    /// Time since the start of the animation. Before its first key and after its last it stands
    /// still.
    pub seconds: f64,
    /// The name of the animation, or else its number in the file, counted from 0; `None` for the
    /// first.
    pub animation: Option<String>,
}

/// How to import.
#[derive(Clone, Copy, Debug, Default)]
pub struct ImportOptions<'a> {
    /// Whether a required extension that we lack is an error.
    pub is_strict: bool,
    /// Whether meshes are read that nothing uses in the scene that is shown.
    pub reads_unused_meshes: bool,
    /// The variant of its materials that is shown; `None` for the default one.
    pub variant: Option<&'a str>,
    /// The moment that is shown; `None` for the model at rest.
    pub pose: Option<&'a Pose>,
}

/// Why a file could not be imported: which file, where in it, what is wrong.
#[derive(Debug, Error)]
pub struct ImportError {
    /// The file.
    pub path: PathBuf,
    /// A place in it that a person can find, such as `mesh "tail", triangle 17` or `line 3`.
    pub place: Option<String>,
    /// What is wrong; part of the message, and so not its source.
    pub problem: Problem,
}

/// What is wrong with a file.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum Problem {
    /// The system could not read it.
    #[error(transparent)]
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
    /// Whether an override or the choice of a camera is wrong, and not a file: the place is then
    /// the option of the command line.
    pub fn is_argument(&self) -> bool {
        let place = self.place.as_deref().unwrap_or("");
        place.starts_with("--set ") || place.starts_with("--camera ")
    }

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

/// Imports a scene file (`.toml`), or a model by itself (`.gltf`, `.glb`, `.obj`), which is read as
/// a scene file that names nothing else. A scene without a camera or lights gets some; those of an
/// animated scene stand still, where they are for the scene at rest.
///
/// # Errors
/// Where a file that it cannot do without cannot be read, or is not what its format demands.
pub fn import(path: &Path, options: &SceneOptions) -> Result<Imported, ImportError> {
    let mut imported = import_posed(path, options)?;
    if options.pose.is_none() || imported.defaults.is_none() {
        return Ok(imported);
    }
    let mut rest = SceneOptions {
        pose: None,
        keep: Keep::NOTHING,
        layers: Needs::default(),
        ..options.clone()
    };
    // So that no image is decoded for it.
    let kind = ("integrator.kind".to_owned(), "\"depth\"".to_owned());
    rest.overrides.push(kind);
    let rest = import_posed(path, &rest)?;
    if let (Some(moved), Some(still)) = (&mut imported.defaults, rest.defaults)
        && (moved.cameras, moved.lights) == (still.cameras, still.lights)
    {
        if still.cameras > 0 {
            imported.scene.cameras = rest.scene.cameras;
        }
        if still.lights > 0 {
            imported.scene.lights = rest.scene.lights;
        }
        *moved = still;
    }
    Ok(imported)
}

fn import_posed(path: &Path, options: &SceneOptions) -> Result<Imported, ImportError> {
    match extension(path).as_str() {
        "toml" => scene_file::import_scene(path, options),
        _ if is_model(path) => scene_file::import_bare(path, options),
        _ => Err(ImportError::invalid(
            path,
            "neither a scene nor a model: the name does not end in .toml, .gltf, .glb or .obj",
        )),
    }
}

/// Imports a model (`.gltf`, `.glb`, `.obj`) as it is, without any additions.
///
/// # Errors
/// Where the file, or a file that it cannot do without, cannot be read or is not what its
/// format demands.
pub fn import_model(path: &Path, options: ImportOptions) -> Result<Imported, ImportError> {
    let mut model = read_model(path, options)?;
    undecoded::decode(&mut model.scene, &model.undecoded, &mut model.warnings);
    Ok(Imported {
        scene: model.scene,
        warnings: model.warnings,
        ..Imported::default()
    })
}

/// As [`import_model`], without the pixels of its images.
fn read_model(path: &Path, options: ImportOptions) -> Result<Model, ImportError> {
    match extension(path).as_str() {
        #[cfg(feature = "gltf")]
        "gltf" | "glb" => gltf::import(path, options),
        #[cfg(feature = "obj")]
        "obj" => obj::import(path),
        #[cfg(not(feature = "gltf"))]
        "gltf" | "glb" => Err(not_built(path, "glTF", "gltf")),
        #[cfg(not(feature = "obj"))]
        "obj" => Err(not_built(path, "OBJ", "obj")),
        _ => Err(ImportError::invalid(path, NOT_A_MODEL)),
    }
}

/// `path` is of a format that was left out of this build.
#[cfg(not(all(feature = "gltf", feature = "obj", feature = "exr")))]
fn not_built(path: &Path, format: &str, feature: &str) -> ImportError {
    let what = format!("{format} (feature \"{feature}\" of this build)");
    ImportError::unsupported(path, what)
}

/// What is wrong with a path that [`is_model`] does not take.
const NOT_A_MODEL: &str = "not a model: the name does not end in .gltf, .glb or .obj";

/// Whether the name is that of a file for [`import_model`].
fn is_model(path: &Path) -> bool {
    matches!(extension(path).as_str(), "gltf" | "glb" | "obj")
}

/// What follows the last dot of the name, in lower case.
fn extension(path: &Path) -> String {
    let extension = path.extension().and_then(|e| e.to_str());
    extension.unwrap_or("").to_ascii_lowercase()
}
