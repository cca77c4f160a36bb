//! The typed description of a scene: everything that its author said, resolved and checked.
//!
//! Importers make it, [`crate::prepare`] turns it into what rays meet. Geometry, lights and
//! cameras are single precision about an anchor of their own in double precision, so that what
//! is far from the origin keeps its shape.

mod left_out;
mod mesh;
mod settings;

pub use left_out::{Keep, LeftOut, Needs, Omission};
pub use mesh::{Attributes, Mesh, MeshError, MeshId};
pub use settings::{
    Background, IntegratorKind, MAX_DEPTH, MAX_LIGHT_SAMPLES, MAX_PIXELS, MAX_SAMPLES, MAX_SIDE,
    Settings, ToneMap,
};

use rayon::prelude::*;

use crate::camera::Camera;
use crate::light::{Environment, Light};
use crate::material::{Material, MaterialId};
use crate::math::{DAffine3, DVec3};
use crate::texture::{Image, Texture};

/// Everything that its author said.
#[derive(Clone, Debug, Default)]
pub struct Scene {
    /// Triangle meshes, each in its own coordinates.
    pub meshes: Vec<Mesh>,
    /// Meshes placed in the world.
    pub instances: Vec<Instance>,
    /// Materials.
    pub materials: Vec<Material>,
    /// Textures.
    pub textures: Vec<Texture>,
    /// Their images.
    pub images: Vec<Image>,
    /// Lights, in file order.
    pub lights: Vec<Placed<Light>>,
    /// Cameras; the first is the default one.
    pub cameras: Vec<Placed<Camera>>,
    /// Animations in the files; they are counted, not played.
    pub animations: usize,
    /// What rays bring back that leave the scene.
    pub background: Background,
    /// A picture of the surroundings, which is added to the background.
    pub environment: Option<Environment>,
}

/// A mesh placed in the world.
#[derive(Clone, Debug)]
pub struct Instance {
    /// The name of its node, for messages; may be empty.
    pub name: String,
    /// Which mesh.
    pub mesh: MeshId,
    /// What it is made of.
    pub material: MaterialId,
    /// From the mesh's coordinates to the world's.
    pub transform: DAffine3,
}

/// Something in single precision, relative to an origin in double precision.
#[derive(Clone, Debug)]
pub struct Placed<T> {
    /// Its name in the file; may be empty.
    pub name: String,
    /// The origin of `item`'s coordinates, in the world.
    pub origin: DVec3,
    /// The thing itself, with world axes and units.
    pub item: T,
}

impl Scene {
    /// Triangles as rendered: every instance counts.
    pub fn triangle_count(&self) -> u64 {
        self.instances
            .iter()
            .map(|i| self.mesh(i.mesh).indices().len() as u64)
            .sum()
    }

    /// The mesh with this id.
    pub fn mesh(&self, id: MeshId) -> &Mesh {
        &self.meshes[id.0 as usize]
    }

    /// Whether no light passes `instance` anywhere.
    pub fn is_opaque(&self, instance: &Instance) -> bool {
        self.materials[instance.material.0 as usize].is_opaque()
    }

    /// World-space corners of the box around all finite vertices that triangles use; `None`
    /// where there are none.
    pub fn bounds(&self) -> Option<(DVec3, DVec3)> {
        let of_instance = |instance: &Instance| {
            let mesh = self.mesh(instance.mesh);
            let vertices = mesh.used_vertices().iter();
            vertices
                .map(|&vertex| mesh.positions()[vertex as usize].as_dvec3())
                .map(|p| instance.transform.transform_point3(p))
                .filter(|p| p.is_finite())
                .map(|p| (p, p))
                .reduce(union)
        };
        let bounds = self.instances.par_iter().filter_map(of_instance);
        bounds.reduce_with(union)
    }

    /// Bytes that meshes and images hold in memory.
    pub fn memory_bytes(&self) -> usize {
        let meshes: usize = self.meshes.iter().map(Mesh::memory_bytes).sum();
        let images: usize = self.images.iter().map(Image::memory_bytes).sum();
        let environment = self
            .environment
            .as_ref()
            .map_or(0, Environment::memory_bytes);
        meshes + images + environment
    }
}

fn union(a: (DVec3, DVec3), b: (DVec3, DVec3)) -> (DVec3, DVec3) {
    (a.0.min(b.0), a.1.max(b.1))
}
