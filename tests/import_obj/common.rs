//! Small files in a folder of their own.

use std::path::{Path, PathBuf};

use halfshade::import::{ImportOptions, Imported, Warning, WarningCode, import_model};
use halfshade::math::DVec3;
use halfshade::scene::Scene;

/// A folder that goes away with its value.
pub struct Folder(tempfile::TempDir);

impl Folder {
    /// With the files of the given names and contents.
    pub fn with(files: &[(&str, &[u8])]) -> Self {
        let folder = Self(tempfile::tempdir().unwrap());
        for (name, content) in files {
            folder.add(name, content);
        }
        folder
    }

    /// Adds a file, and the folders that its name says.
    pub fn add(&self, name: &str, content: &[u8]) {
        let path = self.path(name);
        std::fs::create_dir_all(path.parent().unwrap()).unwrap();
        std::fs::write(path, content).unwrap();
    }

    /// Where the file called `name` is.
    pub fn path(&self, name: &str) -> PathBuf {
        self.0.path().join(name)
    }

    /// Imports the file called `name`; the message where it cannot.
    pub fn import(&self, name: &str) -> Result<Imported, String> {
        import(&self.path(name))
    }
}

/// Imports the file at `path`; the message where it cannot.
pub fn import(path: &Path) -> Result<Imported, String> {
    import_model(path, ImportOptions::default()).map_err(|error| error.to_string())
}

/// Imports a file of the given content.
pub fn import_text(obj: &str) -> Imported {
    Folder::with(&[("a.obj", obj.as_bytes())])
        .import("a.obj")
        .unwrap()
}

/// The message, without the path, of a file of the given content.
pub fn message_of(obj: &[u8]) -> String {
    let folder = Folder::with(&[("a.obj", obj)]);
    let message = folder.import("a.obj").map(|_| ()).unwrap_err();
    let path = folder.path("a.obj").display().to_string();
    let rest = message
        .strip_prefix(&path)
        .expect("the message names the file");
    rest.trim_start_matches([',', ':', ' ']).to_owned()
}

/// The corners of all triangles in the world, instance by instance.
pub fn world_triangles(scene: &Scene) -> Vec<[DVec3; 3]> {
    let mut triangles = Vec::new();
    for instance in &scene.instances {
        let mesh = scene.mesh(instance.mesh);
        let world = |i: u32| {
            let p = mesh.positions()[i as usize].as_dvec3();
            instance.transform.transform_point3(p)
        };
        triangles.extend(mesh.indices().iter().map(|t| t.map(world)));
    }
    triangles
}

/// The warnings of kind `code`.
pub fn warnings(imported: &Imported, code: WarningCode) -> Vec<Warning> {
    imported
        .warnings
        .iter()
        .filter(|w| w.code == code)
        .collect()
}
