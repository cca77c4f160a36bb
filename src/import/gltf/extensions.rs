//! What becomes of extensions: known, harmless, left out with a word, or refused.
//!
//! Of some that are known, values are kept that nothing shows yet: [`check_materials`] says where.

use std::collections::BTreeSet;
use std::path::Path;

use super::document::{Document, place};
use crate::color::Rgb;
use crate::import::{ImportError, ImportOptions, Problem, WarningCode, Warnings};
use crate::material::{Material, MetallicRoughness, Surface};

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

/// What we do all of, but for what [`check_materials`] tells.
pub const KNOWN: &[&str] = &[
    LIGHTS,
    INSTANCING,
    WEBP,
    TEXTURE_TRANSFORM,
    "KHR_materials_emissive_strength",
    "KHR_materials_ior",
    "KHR_materials_specular",
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
        "KHR_materials_clearcoat" => "coats are left out",
        "KHR_materials_sheen" => "cloth lacks its sheen",
        "KHR_materials_iridescence" => "thin films lack their colours",
        "KHR_materials_anisotropy" => "brushed surfaces have round highlights",
        "KHR_materials_dispersion" => "glass does not split light into colours",
        "KHR_materials_diffuse_transmission" => "thin matte surfaces do not let light through",
        "KHR_materials_volume_scatter" => "volumes do not scatter light",
        "KHR_materials_pbrSpecularGlossiness" => {
            "materials are shown as their metallic-roughness values say, or else white"
        }
        "KHR_materials_variants" => "the default variant is shown",
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

/// Tells which materials have values of known extensions that are kept and not shown; `materials`
/// are those of the document, in its order.
///
/// # Errors
/// In strict mode, where the file requires such an extension.
pub fn check_materials(
    document: &Document,
    materials: &[Material],
    path: &Path,
    options: ImportOptions,
    warnings: &mut Warnings,
) -> Result<(), ImportError> {
    for (index, material) in materials.iter().enumerate() {
        let Surface::MetallicRoughness(surface) = &material.surface else {
            continue;
        };
        for (extension, what) in unshown(surface) {
            let place = place("material", index, Some(&material.name));
            let is_required = document.extensions_required.iter().any(|e| e == extension);
            if is_required && options.is_strict {
                return Err(ImportError {
                    path: path.to_owned(),
                    place: Some(place),
                    problem: Problem::Unsupported(format!("{what} ({extension})")),
                });
            }
            let message = format!("{place}: {what} ({extension}) is not supported: it looks clear");
            warnings.add(WarningCode::Approximated, message);
        }
    }
    Ok(())
}

/// Extensions of which `surface` has more than is shown, and what that is.
fn unshown(surface: &MetallicRoughness) -> impl Iterator<Item = (&'static str, &'static str)> {
    let is_metal = surface.metallic.factor == 1.0 && surface.metallic.texture.is_none();
    let lets_light_through = surface.transmission.factor > 0.0 && !is_metal;
    let is_rough = lets_light_through && surface.roughness.factor > 0.0;
    let is_colored = lets_light_through
        && surface.thickness.factor > 0.0
        && surface.attenuation_distance.is_finite()
        && surface.attenuation_color != Rgb::WHITE;
    let rough = is_rough.then_some((TRANSMISSION, "light through a rough surface"));
    let colored = is_colored.then_some((VOLUME, "the colour of a volume"));
    rough.into_iter().chain(colored)
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
