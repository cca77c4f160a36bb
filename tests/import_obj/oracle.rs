//! The same files read by `tobj`, another reader.

use std::io::Cursor;

use halfshade::material::Surface;
use halfshade::math::DVec3;
use proptest::prelude::*;

use super::common::{import, import_text, world_triangles};
use super::shared_models::rows;

/// The faces of a file as polygons of positions, in the order of its statements.
fn tobj_polygons(models: &[tobj::Model]) -> Vec<Vec<DVec3>> {
    let mut polygons = Vec::new();
    for model in models {
        let mesh = &model.mesh;
        let at = |i: u32| {
            let p = &mesh.positions[3 * i as usize..][..3];
            DVec3::new(p[0].into(), p[1].into(), p[2].into())
        };
        let mut rest = mesh.indices.as_slice();
        let sizes = mesh.face_arities.iter().map(|&n| n as usize);
        let all_triangles = std::iter::repeat_n(
            3,
            if mesh.face_arities.is_empty() {
                rest.len() / 3
            } else {
                0
            },
        );
        for size in sizes.chain(all_triangles) {
            let (face, others) = rest.split_at(size);
            polygons.push(face.iter().map(|&i| at(i)).collect());
            rest = others;
        }
    }
    polygons
}

/// What a set of faces has in common with the triangles that it is cut into, however it is cut.
#[derive(Debug)]
struct Measure {
    triangles: usize,
    /// Sum of the normals, each as long as its area; flat or not, a polygon's border decides it.
    area: DVec3,
    min: DVec3,
    max: DVec3,
}

impl Measure {
    fn of(polygons: impl Iterator<Item = Vec<DVec3>>) -> Self {
        let mut total = Self {
            triangles: 0,
            area: DVec3::ZERO,
            min: DVec3::INFINITY,
            max: DVec3::NEG_INFINITY,
        };
        for polygon in polygons {
            total.triangles += polygon.len().saturating_sub(2);
            for pair in polygon.windows(2) {
                total.area += 0.5 * (pair[0] - polygon[0]).cross(pair[1] - polygon[0]);
            }
            for p in polygon {
                total.min = total.min.min(p);
                total.max = total.max.max(p);
            }
        }
        total
    }

    fn assert_near(&self, other: &Self, name: &str) {
        assert_eq!(self.triangles, other.triangles, "{name}");
        if self.triangles > 0 {
            let extent = (other.max - other.min).length();
            // tobj's coordinates are single precision.
            let rounding = 1e-7 * other.max.abs().max(other.min.abs()).max_element();
            let corner = (self.min - other.min)
                .abs()
                .max((self.max - other.max).abs());
            assert!(
                corner.max_element() <= 1e-6 * extent + rounding,
                "{name}: {self:?} {other:?}"
            );
            let difference = (self.area - other.area).length();
            assert!(
                difference <= 1e-5 * extent.powi(2) + 10.0 * rounding * extent,
                "{name}: {self:?} {other:?}"
            );
        }
    }
}

fn without_library(_: &std::path::Path) -> tobj::MTLLoadResult {
    Ok(Default::default())
}

const WHOLE: tobj::LoadOptions = tobj::LoadOptions {
    single_index: true,
    triangulate: false,
    ignore_points: true,
    ignore_lines: true,
};

#[test]
fn real_files_have_the_faces_that_tobj_reads() {
    let mut compared = 0;
    for row in rows().unwrap_or_default() {
        let mut reader = std::io::BufReader::new(std::fs::File::open(&row.path).unwrap());
        // Some files have indices that tobj takes for the end of the whole file.
        let Ok((models, _)) = tobj::load_obj_buf(&mut reader, &WHOLE, without_library) else {
            continue;
        };
        let Ok(imported) = import(&row.path) else {
            continue;
        };
        let theirs = Measure::of(tobj_polygons(&models).into_iter());
        let ours = world_triangles(&imported.scene).into_iter().map(Vec::from);
        Measure::of(ours).assert_near(&theirs, &row.name);
        compared += 1;
    }
    assert!(compared == 0 || compared > 50, "{compared} files");
    println!("{compared} files compared");
}

/// Vertices, and faces of three to six of them in any of the four forms.
fn random_file() -> impl Strategy<Value = String> {
    let vertices = prop::collection::vec(prop::array::uniform3(-10.0f32..10.0), 3..20);
    vertices.prop_flat_map(|vertices| {
        let count = vertices.len();
        let face = (prop::collection::vec(0..count, 3..7), 0..4u8, any::<bool>());
        prop::collection::vec(face, 1..20).prop_map(move |faces| {
            let mut text = String::from("vt 0.5 0.5\nvn 0 0 1\n");
            for [x, y, z] in &vertices {
                text += &format!("v {x} {y} {z}\n");
            }
            for (corners, form, is_negative) in faces {
                text += "f";
                for corner in corners {
                    let index = if is_negative {
                        corner as i64 - count as i64
                    } else {
                        corner as i64 + 1
                    };
                    text += &match form {
                        0 => format!(" {index}"),
                        1 => format!(" {index}/1"),
                        2 => format!(" {index}//1"),
                        _ => format!(" {index}/1/1"),
                    };
                }
                text += "\n";
            }
            text
        })
    })
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(200))]

    #[test]
    fn random_files_have_the_faces_that_tobj_reads(text in random_file()) {
        // tobj wants one form of corners in a mesh: one object a face.
        let separate = text.replace("\nf", "\no face\nf");
        let mut reader = Cursor::new(separate.as_bytes());
        let (models, _) = tobj::load_obj_buf(&mut reader, &WHOLE, without_library).unwrap();
        let theirs = Measure::of(tobj_polygons(&models).into_iter());
        let ours = world_triangles(&import_text(&text).scene).into_iter().map(Vec::from);
        Measure::of(ours).assert_near(&theirs, "random");
    }
}

#[test]
fn real_libraries_have_the_values_that_tobj_reads() {
    let mut compared = 0;
    for row in rows().unwrap_or_default() {
        let Ok(imported) = import(&row.path) else {
            continue;
        };
        let mut reader = std::io::BufReader::new(std::fs::File::open(&row.path).unwrap());
        let folder = row.path.parent().unwrap();
        let load = |name: &std::path::Path| tobj::load_mtl(folder.join(name));
        let Ok((_, Ok(materials))) = tobj::load_obj_buf(&mut reader, &WHOLE, load) else {
            continue;
        };
        for theirs in materials {
            let same_name = |m: &&halfshade::material::Material| m.name == theirs.name;
            let Some(ours) = imported.scene.materials.iter().find(same_name) else {
                continue;
            };
            let Surface::Phong(phong) = &ours.surface else {
                continue;
            };
            if let Some(diffuse) = theirs.diffuse {
                assert_eq!(phong.diffuse.factor.channels(), diffuse, "{}", row.name);
            }
            if let Some(exponent) = theirs.shininess {
                assert_eq!(phong.exponent.factor, exponent, "{}", row.name);
            }
            if let Some(dissolve) = theirs.dissolve {
                assert_eq!(ours.opacity.factor, dissolve, "{}", row.name);
            }
            compared += 1;
        }
    }
    assert!(compared == 0 || compared > 40, "{compared} materials");
    println!("{compared} materials compared");
}
