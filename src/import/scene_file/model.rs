//! `[[model]]`: files placed in the world.

use std::collections::BTreeMap;
use std::collections::btree_map::Entry;
use std::path::{Path, PathBuf};

use super::document::{Node, Place, Source};
use super::material;
use super::merge;
use super::placement::Placement;
use super::section::Section;
use super::value::Value;
use crate::camera::Camera;
use crate::import::undecoded::Undecoded;
use crate::import::{
    ImportError, ImportOptions, Model, NOT_A_MODEL, WarningCode, Warnings, is_model, read_model,
};
use crate::light::Light;
use crate::material::Material;
use crate::scene::{Instance, LeftOut, Placed, Scene};

const KEYS: &[&str] = &[
    "file",
    "translate",
    "rotate",
    "scale",
    "matrix",
    "material",
    "lights",
];

/// What a file holds besides the arrays that its instances share.
struct Loaded {
    instances: Vec<Instance>,
    lights: Vec<Placed<Light>>,
    cameras: Vec<Placed<Camera>>,
}

/// Puts models into a scene, each file imported once.
pub struct Models<'a> {
    source: &'a Source,
    options: ImportOptions<'a>,
    /// The materials of the scene file, which are the first of the scene.
    own_materials: Vec<Material>,
    loaded: BTreeMap<PathBuf, Loaded>,
    /// Images of all models that are not decoded yet, in the order of the scene's.
    pub undecoded: Vec<Undecoded>,
    /// What the importers left out.
    pub left_out: Vec<LeftOut>,
}

impl<'a> Models<'a> {
    /// No models yet; `own_materials` are those that the scene file names.
    pub fn new(
        source: &'a Source,
        options: ImportOptions<'a>,
        own_materials: Vec<Material>,
    ) -> Self {
        Self {
            source,
            options,
            own_materials,
            loaded: BTreeMap::new(),
            undecoded: Vec::new(),
            left_out: Vec::new(),
        }
    }

    /// Adds the `[[model]]` of `node` to `scene`.
    pub fn add(
        &mut self,
        node: &Node,
        scene: &mut Scene,
        warnings: &mut Warnings,
    ) -> Result<(), ImportError> {
        let section = Section::new(self.source, node, "[[model]]", KEYS)?;
        let placement = Placement::read(&section)?;
        let material = section.get("material", |v| material::named(v, &self.own_materials))?;
        let has_lights = section.get("lights", |v| v.boolean())?.unwrap_or(true);
        let file = section.require("file", Ok)?;
        let loaded = self.load(file, scene, warnings)?;
        for instance in &loaded.instances {
            scene.instances.push(Instance {
                material: material.unwrap_or(instance.material),
                transform: placement.transform * instance.transform,
                ..instance.clone()
            });
        }
        let cameras = loaded.cameras.iter();
        scene.cameras.extend(cameras.map(|c| placement.camera(c)));
        if has_lights {
            let lights = loaded.lights.iter();
            scene.lights.extend(lights.map(|l| placement.light(l)));
            let lights = loaded.lights.iter();
            let distorted = lights.filter(|l| placement.distorts(&l.item)).count();
            let message = "a light of a model that is scaled unevenly keeps its shape";
            warnings.add_many(WarningCode::Approximated, message, distorted as u64);
        }
        Ok(())
    }

    fn load(
        &mut self,
        file: Value,
        scene: &mut Scene,
        warnings: &mut Warnings,
    ) -> Result<&Loaded, ImportError> {
        let name = file.string()?;
        let directory = self.source.path.parent().unwrap_or(Path::new(""));
        let path = directory.join(name);
        // A bare model names itself: then its importer says what is wrong with it.
        let is_named_here = file.node.place != Place::Implied;
        if is_named_here && !path.is_file() {
            let message = format!("there is no file \"{name}\" ({})", path.display());
            return Err(file.invalid(message));
        }
        if is_named_here && !is_model(&path) {
            return Err(file.invalid(format!("\"{name}\" is {NOT_A_MODEL}")));
        }
        let key = path.canonicalize().unwrap_or_else(|_| path.clone());
        let number = self.loaded.len();
        match self.loaded.entry(key) {
            Entry::Occupied(entry) => Ok(entry.into_mut()),
            Entry::Vacant(entry) => {
                let mut model = read_model(&path, self.options)?;
                for warning in model.warnings.iter() {
                    let message = match is_named_here {
                        true => format!("{name}: {}", warning.message),
                        false => warning.message,
                    };
                    warnings.add_many(warning.code, message, warning.count);
                }
                for image in &mut model.undecoded {
                    image.model = number;
                }
                let loaded = Loaded::split(&mut model, scene);
                self.undecoded.append(&mut model.undecoded);
                self.left_out.append(&mut model.left_out);
                Ok(entry.insert(loaded))
            }
        }
    }
}

impl Loaded {
    /// Moves the shared arrays of `read` to `scene`, and keeps what is placed.
    fn split(read: &mut Model, scene: &mut Scene) -> Self {
        let mut model = std::mem::take(&mut read.scene);
        Self {
            lights: std::mem::take(&mut model.lights),
            cameras: std::mem::take(&mut model.cameras),
            instances: merge::append(scene, model, &mut read.undecoded),
        }
    }
}
