//! What becomes of each extension of glTF that we have heard of, as a table.

use serde::Serialize;

use super::extensions::{effect, is_harmless, is_known, needed_feature};

/// What becomes of an extension.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Support {
    /// It is read.
    Read,
    /// It is not read, and changes no picture.
    Harmless,
    /// It is not read, and pictures lack something.
    Ignored,
    /// It is not read by this build.
    NotBuilt,
}

/// An extension and what becomes of it.
#[derive(Clone, Copy, Debug, Serialize)]
pub struct ExtensionSupport {
    /// Its name.
    pub name: &'static str,
    /// What becomes of it.
    pub support: Support,
    /// What it brings.
    pub adds: &'static str,
    /// What a picture is like without it; `None` where it is read or changes none.
    pub without: Option<&'static str>,
}

/// Extensions by name, and what they bring.
const NAMES: &[(&str, &str)] = &[
    ("EXT_lights_ies", "lights with measured directions"),
    (
        "EXT_lights_image_based",
        "light from an image of the surroundings",
    ),
    ("EXT_mesh_features", "numbers of features on meshes"),
    ("EXT_mesh_gpu_instancing", "many instances of a node's mesh"),
    ("EXT_mesh_manifold", "what is a closed surface"),
    ("EXT_meshopt_compression", "compressed buffers"),
    ("EXT_structural_metadata", "tables of properties"),
    ("EXT_texture_avif", "AVIF images"),
    ("EXT_texture_webp", "WebP images"),
    (
        "KHR_animation_pointer",
        "animated materials, cameras, lights and visibility (--time-code)",
    ),
    ("KHR_audio_emitter", "sound"),
    ("KHR_draco_mesh_compression", "compressed meshes"),
    ("KHR_gaussian_splatting", "clouds of splats"),
    ("KHR_interactivity", "behaviour"),
    ("KHR_lights_punctual", "point, spot and directional lights"),
    ("KHR_materials_anisotropy", "brushed surfaces"),
    ("KHR_materials_clearcoat", "clear coats"),
    (
        "KHR_materials_diffuse_transmission",
        "thin matte surfaces that let light through",
    ),
    (
        "KHR_materials_dispersion",
        "glass that splits light into colours",
    ),
    ("KHR_materials_emissive_strength", "emission above 1"),
    ("KHR_materials_ior", "indices of refraction"),
    ("KHR_materials_iridescence", "thin films"),
    (
        "KHR_materials_pbrSpecularGlossiness",
        "materials by specular colour and glossiness",
    ),
    ("KHR_materials_sheen", "cloth"),
    (
        "KHR_materials_specular",
        "strength and colour of reflections",
    ),
    (
        "KHR_materials_transmission",
        "surfaces that let light through",
    ),
    ("KHR_materials_unlit", "surfaces of a constant colour"),
    ("KHR_materials_variants", "materials to choose from"),
    (
        "KHR_materials_volume",
        "what is inside of surfaces that let light through",
    ),
    ("KHR_materials_volume_scatter", "volumes that scatter light"),
    ("KHR_mesh_quantization", "vertices of few bits"),
    ("KHR_meshopt_compression", "compressed buffers"),
    ("KHR_node_hoverability", "what the mouse may point at"),
    ("KHR_node_selectability", "what may be selected"),
    ("KHR_node_visibility", "hidden nodes"),
    ("KHR_physics_rigid_bodies", "motion of bodies"),
    ("KHR_texture_basisu", "KTX2 images (ETC1S, UASTC)"),
    (
        "KHR_texture_transform",
        "offset, rotation and scale of textures",
    ),
    ("KHR_xmp", "notes about the file"),
    ("KHR_xmp_json_ld", "notes about the file"),
    ("MSFT_lod", "coarser meshes for the distance"),
    ("MSFT_texture_dds", "DDS images"),
];

/// All extensions that we have heard of, by name.
pub fn extension_table() -> Vec<ExtensionSupport> {
    let row = |&(name, adds): &(&'static str, &'static str)| {
        let support = if is_harmless(name) {
            Support::Harmless
        } else if is_known(name) {
            Support::Read
        } else if needed_feature(name).is_some() {
            Support::NotBuilt
        } else {
            Support::Ignored
        };
        let is_missed = matches!(support, Support::Ignored | Support::NotBuilt);
        ExtensionSupport {
            name,
            support,
            adds,
            without: is_missed.then(|| effect(name)),
        }
    };
    NAMES.iter().map(row).collect()
}

#[cfg(test)]
mod tests {
    use super::super::extensions::{HARMLESS, KNOWN};
    use super::*;

    #[test]
    fn all_that_is_read_or_passed_over_stands_in_the_table() {
        for name in KNOWN.iter().chain(HARMLESS) {
            assert!(NAMES.iter().any(|(known, _)| known == name), "{name}");
        }
        assert!(NAMES.is_sorted());
        let table = extension_table();
        let of = |name: &str| {
            table
                .iter()
                .find(|row| row.name == name)
                .map(|row| row.support)
        };
        assert_eq!(of("KHR_lights_punctual"), Some(Support::Read));
        assert_eq!(of("KHR_xmp"), Some(Support::Harmless));
        assert_eq!(of("KHR_gaussian_splatting"), Some(Support::Ignored));
    }
}
