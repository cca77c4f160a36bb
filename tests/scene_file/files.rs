//! Small files in a directory of their own.

use std::fs;
use std::path::PathBuf;

use halfshade::import::{Imported, SceneOptions, import};
use tempfile::TempDir;

/// One triangle, from the origin to 1 along x and y.
pub const TRIANGLE_OBJ: &str = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";

/// Two cameras and a point light, and nothing to see.
pub const STUDIO_GLTF: &str = r#"{
  "asset": { "version": "2.0" },
  "extensionsUsed": ["KHR_lights_punctual"],
  "extensions": { "KHR_lights_punctual": { "lights": [
    { "type": "point", "color": [1.0, 0.5, 0.25], "intensity": 8.0 }
  ] } },
  "cameras": [
    { "type": "perspective", "perspective": { "yfov": 0.5, "znear": 0.1 } },
    { "type": "orthographic", "orthographic": { "xmag": 2.0, "ymag": 2.0, "znear": 0.1, "zfar": 9.0 } }
  ],
  "nodes": [
    { "name": "front", "camera": 0, "translation": [0.0, 0.0, 4.0] },
    { "name": "flat", "camera": 1, "translation": [0.0, 1.0, 4.0] },
    { "name": "lamp", "translation": [1.0, 2.0, 3.0],
      "extensions": { "KHR_lights_punctual": { "light": 0 } } }
  ],
  "scenes": [{ "nodes": [0, 1, 2] }],
  "scene": 0
}"#;

/// A directory that is removed with it.
pub struct Files {
    directory: TempDir,
}

impl Files {
    /// With `triangle.obj` and `studio.gltf`.
    pub fn new() -> Self {
        let files = Self {
            directory: TempDir::new().unwrap(),
        };
        files.write("triangle.obj", TRIANGLE_OBJ);
        files.write("studio.gltf", STUDIO_GLTF);
        files
    }

    pub fn write(&self, name: &str, content: impl AsRef<[u8]>) -> PathBuf {
        let path = self.directory.path().join(name);
        fs::write(&path, content).unwrap();
        path
    }

    /// Imports `name`; the error is as a person reads it, without the directory.
    pub fn import(&self, name: &str, options: &SceneOptions) -> Result<Imported, String> {
        let path = self.directory.path().join(name);
        import(&path, options).map_err(|error| {
            let directory = format!(
                "{}{}",
                self.directory.path().display(),
                std::path::MAIN_SEPARATOR
            );
            error.to_string().replace(&directory, "")
        })
    }

    /// Imports a scene file that says `text`.
    pub fn scene(&self, text: &str, options: &SceneOptions) -> Result<Imported, String> {
        self.write("scene.toml", text);
        self.import("scene.toml", options)
    }
}

/// Imports a scene file that says `text`.
pub fn scene(text: &str) -> Result<Imported, String> {
    Files::new().scene(text, &SceneOptions::default())
}

/// Imports a scene file that says `text`, with overrides.
pub fn scene_with(text: &str, overrides: &[(&str, &str)]) -> Result<Imported, String> {
    Files::new().scene(text, &with(overrides))
}

/// Options that override.
pub fn with(overrides: &[(&str, &str)]) -> SceneOptions {
    SceneOptions {
        overrides: overrides
            .iter()
            .map(|(path, value)| (path.to_string(), value.to_string()))
            .collect(),
        ..SceneOptions::default()
    }
}

/// Options that name a camera.
pub fn looking_through(camera: &str) -> SceneOptions {
    SceneOptions {
        camera: Some(camera.to_owned()),
        ..SceneOptions::default()
    }
}
