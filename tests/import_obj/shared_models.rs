//! The real files of `../shared/models`, against its `expected.tsv`.

use std::path::PathBuf;

use halfshade::import::WarningCode;
use halfshade::math::DVec3;

use super::common::{import, warnings};

/// One OBJ row of `expected.tsv`.
pub struct Row {
    pub path: PathBuf,
    pub name: String,
    columns: Vec<String>,
}

impl Row {
    fn column(&self, name: &str) -> &str {
        const NAMES: [&str; 19] = [
            "path",
            "triangles",
            "faces",
            "quads",
            "ngons",
            "vertices",
            "vt",
            "vn",
            "coloured_vertices",
            "negative_indices",
            "lines",
            "points",
            "materials_used",
            "groups",
            "bbox_min",
            "bbox_max",
            "out_of_range",
            "mtllib",
            "assimp_faces",
        ];
        let index = NAMES.iter().position(|&n| n == name).unwrap();
        self.columns.get(index).map_or("", String::as_str)
    }

    pub fn number(&self, name: &str) -> u64 {
        self.column(name).parse().unwrap()
    }

    fn point(&self, name: &str) -> DVec3 {
        let values: Vec<f64> = self
            .column(name)
            .split(',')
            .map(|v| v.parse().unwrap())
            .collect();
        DVec3::from_slice(&values)
    }
}

/// All rows; `None`, with a printed word, where the models are not there.
pub fn rows() -> Option<Vec<Row>> {
    let beside = concat!(env!("CARGO_MANIFEST_DIR"), "/../shared/models");
    let root = std::env::var("HALFSHADE_MODELS").unwrap_or_else(|_| beside.to_owned());
    let root = PathBuf::from(root);
    let Ok(table) = std::fs::read_to_string(root.join("expected.tsv")) else {
        println!("skipped: no models in {}", root.display());
        return None;
    };
    let rows: Vec<Row> = table
        .lines()
        .filter(|line| line.starts_with("obj/"))
        .map(|line| {
            let columns: Vec<String> = line.split('\t').map(str::to_owned).collect();
            Row {
                path: root.join(&columns[0]),
                name: columns[0].clone(),
                columns,
            }
        })
        .collect();
    assert!(rows.len() > 60, "{} rows", rows.len());
    Some(rows)
}

#[test]
fn every_file_has_the_triangles_and_bounds_that_other_loaders_found() {
    let mut wrong = Vec::new();
    for row in rows().unwrap_or_default() {
        if row.number("out_of_range") == 0
            && let Err(difference) = compare(&row)
        {
            wrong.push(format!("{}: {difference}", row.name));
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

fn compare(row: &Row) -> Result<(), String> {
    let imported = import(&row.path)?;
    let scene = &imported.scene;
    let triangles = scene.triangle_count();
    if triangles != row.number("triangles") {
        return Err(format!("{triangles} triangles"));
    }
    let named = scene.materials.iter().filter(|m| !m.name.is_empty());
    let unnamed = row.name.contains("unnamed-material") as usize;
    let materials = (named.count() + unnamed) as u64;
    if materials != row.number("materials_used") - without_faces(&row.name) {
        return Err(format!("{materials} materials"));
    }
    let lines: u64 = warnings(&imported, WarningCode::NotTriangles)
        .iter()
        .map(|w| w.count)
        .sum();
    if lines != row.number("lines") + row.number("points") {
        return Err(format!("{lines} lines and points"));
    }
    match scene.bounds() {
        None if triangles == 0 => Ok(()),
        None => Err("no bounds".to_owned()),
        Some((min, max)) => {
            let (expected_min, expected_max) = (row.point("bbox_min"), row.point("bbox_max"));
            let scale = expected_min.abs().max(expected_max.abs()).max_element();
            let is_near = |got: DVec3, expected: DVec3| {
                let components = got.to_array().into_iter().zip(expected.to_array());
                components.into_iter().all(|(got, expected)| {
                    (got - expected).abs() <= rounding(expected) + 1e-7 * scale
                })
            };
            if is_near(min, expected_min) && is_near(max, expected_max) {
                Ok(())
            } else {
                Err(format!("bounds {min} {max}"))
            }
        }
    }
}

/// Half a unit of the sixth significant digit of `value`.
fn rounding(value: f64) -> f64 {
    if value == 0.0 {
        0.0
    } else {
        0.5 * 10f64.powf(value.abs().log10().floor() - 5.0)
    }
}

/// Explained differences: materials that a `usemtl` selects, which `expected.tsv` counts, and no
/// face uses, so that they are not in the scene.
fn without_faces(name: &str) -> u64 {
    match name {
        // `front_wall` (blue) and `light` have vertices, but their faces are comments.
        "obj/embree/cornell_box.obj" => 2,
        // The same box, with its light.
        "obj/tobj/cornell_box.obj" => 1,
        _ => 0,
    }
}

#[test]
fn a_vertex_that_is_not_there_is_named_with_its_line() {
    let messages = [
        (
            "obj/tobj/invalid_index.obj",
            "line 12: face uses vertex 7, but there are only 6",
        ),
        (
            "obj/obj2gltf/box-incomplete-attributes/box-incomplete-positions.obj",
            "line 29: face uses vertex 2, but there are only 1",
        ),
    ];
    let rows = rows().unwrap_or_default();
    for row in rows.iter().filter(|row| row.number("out_of_range") > 0) {
        let (_, expected) = messages.iter().find(|(name, _)| *name == row.name).unwrap();
        let message = import(&row.path).map(|_| ()).unwrap_err();
        assert_eq!(message, format!("{}, {expected}", row.path.display()));
    }
}
