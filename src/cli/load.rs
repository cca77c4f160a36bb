//! A scene from its file, which most commands begin with.

use std::path::Path;

use halfshade::camera::Camera;
use halfshade::import::{Imported, SceneOptions, import};
use halfshade::math::UVec2;
use halfshade::scene::{Placed, Scene};

use super::Failure;
use super::console::Console;

/// The scene at `path`, for the subcommand of this name; `console` hears the warnings.
pub fn load_scene(
    subcommand: &str,
    path: &Path,
    options: &SceneOptions,
    console: Console,
) -> Result<Imported, Failure> {
    let imported = import(path, options).map_err(|error| Failure::of_import(subcommand, &error))?;
    console.warn_all(&imported.warnings);
    Ok(imported)
}

/// Asks for a picture of this size. Not later, with other settings: a default camera frames the scene in it.
pub fn ask_for_size(options: &mut SceneOptions, UVec2 { x, y }: UVec2) {
    let size = ("film.size".to_owned(), format!("[{x}, {y}]"));
    options.overrides.push(size);
}

/// The camera of the scene from `path` that is looked through.
pub fn camera<'a>(scene: &'a Scene, path: &Path) -> Result<&'a Placed<Camera>, Failure> {
    scene.cameras.first().ok_or_else(|| {
        let name = path.display();
        Failure::job(format_args!("{name}: there is no camera to look through"))
    })
}
