//! Triangles as seen from a point: solid angles, and samples that have the density they claim.

use std::f64::consts::PI;

use halfshade::light::SeenTriangle;
use halfshade::math::DVec3;

use crate::random;

fn corner(x: f64, y: f64, z: f64) -> DVec3 {
    DVec3::new(x, y, z)
}

/// Triangles above the origin: near, far, thin, seen edge-on.
fn triangles() -> Vec<[DVec3; 3]> {
    let base = [
        corner(-1.0, -0.8, 1.0),
        corner(1.2, -0.7, 1.0),
        corner(0.1, 1.1, 1.0),
    ];
    let moved = |by: DVec3| base.map(|p| p + by);
    vec![
        base,
        moved(corner(0.0, 0.0, -0.9)),
        moved(corner(3.0, 1.0, 2.0)),
        moved(corner(0.0, 0.0, 300.0)),
        moved(corner(20.0, 0.0, -0.5)),
        [base[0], base[1], base[0] + corner(0.01, 0.02, 0.3)],
        base.map(|p| p * 1e-9),
        base.map(|p| p * 1e9),
        [base[0], base[2], base[1]],
    ]
}

/// The irradiance that samples bring to the origin is Lambert's sum over the edges.
#[test]
fn samples_bring_the_irradiance_of_the_closed_form() {
    for (number, corners) in triangles().into_iter().enumerate() {
        let seen = SeenTriangle::new(corners).unwrap();
        let values: Vec<f64> = random(20_000, number as u64)
            .map(|u| {
                let sample = seen.sample(u).unwrap();
                sample.direction.z.max(0.0) / sample.density
            })
            .collect();
        let n = values.len() as f64;
        let mean = values.iter().sum::<f64>() / n;
        let variance = values.iter().map(|v| (v - mean).powi(2)).sum::<f64>() / (n * (n - 1.0));
        let expected = lambert(corners);
        let off = (mean - expected).abs();
        assert!(
            off <= 4.5 * variance.sqrt() + 1e-9 * expected,
            "triangle {number}: {mean} for {expected}"
        );
    }
}

/// Lambert's edge sum for a triangle that is above z = 0.
fn lambert(corners: [DVec3; 3]) -> f64 {
    let edge = |i: usize| {
        let (a, b) = (corners[i], corners[(i + 1) % 3]);
        let cross = a.cross(b);
        cross.length().atan2(a.dot(b)) * cross.normalize().z
    };
    0.5 * (0..3).map(edge).sum::<f64>().abs()
}

/// A sample's place is where its direction meets the triangle, and its density is that of the direction.
#[test]
fn direction_place_and_density_agree() {
    for (number, corners) in triangles().into_iter().enumerate() {
        let [a, b, c] = corners;
        let seen = SeenTriangle::new(corners).unwrap();
        assert_eq!(seen.is_front(), number != 8, "triangle {number}");
        for u in random(500, 7) {
            let sample = seen.sample(u).unwrap();
            let [v, w] = sample.barycentric;
            assert!(v >= 0.0 && w >= 0.0 && v + w <= 1.0 + 1e-12);
            let place = a * (1.0 - v - w) + b * v + c * w;
            let along = sample.direction * sample.distance;
            assert!(
                (place - along).length() <= 1e-6 * place.length(),
                "triangle {number}: {place} {along}"
            );
            let density = seen.density(place.normalize());
            assert!((density / sample.density - 1.0).abs() < 1e-6);
        }
    }
}

#[test]
fn an_octant_has_an_eighth_of_all_directions() {
    let seen = SeenTriangle::new([DVec3::X, DVec3::Y, DVec3::Z]).unwrap();
    let density = seen.density(DVec3::ONE.normalize());
    assert!((density * 0.5 * PI - 1.0).abs() < 1e-12);
}

#[test]
fn a_triangle_without_area_is_not_seen() {
    assert!(SeenTriangle::new([DVec3::X, DVec3::X, DVec3::Y]).is_none());
    // From within its plane.
    assert!(SeenTriangle::new([DVec3::X, DVec3::Y, -DVec3::X - DVec3::Y]).is_none());
}
