//! Triangle meshes.

use std::sync::OnceLock;

use thiserror::Error;

use crate::math::{Vec2, Vec3};

/// Index of a [`Mesh`] in a scene.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct MeshId(pub u32);

/// Triangles that share vertices. After [`Mesh::new`] every index is in range and every
/// attribute has one value per vertex.
#[derive(Clone, Debug, Default)]
pub struct Mesh {
    /// For messages; may be empty.
    pub name: String,
    positions: Vec<Vec3>,
    indices: Vec<[u32; 3]>,
    normals: Vec<Vec3>,
    tangents: Vec<[f32; 4]>,
    uv_sets: Vec<Vec<Vec2>>,
    colors: Vec<[f32; 4]>,
    used_vertices: OnceLock<Vec<u32>>,
}

/// Which attributes of vertices something reads.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Attributes {
    /// Normals.
    pub normals: bool,
    /// Tangents.
    pub tangents: bool,
    /// How many sets of texture coordinates, from the first to the last that is read.
    pub uv_sets: usize,
    /// Colours.
    pub colors: bool,
}

impl Attributes {
    /// Adds those of `other`.
    pub fn add(&mut self, other: Self) {
        self.normals |= other.normals;
        self.tangents |= other.tangents;
        self.uv_sets = self.uv_sets.max(other.uv_sets);
        self.colors |= other.colors;
    }
}

/// Why arrays are not a mesh.
#[derive(Clone, Debug, Error, PartialEq, Eq)]
#[non_exhaustive]
pub enum MeshError {
    /// An index past the end.
    #[error("triangle {triangle} uses vertex {index}, but there are only {vertices}")]
    IndexOutOfRange {
        /// Which triangle, counted from 0.
        triangle: usize,
        /// The index.
        index: u32,
        /// How many vertices there are.
        vertices: usize,
    },
    /// An attribute that does not have one value per vertex.
    #[error("{attribute} has {count} values for {vertices} vertices")]
    AttributeLength {
        /// Which attribute.
        attribute: &'static str,
        /// Its values.
        count: usize,
        /// How many vertices there are.
        vertices: usize,
    },
}

impl Mesh {
    /// Positions and triangles; attributes are added with the `with_` functions.
    ///
    /// # Errors
    /// Where an index is past the end of `positions`.
    pub fn new(
        name: impl Into<String>,
        positions: Vec<Vec3>,
        indices: Vec<[u32; 3]>,
    ) -> Result<Self, MeshError> {
        let vertices = positions.len();
        for (triangle, corners) in indices.iter().enumerate() {
            if let Some(&index) = corners.iter().find(|&&i| i as usize >= vertices) {
                return Err(MeshError::IndexOutOfRange {
                    triangle,
                    index,
                    vertices,
                });
            }
        }
        Ok(Self {
            name: name.into(),
            positions,
            indices,
            ..Self::default()
        })
    }

    fn check(&self, attribute: &'static str, count: usize) -> Result<(), MeshError> {
        if count == self.positions.len() {
            Ok(())
        } else {
            Err(MeshError::AttributeLength {
                attribute,
                count,
                vertices: self.positions.len(),
            })
        }
    }

    /// Adds vertex normals; they need not be of length 1.
    ///
    /// # Errors
    /// Where there is not one per vertex.
    pub fn with_normals(mut self, normals: Vec<Vec3>) -> Result<Self, MeshError> {
        self.check("normals", normals.len())?;
        self.normals = normals;
        Ok(self)
    }

    /// Adds vertex tangents: a direction, and the sign of the bitangent.
    ///
    /// # Errors
    /// Where there is not one per vertex.
    pub fn with_tangents(mut self, tangents: Vec<[f32; 4]>) -> Result<Self, MeshError> {
        self.check("tangents", tangents.len())?;
        self.tangents = tangents;
        Ok(self)
    }

    /// Adds a set of texture coordinates, with v growing downwards.
    ///
    /// # Errors
    /// Where there is not one per vertex.
    pub fn with_uv_set(mut self, uvs: Vec<Vec2>) -> Result<Self, MeshError> {
        self.check("texture coordinates", uvs.len())?;
        self.uv_sets.push(uvs);
        Ok(self)
    }

    /// Adds vertex colours: linear red, green, blue and opacity, multiplied with the material's.
    ///
    /// # Errors
    /// Where there is not one per vertex.
    pub fn with_colors(mut self, colors: Vec<[f32; 4]>) -> Result<Self, MeshError> {
        self.check("colours", colors.len())?;
        self.colors = colors;
        Ok(self)
    }

    /// Frees the attributes that `read` does not name; the bytes of normals, tangents, texture
    /// coordinates and colours that this freed.
    pub fn retain_attributes(&mut self, read: Attributes) -> [usize; 4] {
        let unread_uvs = self.uv_sets.split_off(read.uv_sets.min(self.uv_sets.len()));
        [
            take_unless(read.normals, &mut self.normals),
            take_unless(read.tangents, &mut self.tangents),
            unread_uvs
                .iter()
                .map(|uvs| size_of_val(uvs.as_slice()))
                .sum(),
            take_unless(read.colors, &mut self.colors),
        ]
    }

    /// Vertex positions, in the mesh's own coordinates. May hold values that are not finite.
    pub fn positions(&self) -> &[Vec3] {
        &self.positions
    }

    /// Triangles, counter-clockwise seen from outside.
    pub fn indices(&self) -> &[[u32; 3]] {
        &self.indices
    }

    /// Vertex normals; empty where the mesh is flat.
    pub fn normals(&self) -> &[Vec3] {
        &self.normals
    }

    /// Vertex tangents; may be empty.
    pub fn tangents(&self) -> &[[f32; 4]] {
        &self.tangents
    }

    /// Sets of texture coordinates.
    pub fn uv_sets(&self) -> &[Vec<Vec2>] {
        &self.uv_sets
    }

    /// Vertex colours; may be empty.
    pub fn colors(&self) -> &[[f32; 4]] {
        &self.colors
    }

    /// The vertices that triangles use, in rising order. Computed at the first call.
    pub fn used_vertices(&self) -> &[u32] {
        self.used_vertices.get_or_init(|| {
            let mut used = vec![false; self.positions.len()];
            for &index in self.indices.as_flattened() {
                used[index as usize] = true;
            }
            (0..used.len() as u32)
                .filter(|&i| used[i as usize])
                .collect()
        })
    }

    /// Bytes of its arrays.
    pub fn memory_bytes(&self) -> usize {
        size_of_val(self.positions.as_slice())
            + size_of_val(self.indices.as_slice())
            + size_of_val(self.normals.as_slice())
            + size_of_val(self.tangents.as_slice())
            + size_of_val(self.colors.as_slice())
            + self
                .uv_sets
                .iter()
                .map(|uvs| size_of_val(uvs.as_slice()))
                .sum::<usize>()
    }
}

/// Frees `values` unless they are `read`; their bytes.
fn take_unless<T>(read: bool, values: &mut Vec<T>) -> usize {
    if read {
        return 0;
    }
    size_of_val(std::mem::take(values).as_slice())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_index_past_the_end_is_named() {
        let error = Mesh::new("tail", vec![Vec3::ZERO; 3], vec![[0, 1, 2], [0, 1, 3]]);
        assert_eq!(
            error.map(|_| ()),
            Err(MeshError::IndexOutOfRange {
                triangle: 1,
                index: 3,
                vertices: 3
            })
        );
    }

    #[test]
    fn an_attribute_has_one_value_per_vertex() {
        let mesh = Mesh::new("", vec![Vec3::ZERO; 3], vec![[0, 1, 2]]);
        let error = mesh.and_then(|m| m.with_normals(vec![Vec3::Y; 2]));
        assert!(matches!(
            error,
            Err(MeshError::AttributeLength { count: 2, .. })
        ));
    }
}
