//! Mode 1: triangles, most of which share an edge with one before them.

use super::Fault;
use super::reader::Reader;

/// The last 16 of what was pushed.
struct Recent<T> {
    entries: [Option<T>; 16],
    pushed: usize,
}

impl<T: Copy> Recent<T> {
    fn new() -> Self {
        Self {
            entries: [None; 16],
            pushed: 0,
        }
    }

    fn push(&mut self, entry: T) {
        self.entries[self.pushed % 16] = Some(entry);
        self.pushed += 1;
    }

    /// The one that was pushed `age` pushes before the last, `age` below 16.
    fn get(&self, age: u8) -> Result<T, Fault> {
        let place = self.pushed.wrapping_sub(1 + usize::from(age)) % 16;
        self.entries[place].ok_or("it refers to what is not there")
    }
}

/// What is remembered from triangle to triangle.
struct Decoder<'a> {
    data: Reader<'a>,
    /// The next vertex that no triangle has had.
    next: u32,
    /// The last vertex that was written out.
    last: u32,
    edges: Recent<(u32, u32)>,
    vertices: Recent<u32>,
}

/// `count` corners, a multiple of 3.
pub fn decode(stream: &[u8], count: usize) -> Result<Vec<u32>, Fault> {
    let (header, mut data, table) = Reader::split(stream, 16)?;
    if header != 0xe1 {
        return Err("it is of a version that is not known");
    }
    if table[14..] != [0, 0] || table.iter().any(|b| b & 15 == 15 || b >> 4 == 15) {
        return Err("its table has entries that it must not have");
    }
    let codes = data.take(count / 3)?;
    let mut decoder = Decoder {
        data,
        next: 0,
        last: 0,
        edges: Recent::new(),
        vertices: Recent::new(),
    };
    let mut corners = Vec::with_capacity(count);
    for &code in codes {
        corners.extend(decoder.triangle(code, table)?);
    }
    decoder.data.finish()?;
    Ok(corners)
}

impl Decoder<'_> {
    fn triangle(&mut self, code: u8, table: &[u8]) -> Result<[u32; 3], Fault> {
        let (high, low) = (code >> 4, code & 15);
        if high < 15 {
            return self.on_edge(high, low);
        }
        let first_is_next = low != 15;
        let corners = match low {
            0..14 => table[usize::from(low)],
            _ => self.data.byte()?,
        };
        // In the table, too, no corners but new ones mean new ones: only here they start anew.
        if low >= 14 && corners == 0 {
            self.next = 0;
        }
        let a = match first_is_next {
            true => self.take_next(),
            false => self.written()?,
        };
        let (b, b_is_new) = self.corner(corners >> 4)?;
        let (c, c_is_new) = self.corner(corners & 15)?;
        self.edges.push((b, a));
        self.edges.push((c, b));
        self.edges.push((a, c));
        self.vertices.push(a);
        for (vertex, is_new) in [(b, b_is_new), (c, c_is_new)] {
            if is_new {
                self.vertices.push(vertex);
            }
        }
        Ok([a, b, c])
    }

    /// A triangle on the edge of age `edge`.
    fn on_edge(&mut self, edge: u8, corner: u8) -> Result<[u32; 3], Fault> {
        let (a, b) = self.edges.get(edge)?;
        let (c, is_new) = match corner {
            0 => (self.take_next(), true),
            13 | 14 => {
                let step = if corner == 13 { u32::MAX } else { 1 };
                self.last = self.last.wrapping_add(step);
                (self.last, true)
            }
            15 => (self.written()?, true),
            _ => (self.vertices.get(corner)?, false),
        };
        self.edges.push((c, b));
        self.edges.push((a, c));
        if is_new {
            self.vertices.push(c);
        }
        Ok([a, b, c])
    }

    /// A corner by its four bits, and whether it is not one of the recent ones.
    fn corner(&mut self, code: u8) -> Result<(u32, bool), Fault> {
        match code {
            0 => Ok((self.take_next(), true)),
            15 => Ok((self.written()?, true)),
            _ => Ok((self.vertices.get(code - 1)?, false)),
        }
    }

    fn take_next(&mut self) -> u32 {
        let vertex = self.next;
        self.next = vertex.wrapping_add(1);
        vertex
    }

    /// A vertex that is written out, as its distance from the last such.
    fn written(&mut self) -> Result<u32, Fault> {
        let value = self.data.variable_integer()?;
        let delta = (value >> 1) ^ (value & 1).wrapping_neg();
        self.last = self.last.wrapping_add(delta);
        Ok(self.last)
    }
}
