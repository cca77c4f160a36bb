//! The triangles of a scene, by themselves.

use rayon::prelude::*;

use crate::math::Vec3;
use crate::scene::Scene;

/// Triangles in one set of coordinates, every instance of a scene for itself.
#[derive(Clone, Debug, Default)]
pub struct Triangles {
    /// Vertices, world space, metres.
    pub positions: Vec<Vec3>,
    /// Corners.
    pub indices: Vec<[u32; 3]>,
}

impl Triangles {
    /// All of `scene`, instance by instance, each in the order of its mesh: for a model of one
    /// object and material that is the order of its file.
    ///
    /// `None` where there are more triangles or vertices than 32 bits can number.
    pub fn of_scene(scene: &Scene) -> Option<Self> {
        let mut bases = Vec::with_capacity(scene.instances.len());
        let mut vertices = 0u32;
        for instance in &scene.instances {
            bases.push(vertices);
            let count = scene.mesh(instance.mesh).positions().len();
            vertices = vertices.checked_add(u32::try_from(count).ok()?)?;
        }
        u32::try_from(scene.triangle_count()).ok()?;
        let positions = scene.instances.par_iter().flat_map(|instance| {
            let positions = scene.mesh(instance.mesh).positions().par_iter();
            positions.map(|p| instance.transform.transform_point3(p.as_dvec3()).as_vec3())
        });
        let indices = scene.instances.par_iter().zip(&bases);
        let indices = indices.flat_map(|(instance, &base)| {
            let triangles = scene.mesh(instance.mesh).indices().par_iter();
            triangles.map(move |corners| corners.map(|vertex| vertex + base))
        });
        Some(Self {
            positions: positions.collect(),
            indices: indices.collect(),
        })
    }
}
