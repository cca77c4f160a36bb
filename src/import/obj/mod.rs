//! Wavefront OBJ, with its MTL materials.
//!
//! Bytes go through [`blocks`] (statements to lists, several blocks of them at a time), [`normals`] (those
//! that the file leaves to be computed), [`anchor`] (double to single precision) and [`meshes`] (one mesh
//! per object and material; groups are merged); [`library`] brings the materials.
//!
//! The reader is our own. `tobj`, which tests compare it with, cuts every polygon into a fan,
//! which is wrong for concave ones, reports errors without line or element, reads no smoothing
//! groups, drops the colours of vertices where some have none, and uses one thread.
//!
//! Positions are read as doubles; a model that is far from the origin for its size becomes
//! single precision about its own middle, and its instances carry that middle in their transform.
//! Colours of vertices are taken as linear. Faces without a material are a neutral matte grey.

mod anchor;
mod blocks;
mod geometry;
mod library;
mod lines;
mod meshes;
mod mtl;
mod names;
mod normals;
mod notes;
mod polygon;
mod reader;
mod references;
mod room;
mod runs;
mod search;
mod skipped;

use std::path::Path;

use anchor::Anchor;
use geometry::Geometry;
use library::Libraries;
use meshes::PartMesh;
use mtl::{NEUTRAL_REFLECTANCE, Textures};

use super::{ImportError, Model, WarningCode, Warnings, files};
use crate::material::{Material, MaterialId, Surface};
use crate::math::DAffine3;
use crate::scene::{Instance, MeshId, Scene};

/// Imports an `.obj` file.
///
/// # Errors
/// Where it cannot be read, has a vertex or face that cannot be understood, or a face that uses
/// a vertex that is not there.
pub fn import(path: &Path) -> Result<Model, ImportError> {
    let bytes = files::read(path).map_err(|error| ImportError::io(path, error))?;
    let (mut geometry, mut warnings) = blocks::read(&bytes).map_err(|error| match error.line {
        Some(line) => ImportError::invalid_at(path, format!("line {line}"), error.what),
        None => ImportError::invalid(path, error.what),
    })?;
    drop(bytes);
    normals::complete(&mut geometry);
    let anchor = Anchor::of(&geometry);
    let meshes = meshes::build(&geometry, anchor, &mut warnings)
        .map_err(|error| ImportError::invalid(path, error.to_string()))?;
    let mut scene = Scene::default();
    let folder = path.parent().unwrap_or(Path::new(""));
    let mut textures = Textures::default();
    let materials = add_materials(&mut scene, &geometry, folder, &mut textures, &mut warnings);
    for (index, part_mesh) in meshes.into_iter().enumerate() {
        let material = materials[index];
        warn_of_missing_uvs(
            &part_mesh,
            &scene.materials[material.0 as usize],
            &mut warnings,
        );
        scene.instances.push(Instance {
            name: part_mesh.mesh.name.clone(),
            mesh: MeshId(index as u32),
            material,
            transform: DAffine3::from_translation(anchor.0),
        });
        scene.meshes.push(part_mesh.mesh);
    }
    scene.images = textures.images;
    scene.textures = textures.textures;
    Ok(Model {
        scene,
        undecoded: textures.undecoded,
        warnings,
        ..Model::default()
    })
}

/// Adds the materials that faces use to `scene`; which one each part has.
fn add_materials(
    scene: &mut Scene,
    geometry: &Geometry,
    folder: &Path,
    textures: &mut Textures,
    warnings: &mut Warnings,
) -> Vec<MaterialId> {
    let libraries = Libraries::read(&geometry.libraries, folder, warnings);
    for name in &geometry.materials {
        scene
            .materials
            .push(libraries.material(name, textures, warnings));
    }
    let neutral = MaterialId(scene.materials.len() as u32);
    if geometry.parts.iter().any(|part| part.material.is_none()) {
        scene
            .materials
            .push(Material::matte("", NEUTRAL_REFLECTANCE));
    }
    let parts = geometry.parts.iter();
    parts
        .map(|part| part.material.map_or(neutral, MaterialId))
        .collect()
}

fn warn_of_missing_uvs(mesh: &PartMesh, material: &Material, warnings: &mut Warnings) {
    if mesh.corners_without_uv > 0 && has_textures(material) {
        let message = format!(
            "faces of the textured material {:?} have no texture coordinates: they show one pixel",
            material.name
        );
        warnings.add_many(WarningCode::BadAttribute, message, mesh.corners_without_uv);
    }
}

fn has_textures(material: &Material) -> bool {
    let in_surface = match &material.surface {
        Surface::Phong(phong) => {
            phong.diffuse.texture.is_some()
                || phong.specular.texture.is_some()
                || phong.exponent.texture.is_some()
        }
        Surface::MetallicRoughness(surface) => {
            surface.base_color.texture.is_some()
                || surface.roughness.texture.is_some()
                || surface.metallic.texture.is_some()
        }
        Surface::Unlit(color) => color.texture.is_some(),
    };
    in_surface
        || material.emission.texture.is_some()
        || material.opacity.texture.is_some()
        || material.normal_map.is_some()
}
