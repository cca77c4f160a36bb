//! One scene into another.

use crate::material::{Material, MaterialId, MetallicRoughness, Phong, Surface};
use crate::scene::{Instance, MeshId, Scene};
use crate::texture::{ImageId, TextureId, TextureRef, TexturedRgb, TexturedScalar};

/// Moves the meshes, materials, textures and images of `model` to the end of those of `scene`, and
/// returns its instances, which then mean those.
pub fn append(scene: &mut Scene, model: Scene) -> Vec<Instance> {
    let meshes = scene.meshes.len() as u32;
    let materials = scene.materials.len() as u32;
    let textures = scene.textures.len() as u32;
    let images = scene.images.len() as u32;
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
            each_texture(&mut material, |texture| {
                texture.texture = TextureId(texture.texture.0 + textures);
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

/// Calls `change` for every texture that `material` looks up.
///
/// Fields are listed one by one, so that a new one cannot be forgotten here.
fn each_texture(material: &mut Material, mut change: impl FnMut(&mut TextureRef)) {
    let Material {
        name: _,
        surface,
        emission,
        alpha_mode: _,
        opacity,
        normal_map,
        is_double_sided: _,
    } = material;
    let (colors, scalars) = textured(surface);
    let normals = normal_map.as_mut().map(|map| &mut map.texture);
    let colors = colors.into_iter().chain([emission]);
    let scalars = scalars.into_iter().chain([opacity]);
    colors
        .filter_map(|color| color.texture.as_mut())
        .chain(scalars.filter_map(|scalar| scalar.texture.as_mut()))
        .chain(normals)
        .for_each(&mut change);
}

/// Everything of `surface` that a texture may modulate.
fn textured(surface: &mut Surface) -> (Vec<&mut TexturedRgb>, Vec<&mut TexturedScalar>) {
    match surface {
        Surface::Phong(Phong {
            diffuse,
            specular,
            exponent,
            reflect: _,
            transmit: _,
            index_of_refraction: _,
        }) => (vec![diffuse, specular], vec![exponent]),
        Surface::MetallicRoughness(parameters) => {
            let MetallicRoughness {
                base_color,
                metallic,
                roughness,
                occlusion,
                index_of_refraction: _,
                specular,
                specular_color,
                transmission,
                thickness,
                attenuation_color: _,
                attenuation_distance: _,
            } = &mut **parameters;
            (
                vec![base_color, specular_color],
                vec![
                    metallic,
                    roughness,
                    occlusion,
                    specular,
                    transmission,
                    thickness,
                ],
            )
        }
        Surface::Unlit(color) => (vec![color], Vec::new()),
    }
}
