//! Brute force in f64, by another formula than the core's (Möller and Trumbore 1997, "Fast,
//! Minimum Storage Ray/Triangle Intersection").

use glam::Vec3;
use halfshade::bvh::Hit;
use halfshade::math::Ray;

use super::meshes::Mesh;

/// Where a line meets a triangle's plane.
pub struct Crossing {
    pub triangle: u32,
    pub t: f64,
    pub u: f64,
    pub v: f64,
    /// Least barycentric weight: negative outside.
    pub inside: f64,
}

pub fn cross(ray: &Ray, corners: [Vec3; 3], triangle: u32) -> Option<Crossing> {
    let [a, b, c] = corners.map(|p| p.as_dvec3());
    let direction = ray.direction.as_dvec3();
    let (e, f) = (b - a, c - a);
    let p = direction.cross(f);
    let determinant = e.dot(p);
    if determinant == 0.0 {
        return None;
    }
    let s = ray.origin.as_dvec3() - a;
    let q = s.cross(e);
    let (u, v) = (s.dot(p) / determinant, direction.dot(q) / determinant);
    Some(Crossing {
        triangle,
        t: f.dot(q) / determinant,
        u,
        v,
        inside: u.min(v).min(1.0 - u - v),
    })
}

/// Holds `hit` against all triangles: it must lie on its triangle, with `t` right to 4
/// roundings, and nothing may be certainly nearer. `margin` is how far, in barycentric weight,
/// a crossing must be from an edge to be certain. Returns whether something was hit.
pub fn check(mesh: &Mesh, ray: &Ray, hit: Option<Hit>, margin: f64) -> bool {
    let tolerance = 4.0 * f64::from(halfshade::math::UNIT_ROUNDOFF);
    let (t_min, t_max) = (f64::from(ray.t_min), f64::from(ray.t_max));
    // Where a ray starts in a triangle's plane, the sign of t is not certain.
    let size = |i: usize| {
        let far = mesh
            .corners(i)
            .map(|p| (p - ray.origin).abs().max_element());
        f64::from(far[0].max(far[1]).max(far[2]) / ray.direction.abs().max_element())
    };
    let crossings = (0..mesh.indices.len())
        .filter_map(|i| cross(ray, mesh.corners(i), i as u32))
        .filter(|c| c.inside > -margin && c.t > t_min && c.t < t_max)
        .filter(|c| c.t > 1e-13 * size(c.triangle as usize));
    let mut nearest = f64::INFINITY;
    let mut own = None;
    for crossing in crossings {
        if crossing.inside > margin {
            nearest = nearest.min(crossing.t);
        }
        if hit.is_some_and(|hit| hit.triangle == crossing.triangle) {
            own = Some(crossing);
        }
    }
    let Some(hit) = hit else {
        assert_eq!(nearest, f64::INFINITY, "missed: {ray:?}");
        return false;
    };
    let own = own.unwrap_or_else(|| panic!("{hit:?} is no crossing: {ray:?}"));
    let t = f64::from(hit.t);
    assert!(
        (t - own.t).abs() <= tolerance * own.t,
        "{hit:?}, t {}: {ray:?}",
        own.t
    );
    assert!(
        t <= nearest * (1.0 + tolerance),
        "{hit:?}, nearer {nearest}: {ray:?}"
    );
    assert!(
        (f64::from(hit.u) - own.u).abs() <= margin + tolerance,
        "{hit:?}, u {}",
        own.u
    );
    assert!(
        (f64::from(hit.v) - own.v).abs() <= margin + tolerance,
        "{hit:?}, v {}",
        own.v
    );
    true
}
