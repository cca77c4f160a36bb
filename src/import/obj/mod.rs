//! Wavefront OBJ.

use std::path::Path;

use super::{ImportError, Imported};

/// Imports an `.obj` file.
pub fn import(path: &Path) -> Result<Imported, ImportError> {
    Err(ImportError::unsupported(path, "OBJ"))
}
