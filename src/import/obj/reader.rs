//! The statements of a block of an OBJ file to lists.

use std::mem::discriminant;

use super::geometry::{Corner, WHITE};
use super::lines::{Line, LineError, Lines, Words, number, shown};
use super::names::{library_names, name_of};
use super::notes::Notes;
use super::references::{message, usual_place};
use super::room::{Room, Start};
use super::runs::{Change, Setting};
use crate::math::{DVec3, Vec2};

/// What the statements of a block say, beside what they put into the lists of the file.
#[derive(Default)]
pub struct Block {
    /// What its statements change for the faces behind them, in order.
    pub changes: Vec<Change>,
    /// Colours of its vertices, linear; empty where none has one, else at least up to the last that has.
    pub colors: Vec<[f32; 3]>,
    /// Files of materials.
    pub libraries: Vec<String>,
    /// What is to be judged at the end of the file.
    pub notes: Notes,
    /// Whether a corner of its faces has texture coordinates.
    pub has_uvs: bool,
    /// Whether a corner of its faces has a normal.
    pub has_normals: bool,
}

/// Reads the statements of `lines`, which are those behind `start`, into `room`, which is as large as
/// [`Start::count`] says of them.
///
/// # Errors
/// Where a statement that the picture depends on is not what the format demands.
pub fn read(lines: Lines<'_>, start: Start, room: Room<'_>) -> Result<Block, LineError> {
    let mut reader = Reader {
        start,
        room,
        block: Block::default(),
        face: Vec::new(),
    };
    for line in lines.behind(start.lines) {
        reader.statement(&line).map_err(|what| LineError {
            line: Some(line.number),
            what,
        })?;
    }
    Ok(reader.block)
}

struct Reader<'a> {
    start: Start,
    room: Room<'a>,
    block: Block,
    /// The corners of the face at hand.
    face: Vec<Corner>,
}

impl Reader<'_> {
    fn statement(&mut self, line: &Line<'_>) -> Result<(), String> {
        let mut words = line.words();
        let Some(keyword) = words.next() else {
            return Ok(());
        };
        let notes = &mut self.block.notes;
        notes.has_statements = true;
        match keyword {
            b"v" => self.vertex(words)?,
            b"vt" => self.uv(words)?,
            b"vn" => self.normal(words)?,
            b"f" | b"fo" => self.face(words, line.number)?,
            b"p" => notes.skipped.points += words.count() as u64,
            b"l" => notes.skipped.lines += 1,
            b"s" => self.change(Setting::Smoothing(smoothing(words)?)),
            b"o" => self.change(Setting::Object(name_of(&line.text).into())),
            b"usemtl" => self.change(Setting::Material(name_of(&line.text).into())),
            b"mtllib" => {
                let names = library_names(name_of(&line.text));
                self.block.libraries.extend(names);
            }
            // Groups are other names for faces; they are merged.
            b"g" => {}
            _ => notes.skipped.statement(keyword)?,
        }
        Ok(())
    }

    fn change(&mut self, to: Setting) {
        let face = self.room.face_ends.count();
        let kind = discriminant(&to);
        // What no face has used is as if it had never been said: a face has one change of each of three kinds at most.
        let changes = &mut self.block.changes;
        let is_unused = |change: &Change| change.face == face && discriminant(&change.to) == kind;
        let mut recent = changes.len().saturating_sub(3)..changes.len();
        if let Some(at) = recent.find(|&at| is_unused(&changes[at])) {
            changes.remove(at);
        }
        changes.push(Change { face, to });
    }

    fn vertex(&mut self, mut words: Words<'_>) -> Result<(), String> {
        let position = numbers::<3>("a vertex", &mut words)?;
        // Behind x y z: nothing, a weight, a colour, or a colour and one number more.
        let mut surplus = [0.0; 4];
        let mut count = 0;
        for word in words {
            if count < surplus.len() {
                surplus[count] = number(word).ok_or_else(|| not_a_number("a vertex", word))?;
            }
            count += 1;
        }
        let [r, g, b, _] = surplus.map(|v| v as f32);
        let color = Some([r, g, b]).filter(|c| count >= 3 && c.iter().all(|v| v.is_finite()));
        if count == 2 || count > 3 || (count == 3 && color.is_none()) {
            self.block.notes.skipped.surplus_numbers += 1;
        }
        if color.is_some() || !self.block.colors.is_empty() {
            let place = self.room.positions.count();
            self.block.colors.resize(place, WHITE);
            self.block.colors.push(color.unwrap_or(WHITE));
        }
        self.room.positions.push(DVec3::from_array(position));
        Ok(())
    }

    fn uv(&mut self, mut words: Words<'_>) -> Result<(), String> {
        const WHAT: &str = "a texture coordinate";
        let [u] = numbers::<1>(WHAT, &mut words)?;
        let v = words.number().unwrap_or(Ok(0.0));
        let v = v.map_err(|word| not_a_number(WHAT, word))?;
        let uv = Vec2::new(u as f32, (1.0 - v) as f32);
        self.room.uvs.push(uv);
        Ok(())
    }

    fn normal(&mut self, mut words: Words<'_>) -> Result<(), String> {
        let normal = DVec3::from_array(numbers::<3>("a normal", &mut words)?);
        self.room.normals.push(normal.as_vec3());
        Ok(())
    }

    fn face(&mut self, mut words: Words<'_>, line: usize) -> Result<(), String> {
        self.face.clear();
        while let Some(corner) = self.next_corner(&mut words, line)? {
            self.face.push(corner);
        }
        if self.face.len() < 3 {
            self.block.notes.skipped.small_faces += 1;
            return Ok(());
        }
        for corner in &self.face {
            self.block.has_uvs |= corner.uv.is_some();
            self.block.has_normals |= corner.normal.is_some();
            self.room.corners.push(corner);
        }
        let end = self.start.corners + self.room.corners.count();
        self.room.face_ends.push(end as u32);
        Ok(())
    }

    fn next_corner(
        &mut self,
        words: &mut Words<'_>,
        line: usize,
    ) -> Result<Option<Corner>, String> {
        if let Some(corner) = words.take_with(|text| self.usual_corner(text)) {
            return Ok(Some(corner));
        }
        words.next().map(|word| self.corner(word, line)).transpose()
    }

    /// The corner at the start of `text`, and its bytes, where it uses what there is already.
    fn usual_corner(&self, text: &[u8]) -> Option<(Corner, usize)> {
        let [positions, uvs, normals] = self.counts();
        let mut at = 0;
        let vertex = usual_place(text, &mut at, positions)??;
        let (mut uv, mut normal) = (None, None);
        if text.get(at) == Some(&b'/') {
            at += 1;
            uv = usual_place(text, &mut at, uvs)?;
            if text.get(at) == Some(&b'/') {
                at += 1;
                normal = usual_place(text, &mut at, normals)?;
            }
        }
        let corner = Corner {
            vertex: vertex.get() - 1,
            uv,
            normal,
        };
        Some((corner, at))
    }

    fn corner(&mut self, word: &[u8], line: usize) -> Result<Corner, String> {
        let mut parts = word.splitn(3, |&b| b == b'/');
        let mut part = || parts.next().unwrap_or(b"");
        let (vertex, uv, normal) = (part(), part(), part());
        let [positions, uvs, normals] = self.counts();
        let notes = &mut self.block.notes;
        let vertex = notes
            .vertices
            .resolve(vertex, positions, line)
            .map_err(|problem| message(&problem, vertex, "vertex", positions))?;
        Ok(Corner {
            vertex: vertex.get() - 1,
            uv: notes.uvs.resolve(uv, uvs, line)?,
            normal: notes.normals.resolve(normal, normals, line)?,
        })
    }

    /// How many positions, texture coordinates and normals the file has so far.
    fn counts(&self) -> [usize; 3] {
        [
            self.start.positions + self.room.positions.count(),
            self.start.uvs + self.room.uvs.count(),
            self.start.normals + self.room.normals.count(),
        ]
    }
}

fn smoothing(mut words: Words<'_>) -> Result<u32, String> {
    match words.next() {
        None | Some(b"off") => Ok(0),
        Some(b"on") => Ok(1),
        Some(word) => std::str::from_utf8(word)
            .ok()
            .and_then(|w| w.parse().ok())
            .ok_or_else(|| format!("\"{}\" is not a smoothing group", shown(word))),
    }
}

/// The next `N` numbers of the statement that `what` names.
fn numbers<const N: usize>(what: &str, words: &mut Words<'_>) -> Result<[f64; N], String> {
    let mut values = [0.0; N];
    for (i, value) in values.iter_mut().enumerate() {
        let number = words
            .number()
            .ok_or_else(|| format!("{what} needs {N} numbers, and has {i}"))?;
        *value = number.map_err(|word| not_a_number(what, word))?;
    }
    Ok(values)
}

fn not_a_number(what: &str, word: &[u8]) -> String {
    format!("{what} has \"{}\", which is not a number", shown(word))
}
