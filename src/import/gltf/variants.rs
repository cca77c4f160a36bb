//! Other materials for the same meshes (`KHR_materials_variants`).

use std::path::Path;

use super::document::Document;
use super::document_material::{VariantMappings, Variants};
use super::extensions::VARIANTS;
use crate::import::scene_file::suggestion;
use crate::import::{ImportError, WarningCode, Warnings};

/// Gives the primitives of `document` the materials of the variant `name`.
///
/// # Errors
/// Where the document has variants, and none of this name.
pub fn choose(
    document: &mut Document,
    path: &Path,
    name: &str,
    warnings: &mut Warnings,
) -> Result<(), ImportError> {
    let variants: Result<Option<Variants>, String> = document.extensions.read(VARIANTS);
    let variants = variants.map_err(|what| ImportError::invalid(path, what))?;
    let Some(Variants { variants }) = variants else {
        let message = format!("it has no variants; \"{name}\" changes nothing");
        warnings.add(WarningCode::BadValue, message);
        return Ok(());
    };
    let names: Vec<&str> = variants.iter().map(|v| v.name.as_str()).collect();
    let chosen = names.iter().position(|other| *other == name);
    let chosen = chosen.ok_or_else(|| {
        let what = format!(
            "no variant is named \"{name}\"; {}",
            suggestion(name, &names)
        );
        ImportError::invalid(path, what)
    })?;
    let primitives = document
        .meshes
        .iter_mut()
        .flat_map(|mesh| &mut mesh.primitives);
    for primitive in primitives {
        let mappings: Result<Option<VariantMappings>, String> = primitive.extensions.read(VARIANTS);
        let mappings = mappings.unwrap_or_else(|what| {
            warnings.add(WarningCode::BadValue, what);
            None
        });
        let mapping = mappings.and_then(|all| {
            let mut mappings = all.mappings.into_iter();
            mappings.find(|mapping| mapping.variants.contains(&chosen))
        });
        if let Some(mapping) = mapping {
            primitive.material = mapping.material;
        }
    }
    Ok(())
}
