//! Room for what each block of a file adds to the lists of the whole.

use super::geometry::{Corner, Corners, Geometry, Index};
use super::lines::Lines;
use crate::math::{DVec3, Vec2, Vec3};

/// What a file has before one of its blocks, or what one adds to that.
#[derive(Clone, Copy, Default)]
pub struct Start {
    /// Physical lines.
    pub lines: usize,
    /// `v`
    pub positions: usize,
    /// `vt`
    pub uvs: usize,
    /// `vn`
    pub normals: usize,
    /// Faces, without those of fewer than three corners.
    pub faces: usize,
    /// Their corners.
    pub corners: usize,
}

impl Start {
    /// What `lines` add to what is before them.
    pub fn count(mut lines: Lines<'_>) -> Self {
        let mut count = Self::default();
        lines = lines.behind(0);
        for line in lines.by_ref() {
            let mut words = line.words();
            match words.next() {
                Some(b"v") => count.positions += 1,
                Some(b"vt") => count.uvs += 1,
                Some(b"vn") => count.normals += 1,
                Some(b"f" | b"fo") => {
                    let corners = words.count_left();
                    if corners >= 3 {
                        count.faces += 1;
                        count.corners += corners;
                    }
                }
                _ => {}
            }
        }
        count.lines = lines.count_so_far();
        count
    }

    /// This and `other` together.
    pub fn and(self, other: Self) -> Self {
        Self {
            lines: self.lines + other.lines,
            positions: self.positions + other.positions,
            uvs: self.uvs + other.uvs,
            normals: self.normals + other.normals,
            faces: self.faces + other.faces,
            corners: self.corners + other.corners,
        }
    }
}

/// The part of a list that one block fills.
pub struct Slots<'a, T> {
    slots: &'a mut [T],
    count: usize,
}

impl<'a, T> Slots<'a, T> {
    /// Takes the first `count` elements from `rest`.
    fn split_off(rest: &mut &'a mut [T], count: usize) -> Self {
        let (slots, others) = std::mem::take(rest).split_at_mut(count);
        *rest = others;
        Self { slots, count: 0 }
    }

    /// Fills the next one.
    pub fn push(&mut self, value: T) {
        self.slots[self.count] = value;
        self.count += 1;
    }

    /// How many are filled.
    pub fn count(&self) -> usize {
        self.count
    }
}

/// The part of [`Corners`] that one block fills.
pub struct CornerSlots<'a> {
    vertices: Slots<'a, u32>,
    uvs: &'a mut [Option<Index>],
    normals: &'a mut [Option<Index>],
}

impl CornerSlots<'_> {
    /// Fills the next one. Memory of attributes that are not there is not touched.
    pub fn push(&mut self, corner: &Corner) {
        let place = self.vertices.count();
        self.vertices.push(corner.vertex);
        if corner.uv.is_some() {
            self.uvs[place] = corner.uv;
        }
        if corner.normal.is_some() {
            self.normals[place] = corner.normal;
        }
    }

    /// How many are filled.
    pub fn count(&self) -> usize {
        self.vertices.count()
    }
}

/// The parts of [`Geometry`] that one block fills.
pub struct Room<'a> {
    /// Of [`Geometry::positions`].
    pub positions: Slots<'a, DVec3>,
    /// Of [`Geometry::uvs`].
    pub uvs: Slots<'a, Vec2>,
    /// Of [`Geometry::normals`].
    pub normals: Slots<'a, Vec3>,
    /// Of [`Geometry::corners`].
    pub corners: CornerSlots<'a>,
    /// Of [`Geometry::face_ends`].
    pub face_ends: Slots<'a, u32>,
}

/// Lists as long as `total` says, of zeros, which take memory once they are written.
pub fn lists(total: &Start) -> Geometry {
    use bytemuck::zeroed_vec;
    Geometry {
        positions: zeroed_vec(total.positions),
        uvs: zeroed_vec(total.uvs),
        normals: zeroed_vec(total.normals),
        corners: Corners {
            vertices: zeroed_vec(total.corners),
            uvs: zeroed_vec(total.corners),
            normals: zeroed_vec(total.corners),
        },
        face_ends: zeroed_vec(total.faces),
        ..Geometry::default()
    }
}

/// The room in `lists` of blocks that add what `counts` say.
pub fn rooms<'a>(lists: &'a mut Geometry, counts: &[Start]) -> Vec<Room<'a>> {
    let mut positions = lists.positions.as_mut_slice();
    let mut uvs = lists.uvs.as_mut_slice();
    let mut normals = lists.normals.as_mut_slice();
    let mut vertices = lists.corners.vertices.as_mut_slice();
    let mut corner_uvs = lists.corners.uvs.as_mut_slice();
    let mut corner_normals = lists.corners.normals.as_mut_slice();
    let mut face_ends = lists.face_ends.as_mut_slice();
    let room = |count: &Start| Room {
        positions: Slots::split_off(&mut positions, count.positions),
        uvs: Slots::split_off(&mut uvs, count.uvs),
        normals: Slots::split_off(&mut normals, count.normals),
        corners: CornerSlots {
            vertices: Slots::split_off(&mut vertices, count.corners),
            uvs: Slots::split_off(&mut corner_uvs, count.corners).slots,
            normals: Slots::split_off(&mut corner_normals, count.corners).slots,
        },
        face_ends: Slots::split_off(&mut face_ends, count.faces),
    };
    counts.iter().map(room).collect()
}
