//! The triangles that rays meet: flattened where that is cheap, instances where it is not.

use std::collections::BTreeMap;

use rayon::prelude::*;

use crate::bvh::{Builder, Bvh, Tracer};
use crate::math::{DAffine3, DMat3, Mat3, Vec3, gamma};
use crate::scene::{Instance, MeshId, Scene};

use super::defects::{Defects, defects};
use super::placement::Placement;

/// Triangles of one tree, in the coordinates that they are traced in.
#[derive(Debug, Default)]
pub struct TreeGeometry {
    /// Vertices.
    pub positions: Vec<Vec3>,
    /// Triangles.
    pub indices: Vec<[u32; 3]>,
}

/// One instance of the tracer.
#[derive(Debug)]
pub struct Traced {
    /// Which tree.
    pub tree: u32,
    /// The tree's triangles below this number let no light pass wherever they are hit, and are not
    /// asked.
    pub opaque_triangles: u32,
    /// What it is.
    pub placing: Placing,
}

/// What an instance of the tracer is.
#[derive(Debug)]
pub enum Placing {
    /// A tree in prepared coordinates, made of many instances of the scene. Each part says which,
    /// and at which triangle of the tree it begins.
    Flattened(Vec<Part>),
    /// One instance of the scene.
    Instanced {
        /// Which instance of the scene.
        instance: u32,
        /// From the mesh's coordinates to prepared ones.
        to_prepared: DAffine3,
        /// How it spreads rounding errors.
        error: ErrorSpread,
    },
}

/// Magnitudes of a transform and its inverse, which bound what rounding does to a point on its
/// way there and back.
#[derive(Clone, Copy, Debug)]
pub struct ErrorSpread {
    forward: Mat3,
    backward: Mat3,
    shift: Vec3,
}

impl ErrorSpread {
    fn of(transform: &DAffine3) -> Self {
        let magnitudes =
            |m: DMat3| Mat3::from_cols_array(&m.to_cols_array().map(|c| c.abs() as f32));
        let inverse = transform.inverse();
        Self {
            forward: magnitudes(transform.matrix3),
            backward: magnitudes(inverse.matrix3),
            shift: inverse.translation.abs().as_vec3(),
        }
    }

    /// How far a point whose coordinates are at most `reach` may be off, after it was rounded in
    /// the mesh's coordinates.
    pub fn bound(&self, reach: Vec3) -> Vec3 {
        let bound = self.forward * (self.backward * reach + self.shift) * gamma(8);
        // Scales beyond single precision have no bound, and rays that start there no use.
        if bound.is_finite() { bound } else { reach }
    }
}

/// A run of triangles in a flattened tree.
#[derive(Clone, Copy, Debug)]
pub struct Part {
    /// Its first triangle in the tree.
    pub first_triangle: u32,
    /// Which instance of the scene it is.
    pub instance: u32,
}

/// All triangles of a scene, ready to be traced.
#[derive(Debug)]
pub struct Geometry {
    /// Finds hits.
    pub tracer: Tracer,
    /// Per tree: its triangles.
    pub trees: Vec<TreeGeometry>,
    /// Per instance of the tracer: its tree, and what it is.
    pub traced: Vec<Traced>,
    /// The meshes with triangles that are hard to render; one that is kept as instances counts once.
    pub defects: BTreeMap<MeshId, Defects>,
}

impl Geometry {
    /// Places and builds everything that `scene` holds.
    ///
    /// At most `flatten_budget` triangles are added by flattening shared meshes. `asks_all` has all
    /// surfaces asked for their opacity, opaque ones too.
    pub fn build(
        scene: &Scene,
        placement: &Placement,
        builder: Builder,
        flatten_budget: u64,
        asks_all: bool,
    ) -> Self {
        let instanced = instanced_meshes(scene, flatten_budget);
        let (shared, mut single): (Vec<_>, Vec<_>) = scene
            .instances
            .iter()
            .enumerate()
            .map(|(i, instance)| (i as u32, instance))
            .partition(|(_, instance)| instanced.binary_search(&instance.mesh).is_ok());
        single.sort_by_key(|(_, instance)| !scene.is_opaque(instance));
        let end = |opaque| if asks_all { 0 } else { opaque };

        let mut trees = Vec::new();
        let mut traced = Vec::new();
        if !single.is_empty() || shared.is_empty() {
            let (tree, parts) = flatten(scene, &single, placement);
            let opaque = single.partition_point(|(_, instance)| scene.is_opaque(instance));
            let opaque = parts.get(opaque).map_or(u32::MAX, |p| p.first_triangle);
            trees.push(tree);
            traced.push(Traced {
                tree: 0,
                opaque_triangles: end(opaque),
                placing: Placing::Flattened(parts),
            });
        }
        let first_mesh_tree = trees.len() as u32;
        trees.extend(instanced.iter().map(|&id| {
            let mesh = scene.mesh(id);
            TreeGeometry {
                positions: mesh.positions().to_vec(),
                indices: mesh.indices().to_vec(),
            }
        }));
        for (id, instance) in shared {
            let tree = instanced.partition_point(|&m| m < instance.mesh) as u32;
            let to_prepared = placement.after(&instance.transform);
            traced.push(Traced {
                tree: first_mesh_tree + tree,
                opaque_triangles: end(if scene.is_opaque(instance) {
                    u32::MAX
                } else {
                    0
                }),
                placing: Placing::Instanced {
                    instance: id,
                    to_prepared,
                    error: ErrorSpread::of(&to_prepared),
                },
            });
        }

        let defects = defects_by_mesh(scene, &trees, &traced);
        trees.iter_mut().for_each(drop_non_finite);
        let bvhs: Vec<Bvh> = trees
            .par_iter()
            .map(|tree| Bvh::build(&tree.positions, &tree.indices, builder))
            .collect();
        let tracer = Tracer::new(bvhs, &transforms(&traced));
        Self {
            tracer,
            trees,
            traced,
            defects,
        }
    }

    /// Bytes of triangles and trees.
    pub fn memory_bytes(&self) -> usize {
        let triangles: usize = self
            .trees
            .iter()
            .map(|t| size_of_val(t.positions.as_slice()) + size_of_val(t.indices.as_slice()))
            .sum();
        triangles + self.tracer.memory_bytes()
    }
}

fn transforms(traced: &[Traced]) -> Vec<(u32, DAffine3)> {
    traced
        .iter()
        .map(|t| match t.placing {
            Placing::Flattened(_) => (t.tree, DAffine3::IDENTITY),
            Placing::Instanced { to_prepared, .. } => (t.tree, to_prepared),
        })
        .collect()
}

/// The meshes that are kept as instances, in rising order: those with most triangles in copies,
/// so that all other copies together are within `flatten_budget`.
fn instanced_meshes(scene: &Scene, flatten_budget: u64) -> Vec<MeshId> {
    let mut uses = vec![0u64; scene.meshes.len()];
    for instance in &scene.instances {
        uses[instance.mesh.0 as usize] += 1;
    }
    let mut copies: Vec<(u64, MeshId)> = (0..uses.len())
        .map(|id| {
            let triangles = scene.meshes[id].indices().len() as u64;
            let copies = uses[id].saturating_sub(1) * triangles;
            (copies, MeshId(id as u32))
        })
        .collect();
    copies.sort_by_key(|&(copies, id)| (copies, id));
    let mut added = 0;
    let flattened = copies
        .iter()
        .take_while(|(copies, _)| {
            added += copies;
            added <= flatten_budget
        })
        .count();
    let mut instanced: Vec<MeshId> = copies.split_off(flattened).iter().map(|c| c.1).collect();
    instanced.sort();
    instanced
}

/// How many triangles the trees over `scene` will hold, with that budget for flattening.
pub(super) fn traced_triangles(scene: &Scene, flatten_budget: u64) -> u64 {
    let instanced = instanced_meshes(scene, flatten_budget);
    let triangles = |mesh: MeshId| scene.mesh(mesh).indices().len() as u64;
    let flattened = scene
        .instances
        .iter()
        .filter(|instance| instanced.binary_search(&instance.mesh).is_err())
        .map(|instance| triangles(instance.mesh));
    flattened.sum::<u64>() + instanced.iter().map(|&mesh| triangles(mesh)).sum::<u64>()
}

/// One tree of all `instances`, in prepared coordinates.
fn flatten(
    scene: &Scene,
    instances: &[(u32, &Instance)],
    placement: &Placement,
) -> (TreeGeometry, Vec<Part>) {
    let mut parts = Vec::with_capacity(instances.len());
    let mut bases = Vec::with_capacity(instances.len());
    let (mut vertices, mut triangles) = (0u32, 0u32);
    for &(id, instance) in instances {
        let mesh = scene.mesh(instance.mesh);
        parts.push(Part {
            first_triangle: triangles,
            instance: id,
        });
        bases.push(vertices);
        triangles += mesh.indices().len() as u32;
        vertices += mesh.positions().len() as u32;
    }
    let positions = instances
        .par_iter()
        .flat_map(|(_, instance)| {
            let to_prepared = placement.after(&instance.transform);
            scene
                .mesh(instance.mesh)
                .positions()
                .par_iter()
                .map(move |p| to_prepared.transform_point3(p.as_dvec3()).as_vec3())
        })
        .collect();
    let indices = instances
        .par_iter()
        .zip(&bases)
        .flat_map(|((_, instance), &base)| {
            scene
                .mesh(instance.mesh)
                .indices()
                .par_iter()
                .map(move |corners| corners.map(|i| i + base))
        })
        .collect();
    (TreeGeometry { positions, indices }, parts)
}

/// The meshes of `trees` that have triangles which are hard to render.
fn defects_by_mesh(
    scene: &Scene,
    trees: &[TreeGeometry],
    traced: &[Traced],
) -> BTreeMap<MeshId, Defects> {
    let mesh = |instance: u32| scene.instances[instance as usize].mesh;
    let mut parts = vec![Vec::new(); trees.len()];
    for traced in traced {
        parts[traced.tree as usize] = match &traced.placing {
            Placing::Flattened(parts) => (parts.iter())
                .map(|part| (part.first_triangle, mesh(part.instance)))
                .collect(),
            Placing::Instanced { instance, .. } => vec![(0, mesh(*instance))],
        };
    }
    let mut all = BTreeMap::<MeshId, Defects>::new();
    for (tree, parts) in trees.iter().zip(&parts) {
        for (mesh, found) in defects(tree, parts) {
            all.entry(mesh).or_default().add(&found);
        }
    }
    all.retain(|_, found| *found != Defects::default());
    all
}

/// Collapses triangles with a vertex that is not finite to a point, so that the numbers of the
/// others stay what they are.
fn drop_non_finite(tree: &mut TreeGeometry) {
    let TreeGeometry { positions, indices } = tree;
    if positions.par_iter().all(|p| p.is_finite()) {
        return;
    }
    indices
        .par_iter_mut()
        .filter(|corners| corners.iter().any(|&i| !positions[i as usize].is_finite()))
        .for_each(|corners| *corners = [corners[0]; 3]);
    for p in positions.iter_mut().filter(|p| !p.is_finite()) {
        *p = Vec3::ZERO;
    }
}
