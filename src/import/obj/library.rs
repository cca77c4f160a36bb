//! The materials of a scene, from the libraries that an OBJ file names.

use std::collections::HashMap;
use std::path::{Path, PathBuf};

use super::mtl::{self, MtlMaterial, NEUTRAL_REFLECTANCE, Textures};
use super::search::find;
use crate::import::{WarningCode, Warnings, files};
use crate::material::Material;

/// The materials of all libraries of one OBJ file.
pub struct Libraries {
    /// Of the OBJ file, and then of each library.
    folders: Vec<PathBuf>,
    /// With the number of the folder of each one's library.
    materials: Vec<(MtlMaterial, usize)>,
    by_name: HashMap<String, usize>,
}

impl Libraries {
    /// Reads the libraries called `names` in the folder of the OBJ file. One that is missing is
    /// a warning. Of materials of one name the first counts.
    pub fn read(names: &[String], folder: &Path, warnings: &mut Warnings) -> Self {
        let mut libraries = Self {
            folders: vec![folder.to_owned()],
            materials: Vec::new(),
            by_name: HashMap::new(),
        };
        for name in names {
            let Some(path) = find(name, &[folder]) else {
                let message = format!("material library {name:?} was not found");
                warnings.add(WarningCode::MissingFile, message);
                continue;
            };
            match files::read(&path) {
                Ok(bytes) => {
                    let materials = mtl::read(&bytes, name, warnings);
                    libraries.add(materials, &path, warnings);
                }
                Err(error) => {
                    let message = format!("material library {name:?}: {error}");
                    warnings.add(WarningCode::MissingFile, message);
                }
            }
        }
        libraries
    }

    fn add(&mut self, materials: Vec<MtlMaterial>, path: &Path, warnings: &mut Warnings) {
        let folder = self.folders.len();
        self.folders
            .push(path.parent().unwrap_or(Path::new("")).to_owned());
        for material in materials {
            let next = self.materials.len();
            if *self.by_name.entry(material.name.clone()).or_insert(next) == next {
                self.materials.push((material, folder));
            } else {
                let message = format!(
                    "material {:?} is defined again; the first counts",
                    material.name
                );
                warnings.add(WarningCode::BadValue, message);
            }
        }
    }

    /// The material called `name`; a neutral one, with a warning, where no library has it.
    pub fn material(
        &self,
        name: &str,
        textures: &mut Textures,
        warnings: &mut Warnings,
    ) -> Material {
        match self.by_name.get(name) {
            Some(&index) => {
                let (material, folder) = &self.materials[index];
                let folders: [&Path; 2] = [&self.folders[*folder], &self.folders[0]];
                mtl::material(material, &folders, textures, warnings)
            }
            None => {
                let message =
                    format!("material {name:?} is not defined; its faces are a neutral grey");
                warnings.add(WarningCode::MissingMaterial, message);
                Material::matte(name, NEUTRAL_REFLECTANCE)
            }
        }
    }
}
