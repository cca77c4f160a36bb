//! Tangents of meshes that have none: MikkTSpace, which glTF asks for, so that normal maps are read
//! as they were baked.

use std::collections::BTreeMap;

use bevy_mikktspace::{Geometry, TangentSpace, generate_tangents};
use rayon::prelude::*;

use crate::material::{Material, TextureSlot};
use crate::math::{Affine2, Vec2, Vec3};
use crate::scene::{Mesh, MeshError, Scene};

/// With which texture coordinates a material's directions go along the surface.
#[derive(Clone, Copy)]
struct Along {
    uv_set: usize,
    transform: Affine2,
}

/// Adds tangents to the meshes of `scene` that need them. Corners that share a vertex and not its
/// tangent get vertices of their own.
pub fn add_missing(scene: &mut Scene) {
    let mut asked: BTreeMap<usize, Along> = BTreeMap::new();
    for instance in &scene.instances {
        let material = &mut scene.materials[instance.material.0 as usize];
        if let Some(along) = along(material) {
            asked.entry(instance.mesh.0 as usize).or_insert(along);
        }
    }
    let meshes = scene.meshes.par_iter_mut().enumerate();
    meshes.for_each(|(index, mesh)| {
        if let Some(along) = asked.get(&index)
            && let Some(corners) = corner_tangents(mesh, *along)
            && let Ok(split) = with_tangents(mesh, &corners)
        {
            *mesh = split;
        }
    });
}

/// What `material` reads tangents for; `None` where it does not.
fn along(material: &mut Material) -> Option<Along> {
    if !material.reads_tangents() {
        return None;
    }
    let mut found = [None; 3];
    // Nothing is changed: this is how a material lists its textures.
    material.retain_textures(|slot, texture| {
        let rank = match slot {
            TextureSlot::Normal => 0,
            TextureSlot::ClearcoatNormal => 1,
            TextureSlot::Anisotropy => 2,
            _ => return true,
        };
        found[rank] = Some(Along {
            uv_set: usize::from(texture.uv_set),
            transform: texture.transform,
        });
        true
    });
    Some(found.into_iter().flatten().next().unwrap_or(Along {
        uv_set: 0,
        transform: Affine2::IDENTITY,
    }))
}

/// A mesh as MikkTSpace reads it.
struct Corners<'a> {
    mesh: &'a Mesh,
    uvs: &'a [Vec2],
    transform: Affine2,
    /// By corner; zero where there is no tangent.
    tangents: Vec<[f32; 4]>,
}

impl Corners<'_> {
    fn vertex(&self, face: usize, corner: usize) -> usize {
        self.mesh.indices()[face][corner] as usize
    }
}

impl Geometry for Corners<'_> {
    fn num_faces(&self) -> usize {
        self.mesh.indices().len()
    }

    fn num_vertices_of_face(&self, _: usize) -> usize {
        3
    }

    fn position(&self, face: usize, corner: usize) -> [f32; 3] {
        self.mesh.positions()[self.vertex(face, corner)].to_array()
    }

    fn normal(&self, face: usize, corner: usize) -> [f32; 3] {
        let normal = self.mesh.normals()[self.vertex(face, corner)];
        normal.normalize_or_zero().to_array()
    }

    fn tex_coord(&self, face: usize, corner: usize) -> [f32; 2] {
        let uv = self.uvs[self.vertex(face, corner)];
        let uv = self.transform.transform_point2(uv);
        // Green points up in the picture, and glTF's v down.
        [uv.x, -uv.y]
    }

    fn set_tangent(&mut self, space: Option<TangentSpace>, face: usize, corner: usize) {
        if let Some(space) = space {
            self.tangents[3 * face + corner] = space.tangent_encoded();
        }
    }
}

/// Tangents by corner; `None` where the mesh has its own, or lacks what they are made of.
fn corner_tangents(mesh: &Mesh, along: Along) -> Option<Vec<[f32; 4]>> {
    let uvs = mesh.uv_sets().get(along.uv_set)?;
    if !mesh.tangents().is_empty() || mesh.normals().is_empty() {
        return None;
    }
    let finite = |v: &[Vec3]| v.iter().all(|v| v.is_finite());
    if !(finite(mesh.positions()) && finite(mesh.normals()) && uvs.iter().all(|v| v.is_finite())) {
        return None;
    }
    let mut corners = Corners {
        mesh,
        uvs,
        transform: along.transform,
        tangents: vec![[0.0; 4]; 3 * mesh.indices().len()],
    };
    generate_tangents(&mut corners).ok()?;
    Some(corners.tangents)
}

/// `mesh` with a vertex for each pair of vertex and tangent.
fn with_tangents(mesh: &Mesh, corners: &[[f32; 4]]) -> Result<Mesh, MeshError> {
    let mut numbers: BTreeMap<(u32, [u32; 4]), u32> = BTreeMap::new();
    let mut kept: Vec<u32> = Vec::new();
    let mut tangents = Vec::new();
    let mut number = |vertex: u32, tangent: [f32; 4]| {
        *numbers
            .entry((vertex, tangent.map(f32::to_bits)))
            .or_insert_with(|| {
                kept.push(vertex);
                tangents.push(tangent);
                kept.len() as u32 - 1
            })
    };
    let triangles = mesh.indices().iter().zip(corners.as_chunks::<3>().0);
    let indices = triangles
        .map(|(triangle, tangents)| std::array::from_fn(|i| number(triangle[i], tangents[i])))
        .collect();
    fn pick<T: Copy>(kept: &[u32], values: &[T]) -> Vec<T> {
        kept.iter().map(|&i| values[i as usize]).collect()
    }
    let mut split = Mesh::new(&*mesh.name, pick(&kept, mesh.positions()), indices)?
        .with_normals(pick(&kept, mesh.normals()))?
        .with_tangents(tangents)?;
    for uvs in mesh.uv_sets() {
        split = split.with_uv_set(pick(&kept, uvs))?;
    }
    if !mesh.colors().is_empty() {
        split = split.with_colors(pick(&kept, mesh.colors()))?;
    }
    Ok(split)
}
