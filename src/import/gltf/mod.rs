//! glTF 2.0: `.gltf` with its buffers and images beside it or inside, and `.glb`.
//!
//! The document is read as it is ([`document`]) and then resolved, one noun after the other,
//! into a [`Scene`]. Nothing in it is trusted: indices and ranges are checked where they are used,
//! the node graph is walked without recursion, and all that is made of the document (vertices,
//! instances, materials, lights, pixels) is charged to a [`Budget`] in proportion to the size of the
//! file. The document itself is not: it takes less than a hundred times the bytes of its JSON.
//!
//! Not shown: points and lines, and the extensions of which [`extensions`] says what is missing
//! without them. Animations are counted, and shown at one time where that is asked for.

mod accessor;
mod animation;
mod buffers;
mod camera;
mod component;
mod container;
mod document;
mod document_material;
#[cfg(feature = "draco")]
mod draco;
mod extensions;
mod geometry;
mod graph;
mod instancing;
mod light;
mod material;
mod material_layers;
mod meshes;
mod meshopt;
mod morph;
mod skin;
mod support;
mod tangents;
mod texture;
mod topology;
mod uri;
mod variants;

use std::path::Path;

use accessor::AccessorReader;
use buffers::Buffers;
use container::Container;
use document::Document;
use graph::Graph;
use light::Lights;
use meshes::{Meshes, Part};
use texture::Textures;

pub use support::{ExtensionSupport, Support, extension_table};

use super::budget::Budget;
use super::{ImportError, ImportOptions, Model, Problem, WarningCode, Warnings, files};
use crate::material::{Material, MaterialId, MetallicRoughness};
use crate::math::DAffine3;
use crate::scene::{Instance, LeftOut, Omission, Placed, Scene};

/// Imports a `.gltf` or `.glb` file.
///
/// The scene's materials are the file's, in its order; where a primitive has none, the default
/// material of the specification follows them.
///
/// # Errors
/// Where the file or one of its buffers cannot be read, or what would be shown is broken.
pub fn import(path: &Path, options: ImportOptions) -> Result<Model, ImportError> {
    let file = files::read(path).map_err(|error| ImportError::io(path, error))?;
    let mut model = Model::default();
    read(path, &file, options, &mut model)?;
    Ok(model)
}

fn read(
    path: &Path,
    file: &[u8],
    options: ImportOptions,
    model: &mut Model,
) -> Result<(), ImportError> {
    let warnings = &mut model.warnings;
    let Container { json, binary } = container::split(file).map_err(in_file(path))?;
    let mut document: Document = serde_json::from_slice(json)
        .map_err(|error| ImportError::invalid(path, format!("not a glTF document: {error}")))?;
    check_version(&document).map_err(in_file(path))?;
    extensions::check(&document, path, options, warnings)?;
    #[cfg_attr(not(feature = "draco"), expect(unused_mut))]
    let mut buffers = Buffers::read(path, &document, binary)?;
    // The binary part of a .glb counts twice, which does no harm to a bound.
    let budget = Budget::for_geometry(file.len() as u64 + buffers.len());
    if let Some(pose) = options.pose {
        let accessors = AccessorReader {
            document: &document,
            buffers: &buffers,
            budget: &budget,
        };
        let posed = animation::posed(json, &accessors, pose, warnings);
        document = posed.map_err(in_file(path))?.unwrap_or(document);
    }
    if let Some(variant) = options.variant {
        variants::choose(&mut document, path, variant, warnings)?;
    }
    let graph = Graph::of(&document, warnings)
        .map_err(|(place, what)| ImportError::invalid_at(path, place, what))?;
    #[cfg(feature = "draco")]
    {
        let meshes = match options.reads_unused_meshes {
            true => (0..document.meshes.len()).collect(),
            false => graph.meshes(&document),
        };
        let done = draco::decompress(&mut document, &mut buffers, &budget, meshes);
        done.map_err(|misplaced| ImportError {
            path: path.to_owned(),
            place: Some(misplaced.place),
            problem: misplaced.problem,
        })?;
    }
    let accessors = AccessorReader {
        document: &document,
        buffers: &buffers,
        budget: &budget,
    };
    let textures = Textures::read(path, &document, &buffers, warnings);
    let materials = materials(&accessors, &textures, warnings).map_err(in_file(path))?;
    model.undecoded = textures.undecoded;
    model.scene = Scene {
        materials,
        textures: textures.textures,
        images: textures.images,
        animations: document.animations.len(),
        ..Scene::default()
    };
    let mut builder = SceneBuilder {
        path,
        accessors: &accessors,
        graph: &graph,
        meshes: Meshes::new(&accessors, &graph),
        scene: &mut model.scene,
        warnings,
    };
    builder.add_shown_nodes()?;
    let left_out = builder.leave_out_unused_meshes(options);
    let meshes = builder.meshes.meshes;
    model.scene.meshes = meshes;
    tangents::add_missing(&mut model.scene);
    model.left_out.extend(left_out);
    Ok(())
}

fn in_file(path: &Path) -> impl Fn(Problem) -> ImportError {
    move |problem| ImportError {
        path: path.to_owned(),
        place: None,
        problem,
    }
}

fn check_version(document: &Document) -> Result<(), Problem> {
    let asset = &document.asset;
    if asset.version.is_empty() {
        let what = "not a glTF document: it has no asset.version";
        return Err(Problem::Invalid(what.into()));
    }
    // Later minor versions can be read, unless the file says that they cannot.
    let is_major_2 = asset.version.split('.').next() == Some("2");
    let needed = asset.min_version.as_deref().unwrap_or("2.0");
    if !is_major_2 || needed != "2.0" {
        let version = asset.min_version.as_ref().unwrap_or(&asset.version);
        return Err(Problem::Unsupported(format!("glTF version {version}")));
    }
    Ok(())
}

fn materials(
    accessors: &AccessorReader,
    textures: &Textures,
    warnings: &mut Warnings,
) -> Result<Vec<Material>, Problem> {
    let entries = &accessors.document.materials;
    let each = size_of::<Material>() + size_of::<MetallicRoughness>();
    accessors.budget.take((entries.len() * each) as u64)?;
    let material = |(index, entry)| material::material(index, entry, textures, warnings);
    Ok(entries.iter().enumerate().map(material).collect())
}

/// Fills a scene with what its nodes hold.
struct SceneBuilder<'a, 'b> {
    path: &'a Path,
    accessors: &'a AccessorReader<'b>,
    graph: &'a Graph,
    meshes: Meshes<'a, 'b>,
    scene: &'a mut Scene,
    warnings: &'a mut Warnings,
}

impl SceneBuilder<'_, '_> {
    fn add_shown_nodes(&mut self) -> Result<(), ImportError> {
        let document = self.accessors.document;
        let lights = Lights::read(document, self.warnings);
        let graph = self.graph;
        for &node in &graph.shown {
            let Some(world) = graph.world(node) else {
                continue;
            };
            if !graph.is_hidden(node)
                && let Some(light) = lights.of_node(document, node, world, self.warnings)
            {
                self.charge_for(node, &light)?;
                self.scene.lights.push(light);
            }
            if let Some(camera) = camera::of_node(document, node, world, self.warnings) {
                self.charge_for(node, &camera)?;
                self.scene.cameras.push(camera);
            }
            if !graph.is_hidden(node) {
                self.add_mesh(node, world)?;
            }
        }
        Ok(())
    }

    /// Meshes that no shown node uses are not read, unless `options` say so.
    fn leave_out_unused_meshes(&mut self, options: ImportOptions) -> Option<LeftOut> {
        let unused = self.meshes.unused();
        if options.reads_unused_meshes {
            for index in unused {
                self.meshes.read_unused(index, self.warnings);
            }
            return None;
        }
        let bytes = unused.iter().map(|&index| self.meshes.bytes_of(index));
        let bytes = bytes.sum();
        (!unused.is_empty()).then(|| {
            let what = format!(
                "{} of {} meshes",
                unused.len(),
                self.accessors.document.meshes.len()
            );
            let why = "no node of the shown scene uses them";
            LeftOut::new(Omission::Meshes, what, why, bytes)
        })
    }

    /// Many nodes may share one light or camera of a long name.
    fn charge_for<T>(&self, node: usize, placed: &Placed<T>) -> Result<(), ImportError> {
        let bytes = size_of::<Placed<T>>() + placed.name.len();
        let taken = self.accessors.budget.take(bytes as u64);
        taken.map_err(|problem| self.error(self.accessors.document.node_place(node), problem))
    }

    fn add_mesh(&mut self, node: usize, world: &DAffine3) -> Result<(), ImportError> {
        let parts = self.meshes.of_node(node, self.warnings);
        let parts = parts.map_err(|misplaced| self.error(misplaced.place, misplaced.problem))?;
        if parts.is_empty() {
            return Ok(());
        }
        let entry = &self.accessors.document.nodes[node];
        let place = || self.accessors.document.node_place(node);
        let transforms = instancing::transforms(self.accessors, entry);
        match transforms.map_err(|problem| self.error(place(), problem))? {
            Some(_) if parts.iter().any(|part| part.anchor.is_some()) => {
                let message = format!("{}: instances of a skinned mesh are shown as one", place());
                self.warnings.add(WarningCode::Approximated, message);
                self.add_instances(node, &parts, world)
            }
            Some(transforms) => {
                for transform in transforms {
                    self.add_instances(node, &parts, &(*world * transform))?;
                }
                Ok(())
            }
            None => self.add_instances(node, &parts, world),
        }
    }

    fn add_instances(
        &mut self,
        node: usize,
        parts: &[Part],
        world: &DAffine3,
    ) -> Result<(), ImportError> {
        let document = self.accessors.document;
        let name = document.nodes[node].name.as_deref().unwrap_or("");
        let bytes = parts.len() * (size_of::<Instance>() + name.len());
        let taken = self.accessors.budget.take(bytes as u64);
        taken.map_err(|problem| self.error(document.node_place(node), problem))?;
        for part in parts {
            let material = self.material(part.material);
            self.scene.instances.push(Instance {
                name: name.into(),
                mesh: part.mesh,
                material,
                transform: part.anchor.map_or(*world, DAffine3::from_translation),
            });
        }
        Ok(())
    }

    /// The scene's material for one of the document, or for none: the default one is added when
    /// it is first needed.
    fn material(&mut self, index: Option<usize>) -> MaterialId {
        let in_file = self.accessors.document.materials.len();
        if index.is_none() && self.scene.materials.len() == in_file {
            self.scene.materials.push(material::default_material());
        }
        MaterialId(index.unwrap_or(in_file) as u32)
    }

    fn error(&self, place: String, problem: Problem) -> ImportError {
        ImportError {
            path: self.path.to_owned(),
            place: Some(place),
            problem,
        }
    }
}
