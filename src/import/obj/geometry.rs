//! What the statements of an OBJ file say, as lists that are not yet meshes.

use std::num::NonZeroU32;
use std::ops::Range;

use crate::math::{DVec3, Vec2, Vec3};

/// Place in one of the file's lists. It counts from 1, as the file does, so that an
/// `Option<Index>` takes no more than four bytes.
pub type Index = NonZeroU32;

/// The element of `list` that `index` means.
pub fn at<T: Copy>(list: &[T], index: Index) -> T {
    list[index.get() as usize - 1]
}

/// The colour of vertices without one.
pub const WHITE: [f32; 3] = [1.0; 3];

/// Where a face touches a vertex.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Corner {
    /// Which position, counted from 0.
    pub vertex: u32,
    /// Which texture coordinates.
    pub uv: Option<Index>,
    /// Which normal.
    pub normal: Option<Index>,
}

/// The corners of all faces. A list of attributes is empty where no corner has one, so that a file without
/// them pays nothing.
#[derive(Debug, Default, PartialEq)]
pub struct Corners {
    /// The position of each, counted from 0.
    pub vertices: Vec<u32>,
    /// The texture coordinates of each.
    pub uvs: Vec<Option<Index>>,
    /// The normal of each.
    pub normals: Vec<Option<Index>>,
}

impl Corners {
    /// Corner number `i`, counted from 0.
    pub fn get(&self, i: usize) -> Corner {
        Corner {
            vertex: self.vertices[i],
            uv: self.uvs.get(i).copied().flatten(),
            normal: self.normals.get(i).copied().flatten(),
        }
    }

    /// Gives corner `i` a normal.
    pub fn set_normal(&mut self, i: usize, normal: Index) {
        self.normals.resize(self.vertices.len(), None);
        self.normals[i] = Some(normal);
    }

    /// Takes away every index of texture coordinates above `uvs` and of normals above
    /// `normals`; how many those were.
    pub fn drop_above(&mut self, uvs: usize, normals: usize) -> [u64; 2] {
        [
            drop_above(&mut self.uvs, uvs),
            drop_above(&mut self.normals, normals),
        ]
    }

    /// How many of the corners in `range` have no texture coordinates.
    pub fn without_uv(&self, range: Range<usize>) -> u64 {
        let with = self.uvs.get(range.clone()).unwrap_or_default();
        let with = with.iter().filter(|uv| uv.is_some()).count();
        (range.len() - with) as u64
    }

    /// Whether every corner has a normal.
    pub fn all_have_normals(&self) -> bool {
        !self.normals.is_empty() && self.normals.iter().all(Option::is_some)
    }

    /// Whether no corner has texture coordinates or a normal.
    pub fn are_bare(&self) -> bool {
        self.uvs.is_empty() && self.normals.is_empty()
    }
}

fn drop_above(list: &mut [Option<Index>], limit: usize) -> u64 {
    let mut dropped = 0;
    for slot in list {
        if slot.is_some_and(|index| index.get() as usize > limit) {
            *slot = None;
            dropped += 1;
        }
    }
    dropped
}

/// Consecutive faces of one part and one smoothing group.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Run {
    /// Its first face; it ends where the next run starts.
    pub first_face: u32,
    /// Its part, an index into [`Geometry::parts`].
    pub part: u32,
    /// Its smoothing group; 0: none.
    pub smoothing: u32,
}

/// Faces that become one mesh: those of one object and one material.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Part {
    /// Its object, an index into [`Geometry::objects`]; `None` before the first `o`.
    pub object: Option<u32>,
    /// Its material, an index into [`Geometry::materials`]; `None` before the first `usemtl`.
    pub material: Option<u32>,
}

/// The lists of an OBJ file. Every corner's vertex is one of `positions`; its texture
/// coordinates and normal are in their lists after [`Corners::drop_above`].
#[derive(Debug, Default, PartialEq)]
pub struct Geometry {
    /// `v`, as written.
    pub positions: Vec<DVec3>,
    /// Colours behind `v`, linear; empty where no vertex has one.
    pub colors: Vec<[f32; 3]>,
    /// `vt`, with v turned to grow downwards.
    pub uvs: Vec<Vec2>,
    /// `vn`, as written, and behind them those that were computed.
    pub normals: Vec<Vec3>,
    /// The corners of all faces, one face after the other.
    pub corners: Corners,
    /// Where each face's corners end.
    pub face_ends: Vec<u32>,
    /// The faces by part and smoothing group.
    pub runs: Vec<Run>,
    /// What the faces are split into, in the order of their first faces.
    pub parts: Vec<Part>,
    /// Names of objects with faces.
    pub objects: Vec<String>,
    /// Names of materials with faces.
    pub materials: Vec<String>,
    /// Files of materials, in order.
    pub libraries: Vec<String>,
}

impl Geometry {
    /// The corners of face `face`.
    pub fn corners_of(&self, face: usize) -> Range<usize> {
        self.corners_of_all(face..face + 1)
    }

    /// The corners of consecutive faces.
    pub fn corners_of_all(&self, faces: Range<usize>) -> Range<usize> {
        let end_before = |face: usize| match face {
            0 => 0,
            _ => self.face_ends[face - 1] as usize,
        };
        end_before(faces.start)..end_before(faces.end)
    }

    /// The faces of run number `run`.
    pub fn faces_of(&self, run: usize) -> Range<usize> {
        let next = self.runs.get(run + 1);
        let end = next.map_or(self.face_ends.len(), |r| r.first_face as usize);
        self.runs[run].first_face as usize..end
    }
}
