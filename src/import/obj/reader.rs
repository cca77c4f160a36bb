//! The statements of an OBJ file to [`Geometry`].

use std::collections::{BTreeMap, HashMap};

use super::geometry::{Corner, Geometry, Part, Run};
use super::lines::{Line, Lines, Words, number, shown};
use super::names::{Names, library_names};
use super::references::{Attributes, BadIndex, References, message};
use crate::import::{WarningCode, Warnings};
use crate::math::{DVec3, Vec2};

/// What is wrong with a file, and on which line.
#[derive(Debug, PartialEq, Eq)]
pub struct LineError {
    /// Counted from 1; `None` where it is the file as a whole.
    pub line: Option<usize>,
    /// What is wrong.
    pub what: String,
}

/// Statements of free-form geometry.
const FREE_FORM: [&str; 17] = [
    "vp", "cstype", "deg", "bmat", "step", "curv", "curv2", "surf", "parm", "trim", "hole", "scrv",
    "sp", "end", "con", "bzp", "bsp",
];

/// Reads a whole file.
///
/// # Errors
/// Where a statement that the picture depends on is not what the format demands.
pub fn read(bytes: &[u8]) -> Result<(Geometry, Warnings), LineError> {
    let mut reader = Reader {
        geometry: Geometry::default(),
        objects: Names::default(),
        materials: Names::default(),
        smoothing: 0,
        part_ids: HashMap::new(),
        vertices: References::default(),
        uvs: Attributes::new("texture coordinate"),
        normals: Attributes::new("normal"),
        skipped: Skipped::default(),
        has_statements: false,
    };
    for line in Lines::new(bytes) {
        reader.statement(&line).map_err(|what| LineError {
            line: Some(line.number),
            what,
        })?;
    }
    reader.finish()
}

struct Reader {
    geometry: Geometry,
    objects: Names,
    materials: Names,
    smoothing: u32,
    part_ids: HashMap<Part, u32>,
    vertices: References,
    uvs: Attributes,
    normals: Attributes,
    skipped: Skipped,
    has_statements: bool,
}

/// How often something was passed over.
#[derive(Default)]
struct Skipped {
    points: u64,
    lines: u64,
    small_faces: u64,
    surplus_numbers: u64,
    statements: BTreeMap<String, u64>,
}

impl Reader {
    fn statement(&mut self, line: &Line<'_>) -> Result<(), String> {
        let mut words = Words::of_numbers(&line.text);
        let Some(keyword) = words.next() else {
            return Ok(());
        };
        self.has_statements = true;
        match keyword {
            b"v" => self.vertex(words)?,
            b"vt" => self.uv(words)?,
            b"vn" => self.normal(words)?,
            b"f" | b"fo" => self.face(words, line.number)?,
            b"p" => self.skipped.points += words.count() as u64,
            b"l" => self.skipped.lines += 1,
            b"s" => self.smoothing(words)?,
            b"o" => self.objects.select(name_of(line)),
            b"usemtl" => self.materials.select(name_of(line)),
            b"mtllib" => self.geometry.libraries.extend(library_names(name_of(line))),
            // Groups are other names for faces; they are merged.
            b"g" => {}
            _ => self.other(keyword)?,
        }
        Ok(())
    }

    fn vertex(&mut self, mut words: Words<'_>) -> Result<(), String> {
        let position = numbers::<3>("a vertex", &mut words)?;
        // Behind x y z: nothing, a weight, a colour, or a colour and one number more.
        let mut surplus = [0.0; 4];
        let mut count = 0;
        for word in words {
            if count < surplus.len() {
                surplus[count] = parsed("a vertex", word)?;
            }
            count += 1;
        }
        let [r, g, b, _] = surplus.map(|v| v as f32);
        let color = Some([r, g, b]).filter(|c| count >= 3 && c.iter().all(|v| v.is_finite()));
        if count == 2 || count > 3 || (count == 3 && color.is_none()) {
            self.skipped.surplus_numbers += 1;
        }
        self.color(color);
        self.geometry.positions.push(DVec3::from_array(position));
        Ok(())
    }

    /// The colour of the vertex that comes next; others are white once one vertex has a colour.
    fn color(&mut self, color: Option<[f32; 3]>) {
        const WHITE: [f32; 3] = [1.0; 3];
        let colors = &mut self.geometry.colors;
        if color.is_some() {
            colors.resize(self.geometry.positions.len(), WHITE);
        }
        if color.is_some() || !colors.is_empty() {
            colors.push(color.unwrap_or(WHITE));
        }
    }

    fn uv(&mut self, mut words: Words<'_>) -> Result<(), String> {
        let [u] = numbers::<1>("a texture coordinate", &mut words)?;
        let v = words
            .next()
            .map_or(Ok(0.0), |w| parsed("a texture coordinate", w))?;
        self.geometry
            .uvs
            .push(Vec2::new(u as f32, (1.0 - v) as f32));
        Ok(())
    }

    fn normal(&mut self, mut words: Words<'_>) -> Result<(), String> {
        let normal = numbers::<3>("a normal", &mut words)?;
        self.geometry
            .normals
            .push(DVec3::from_array(normal).as_vec3());
        Ok(())
    }

    fn smoothing(&mut self, mut words: Words<'_>) -> Result<(), String> {
        self.smoothing = match words.next() {
            None | Some(b"off") => 0,
            Some(b"on") => 1,
            Some(word) => std::str::from_utf8(word)
                .ok()
                .and_then(|w| w.parse().ok())
                .ok_or_else(|| format!("\"{}\" is not a smoothing group", shown(word)))?,
        };
        Ok(())
    }

    fn face(&mut self, words: Words<'_>, line: usize) -> Result<(), String> {
        let start = self.geometry.corners.len();
        for word in words {
            let corner = self.corner(word, line)?;
            self.geometry.corners.push(corner);
        }
        let end = self.geometry.corners.len();
        if end - start < 3 {
            self.skipped.small_faces += 1;
            self.geometry.corners.truncate(start);
            return Ok(());
        }
        let end =
            u32::try_from(end).map_err(|_| format!("more than {} corners of faces", u32::MAX))?;
        self.start_run_where_needed();
        self.geometry.face_ends.push(end);
        Ok(())
    }

    fn corner(&mut self, word: &[u8], line: usize) -> Result<Corner, String> {
        let mut parts = word.splitn(3, |&b| b == b'/');
        let mut part = || parts.next().unwrap_or(b"");
        let (vertex, uv, normal) = (part(), part(), part());
        let positions = self.geometry.positions.len();
        let vertex = self
            .vertices
            .resolve(vertex, positions, line)
            .map_err(|problem| message(&problem, vertex, "vertex", positions))?;
        Ok(Corner {
            vertex,
            uv: self.uvs.resolve(uv, self.geometry.uvs.len(), line)?,
            normal: self
                .normals
                .resolve(normal, self.geometry.normals.len(), line)?,
        })
    }

    fn start_run_where_needed(&mut self) {
        let part = Part {
            object: self.objects.current(),
            material: self.materials.current(),
        };
        let next = self.geometry.parts.len() as u32;
        let id = *self.part_ids.entry(part).or_insert(next);
        if id == next {
            self.geometry.parts.push(part);
        }
        let last = self.geometry.runs.last();
        if last.is_none_or(|run| run.part != id || run.smoothing != self.smoothing) {
            self.geometry.runs.push(Run {
                first_face: self.geometry.face_ends.len() as u32,
                part: id,
                smoothing: self.smoothing,
            });
        }
    }

    fn other(&mut self, keyword: &[u8]) -> Result<(), String> {
        const MOST: usize = 20;
        let is_word = |b: &u8| b.is_ascii_alphanumeric() || b"_-.:".contains(b);
        if !keyword.iter().all(is_word) {
            return Err(format!(
                "\"{}\" is not a statement of an OBJ file",
                shown(keyword)
            ));
        }
        let mut name = shown(keyword);
        if self.skipped.statements.len() >= MOST && !self.skipped.statements.contains_key(&name) {
            name = "other words".to_owned();
        }
        *self.skipped.statements.entry(name).or_default() += 1;
        Ok(())
    }

    fn finish(mut self) -> Result<(Geometry, Warnings), LineError> {
        self.geometry.objects = self.objects.into_list();
        self.geometry.materials = self.materials.into_list();
        let geometry = &mut self.geometry;
        let vertices = geometry.positions.len();
        if let Some((index, line)) = self.vertices.first_above(vertices) {
            return Err(LineError {
                line: Some(line),
                what: message(
                    &BadIndex::OutOfRange,
                    index.to_string().as_bytes(),
                    "vertex",
                    vertices,
                ),
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
        let [late_uvs, late_normals] = geometry.corners.drop_above(uvs, normals);
        self.uvs.warn(late_uvs, uvs, &mut warnings);
        self.normals.warn(late_normals, normals, &mut warnings);
        self.skipped.warn(&mut warnings);
        Ok((self.geometry, warnings))
    }
}

impl Skipped {
    fn warn(self, warnings: &mut Warnings) {
        use WarningCode::{BadAttribute, BadFace, NotTriangles, UnknownStatement};
        let mut add = |code, message: &str, count| warnings.add_many(code, message, count);
        add(NotTriangles, "points are not rendered", self.points);
        add(NotTriangles, "lines are not rendered", self.lines);
        add(
            BadFace,
            "faces with fewer than three corners were left out",
            self.small_faces,
        );
        add(
            BadAttribute,
            "numbers behind a vertex that are no colour were ignored",
            self.surplus_numbers,
        );
        for (name, count) in self.statements {
            if FREE_FORM.contains(&name.as_str()) {
                let message = format!("free-form curves and surfaces (`{name}`) are not rendered");
                warnings.add_many(NotTriangles, message, count);
            } else {
                warnings.add_many(
                    UnknownStatement,
                    format!("`{name}` was not understood"),
                    count,
                );
            }
        }
    }
}

/// What stands behind the keyword of `line`, as one name.
fn name_of<'l>(line: &'l Line<'_>) -> &'l [u8] {
    let mut words = Words::of_names(&line.text);
    words.next();
    words.rest()
}

/// The next `N` numbers of the statement that `what` names.
fn numbers<const N: usize>(what: &str, words: &mut Words<'_>) -> Result<[f64; N], String> {
    let mut values = [0.0; N];
    for (i, value) in values.iter_mut().enumerate() {
        let word = words
            .next()
            .ok_or_else(|| format!("{what} needs {N} numbers, and has {i}"))?;
        *value = parsed(what, word)?;
    }
    Ok(values)
}

fn parsed(what: &str, word: &[u8]) -> Result<f64, String> {
    number(word).ok_or_else(|| format!("{what} has \"{}\", which is not a number", shown(word)))
}
