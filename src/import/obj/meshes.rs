//! Lists of faces to one mesh per object and material.

use std::ops::Range;

use rayon::prelude::*;

use super::anchor::Anchor;
use super::geometry::{Corner, Corners, Geometry, Index, Part, at};
use super::polygon::{Outcome, Triangulator};
use crate::import::{WarningCode, Warnings};
use crate::math::{DVec3, Vec2, Vec3};
use crate::scene::{Mesh, MeshError};

/// The mesh of one part.
pub struct PartMesh {
    /// Its triangles.
    pub mesh: Mesh,
    /// Corners of its faces without texture coordinates.
    pub corners_without_uv: u64,
}

/// One mesh for each part of `geometry`, in the order of its parts.
///
/// # Errors
/// Where the lists do not fit together; [`super::blocks::read`] makes none such.
pub fn build(
    geometry: &Geometry,
    anchor: Anchor,
    warnings: &mut Warnings,
) -> Result<Vec<PartMesh>, MeshError> {
    let mut builder = Builder {
        geometry,
        anchor,
        triangulator: Triangulator::new(),
        table: VertexTable::new(geometry),
        ring: Vec::new(),
        face: Vec::new(),
        flat_polygons: 0,
        crossed_polygons: 0,
        large_polygons: 0,
        infinite_vertices: 0,
    };
    let runs = runs_by_part(geometry);
    let meshes = geometry.parts.iter().zip(&runs);
    let meshes = meshes
        .map(|(part, runs)| builder.part(*part, runs))
        .collect();
    warnings.add_many(
        WarningCode::BadFace,
        "polygons have no area",
        builder.flat_polygons,
    );
    warnings.add_many(
        WarningCode::BadFace,
        "polygons cross themselves, and their triangles overlap",
        builder.crossed_polygons,
    );
    warnings.add_many(
        WarningCode::BadFace,
        "polygons are too large to be clipped, and their triangles may overlap",
        builder.large_polygons,
    );
    warnings.add_many(
        WarningCode::NonFiniteVertex,
        "vertices are not finite numbers in single precision",
        builder.infinite_vertices,
    );
    meshes
}

fn runs_by_part(geometry: &Geometry) -> Vec<Vec<usize>> {
    let mut runs = vec![Vec::new(); geometry.parts.len()];
    for (number, run) in geometry.runs.iter().enumerate() {
        runs[run.part as usize].push(number);
    }
    runs
}

struct Builder<'a> {
    geometry: &'a Geometry,
    anchor: Anchor,
    triangulator: Triangulator,
    table: VertexTable,
    ring: Vec<DVec3>,
    /// The mesh's vertices at the corners of the face at hand.
    face: Vec<u32>,
    flat_polygons: u64,
    crossed_polygons: u64,
    large_polygons: u64,
    infinite_vertices: u64,
}

impl Builder<'_> {
    fn part(&mut self, part: Part, runs: &[usize]) -> Result<PartMesh, MeshError> {
        let geometry = self.geometry;
        let faces = || runs.iter().map(|&run| geometry.faces_of(run));
        let corners: usize = faces().map(|f| geometry.corners_of_all(f).len()).sum();
        let count = corners - 2 * faces().map(|faces| faces.len()).sum::<usize>();
        let mut triangles = Vec::with_capacity(count);
        if corners == 3 * count {
            for corners in faces().map(|faces| geometry.corners_of_all(faces)) {
                self.table
                    .triangles(&geometry.corners, corners, &mut triangles);
            }
        } else {
            for face in faces().flatten() {
                self.face.clear();
                for i in geometry.corners_of(face) {
                    self.face.push(self.table.vertex(geometry.corners.get(i)));
                }
                self.triangles_of(face, &mut triangles);
            }
        }
        let corners_without_uv = faces()
            .map(|faces| geometry.corners.without_uv(geometry.corners_of_all(faces)))
            .sum();
        let corners = self.table.take();
        let name = part.object.map_or("", |o| &geometry.objects[o as usize]);
        let mesh = self.mesh(name, &corners, triangles)?;
        Ok(PartMesh {
            mesh,
            corners_without_uv,
        })
    }

    /// Adds the triangles of face number `face`, whose vertices stand in `self.face`.
    fn triangles_of(&mut self, face: usize, triangles: &mut Vec<[u32; 3]>) {
        if let [a, b, c] = self.face[..] {
            triangles.push([a, b, c]);
            return;
        }
        let vertices = &self.geometry.corners.vertices[self.geometry.corners_of(face)];
        self.ring.clear();
        self.ring.extend(
            vertices
                .iter()
                .map(|&v| self.geometry.positions[v as usize]),
        );
        let (cut, outcome) = self.triangulator.cut(&self.ring);
        triangles.extend(cut.iter().map(|t| t.map(|i| self.face[i as usize])));
        match outcome {
            Outcome::Covered => {}
            Outcome::NoArea => self.flat_polygons += 1,
            Outcome::Overlapping => self.crossed_polygons += 1,
            Outcome::TooLarge => self.large_polygons += 1,
        }
    }

    fn mesh(
        &mut self,
        name: &str,
        corners: &[Corner],
        triangles: Vec<[u32; 3]>,
    ) -> Result<Mesh, MeshError> {
        let geometry = self.geometry;
        let position = |c: &Corner| self.anchor.local(geometry.positions[c.vertex as usize]);
        let normal = |c: &Corner| c.normal.map_or(Vec3::ZERO, |n| at(&geometry.normals, n));
        let origin = Vec2::new(0.0, 1.0);
        let uv = |c: &Corner| c.uv.map_or(origin, |uv| at(&geometry.uvs, uv));
        let color = |c: &Corner| {
            let [r, g, b] = geometry.colors[c.vertex as usize];
            [r, g, b, 1.0]
        };
        let positions = each(corners, position);
        let infinite = positions.iter().filter(|p| !p.is_finite()).count();
        self.infinite_vertices += infinite as u64;
        let mut mesh = Mesh::new(name, positions, triangles)?;
        if corners.iter().any(|c| c.normal.is_some()) {
            mesh = mesh.with_normals(each(corners, normal))?;
        }
        if corners.iter().any(|c| c.uv.is_some()) {
            mesh = mesh.with_uv_set(each(corners, uv))?;
        }
        if !geometry.colors.is_empty() {
            mesh = mesh.with_colors(each(corners, color))?;
        }
        Ok(mesh)
    }
}

/// What `value` says of each corner; on all threads where there are many.
fn each<T: Send>(corners: &[Corner], value: impl Fn(&Corner) -> T + Send + Sync) -> Vec<T> {
    /// Takes a thread some tenths of a millisecond.
    const MANY: usize = 1 << 16;
    if corners.len() < MANY {
        corners.iter().map(value).collect()
    } else {
        corners.par_iter().map(value).collect()
    }
}

/// The vertices of one mesh: every corner once that differs from the others in its position,
/// texture coordinates or normal.
struct VertexTable {
    /// Whether vertices are the file's own, in its order: where there is one part, and corners
    /// have nothing but a position.
    keeps_file_order: bool,
    corners: Vec<Corner>,
    /// By vertex of the file: the last of `corners` at it.
    heads: Vec<Option<Index>>,
    /// By corner: the one before it at the same vertex of the file.
    previous: Vec<Option<Index>>,
}

impl VertexTable {
    /// How many corners at one vertex are compared before another is added, so that the fan of
    /// a file with a million normals at one vertex does not take the square of a million steps.
    const MOST_COMPARED: usize = 64;

    fn new(geometry: &Geometry) -> Self {
        let vertices = geometry.positions.len();
        let keeps_file_order = geometry.parts.len() == 1 && geometry.corners.are_bare();
        let corners = (0..vertices as u32).map(|vertex| Corner {
            vertex,
            uv: None,
            normal: None,
        });
        Self {
            keeps_file_order,
            corners: if keeps_file_order {
                corners.collect()
            } else {
                Vec::new()
            },
            heads: if keeps_file_order {
                Vec::new()
            } else {
                vec![None; vertices]
            },
            previous: Vec::new(),
        }
    }

    /// Adds triangles whose corners are those of `range`.
    fn triangles(&mut self, corners: &Corners, range: Range<usize>, to: &mut Vec<[u32; 3]>) {
        if self.keeps_file_order {
            let (triangles, _) = corners.vertices[range].as_chunks();
            to.extend_from_slice(triangles);
        } else {
            let first = range.step_by(3);
            to.extend(first.map(|i| [i, i + 1, i + 2].map(|i| self.vertex(corners.get(i)))));
        }
    }

    /// The mesh's vertex at `corner`.
    fn vertex(&mut self, corner: Corner) -> u32 {
        if self.keeps_file_order {
            return corner.vertex;
        }
        let place = corner.vertex as usize;
        let head = self.heads[place];
        let mut next = head;
        for _ in 0..Self::MOST_COMPARED {
            let Some(index) = next else { break };
            if at(&self.corners, index) == corner {
                return index.get() - 1;
            }
            next = at(&self.previous, index);
        }
        self.corners.push(corner);
        self.previous.push(head);
        let count = self.corners.len() as u32;
        self.heads[place] = Index::new(count);
        count - 1
    }

    /// The corner of each vertex; the table is empty afterwards.
    fn take(&mut self) -> Vec<Corner> {
        for corner in &self.corners {
            if let Some(head) = self.heads.get_mut(corner.vertex as usize) {
                *head = None;
            }
        }
        self.previous.clear();
        std::mem::take(&mut self.corners)
    }
}
