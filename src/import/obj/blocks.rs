//! A file in blocks that are read at the same time.
//!
//! What the statements of a block mean depends on those before it in three ways. How many elements
//! and lines there are is counted beforehand, so that each block fills its own part of the file's lists;
//! objects, materials and smoothing groups are put together by [`Runs`] afterwards; and so are the
//! indices that can only be judged at the end. So the result does not depend on where the file is cut.

use rayon::prelude::*;

use super::geometry::{Geometry, WHITE};
use super::lines::{LineError, Lines};
use super::notes::Notes;
use super::reader::{self, Block};
use super::room::{self, Room, Start};
use super::runs::Runs;
use crate::import::Warnings;

/// Bytes of a block: some milliseconds of work. A file of one block needs no other thread.
const BLOCK: usize = 1 << 20;

/// Reads a whole file.
///
/// # Errors
/// Where a statement that the picture depends on is not what the format demands: the first such.
pub fn read(bytes: &[u8]) -> Result<(Geometry, Warnings), LineError> {
    read_by(bytes, BLOCK)
}

/// The same, in blocks of `size` bytes.
fn read_by(bytes: &[u8], size: usize) -> Result<(Geometry, Warnings), LineError> {
    let blocks = Lines::new(bytes).split(size);
    let counts = each(blocks.clone(), Start::count);
    let mut total = Start::default();
    let mut starts = Vec::with_capacity(counts.len());
    for &count in &counts {
        starts.push(total);
        total = total.and(count);
    }
    if u32::try_from(total.corners).is_err() {
        return Err(LineError {
            line: None,
            what: format!("it has more than {} corners of faces", u32::MAX),
        });
    }
    let mut lists = room::lists(&total);
    let rooms = room::rooms(&mut lists, &counts);
    let work: Vec<_> = blocks.into_iter().zip(starts.iter().zip(rooms)).collect();
    let read =
        |(lines, (start, room)): (Lines<'_>, (&Start, Room<'_>))| reader::read(lines, *start, room);
    let blocks = each(work, read)
        .into_iter()
        .collect::<Result<Vec<_>, _>>()?;
    join(lists, blocks, &starts)
}

/// What `work` makes of each item, in their order; on several threads where there are several.
fn each<I: Send, O: Send>(mut items: Vec<I>, work: impl Fn(I) -> O + Send + Sync) -> Vec<O> {
    match items.pop() {
        Some(only) if items.is_empty() => vec![work(only)],
        Some(last) => {
            items.push(last);
            items.into_par_iter().map(work).collect()
        }
        None => Vec::new(),
    }
}

/// The whole file, whose `blocks` have filled `lists` from `starts` on.
fn join(
    mut lists: Geometry,
    blocks: Vec<Block>,
    starts: &[Start],
) -> Result<(Geometry, Warnings), LineError> {
    let mut runs = Runs::default();
    let mut notes = Notes::default();
    let mut colors = Vec::new();
    if !blocks.iter().any(|block| block.has_uvs) {
        lists.corners.uvs = Vec::new();
    }
    if !blocks.iter().any(|block| block.has_normals) {
        lists.corners.normals = Vec::new();
    }
    let faces = starts.iter().skip(1).map(|start| start.faces);
    let faces = faces.chain([lists.face_ends.len()]);
    for ((block, start), faces) in blocks.into_iter().zip(starts).zip(faces) {
        runs.add(&block.changes, faces - start.faces);
        lists.libraries.extend(block.libraries);
        notes.append(block.notes);
        if !block.colors.is_empty() {
            colors.resize(start.positions, WHITE);
            colors.extend(block.colors);
        }
    }
    if !colors.is_empty() {
        colors.resize(lists.positions.len(), WHITE);
    }
    lists.colors = colors;
    runs.finish(&mut lists);
    let warnings = notes.finish(&mut lists)?;
    Ok((lists, warnings))
}

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests {
    use proptest::prelude::*;

    use super::*;
    use crate::import::Warning;
    use crate::import::obj::geometry::at;
    use crate::math::{Vec2, Vec3};

    fn result(bytes: &[u8], size: usize) -> Result<(Geometry, Vec<Warning>), LineError> {
        read_by(bytes, size).map(|(geometry, warnings)| (geometry, warnings.iter().collect()))
    }

    /// Statements of every kind, right and wrong; most mean something only together with those before.
    fn any_statement() -> impl Strategy<Value = String> {
        prop_oneof![
            6 => "v -?[0-9]{1,3}(\\.[0-9]{0,4})? [0-9] [0-9]( [01])?( 0\\.5 1)?",
            3 => "vt 0\\.[0-9]( 1)?",
            3 => "vn 0 [01] 1",
            8 => "f(  ?-?[1-4](/-?[1-3]?(/-?[1-3])?)?){2,5} ?",
            1 => "f [1-4]/9/9 2//12 1/7",
            2 => "usemtl [ab]( c)?",
            2 => "o [xy]",
            2 => "s ([0-3]|off)",
            1 => "(g a|mtllib m\\.mtl|p 1 2|l 1 2|cstype bezier|[k-p]x|vn?)",
            1 => "#.{0,3}\\\\",
            1 => "(f 1 2 \\\\\n3|v 1 \\\\\r\n 2\\\\\n 3|\\\\\n\\\\|o \\\\\n z)",
            1 => "(|\r|\t| f|f # 1 2 3|v 0 0 0 # 1)",
        ]
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(2000))]

        #[test]
        fn the_result_does_not_depend_on_where_a_file_is_cut(
            statements in prop::collection::vec(any_statement(), 1..60),
            size in 1..200usize,
            separator in prop_oneof![4 => Just("\n"), 2 => Just("\r\n"), 1 => Just("\r")],
        ) {
            // Faces of the first lines find some vertices.
            let text = ["v 0 0 0"; 4].iter().copied().chain(statements.iter().map(String::as_str));
            let text = text.collect::<Vec<_>>().join(separator);
            prop_assert_eq!(result(text.as_bytes(), size), result(text.as_bytes(), usize::MAX));
        }

        #[test]
        fn small_blocks_hold_what_tobj_reads(
            elements in prop::collection::vec((prop::array::uniform3(-1e3f32..1e3), 0..6u8, any::<bool>()), 3..80),
            size in 1..100usize,
        ) {
            let mut text = String::new();
            for (place, ([x, y, z], form, is_negative)) in elements.iter().enumerate() {
                text += &format!("v {x} {y} {z}\nvt {x:.3} {y:e}\nvn {x:.20} {y} {z}\n");
                let corner = |back: usize| match (place + 1).checked_sub(back) {
                    Some(i) if i > 0 && !is_negative => i.to_string(),
                    Some(i) if i > 0 => format!("-{}", back + 1),
                    _ => "1".to_owned(),
                };
                let corners = (0..3 + usize::from(*form) % 3).map(|back| {
                    let i = corner(back * back);
                    format!(" {i}/{i}/{i}")
                });
                text += &format!("o {place}\nf{}\n", corners.collect::<String>());
            }
            let (geometry, _) = result(text.as_bytes(), size).unwrap();
            let ours = (0..geometry.face_ends.len()).map(|face| {
                let corners = geometry.corners_of(face).map(|i| {
                    let corner = geometry.corners.get(i);
                    let position = geometry.positions[corner.vertex as usize].as_vec3();
                    (position, corner.uv.map(|uv| at(&geometry.uvs, uv)), corner.normal.map(|n| at(&geometry.normals, n)))
                });
                corners.collect::<Vec<_>>()
            });
            let options = tobj::LoadOptions { single_index: true, ..tobj::LoadOptions::default() };
            let no_library = |_: &std::path::Path| Ok(Default::default());
            let (models, _) = tobj::load_obj_buf(&mut text.as_bytes(), &options, no_library).unwrap();
            let theirs = models.iter().map(|model| {
                let mesh = &model.mesh;
                let corners = mesh.indices.iter().map(|&i| {
                    let i = i as usize;
                    let uv = Vec2::from_slice(&mesh.texcoords[2 * i..]);
                    let uv = Vec2::new(uv.x, 1.0 - uv.y);
                    let normal = Vec3::from_slice(&mesh.normals[3 * i..]);
                    (Vec3::from_slice(&mesh.positions[3 * i..]), Some(uv), Some(normal))
                });
                corners.collect::<Vec<_>>()
            });
            for (ours, theirs) in ours.zip(theirs) {
                prop_assert_eq!(ours.len(), theirs.len());
                for ((p, uv, n), (their_p, their_uv, their_n)) in ours.into_iter().zip(theirs) {
                    prop_assert_eq!((p, n), (their_p, their_n));
                    // Theirs is turned in single precision.
                    let turn = uv.unwrap() - their_uv.unwrap();
                    prop_assert!(turn.x == 0.0 && turn.y.abs() <= 1e-4, "{uv:?} {their_uv:?}");
                }
            }
            prop_assert_eq!(geometry.face_ends.len(), models.len());
        }
    }

    #[test]
    fn the_first_error_of_a_file_counts() {
        let text = "v 0 0 0\n".repeat(50) + "f 1 2 x\n" + &"v 0 0 0\n".repeat(50) + "v 0 y 0\n";
        for size in [1, 10, 300, usize::MAX] {
            let error = result(text.as_bytes(), size).unwrap_err();
            assert_eq!(error.line, Some(51), "{size}: {error:?}");
        }
    }
}
