//! What can only be judged at the end of a file.

use super::geometry::Geometry;
use super::lines::LineError;
use super::references::{Attributes, BadIndex, References, message};
use super::skipped::Skipped;
use crate::import::Warnings;

/// What the statements of a file, or of a part of it, leave to be judged.
pub struct Notes {
    /// Indices of vertices.
    pub vertices: References,
    /// Indices of texture coordinates.
    pub uvs: Attributes,
    /// Indices of normals.
    pub normals: Attributes,
    /// What was passed over.
    pub skipped: Skipped,
    /// Whether there is a statement at all.
    pub has_statements: bool,
}

impl Default for Notes {
    fn default() -> Self {
        Self {
            vertices: References::default(),
            uvs: Attributes::new("texture coordinate"),
            normals: Attributes::new("normal"),
            skipped: Skipped::default(),
            has_statements: false,
        }
    }
}

impl Notes {
    /// Adds those of the part of the file behind this.
    pub fn append(&mut self, later: Self) {
        self.vertices.append(later.vertices);
        self.uvs.append(later.uvs);
        self.normals.append(later.normals);
        self.skipped.add(later.skipped);
        self.has_statements |= later.has_statements;
    }

    /// Judges the whole file that `geometry` is, and takes from its corners the attributes that are not there.
    ///
    /// # Errors
    /// Where it has no vertices, or a face that uses one that is not there.
    pub fn finish(self, geometry: &mut Geometry) -> Result<Warnings, LineError> {
        let vertices = geometry.positions.len();
        if let Some((index, line)) = self.vertices.first_above(vertices) {
            let word = index.to_string();
            return Err(LineError {
                line: Some(line),
                what: message(&BadIndex::OutOfRange, word.as_bytes(), "vertex", vertices),
            });
        }
        if vertices == 0 {
            let what = if self.has_statements {
                "it has no vertices"
            } else {
                "it is empty"
            };
            return Err(LineError {
                line: None,
                what: what.to_owned(),
            });
        }
        let mut warnings = Warnings::default();
        let [uvs, normals] = [geometry.uvs.len(), geometry.normals.len()];
        let [late_uvs, late_normals] =
            if self.uvs.are_within(uvs) && self.normals.are_within(normals) {
                [0, 0]
            } else {
                geometry.corners.drop_above(uvs, normals)
            };
        self.uvs.warn(late_uvs, uvs, &mut warnings);
        self.normals.warn(late_normals, normals, &mut warnings);
        self.skipped.warn(&mut warnings);
        Ok(warnings)
    }
}
