//! What the statements of an OBJ file say, as lists that are not yet meshes.

use std::num::NonZeroU32;

use super::lines::LineError;
use crate::math::{DVec3, Vec2, Vec3};

/// Place in one of the file's lists. It counts from 1, as the file does, so that an
/// `Option<Index>` takes no more than four bytes.
pub type Index = NonZeroU32;

/// The element of `list` that `index` means.
pub fn at<T: Copy>(list: &[T], index: Index) -> T {
    list[index.get() as usize - 1]
}

/// Where a face touches a vertex.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Corner {
    /// Which position.
    pub vertex: Index,
    /// Which texture coordinates.
    pub uv: Option<Index>,
    /// Which normal.
    pub normal: Option<Index>,
}

/// The corners of all faces. Lists of attributes are as long as the last corner that has one, so
/// that a file without them pays nothing.
#[derive(Default)]
pub struct Corners {
    vertices: Vec<Index>,
    uvs: Vec<Option<Index>>,
    normals: Vec<Option<Index>>,
}

impl Corners {
    /// How many there are.
    pub fn len(&self) -> usize {
        self.vertices.len()
    }

    /// Adds one at the end.
    pub fn push(&mut self, corner: Corner) {
        let place = self.len();
        self.vertices.push(corner.vertex);
        set(&mut self.uvs, place, corner.uv);
        set(&mut self.normals, place, corner.normal);
    }

    /// Corner number `i`, counted from 0.
    pub fn get(&self, i: usize) -> Corner {
        Corner {
            vertex: self.vertices[i],
            uv: self.uvs.get(i).copied().flatten(),
            normal: self.normals.get(i).copied().flatten(),
        }
    }

    /// The vertices of all corners.
    pub fn vertices(&self) -> &[Index] {
        &self.vertices
    }

    /// Gives corner `i` a normal.
    pub fn set_normal(&mut self, i: usize, normal: Index) {
        set(&mut self.normals, i, Some(normal));
    }

    /// Takes away every index of texture coordinates above `uvs` and of normals above
    /// `normals`; how many those were.
    pub fn drop_above(&mut self, uvs: usize, normals: usize) -> [u64; 2] {
        [
            drop_above(&mut self.uvs, uvs),
            drop_above(&mut self.normals, normals),
        ]
    }

    /// Whether no corner has texture coordinates or a normal.
    pub fn are_bare(&self) -> bool {
        self.uvs.is_empty() && self.normals.is_empty()
    }
}

fn set(list: &mut Vec<Option<Index>>, place: usize, value: Option<Index>) {
    if value.is_some() {
        if list.len() <= place {
            list.resize(place + 1, None);
        }
        list[place] = value;
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
#[derive(Default)]
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
    /// Adds the colour of the vertex that comes next. Others are white once one vertex has a colour.
    pub fn add_color(&mut self, color: Option<[f32; 3]>) {
        if color.is_some() {
            self.colors.resize(self.positions.len(), WHITE);
        }
        if color.is_some() || !self.colors.is_empty() {
            self.colors.push(color.unwrap_or(WHITE));
        }
    }

    /// The lists of a file from those of its `blocks`, in order, which have no parts, runs and names yet.
    ///
    /// # Errors
    /// Where faces have more corners than can be counted.
    pub fn join(mut blocks: Vec<Self>) -> Result<Self, LineError> {
        let corners: usize = blocks.iter().map(|block| block.corners.len()).sum();
        if u32::try_from(corners).is_err() {
            return Err(LineError {
                line: None,
                what: format!("it has more than {} corners of faces", u32::MAX),
            });
        }
        if blocks.len() == 1
            && let Some(block) = blocks.pop()
        {
            return Ok(block);
        }
        let [mut vertices, mut corners] = [0, 0];
        let mut lists = Lists::default();
        for block in blocks {
            let faces = block.face_ends.into_iter();
            lists.face_ends.push(faces.map(|end| end + corners as u32).collect());
            lists.colors.push((vertices, block.colors));
            vertices += block.positions.len();
            lists.positions.push(block.positions);
            lists.uvs.push(block.uvs);
            lists.normals.push(block.normals);
            lists.corner_uvs.push((corners, block.corners.uvs));
            lists.corner_normals.push((corners, block.corners.normals));
            corners += block.corners.vertices.len();
            lists.corners.push(block.corners.vertices);
            lists.libraries.extend(block.libraries);
        }
        Ok(lists.join(vertices))
    }

    /// The corners of face `face`.
    pub fn corners_of(&self, face: usize) -> std::ops::Range<usize> {
        let start = if face == 0 {
            0
        } else {
            self.face_ends[face - 1]
        };
        start as usize..self.face_ends[face] as usize
    }

    /// The faces of run number `run`.
    pub fn faces_of(&self, run: usize) -> std::ops::Range<usize> {
        let next = self.runs.get(run + 1);
        let end = next.map_or(self.face_ends.len(), |r| r.first_face as usize);
        self.runs[run].first_face as usize..end
    }
}

const WHITE: [f32; 3] = [1.0; 3];

/// The lists of all blocks of a file, kind by kind; some with the place of each block's first element.
#[derive(Default)]
struct Lists {
    positions: Vec<Vec<DVec3>>,
    colors: Vec<(usize, Vec<[f32; 3]>)>,
    uvs: Vec<Vec<Vec2>>,
    normals: Vec<Vec<Vec3>>,
    corners: Vec<Vec<Index>>,
    corner_uvs: Vec<(usize, Vec<Option<Index>>)>,
    corner_normals: Vec<(usize, Vec<Option<Index>>)>,
    face_ends: Vec<Vec<u32>>,
    libraries: Vec<String>,
}

impl Lists {
    /// The lists of the file, which has `vertices` vertices.
    fn join(self, vertices: usize) -> Geometry {
        let mut geometry = Geometry {
            libraries: self.libraries,
            ..Geometry::default()
        };
        let Geometry {
            positions,
            colors,
            uvs,
            normals,
            corners,
            face_ends,
            ..
        } = &mut geometry;
        rayon::scope(|scope| {
            scope.spawn(|_| *positions = self.positions.concat());
            scope.spawn(|_| corners.vertices = self.corners.concat());
            scope.spawn(|_| corners.uvs = concat_with_gaps(self.corner_uvs, None));
            scope.spawn(|_| corners.normals = concat_with_gaps(self.corner_normals, None));
            scope.spawn(|_| *normals = self.normals.concat());
            scope.spawn(|_| *uvs = self.uvs.concat());
            scope.spawn(|_| *face_ends = self.face_ends.concat());
            scope.spawn(|_| {
                *colors = concat_with_gaps(self.colors, WHITE);
                if !colors.is_empty() {
                    colors.resize(vertices, WHITE);
                }
            });
        });
        geometry
    }
}

/// One list that has each of `lists` at its place, and `gap` in between; it ends with the last that is not empty.
fn concat_with_gaps<T: Copy>(lists: Vec<(usize, Vec<T>)>, gap: T) -> Vec<T> {
    let ends = lists.iter().filter(|(_, list)| !list.is_empty());
    let total = ends.map(|(start, list)| start + list.len()).max();
    let mut joined = Vec::with_capacity(total.unwrap_or(0));
    for (start, list) in lists {
        if !list.is_empty() {
            joined.resize(start, gap);
            joined.extend_from_slice(&list);
        }
    }
    joined
}
