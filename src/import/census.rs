//! What a scene holds and its render does not read: it is left out before it costs anything.
//!
//! Comes after everything is read but the pixels of images, and before those are decoded. What is
//! taken away is what the integrator and the layers cannot reach, so the picture is the same bit
//! for bit.

use std::collections::{BTreeMap, BTreeSet};

use super::undecoded::Undecoded;
use crate::material::{AlphaMode, Material, Surface, TextureSlot};
use crate::scene::{Attributes, Keep, LeftOut, Needs, Omission, Scene};
use crate::texture::Pixels;

/// Leaves out of `scene` what `needs` does not name, but for what `keep` does; images that stay are
/// left in `undecoded`.
pub fn leave_out(
    scene: &mut Scene,
    undecoded: &mut Vec<Undecoded>,
    needs: Needs,
    keep: Keep,
) -> Vec<LeftOut> {
    let mut left_out = Vec::new();
    if !keep.contains(Omission::Images) {
        let whys = strip_materials(scene, needs);
        left_out.extend(drop_images(scene, undecoded, &whys));
    }
    if !keep.contains(Omission::Attributes) {
        left_out.extend(drop_attributes(scene, needs));
    }
    left_out
}

/// Why nothing reads an image; `None` where something does.
type Unread = Option<BTreeSet<&'static str>>;

/// Takes the textures out of materials that nothing reads; by image, why nothing reads it.
fn strip_materials(scene: &mut Scene, needs: Needs) -> Vec<Unread> {
    let mut is_shown = vec![false; scene.materials.len()];
    for instance in &scene.instances {
        is_shown[instance.material.0 as usize] = true;
    }
    let has_ambient = needs.ambient && !scene.background.ambient.is_black();
    let mut images: Vec<Unread> = vec![Some(BTreeSet::new()); scene.images.len()];
    for (material, is_shown) in scene.materials.iter_mut().zip(is_shown) {
        let unread = TextureSlot::ALL.map(|slot| match is_shown {
            true => unread(slot, material, needs, has_ambient),
            false => Some("nothing that is shown is made of their materials"),
        });
        material.retain_textures(|slot, texture| {
            let image = scene.textures[texture.texture.0 as usize].image;
            let image = &mut images[image.0 as usize];
            match (unread[slot as usize], image.as_mut()) {
                (None, _) => *image = None,
                (Some(why), Some(whys)) => {
                    whys.insert(why);
                }
                (Some(_), None) => {}
            }
            unread[slot as usize].is_none()
        });
    }
    images
}

/// Why the texture in `slot` of a shown material is not read; `None` where it is.
fn unread(
    slot: TextureSlot,
    material: &Material,
    needs: Needs,
    has_ambient: bool,
) -> Option<&'static str> {
    const NOT_ASKED_FOR: &str = "what is rendered does not read them";
    let is_read = match slot {
        TextureSlot::Opacity => true,
        TextureSlot::BaseColor => needs.scattering || needs.albedo,
        TextureSlot::Normal => needs.scattering || needs.normals,
        _ => needs.scattering,
    };
    if !is_read {
        return Some(NOT_ASKED_FOR);
    }
    match slot {
        TextureSlot::Opacity if material.alpha_mode == AlphaMode::Opaque => {
            Some("the surfaces are opaque")
        }
        TextureSlot::Occlusion if !has_ambient => Some("there is no ambient light to occlude"),
        TextureSlot::Thickness => Some("bodies are as thick as their meshes"),
        _ if is_multiplied_by_zero(slot, material) => Some("their factors are 0"),
        _ => None,
    }
}

/// Whether the texture in `slot` only modulates a factor of 0. Texels are finite, whatever the
/// format.
fn is_multiplied_by_zero(slot: TextureSlot, material: &Material) -> bool {
    match (slot, &material.surface) {
        (TextureSlot::Emission, _) => material.emission.factor.is_black(),
        (TextureSlot::Specular | TextureSlot::Exponent, Surface::Phong(phong)) => {
            phong.specular.factor.is_black()
        }
        (TextureSlot::BaseColor, Surface::Phong(phong)) => phong.diffuse.factor.is_black(),
        (_, Surface::MetallicRoughness(surface)) => match slot {
            TextureSlot::BaseColor => surface.base_color.factor.is_black(),
            TextureSlot::Metallic => surface.metallic.factor == 0.0,
            TextureSlot::Roughness => surface.roughness.factor == 0.0,
            TextureSlot::Occlusion => surface.occlusion.factor == 0.0,
            TextureSlot::Specular => surface.specular.factor == 0.0,
            TextureSlot::SpecularColor => surface.specular_color.factor.is_black(),
            TextureSlot::Transmission => surface.transmission.factor == 0.0,
            TextureSlot::Clearcoat
            | TextureSlot::ClearcoatRoughness
            | TextureSlot::ClearcoatNormal => {
                let coat = surface.clearcoat.as_ref();
                coat.is_some_and(|coat| coat.factor.factor == 0.0)
            }
            TextureSlot::SheenColor | TextureSlot::SheenRoughness => {
                let sheen = surface.sheen.as_ref();
                sheen.is_some_and(|sheen| sheen.color.factor.is_black())
            }
            TextureSlot::Iridescence | TextureSlot::IridescenceThickness => {
                let film = surface.iridescence.as_ref();
                film.is_some_and(|film| film.factor.factor == 0.0)
            }
            TextureSlot::Anisotropy => {
                let grain = surface.anisotropy.as_ref();
                grain.is_some_and(|grain| grain.strength == 0.0)
            }
            TextureSlot::DiffuseTransmission | TextureSlot::DiffuseTransmissionColor => {
                let through = surface.diffuse_transmission.as_ref();
                through.is_some_and(|through| through.factor.factor == 0.0)
            }
            _ => false,
        },
        _ => false,
    }
}

/// Leaves the images out that nothing reads: one entry for each reason.
fn drop_images(scene: &mut Scene, undecoded: &mut Vec<Undecoded>, whys: &[Unread]) -> Vec<LeftOut> {
    let mut groups: BTreeMap<String, (Vec<String>, u64)> = BTreeMap::new();
    let mut bytes = vec![0; scene.images.len()];
    undecoded.retain(|entry| {
        let index = entry.image.0 as usize;
        if whys[index].is_some() {
            let name = &scene.images[index].name;
            bytes[index] = entry.source.decoded_bytes(name).unwrap_or(0);
        }
        whys[index].is_none()
    });
    for ((image, whys), undecoded_bytes) in scene.images.iter_mut().zip(whys).zip(bytes) {
        let Some(whys) = whys else { continue };
        let saved = undecoded_bytes + image.memory_bytes() as u64;
        image.pixels = Pixels::Rgba8(Vec::new());
        let (names, sum) = groups.entry(reason(whys)).or_default();
        names.push(image.name.clone());
        *sum += saved;
    }
    let entry = |(why, (names, bytes)): (String, (Vec<String>, u64))| {
        let what = format!("{}: {}", counted(names.len(), "image"), names.join(", "));
        LeftOut::new(Omission::Images, what, why, bytes)
    };
    groups.into_iter().map(entry).collect()
}

fn reason(whys: &BTreeSet<&'static str>) -> String {
    if whys.is_empty() {
        return "no material names them".to_owned();
    }
    let whys: Vec<&str> = whys.iter().copied().collect();
    whys.join("; ")
}

/// Leaves attributes of vertices out that nothing reads.
fn drop_attributes(scene: &mut Scene, needs: Needs) -> Vec<LeftOut> {
    let read: Vec<Attributes> = (scene.materials.iter_mut())
        .map(|material| read_attributes(material, needs))
        .collect();
    let mut by_mesh = vec![Attributes::default(); scene.meshes.len()];
    for instance in &scene.instances {
        by_mesh[instance.mesh.0 as usize].add(read[instance.material.0 as usize]);
    }
    let mut freed = [(0, 0); 4];
    for (mesh, read) in scene.meshes.iter_mut().zip(by_mesh) {
        for (sum, bytes) in freed.iter_mut().zip(mesh.retain_attributes(read)) {
            sum.0 += usize::from(bytes > 0);
            sum.1 += bytes as u64;
        }
    }
    let reasons = [
        ("normals", "what is rendered does not read them"),
        ("tangents", "nothing is bent or stretched along them"),
        ("texture coordinates", "no texture is read with them"),
        ("colours of vertices", "what is rendered does not read them"),
    ];
    let entry = |((name, why), (meshes, bytes))| {
        let what = format!("{name} of {}", counted(meshes, "mesh"));
        LeftOut::new(Omission::Attributes, what, why, bytes)
    };
    let entries = reasons.into_iter().zip(freed);
    let entries = entries.filter(|(_, (meshes, _))| *meshes > 0);
    entries.map(entry).collect()
}

/// What is read of the vertices of a surface of `material`.
fn read_attributes(material: &mut Material, needs: Needs) -> Attributes {
    let mut uv_sets = usize::from(needs.uv);
    material.retain_textures(|_, texture| {
        uv_sets = uv_sets.max(usize::from(texture.uv_set) + 1);
        true
    });
    Attributes {
        normals: needs.scattering || needs.normals,
        tangents: material.reads_tangents(),
        uv_sets,
        colors: needs.scattering || needs.albedo || material.alpha_mode != AlphaMode::Opaque,
    }
}

/// Like `1 mesh` and `2 meshes`.
fn counted(count: usize, noun: &str) -> String {
    let plural = match (count, noun.ends_with("sh")) {
        (1, _) => "",
        (_, true) => "es",
        (_, false) => "s",
    };
    format!("{count} {noun}{plural}")
}
