//! A file in blocks that are read at the same time, and joined in their order.
//!
//! What the statements of a block mean depends on those before it in three ways. How many elements
//! and lines there are is counted beforehand; objects, materials and smoothing groups are put together
//! by [`Runs`] afterwards; and so are the indices that can only be judged at the end. So the result does
//! not depend on where the file is cut.

use rayon::prelude::*;

use super::geometry::Geometry;
use super::lines::{LineError, Lines, Words};
use super::notes::Notes;
use super::reader::{self, Block};
use super::runs::Runs;
use crate::import::Warnings;

/// Bytes of a block: some milliseconds of work. A file of one block needs no other thread.
const BLOCK: usize = 1 << 20;

/// What a file has before one of its blocks.
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
}

/// Reads a whole file.
///
/// # Errors
/// Where a statement that the picture depends on is not what the format demands: the first such.
pub fn read(bytes: &[u8]) -> Result<(Geometry, Warnings), LineError> {
    read_by(bytes, BLOCK)
}

fn read_by(bytes: &[u8], size: usize) -> Result<(Geometry, Warnings), LineError> {
    let mut parts = Lines::new(bytes).split(size);
    if parts.len() == 1
        && let Some(lines) = parts.pop()
    {
        return join(vec![reader::read(lines, Start::default())?]);
    }
    let counts: Vec<Start> = parts.par_iter().map(|lines| count(lines.clone())).collect();
    let starts = counts.iter().scan(Start::default(), |before, count| {
        let start = *before;
        *before = before.and(count);
        Some(start)
    });
    let parts: Vec<(Lines<'_>, Start)> = parts.into_iter().zip(starts).collect();
    let blocks: Vec<_> = parts
        .into_par_iter()
        .map(|(lines, start)| reader::read(lines, start))
        .collect();
    join(blocks.into_iter().collect::<Result<_, _>>()?)
}

/// What `lines` add to what is before them.
fn count(mut lines: Lines<'_>) -> Start {
    let mut count = Start::default();
    for line in lines.by_ref() {
        match Words::of_numbers(&line.text).next() {
            Some(b"v") => count.positions += 1,
            Some(b"vt") => count.uvs += 1,
            Some(b"vn") => count.normals += 1,
            _ => {}
        }
    }
    count.lines = lines.count_so_far();
    count
}

impl Start {
    fn and(self, other: &Self) -> Self {
        Self {
            lines: self.lines + other.lines,
            positions: self.positions + other.positions,
            uvs: self.uvs + other.uvs,
            normals: self.normals + other.normals,
        }
    }
}

/// The whole file that `blocks` are.
fn join(blocks: Vec<Block<'_>>) -> Result<(Geometry, Warnings), LineError> {
    let mut runs = Runs::default();
    let mut notes = Notes::default();
    let mut lists = Vec::with_capacity(blocks.len());
    for block in blocks {
        runs.add(&block.changes, block.lists.face_ends.len());
        notes.append(block.notes);
        lists.push(block.lists);
    }
    let mut geometry = Geometry::join(lists)?;
    runs.finish(&mut geometry);
    let warnings = notes.finish(&mut geometry)?;
    Ok((geometry, warnings))
}
