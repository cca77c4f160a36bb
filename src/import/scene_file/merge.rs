//! One scene into another.

use crate::import::undecoded::Undecoded;
use crate::material::MaterialId;
use crate::scene::{Instance, MeshId, Scene};
use crate::texture::{ImageId, TextureId};

/// Moves the meshes, materials, textures and images of `model` to the end of those of `scene`, and
/// returns its instances, which then mean those; so do `undecoded`.
pub fn append(scene: &mut Scene, model: Scene, undecoded: &mut [Undecoded]) -> Vec<Instance> {
    let meshes = scene.meshes.len() as u32;
    let materials = scene.materials.len() as u32;
    let textures = scene.textures.len() as u32;
    let images = scene.images.len() as u32;
    for entry in undecoded {
        entry.image.0 += images;
    }
    scene.meshes.extend(model.meshes);
    scene.images.extend(model.images);
    scene
        .textures
        .extend(model.textures.into_iter().map(|mut texture| {
            texture.image = ImageId(texture.image.0 + images);
            texture
        }));
    scene
        .materials
        .extend(model.materials.into_iter().map(|mut material| {
            material.retain_textures(|_, texture| {
                texture.texture = TextureId(texture.texture.0 + textures);
                true
            });
            material
        }));
    scene.animations += model.animations;
    let mut instances = model.instances;
    for instance in &mut instances {
        instance.mesh = MeshId(instance.mesh.0 + meshes);
        instance.material = MaterialId(instance.material.0 + materials);
    }
    instances
}
