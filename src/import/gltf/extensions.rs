//! What becomes of extensions: known, harmless, left out with a word, or refused.

use std::collections::BTreeSet;
use std::path::Path;

use super::document::Document;
use crate::import::{ImportError, ImportOptions, WarningCode, Warnings};

/// What may move beside nodes.
pub const ANIMATION_POINTER: &str = "KHR_animation_pointer";
/// Nodes that are not shown.
pub const NODE_VISIBILITY: &str = "KHR_node_visibility";
/// Compressed meshes.
pub const DRACO: &str = "KHR_draco_mesh_compression";
/// Compressed buffer views.
pub const MESHOPT: [&str; 2] = ["EXT_meshopt_compression", "KHR_meshopt_compression"];
/// Lights.
pub const LIGHTS: &str = "KHR_lights_punctual";
/// Instances of a node's mesh.
pub const INSTANCING: &str = "EXT_mesh_gpu_instancing";
/// WebP images.
pub const WEBP: &str = "EXT_texture_webp";
/// KTX2 images.
pub const BASISU: &str = "KHR_texture_basisu";
/// Offset, rotation and scale of texture coordinates.
pub const TEXTURE_TRANSFORM: &str = "KHR_texture_transform";
/// Surfaces that let light through.
pub const TRANSMISSION: &str = "KHR_materials_transmission";
/// What is inside of them.
pub const VOLUME: &str = "KHR_materials_volume";

/// The model that came before metallic-roughness.
pub const SPECULAR_GLOSSINESS: &str = "KHR_materials_pbrSpecularGlossiness";
/// Other materials for the same meshes.
pub const VARIANTS: &str = "KHR_materials_variants";

/// What we do all of.
pub const KNOWN: &[&str] = &[
    LIGHTS,
    INSTANCING,
    WEBP,
    TEXTURE_TRANSFORM,
    "KHR_materials_anisotropy",
    "KHR_materials_clearcoat",
    "KHR_materials_diffuse_transmission",
    "KHR_materials_dispersion",
    "KHR_materials_emissive_strength",
    "KHR_materials_ior",
    "KHR_materials_iridescence",
    "KHR_materials_sheen",
    "KHR_materials_specular",
    SPECULAR_GLOSSINESS,
    VARIANTS,
    TRANSMISSION,
    "KHR_materials_unlit",
    VOLUME,
    "KHR_mesh_quantization",
    MESHOPT[0],
    MESHOPT[1],
    ANIMATION_POINTER,
    NODE_VISIBILITY,
    DRACO,
    BASISU,
];

/// What never changes a still picture.
pub const HARMLESS: &[&str] = &[
    "KHR_xmp",
    "KHR_xmp_json_ld",
    "KHR_audio_emitter",
    "KHR_interactivity",
    "KHR_node_hoverability",
    "KHR_node_selectability",
    "KHR_physics_rigid_bodies",
    "EXT_mesh_manifold",
    "EXT_mesh_features",
    "EXT_structural_metadata",
];

/// What will look different without an extension.
pub fn effect(name: &str) -> &'static str {
    match name {
        "KHR_materials_volume_scatter" => "volumes do not scatter light",
        "KHR_gaussian_splatting" => "splats are left out",
        DRACO => "the meshes are left out",
        "EXT_lights_ies" => "such lights are left out",
        "MSFT_lod" => "the finest level of detail is shown",
        "EXT_lights_image_based" => "light from the environment is left out",
        "EXT_texture_avif" | "MSFT_texture_dds" | BASISU => {
            "textures without a PNG, JPEG or WebP image are left out"
        }
        _ => "what it adds is left out",
    }
}

/// Decides about every extension that the document requires or uses.
///
/// # Errors
/// Where the file requires one that hides its geometry from us, and, in strict mode, any that we
/// lack.
pub fn check(
    document: &Document,
    path: &Path,
    options: ImportOptions,
    warnings: &mut Warnings,
) -> Result<(), ImportError> {
    for name in &document.extensions_required {
        let name = name.as_str();
        if let Some(feature) = needed_feature(name).filter(|_| name == DRACO) {
            let what = format!("{name} (feature \"{feature}\" of this build)");
            return Err(ImportError::unsupported(path, what));
        }
        if options.is_strict && !is_known(name) {
            return Err(ImportError::unsupported(path, name));
        }
        if !is_known(name) {
            let message = format!("{name} is required and not supported: {}", effect(name));
            warnings.add(WarningCode::RequiredExtension, message);
        }
    }
    let required: BTreeSet<&String> = document.extensions_required.iter().collect();
    for name in &document.extensions_used {
        if !is_known(name) && !is_judged_by_use(name) && !required.contains(name) {
            let message = format!("{name} is not supported: {}", effect(name));
            warnings.add(WarningCode::IgnoredExtension, message);
        }
    }
    Ok(())
}

/// Whether only the things that use an extension can tell if anything is missing without it.
fn is_judged_by_use(name: &str) -> bool {
    name == DRACO || name == BASISU
}

/// Whether an extension never changes a picture.
pub fn is_harmless(name: &str) -> bool {
    HARMLESS.contains(&name)
}

/// The feature that an extension needs and this build lacks.
pub fn needed_feature(name: &str) -> Option<&'static str> {
    match name {
        DRACO if !cfg!(feature = "draco") => Some("draco"),
        BASISU if !cfg!(feature = "ktx2") => Some("ktx2"),
        _ => None,
    }
}

/// Whether we do all that is to be done for an extension.
pub fn is_known(name: &str) -> bool {
    let is_listed = KNOWN.contains(&name) || is_harmless(name);
    is_listed && needed_feature(name).is_none()
}
