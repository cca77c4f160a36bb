//! The vertices and triangles of one primitive, before and after they are deformed.

use super::accessor::{AccessorReader, Selection};
use super::document::{Attributes, ElementKind};
use super::topology::Mode;
use crate::import::{Problem, WarningCode, Warnings};
use crate::math::{Vec2, Vec3};
use crate::scene::{Mesh, MeshError};

/// Sets of texture coordinates that are kept.
pub const MAX_UV_SETS: usize = 4;

/// What defines the shape of a primitive, and nothing else: primitives that agree in this share
/// one mesh.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct Shape<'a> {
    /// Accessors of vertices.
    pub attributes: &'a Attributes,
    /// Accessor of corners; `None` where vertices are corners.
    pub indices: Option<usize>,
    /// How corners form triangles.
    pub mode: Mode,
    /// Displacements of vertices.
    pub targets: &'a [Attributes],
}

/// Vertices and triangles. Attributes have one value per vertex or none at all.
#[derive(Debug, Default)]
pub struct Geometry {
    /// Which vertices of the accessors these are.
    pub selection: Selection,
    /// Vertices that the accessors have.
    pub stored_vertices: usize,
    pub positions: Vec<Vec3>,
    pub normals: Vec<Vec3>,
    pub tangents: Vec<[f32; 4]>,
    pub uv_sets: Vec<Vec<Vec2>>,
    pub colors: Vec<[f32; 4]>,
    pub triangles: Vec<[u32; 3]>,
}

/// Reads attributes of one primitive.
pub struct GeometryReader<'a, 'b> {
    /// The document.
    pub accessors: &'a AccessorReader<'b>,
    /// How messages call the primitive.
    pub place: &'a str,
}

impl GeometryReader<'_, '_> {
    /// Positions, triangles and attributes; `None` where there is nothing to show.
    ///
    /// Where a primitive uses a small part of a large shared accessor, only that part is kept.
    ///
    /// # Errors
    /// Where positions or indices cannot be read. Other attributes are dropped with a warning.
    pub fn read(&self, shape: Shape, warnings: &mut Warnings) -> Result<Option<Geometry>, Problem> {
        let Some(&positions) = shape.attributes.get("POSITION") else {
            let message = format!("{}: it has no positions and is left out", self.place);
            warnings.add(WarningCode::BadAttribute, message);
            return Ok(None);
        };
        let vertices = self.accessors.count(positions)?;
        let mut triangles = self.triangles(shape, vertices, warnings)?;
        check_range(&triangles, vertices)?;
        let selection = select_used(&mut triangles, vertices);
        let mut geometry = Geometry {
            positions: into_vec3(self.accessors.floats(positions, &selection)?),
            stored_vertices: vertices,
            triangles,
            ..Geometry::default()
        };
        let attributes = shape.attributes;
        if let Some(normals) =
            self.vertex_floats(attributes, "NORMAL", vertices, &selection, warnings)
        {
            geometry.normals = into_vec3(normals);
        }
        if let Some(tangents) =
            self.vertex_floats(attributes, "TANGENT", vertices, &selection, warnings)
        {
            geometry.tangents = tangents;
        }
        geometry.colors = self.colors(attributes, vertices, &selection, warnings);
        geometry.uv_sets = self.uv_sets(attributes, vertices, &selection, warnings);
        geometry.selection = selection;
        Ok(Some(geometry))
    }

    /// One attribute; `None` where it is not there, or was dropped with a warning.
    pub fn vertex_floats<const N: usize>(
        &self,
        attributes: &Attributes,
        name: &str,
        vertices: usize,
        selection: &Selection,
        warnings: &mut Warnings,
    ) -> Option<Vec<[f32; N]>> {
        let read = |accessor| self.accessors.floats(accessor, selection);
        self.vertex_values(attributes, name, vertices, read, warnings)
    }

    /// As [`Self::vertex_floats`], for unsigned integers.
    pub fn vertex_integers<const N: usize>(
        &self,
        attributes: &Attributes,
        name: &str,
        vertices: usize,
        selection: &Selection,
        warnings: &mut Warnings,
    ) -> Option<Vec<[u32; N]>> {
        let read = |accessor| self.accessors.integers(accessor, selection);
        self.vertex_values(attributes, name, vertices, read, warnings)
    }

    fn vertex_values<T>(
        &self,
        attributes: &Attributes,
        name: &str,
        vertices: usize,
        read: impl FnOnce(usize) -> Result<Vec<T>, Problem>,
        warnings: &mut Warnings,
    ) -> Option<Vec<T>> {
        let &accessor = attributes.get(name)?;
        let values = self
            .check_count(accessor, vertices)
            .and_then(|()| read(accessor));
        values
            .map_err(|problem| self.drop_attribute(name, &problem, warnings))
            .ok()
    }

    fn check_count(&self, accessor: usize, vertices: usize) -> Result<(), Problem> {
        let count = self.accessors.count(accessor)?;
        if count != vertices {
            return Err(Problem::Invalid(format!(
                "accessor {accessor}: {count} values for {vertices} vertices"
            )));
        }
        Ok(())
    }

    fn drop_attribute(&self, name: &str, problem: &Problem, warnings: &mut Warnings) {
        let message = format!("{}: {name} is left out: {problem}", self.place);
        warnings.add(WarningCode::BadAttribute, message);
    }

    fn triangles(
        &self,
        shape: Shape,
        vertices: usize,
        warnings: &mut Warnings,
    ) -> Result<Vec<[u32; 3]>, Problem> {
        let budget = self.accessors.budget;
        let corners: Vec<u32> = match shape.indices {
            Some(indices) => {
                let corners = self.accessors.integers::<1>(indices, &Selection::All)?;
                corners.into_iter().flatten().collect()
            }
            None => {
                budget.take(vertices as u64 * size_of::<u32>() as u64)?;
                (0..vertices as u32).collect()
            }
        };
        if shape.mode == Mode::Triangles && !corners.len().is_multiple_of(3) {
            let message = format!(
                "{}: its last triangle has only {} corners",
                self.place,
                corners.len() % 3
            );
            warnings.add(WarningCode::BadFace, message);
        }
        let count = shape.mode.triangle_count(corners.len()) as u64;
        budget.take(count * size_of::<[u32; 3]>() as u64)?;
        Ok(shape.mode.triangles(&corners))
    }

    /// `COLOR_0` in `[0, 1]` as the specification demands, opaque where it has no alpha.
    fn colors(
        &self,
        attributes: &Attributes,
        vertices: usize,
        selection: &Selection,
        warnings: &mut Warnings,
    ) -> Vec<[f32; 4]> {
        const NAME: &str = "COLOR_0";
        let kind = attributes.get(NAME).map(|&i| self.accessors.get(i));
        let colors = if let Some(Ok(accessor)) = kind
            && accessor.kind == ElementKind::Vec3
        {
            let colors = self.vertex_floats(attributes, NAME, vertices, selection, warnings);
            let opaque = |[r, g, b]: [f32; 3]| [r, g, b, 1.0];
            colors.map(|colors| colors.into_iter().map(opaque).collect())
        } else {
            self.vertex_floats(attributes, NAME, vertices, selection, warnings)
        };
        let mut colors: Vec<[f32; 4]> = colors.unwrap_or_default();
        for channel in colors.as_flattened_mut() {
            *channel = if channel.is_nan() {
                0.0
            } else {
                channel.clamp(0.0, 1.0)
            };
        }
        colors
    }

    /// The sets up to the last that is there; those missing before it are all zero.
    fn uv_sets(
        &self,
        attributes: &Attributes,
        vertices: usize,
        selection: &Selection,
        warnings: &mut Warnings,
    ) -> Vec<Vec<Vec2>> {
        let name = |set: usize| format!("TEXCOORD_{set}");
        let last = (0..MAX_UV_SETS).rfind(|&set| attributes.contains_key(&name(set)));
        if attributes.contains_key(&name(MAX_UV_SETS)) {
            let message = format!(
                "{}: it has more than {MAX_UV_SETS} sets of texture coordinates",
                self.place
            );
            warnings.add(WarningCode::BadAttribute, message);
        }
        let sets = last.map_or(0, |last| last + 1);
        let mut uv_sets = Vec::with_capacity(sets);
        for set in 0..sets {
            let uvs = self.vertex_floats(attributes, &name(set), vertices, selection, warnings);
            uv_sets.push(match uvs {
                Some(uvs) => bytemuck::cast_vec::<[f32; 2], Vec2>(uvs),
                None => vec![Vec2::ZERO; selection.len_of(vertices)],
            });
        }
        uv_sets
    }
}

impl Geometry {
    /// As a mesh of the scene.
    ///
    /// # Errors
    /// Where indices or attributes do not fit, which reading has already made sure of.
    pub fn into_mesh(self, name: &str) -> Result<Mesh, MeshError> {
        let mut mesh = Mesh::new(name, self.positions, self.triangles)?;
        if !self.normals.is_empty() {
            mesh = mesh.with_normals(self.normals)?;
        }
        if !self.tangents.is_empty() {
            mesh = mesh.with_tangents(self.tangents)?;
        }
        for uvs in self.uv_sets {
            mesh = mesh.with_uv_set(uvs)?;
        }
        if !self.colors.is_empty() {
            mesh = mesh.with_colors(self.colors)?;
        }
        Ok(mesh)
    }
}

impl Selection {
    /// How many elements of `count` are selected.
    pub fn len_of(&self, count: usize) -> usize {
        match self {
            Self::All => count,
            Self::Only(wanted) => wanted.len(),
        }
    }
}

/// Three numbers each, as vectors.
pub fn into_vec3(values: Vec<[f32; 3]>) -> Vec<Vec3> {
    bytemuck::cast_vec(values)
}

fn check_range(triangles: &[[u32; 3]], vertices: usize) -> Result<(), Problem> {
    for (triangle, corners) in triangles.iter().enumerate() {
        if let Some(&index) = corners.iter().find(|&&i| i as usize >= vertices) {
            let error = MeshError::IndexOutOfRange {
                triangle,
                index,
                vertices,
            };
            return Err(Problem::Invalid(error.to_string()));
        }
    }
    Ok(())
}

/// The vertices that `triangles` use, which are renumbered, where those are surely not all.
fn select_used(triangles: &mut [[u32; 3]], vertices: usize) -> Selection {
    let corners = triangles.as_flattened_mut();
    if corners.len() >= vertices {
        return Selection::All;
    }
    let mut used = corners.to_vec();
    used.sort_unstable();
    used.dedup();
    for corner in corners {
        // Every corner is in the list that was made of them.
        *corner = used.partition_point(|&vertex| vertex < *corner) as u32;
    }
    Selection::Only(used)
}
