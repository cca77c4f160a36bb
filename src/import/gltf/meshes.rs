//! Meshes: each distinct shape once, however many primitives and nodes use it.

use std::collections::BTreeMap;
use std::rc::Rc;

use super::accessor::AccessorReader;
use super::document::{Document, MeshEntry, Primitive, place, primitive_place};
use super::extensions::DRACO;
use super::geometry::{GeometryReader, Shape};
use super::graph::Graph;
use super::morph;
use super::skin::Skin;
use super::topology::Mode;
use crate::import::{Problem, WarningCode, Warnings};
use crate::math::DVec3;
use crate::scene::{Mesh, MeshId};

/// Something wrong with a named thing.
pub struct Misplaced {
    /// What it is called.
    pub place: String,
    /// What is wrong with it.
    pub problem: Problem,
}

/// One primitive of a mesh as it is shown.
#[derive(Clone, Copy, Debug)]
pub struct Part {
    /// Its triangles.
    pub mesh: MeshId,
    /// The document's material; `None` for the default one.
    pub material: Option<usize>,
    /// Where its vertices were baked to world coordinates: their origin.
    pub anchor: Option<DVec3>,
}

/// A mesh as a node shows it: with the node's morph weights, in the node's skin.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord)]
struct Look {
    mesh: usize,
    /// The bits of the node's own weights.
    weights: Option<Vec<u32>>,
    skin: Option<usize>,
}

/// What two primitives must agree in to share a mesh.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord)]
struct BakedShape<'a> {
    shape: Shape<'a>,
    /// The bits of the weights of its targets.
    weights: Vec<u32>,
    skin: Option<usize>,
}

/// Makes meshes and remembers them.
pub struct Meshes<'a, 'b> {
    /// All meshes so far.
    pub meshes: Vec<Mesh>,
    accessors: &'a AccessorReader<'b>,
    graph: &'a Graph,
    looks: BTreeMap<Look, Rc<[Part]>>,
    shapes: BTreeMap<BakedShape<'a>, Option<(MeshId, Option<DVec3>)>>,
    skins: BTreeMap<usize, Option<Rc<Skin>>>,
}

impl<'a, 'b> Meshes<'a, 'b> {
    /// None yet.
    pub fn new(accessors: &'a AccessorReader<'b>, graph: &'a Graph) -> Self {
        Self {
            meshes: Vec::new(),
            accessors,
            graph,
            looks: BTreeMap::new(),
            shapes: BTreeMap::new(),
            skins: BTreeMap::new(),
        }
    }

    /// What node `node` shows of its mesh; nothing where it has none.
    ///
    /// # Errors
    /// Where the mesh, one of its primitives or its skin is broken.
    pub fn of_node(
        &mut self,
        node: usize,
        warnings: &mut Warnings,
    ) -> Result<Rc<[Part]>, Misplaced> {
        let document: &'a Document = self.accessors.document;
        let entry = &document.nodes[node];
        let Some(index) = entry.mesh else {
            return Ok(Rc::new([]));
        };
        let Some(mesh) = document.meshes.get(index) else {
            let count = document.meshes.len();
            let what = format!("its mesh {index} is not there: there are only {count}");
            return Err(Misplaced {
                place: document.node_place(node),
                problem: Problem::Invalid(what),
            });
        };
        let look = Look {
            mesh: index,
            weights: entry.weights.as_deref().map(bits),
            skin: entry.skin,
        };
        if let Some(parts) = self.looks.get(&look) {
            return Ok(Rc::clone(parts));
        }
        let weights = entry.weights.as_deref().unwrap_or(&mesh.weights);
        let skin = self.skin(node, warnings)?;
        let parts = self.parts(index, mesh, weights, skin.as_ref(), warnings)?;
        self.looks.insert(look, Rc::clone(&parts));
        Ok(parts)
    }

    /// Meshes of the document that no node asked for.
    pub fn unused(&self) -> Vec<usize> {
        let mut is_used = vec![false; self.accessors.document.meshes.len()];
        for look in self.looks.keys() {
            is_used[look.mesh] = true;
        }
        (0..is_used.len()).filter(|&i| !is_used[i]).collect()
    }

    /// Reads mesh `index` though no node asked for it; a broken one is a warning.
    pub fn read_unused(&mut self, index: usize, warnings: &mut Warnings) {
        let mesh: &'a MeshEntry = &self.accessors.document.meshes[index];
        if let Err(broken) = self.parts(index, mesh, &mesh.weights, None, warnings) {
            let message = format!("{}: {}; nothing uses it", broken.place, broken.problem);
            warnings.add(WarningCode::BadAttribute, message);
        }
    }

    /// Bytes that the vertices and corners of mesh `index` would take, as its accessors count them.
    pub fn bytes_of(&self, index: usize) -> u64 {
        let mesh = &self.accessors.document.meshes[index];
        let primitives = mesh.primitives.iter();
        let attributes = primitives.flat_map(|primitive| {
            let corners = primitive.indices.map(|i| (i, size_of::<u32>()));
            let vertices = primitive.attributes.iter();
            let vertices = vertices.map(|(name, &i)| (i, bytes_of_attribute(name)));
            vertices.chain(corners)
        });
        attributes
            .map(|(accessor, bytes)| {
                let count = self.accessors.count(accessor).unwrap_or(0);
                count as u64 * bytes as u64
            })
            .sum()
    }

    /// The primitives of mesh `index`.
    fn parts(
        &mut self,
        index: usize,
        mesh: &'a MeshEntry,
        weights: &[f32],
        skin: Option<&(usize, Rc<Skin>)>,
        warnings: &mut Warnings,
    ) -> Result<Rc<[Part]>, Misplaced> {
        let mut parts = Vec::new();
        for (i, primitive) in mesh.primitives.iter().enumerate() {
            let place = primitive_place(index, mesh, i);
            let part = self.part(primitive, mesh, weights, skin, &place, warnings);
            parts.extend(part.map_err(|problem| Misplaced { place, problem })?);
        }
        Ok(parts.into())
    }

    /// The skin of a node, with its index; `None` where it has none that can be used.
    fn skin(
        &mut self,
        node: usize,
        warnings: &mut Warnings,
    ) -> Result<Option<(usize, Rc<Skin>)>, Misplaced> {
        let document = self.accessors.document;
        let Some(index) = document.nodes[node].skin else {
            return Ok(None);
        };
        if let Some(skin) = self.skins.get(&index) {
            return Ok(skin.clone().map(|skin| (index, skin)));
        }
        let skin = Skin::read(self.accessors, self.graph, index);
        let skin = skin.map_err(|problem| Misplaced {
            place: document.node_place(node),
            problem,
        })?;
        if skin.is_none() {
            let name = document.skins[index].name.as_deref();
            let place = place("skin", index, name);
            let message = format!("{place}: it has no joints with finite places; it is left out");
            warnings.add(WarningCode::BadValue, message);
        }
        let skin = skin.map(Rc::new);
        self.skins.insert(index, skin.clone());
        Ok(skin.map(|skin| (index, skin)))
    }

    fn part(
        &mut self,
        primitive: &'a Primitive,
        mesh: &MeshEntry,
        weights: &[f32],
        skin: Option<&(usize, Rc<Skin>)>,
        place: &str,
        warnings: &mut Warnings,
    ) -> Result<Option<Part>, Problem> {
        let document = self.accessors.document;
        let code = primitive.mode.unwrap_or(Mode::DEFAULT_CODE);
        let mode = Mode::from_code(code)
            .ok_or_else(|| Problem::Invalid(format!("mode {code} is not known")))?;
        if mode == Mode::NotTriangles {
            let message = format!("{place}: points and lines are not shown");
            warnings.add(WarningCode::NotTriangles, message);
            return Ok(None);
        }
        if let Some(material) = primitive.material
            && material >= document.materials.len()
        {
            let count = document.materials.len();
            let what = format!("material {material} is not there: there are only {count}");
            return Err(Problem::Invalid(what));
        }
        // Draco's data may come with a copy that is not compressed.
        let is_missing = cfg!(not(feature = "draco"));
        if is_missing && primitive.extensions.has(DRACO) && document.lacks_data(primitive) {
            let what = format!("{DRACO} (feature \"draco\" of this build)");
            return Err(Problem::Unsupported(what));
        }
        let weights = effective_weights(primitive, weights, place, warnings);
        let baked = BakedShape {
            shape: Shape {
                attributes: &primitive.attributes,
                indices: primitive.indices,
                mode,
                targets: &primitive.targets,
            },
            weights: bits(&weights),
            skin: skin.map(|(index, _)| *index),
        };
        let made = match self.shapes.get(&baked) {
            Some(&made) => made,
            None => {
                let name = mesh.name.as_deref().unwrap_or("");
                let skin = skin.map(|(_, skin)| &**skin);
                let made = self.make(baked.shape, name, &weights, skin, place, warnings)?;
                self.shapes.insert(baked, made);
                made
            }
        };
        Ok(made.map(|(mesh, anchor)| Part {
            mesh,
            material: primitive.material,
            anchor,
        }))
    }

    fn make(
        &mut self,
        shape: Shape,
        name: &str,
        weights: &[f32],
        skin: Option<&Skin>,
        place: &str,
        warnings: &mut Warnings,
    ) -> Result<Option<(MeshId, Option<DVec3>)>, Problem> {
        let accessors = self.accessors;
        let reader = GeometryReader { accessors, place };
        let Some(mut geometry) = reader.read(shape, warnings)? else {
            return Ok(None);
        };
        morph::apply(&mut geometry, &reader, shape.targets, weights, warnings);
        let mut anchor = None;
        if let Some(skin) = skin
            && skin.apply(&mut geometry, &reader, shape.attributes, warnings)?
        {
            anchor = Some(skin.anchor);
        }
        accessors.budget.take(name.len() as u64)?;
        let mesh = geometry.into_mesh(name);
        let mesh = mesh.map_err(|error| Problem::Invalid(error.to_string()))?;
        self.meshes.push(mesh);
        Ok(Some((MeshId(self.meshes.len() as u32 - 1), anchor)))
    }
}

/// Bytes of one vertex's value in memory.
fn bytes_of_attribute(name: &str) -> usize {
    match name {
        "POSITION" | "NORMAL" => size_of::<[f32; 3]>(),
        "TANGENT" | "COLOR_0" => size_of::<[f32; 4]>(),
        _ if name.starts_with("TEXCOORD_") => size_of::<[f32; 2]>(),
        _ => 0,
    }
}

fn bits(weights: &[f32]) -> Vec<u32> {
    weights.iter().map(|weight| weight.to_bits()).collect()
}

/// The weights of the primitive's targets; none at all where all are 0.
fn effective_weights(
    primitive: &Primitive,
    weights: &[f32],
    place: &str,
    warnings: &mut Warnings,
) -> Vec<f32> {
    let weights = &weights[..weights.len().min(primitive.targets.len())];
    if weights.iter().all(|&weight| weight == 0.0) {
        return Vec::new();
    }
    let finite = |&weight: &f32| if weight.is_finite() { weight } else { 0.0 };
    if weights.iter().any(|weight| !weight.is_finite()) {
        let message = format!("{place}: a morph weight that is not finite became 0");
        warnings.add(WarningCode::BadValue, message);
    }
    weights.iter().map(finite).collect()
}
