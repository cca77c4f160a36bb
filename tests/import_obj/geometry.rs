//! What the statements of an OBJ file mean for meshes.

use halfshade::import::WarningCode;
use halfshade::math::{DVec3, Vec2, Vec3};
use halfshade::scene::Mesh;

use super::common::{import_text, warnings, world_triangles};

const SQUARE: &str = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n";

/// A cube of edge 1 about `center`; faces of four vertices without attributes.
fn cube(center: [f64; 3]) -> String {
    let mut text = String::new();
    for i in 0..8 {
        let side = |bit: u32| if i >> bit & 1 == 1 { 0.5 } else { -0.5 };
        let [x, y, z] = [
            center[0] + side(0),
            center[1] + side(1),
            center[2] + side(2),
        ];
        text += &format!("v {x} {y} {z}\n");
    }
    text + "f 1 3 4 2\nf 5 6 8 7\nf 1 2 6 5\nf 3 7 8 4\nf 1 5 7 3\nf 2 4 8 6\n"
}

fn only_mesh(text: &str) -> Mesh {
    let imported = import_text(text);
    assert_eq!(imported.scene.meshes.len(), 1);
    imported.scene.meshes[0].clone()
}

#[test]
fn corners_may_be_written_in_every_way() {
    let lists = format!("{SQUARE}vt 0.25 0.25\nvn 0 0 1\n");
    let expected = world_triangles(&import_text(&format!("{lists}f 1 2 3\n")).scene);
    for face in [
        "f 1/1 2/1 3/1",
        "f 1//1 2//1 3//1",
        "f 1/1/1 2/1/1 3/1/1",
        "f 1/ 2/ 3/",
        "f 1// 2// 3//",
        "f 1/1/ 2 3//1",
        "f -4 -3 -2",
        "f -4/-1/-1 -3/-1/-1 -2/-1/-1",
        "  f\t+1   2 3 # a comment",
        "f 1 \\\n2\\\r\n 3",
        "f 1 2 3\r",
        "fo 1 2 3",
    ] {
        let imported = import_text(&format!("{lists}{face}\n"));
        assert_eq!(world_triangles(&imported.scene), expected, "{face}");
        assert!(imported.warnings.is_empty(), "{face}");
    }
}

#[test]
fn negative_indices_count_from_where_they_stand() {
    let text = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf -3 -2 -1\nv 5 0 0\nv 6 0 0\nv 5 1 0\nf -3 -2 -1\n";
    let triangles = world_triangles(&import_text(text).scene);
    assert_eq!(triangles[0][0], DVec3::ZERO);
    assert_eq!(triangles[1][0], DVec3::new(5.0, 0.0, 0.0));
}

#[test]
fn a_face_may_stand_before_its_vertices() {
    let triangles = world_triangles(&import_text(&format!("f 1 2 3\n{SQUARE}")).scene);
    assert_eq!(triangles[0][1], DVec3::X);
}

#[test]
fn v_grows_upwards_in_the_file_and_downwards_in_the_mesh() {
    let mesh = only_mesh(&format!("{SQUARE}vt 0.25 0.75\nvt 0.5\nf 1/1 2/2 3/1\n"));
    assert_eq!(mesh.uv_sets()[0][0], Vec2::new(0.25, 0.25));
    assert_eq!(mesh.uv_sets()[0][1], Vec2::new(0.5, 1.0));
}

#[test]
fn vertex_colours_are_linear_and_white_where_missing() {
    let mesh = only_mesh("v 0 0 0\nv 1 0 0 0.25 0.5 1\nv 0 1 0 1.0\nf 1 2 3\n");
    let white = [1.0; 4];
    assert_eq!(mesh.colors(), [white, [0.25, 0.5, 1.0, 1.0], white]);
    assert_eq!(mesh.positions()[2], Vec3::Y, "a weight changes nothing");
}

#[test]
fn bare_vertices_stay_as_they_are() {
    let mesh = only_mesh("v 9 9 9\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 2 3 4\nf 4 3 2\n");
    assert_eq!(mesh.positions().len(), 4);
    assert_eq!(mesh.indices(), [[1, 2, 3], [3, 2, 1]]);
}

#[test]
fn a_vertex_is_shared_by_corners_that_agree_in_everything() {
    let lists = format!("{SQUARE}vt 0 0\nvt 1 1\nvn 0 0 1\nvn 0 0 -1\n");
    let mesh = only_mesh(&format!(
        "{lists}f 1/1/1 2/1/1 3/1/1\nf 1/1/1 3/1/1 4/1/1\n"
    ));
    assert_eq!(mesh.positions().len(), 4);
    let mesh = only_mesh(&format!(
        "{lists}f 1/1/1 2/1/1 3/1/1\nf 1/2/1 3/1/2 4/1/1\n"
    ));
    assert_eq!(mesh.positions().len(), 6);
    assert_eq!(mesh.normals()[4], Vec3::NEG_Z);
}

#[test]
fn there_is_one_mesh_for_each_object_and_material() {
    let imported = import_text(&format!(
        "{SQUARE}f 1 2 3\no roof\ng a\nusemtl red\nf 1 2 3\ng b\nf 1 3 4\n\
         o wall\nf 1 2 3\nusemtl blue\nf 1 2 3\no empty\no roof\nusemtl red\nf 2 3 4\n"
    ));
    let scene = &imported.scene;
    let parts: Vec<(&str, &str, usize)> = scene
        .instances
        .iter()
        .map(|i| {
            let material = &scene.materials[i.material.0 as usize];
            let triangles = scene.mesh(i.mesh).indices().len();
            (i.name.as_str(), material.name.as_str(), triangles)
        })
        .collect();
    assert_eq!(
        parts,
        [
            ("", "", 1),
            ("roof", "red", 3),
            ("wall", "red", 1),
            ("wall", "blue", 1)
        ]
    );
    assert_eq!(scene.materials.len(), 3);
    assert_eq!(
        scene.meshes[1].positions().len(),
        4,
        "only what the part uses"
    );
}

#[test]
fn without_normals_or_smoothing_a_mesh_is_flat() {
    assert!(only_mesh(&cube([0.0; 3])).normals().is_empty());
    assert!(
        only_mesh(&format!("s off\n{}", cube([0.0; 3])))
            .normals()
            .is_empty()
    );
    assert!(
        only_mesh(&format!("s 1\ns 0\n{}", cube([0.0; 3])))
            .normals()
            .is_empty()
    );
}

#[test]
fn a_smoothing_group_weighs_normals_by_angle() {
    // Weighted by area, or by the number of faces, the corners of a cube that is cut into
    // triangles would lean to one side.
    let quads = cube([0.0; 3]);
    let cut = |line: &str| match line.split(' ').collect::<Vec<_>>()[..] {
        ["f", a, b, c, d] => format!("f {a} {b} {c}\nf {a} {c} {d}\n"),
        _ => format!("{line}\n"),
    };
    let triangles: String = quads.lines().map(cut).collect();
    for faces in [quads, triangles] {
        let mesh = only_mesh(&format!("s 1\n{faces}"));
        assert_eq!(mesh.positions().len(), 8);
        for (position, normal) in mesh.positions().iter().zip(mesh.normals()) {
            let diagonal = position.normalize();
            assert!((*normal - diagonal).length() < 1e-6, "{position}: {normal}");
        }
    }
}

#[test]
fn a_colour_that_is_no_number_is_left_out() {
    let imported = import_text("v 0 0 0 1 0 0\nv 1 0 0 nan 0 0\nv 0 1 0 1 1\nf 1 2 3\n");
    let colors = imported.scene.meshes[0].colors();
    assert_eq!(colors, [[1.0, 0.0, 0.0, 1.0], [1.0; 4], [1.0; 4]]);
    assert_eq!(warnings(&imported, WarningCode::BadAttribute)[0].count, 2);
}

#[test]
fn smoothing_stops_at_the_border_of_a_group_and_not_at_that_of_a_material() {
    // A roof of two slopes that meet at the y axis.
    let roof = "v -1 0 0\nv -1 0 1\nv 0 1 0\nv 0 1 1\nv 1 0 0\nv 1 0 1\n";
    let ridge_normals = |between: &str| {
        let text = format!("{roof}s 1\nf 1 2 4 3\n{between}\nf 3 4 6 5\n");
        let scene = import_text(&text).scene;
        let on_ridge = |mesh: &Mesh| -> Vec<Vec3> {
            let vertices = mesh.positions().iter().zip(mesh.normals());
            vertices
                .filter(|(p, _)| p.x == 0.0)
                .map(|(_, &n)| n)
                .collect()
        };
        scene.meshes.iter().flat_map(on_ridge).collect::<Vec<_>>()
    };
    let near = |a: &Vec3, b: Vec3| (*a - b).length() < 1e-6;
    let slope = Vec3::new(1.0, 1.0, 0.0).normalize();
    let smooth = ridge_normals("");
    assert!(
        smooth.len() == 2 && smooth.iter().all(|n| near(n, Vec3::Y)),
        "{smooth:?}"
    );
    let two_materials = ridge_normals("usemtl other");
    assert!(two_materials.len() == 4 && two_materials.iter().all(|n| near(n, Vec3::Y)));
    let creased = ridge_normals("s 2");
    assert_eq!(creased.len(), 4);
    assert!(
        creased
            .iter()
            .all(|n| near(n, slope) || near(n, slope * Vec3::new(-1.0, 1.0, 1.0)))
    );
}

#[test]
fn a_flat_face_beside_smooth_ones_keeps_its_own_normal() {
    let lists = format!("{SQUARE}vn 0 1 0\nvn 0 0 0\n");
    let mesh = only_mesh(&format!(
        "{lists}f 1//1 2//1 3//1\nf 1 3 4\nf 1//2 2//1 3\n"
    ));
    let normals = |triangle: usize| mesh.indices()[triangle].map(|i| mesh.normals()[i as usize]);
    assert_eq!(normals(0), [Vec3::Y; 3]);
    assert_eq!(normals(1), [Vec3::Z; 3]);
    assert_eq!(normals(2), [Vec3::Z, Vec3::Y, Vec3::Z]);
}

#[test]
fn points_lines_curves_and_small_faces_are_counted_and_left_out() {
    let imported = import_text(&format!(
        "{SQUARE}p 1 2 3\nl 1 2 3\nl 1/1 2/2\nf 1 2\nf\nvp 0.1 0.2\ncurv 0 1 1 2\nwhatever 1\nf 1 2 3\n"
    ));
    assert_eq!(imported.scene.triangle_count(), 1);
    let count = |code| {
        warnings(&imported, code)
            .iter()
            .map(|w| w.count)
            .sum::<u64>()
    };
    assert_eq!(count(WarningCode::NotTriangles), 3 + 2 + 2);
    assert_eq!(count(WarningCode::BadFace), 2);
    assert_eq!(count(WarningCode::UnknownStatement), 1);
}

#[test]
fn an_attribute_that_is_not_there_costs_no_more_than_itself() {
    let imported = import_text(&format!(
        "{SQUARE}vt 0 0\nvn 0 0 1\nf 1/1/1 2/2/1 3/1/-2\nf 1/1/1 2/1/9 3/0/1\n"
    ));
    assert_eq!(imported.scene.triangle_count(), 2);
    let words = warnings(&imported, WarningCode::BadAttribute);
    assert_eq!(words.iter().map(|w| w.count).collect::<Vec<_>>(), [2, 2]);
    assert!(
        words.iter().all(|w| w.message.contains("first on line 7")),
        "{words:?}"
    );
}

#[test]
fn a_model_far_from_the_origin_keeps_its_shape() {
    for exponent in 0..=9 {
        let center = [10f64.powi(exponent), -3.0 * 10f64.powi(exponent), 0.7];
        let triangles = world_triangles(&import_text(&cube(center)).scene);
        assert_eq!(triangles.len(), 12);
        for [a, b, c] in triangles {
            for edge in [b - a, c - b, a - c] {
                let length = edge.length();
                let nearest = if length < 1.2 { 1.0 } else { 2f64.sqrt() };
                // The text itself has 16 digits of 3e9.
                let digits = 4.0 * f64::EPSILON * 3.0 * 10f64.powi(exponent);
                assert!(
                    (length - nearest).abs() < 1e-6 + digits,
                    "{exponent}: {length}"
                );
            }
        }
    }
}

#[test]
fn far_vertices_are_where_the_text_says() {
    let imported = import_text(&cube([4.5e6, 5.3e5, 120.25]));
    let anchor = imported.scene.instances[0].transform.translation;
    assert_eq!(anchor, DVec3::new(4.5e6, 5.3e5, 120.25));
    for corner in world_triangles(&imported.scene).as_flattened() {
        let from_center = *corner - anchor;
        assert_eq!(from_center.abs(), DVec3::splat(0.5));
    }
}

#[test]
fn a_model_near_the_origin_stays_where_it_is() {
    let imported = import_text(&cube([3.0, -7.0, 0.1]));
    assert_eq!(
        imported.scene.instances[0].transform.translation,
        DVec3::ZERO
    );
    assert!(
        imported.scene.meshes[0]
            .positions()
            .contains(&Vec3::new(2.5, -7.5, -0.4))
    );
}

#[test]
fn import_commutes_with_scaling_by_powers_of_two() {
    for center in [[0.1, 0.2, 0.3], [1e5, 1.1e4, 13.7]] {
        let base = world_triangles(&import_text(&cube(center)).scene);
        for k in [-40, -7, 13, 40] {
            let s = 2f64.powi(k);
            let scaled: String = cube(center)
                .lines()
                .map(|line| match line.strip_prefix("v ") {
                    Some(numbers) => {
                        let numbers = numbers.split(' ').map(|n| n.parse::<f64>().unwrap() * s);
                        let words: Vec<String> = numbers.map(|n| format!("{n:e}")).collect();
                        format!("v {}\n", words.join(" "))
                    }
                    None => format!("{line}\n"),
                })
                .collect();
            let got = world_triangles(&import_text(&scaled).scene);
            let expected: Vec<_> = base.iter().map(|t| t.map(|p| p * s)).collect();
            assert_eq!(got, expected, "scale 2^{k}");
        }
    }
}

#[test]
fn vertices_that_are_not_finite_are_left_to_those_who_render() {
    let imported =
        import_text("v nan 0 0\nv 1e999 0 0\nv 0 1 0\nv 0 0 0\nv 1 0 0\nf 1 2 3\nf 3 4 5\n");
    assert_eq!(imported.scene.triangle_count(), 2);
    assert_eq!(
        imported.scene.bounds(),
        Some((DVec3::ZERO, DVec3::new(1.0, 1.0, 0.0)))
    );
    assert_eq!(warnings(&imported, WarningCode::NonFiniteVertex).len(), 1);
}

#[test]
fn many_normals_at_one_vertex_take_no_square_of_time() {
    let mut text = String::from("v 0 0 0\nv 1 0 0\nv 0 1 0\n");
    for i in 1..=100_000 {
        text += &format!("vn 0 0 {i}\nf 1//{i} 2//{i} 3//{i}\n");
    }
    let mesh = only_mesh(&text);
    assert_eq!(mesh.positions().len(), 300_000);
}
