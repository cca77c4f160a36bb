//! Polygons of any shape, cut into triangles.

use halfshade::import::WarningCode;
use halfshade::math::{DQuat, DVec3};
use proptest::prelude::*;

use super::common::{import_text, warnings, world_triangles};

/// The triangles of one face with the given corners.
fn cut(corners: &[DVec3]) -> Vec<[DVec3; 3]> {
    world_triangles(&import_text(&text_of(corners)).scene)
}

fn text_of(corners: &[DVec3]) -> String {
    let mut text: String = corners
        .iter()
        .map(|p| format!("v {} {} {}\n", p.x, p.y, p.z))
        .collect();
    text += "f";
    for i in 1..=corners.len() {
        text += &format!(" {i}");
    }
    text + "\n"
}

fn area_vector(corners: &[DVec3]) -> DVec3 {
    let origin = corners[0];
    let pairs = corners.windows(2);
    pairs
        .map(|p| 0.5 * (p[0] - origin).cross(p[1] - origin))
        .sum()
}

/// Checks that the triangles of `corners` turn as it does, do not overlap, and are all of it.
fn assert_covered(corners: &[DVec3], is_strict: bool) -> Result<(), String> {
    let triangles = cut(corners);
    if triangles.len() != corners.len() - 2 {
        return Err(format!(
            "{} triangles of {} corners",
            triangles.len(),
            corners.len()
        ));
    }
    let whole = area_vector(corners);
    let normal = whole.normalize();
    // Positions are single precision after import.
    let tolerance = 1e-6 * whole.length();
    let areas: Vec<f64> = triangles
        .iter()
        .map(|t| area_vector(t).dot(normal))
        .collect();
    if let Some(flipped) = areas.iter().find(|&&a| a < -tolerance) {
        return Err(format!(
            "a triangle of area {flipped} in {}",
            whole.length()
        ));
    }
    if is_strict && areas.iter().any(|&a| a <= 0.0) {
        return Err(format!("a triangle without area: {areas:?}"));
    }
    let sum: f64 = areas.iter().sum();
    if (sum - whole.length()).abs() > tolerance * 10.0 {
        return Err(format!("area {sum} of {}", whole.length()));
    }
    Ok(())
}

fn polygon(points: &[[f64; 2]]) -> Vec<DVec3> {
    points.iter().map(|&[x, y]| DVec3::new(x, y, 0.0)).collect()
}

#[test]
fn a_concave_quad_is_cut_at_its_concave_corner() {
    let arrow = [[0.0, 0.0], [2.0, -1.0], [0.5, 0.0], [2.0, 1.0]];
    for turn in 0..4 {
        let mut points = arrow;
        points.rotate_left(turn);
        assert_eq!(assert_covered(&polygon(&points), true), Ok(()), "{turn}");
        points.reverse();
        assert_eq!(
            assert_covered(&polygon(&points), true),
            Ok(()),
            "{turn} reversed"
        );
    }
}

#[test]
fn concave_polygons_are_covered_once() {
    let l = [
        [0.0, 0.0],
        [3.0, 0.0],
        [3.0, 1.0],
        [1.0, 1.0],
        [1.0, 3.0],
        [0.0, 3.0],
    ];
    let comb: Vec<[f64; 2]> = (0..20)
        .flat_map(|i| {
            let x = f64::from(i);
            [[x, 0.0], [x + 0.5, 5.0]]
        })
        .chain([[20.0, 0.0], [20.0, -1.0], [0.0, -1.0]])
        .rev()
        .collect();
    for points in [l.as_slice(), &comb] {
        for axis in [DVec3::X, DVec3::Y, DVec3::new(1.0, -2.0, 0.5).normalize()] {
            for angle in [0.0, 0.7, std::f64::consts::FRAC_PI_2, 3.0] {
                let turn = DQuat::from_axis_angle(axis, angle);
                let corners: Vec<DVec3> = polygon(points).iter().map(|&p| turn * p).collect();
                assert_eq!(assert_covered(&corners, true), Ok(()), "{axis} {angle}");
                let reversed: Vec<DVec3> = corners.into_iter().rev().collect();
                assert_eq!(assert_covered(&reversed, true), Ok(()), "{axis} {angle}");
            }
        }
    }
}

#[test]
fn corners_on_an_edge_split_the_triangle_on_it() {
    // A square with corners on its edges: no triangle may be left without area, or neighbours
    // that share those corners would be met with gaps.
    let points: Vec<[f64; 2]> = vec![
        [0.0, 0.0],
        [1.0, 0.0],
        [2.0, 0.0],
        [3.0, 0.0],
        [4.0, 0.0],
        [4.0, 2.0],
        [4.0, 4.0],
        [2.0, 4.0],
        [0.0, 4.0],
        [0.0, 3.0],
        [0.0, 1.0],
    ];
    for turn in 0..points.len() {
        let mut points = points.clone();
        points.rotate_left(turn);
        assert_eq!(assert_covered(&polygon(&points), true), Ok(()), "{turn}");
    }
}

#[test]
fn spikes_and_repeated_corners_keep_the_count() {
    for points in [
        vec![[0.0, 0.0], [0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]],
        vec![[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0], [0.0, 0.0]],
        vec![[0.0, 0.0], [3.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]],
        vec![
            [0.0, 0.0],
            [1.0, 0.0],
            [1.0, 0.0],
            [1.0, 0.0],
            [1.0, 1.0],
            [0.0, 1.0],
        ],
    ] {
        assert_eq!(
            assert_covered(&polygon(&points), false),
            Ok(()),
            "{points:?}"
        );
    }
}

#[test]
fn polygons_without_area_keep_the_count_and_are_told() {
    for points in [
        vec![[0.0, 0.0]; 6],
        vec![[0.0, 0.0], [1.0, 1.0], [2.0, 2.0], [3.0, 3.0]],
        vec![[0.0, 0.0], [0.1, 0.3], [0.2, 0.6], [0.3, 0.9], [0.7, 2.1]],
        vec![[0.0, 0.0], [1.0, 1.0], [1.0, 0.0], [0.0, 1.0]],
    ] {
        let imported = import_text(&text_of(&polygon(&points)));
        assert_eq!(imported.scene.triangle_count() as usize, points.len() - 2);
        let words = warnings(&imported, WarningCode::BadFace);
        assert_eq!(words.len(), 1, "{points:?}");
        assert!(words[0].message.contains("no area"), "{words:?}");
    }
}

#[test]
fn a_polygon_that_crosses_itself_keeps_the_count_and_is_told() {
    let points = [[0.0, 0.0], [4.0, 0.0], [1.0, 3.0], [3.0, 3.0]];
    let star: Vec<[f64; 2]> = (0..5)
        .map(|i| {
            let (sin, cos) = (f64::from(i) * 4.0 / 5.0 * std::f64::consts::PI).sin_cos();
            [cos, sin]
        })
        .collect();
    for points in [points.as_slice(), &star] {
        let imported = import_text(&text_of(&polygon(points)));
        assert_eq!(imported.scene.triangle_count() as usize, points.len() - 2);
        let words = warnings(&imported, WarningCode::BadFace);
        assert!(words[0].message.contains("cross"), "{words:?}");
    }
}

#[test]
fn a_polygon_that_crosses_itself_keeps_its_border() {
    // Bent so much that every plane it is laid into makes it cross itself.
    let corners = [
        [-3.9, 5.6, -9.6],
        [6.2, 9.3, -0.3],
        [-1.9, -8.8, -1.9],
        [4.7, 5.1, 2.0],
        [0.0, -0.1, -9.2],
        [9.4, -9.1, 0.1],
    ]
    .map(DVec3::from_array);
    let sum: DVec3 = cut(&corners).iter().map(|t| area_vector(t)).sum();
    let border = area_vector(&corners);
    assert!(
        (sum - border).length() < 1e-5 * border.length(),
        "{sum} {border}"
    );
}

#[test]
fn huge_polygons_that_cross_themselves_end_in_good_time() {
    let mut state = 1u64;
    let mut random = || {
        state = state
            .wrapping_mul(6_364_136_223_846_793_005)
            .wrapping_add(1);
        (state >> 40) as f64
    };
    for (count, faces) in [(2_000, 1), (20_000, 40), (200_000, 2)] {
        let corners: Vec<DVec3> = (0..count)
            .map(|_| DVec3::new(random(), random(), 0.0))
            .collect();
        let mut text = text_of(&corners);
        let start_of_face = text.find('f').unwrap();
        text += &text[start_of_face..].repeat(faces - 1);
        let start = std::time::Instant::now();
        let imported = import_text(&text);
        let seconds = start.elapsed().as_secs_f64();
        assert_eq!(
            imported.scene.triangle_count() as usize,
            faces * (count - 2)
        );
        println!("{faces} times {count} corners: {seconds:.2} s");
        assert!(
            seconds < 120.0,
            "{faces} times {count} corners took {seconds} s"
        );
    }
}

/// A comb of `teeth` teeth: concave, and free of crossings.
fn comb(teeth: u32) -> Vec<DVec3> {
    let mut points = vec![[0.0, -1.0], [f64::from(teeth), -1.0]];
    points.extend((0..teeth).rev().flat_map(|i| {
        let x = f64::from(i);
        [[x + 1.0, 0.0], [x + 0.5, 5.0]]
    }));
    polygon(&points)
}

#[test]
fn a_large_polygon_is_covered_once() {
    let comb = comb(25_000);
    assert!(comb.len() > 50_000);
    assert_eq!(assert_covered(&comb, false), Ok(()));
}

#[test]
fn small_polygons_after_large_ones_that_cross_themselves_are_covered_once() {
    let star: Vec<DVec3> = (0..40_001)
        .map(|i| {
            let (sin, cos) = (f64::from(i) * 20_000.0 / 40_001.0 * std::f64::consts::TAU).sin_cos();
            DVec3::new(cos, sin, 0.0)
        })
        .collect();
    let small = comb(20);
    let text = text_of(&star)
        + &small
            .iter()
            .map(|p| format!("v {} {} {}\n", p.x, p.y, p.z))
            .collect::<String>()
        + &(1..=small.len())
            .rev()
            .fold("f".to_owned(), |face, i| face + &format!(" -{i}"))
        + "\n";
    let imported = import_text(&text);
    let words = warnings(&imported, WarningCode::BadFace);
    assert_eq!(words.len(), 1, "{words:?}");
    assert!(
        words[0].message.contains("cross") && words[0].count == 1,
        "{words:?}"
    );
    let triangles = world_triangles(&imported.scene);
    let covered: f64 = triangles[star.len() - 2..]
        .iter()
        .map(|t| area_vector(t).length())
        .sum();
    assert!(
        (covered - area_vector(&small).length()).abs() < 1e-4,
        "{covered}"
    );
}

#[test]
fn a_polygon_too_large_to_clip_is_a_fan_and_told() {
    let comb = comb(70_000);
    let imported = import_text(&text_of(&comb));
    assert_eq!(imported.scene.triangle_count() as usize, comb.len() - 2);
    let words = warnings(&imported, WarningCode::BadFace);
    assert_eq!(words.len(), 1, "{words:?}");
    assert!(words[0].message.contains("too large"), "{words:?}");
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(300))]

    #[test]
    fn star_shaped_polygons_in_any_plane_are_covered_once(
        radii in prop::collection::vec(0.05f64..1.0, 3..40),
        axis in prop::array::uniform3(-1.0f64..1.0),
        angle in 0.0f64..6.0,
        scale in -20i32..20,
    ) {
        let axis = DVec3::from_array(axis).try_normalize().unwrap_or(DVec3::Y);
        let turn = DQuat::from_axis_angle(axis, angle);
        let step = std::f64::consts::TAU / radii.len() as f64;
        let corners: Vec<DVec3> = radii
            .iter()
            .enumerate()
            .map(|(i, r)| {
                let (sin, cos) = (i as f64 * step).sin_cos();
                2f64.powi(scale) * (turn * DVec3::new(r * cos, r * sin, 0.0))
            })
            .collect();
        let covered = assert_covered(&corners, false);
        prop_assert!(covered.is_ok(), "{covered:?}");
    }
}
