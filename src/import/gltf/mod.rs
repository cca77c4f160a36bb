//! glTF 2.0.

use std::path::Path;

use super::{ImportError, ImportOptions, Imported};

/// Imports a `.gltf` or `.glb` file.
pub fn import(path: &Path, _options: ImportOptions) -> Result<Imported, ImportError> {
    Err(ImportError::unsupported(path, "glTF"))
}
