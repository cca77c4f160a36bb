//! Brute force in double precision, by another formula than the core's (Möller and Trumbore 1997,
//! "Fast, Minimum Storage Ray/Triangle Intersection").

use crate::bench::Triangles;
use crate::bvh::Hit;
use crate::math::{Ray, UNIT_ROUNDOFF, Vec3};

/// Where a line meets a triangle's plane.
#[derive(Clone, Copy, Debug)]
pub struct Crossing {
    /// Which triangle.
    pub triangle: u32,
    /// Parameter of the ray.
    pub t: f64,
    /// Barycentric weight of corner 1.
    pub u: f64,
    /// Barycentric weight of corner 2.
    pub v: f64,
    /// Least barycentric weight: negative outside.
    pub inside: f64,
}

/// Where the line of `ray` crosses the plane of a triangle; `None` where it runs along it.
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

/// What a hit is, held against all triangles.
#[derive(Clone, Debug, PartialEq)]
pub enum Verdict {
    /// Rightly none.
    Miss,
    /// Right but for the error of its `t`, in roundings to single precision: 2^-24 of `t`, or of the least normal
    /// number where `t` is below that.
    Hit {
        /// The error.
        error: f64,
    },
    /// Wrong, and how.
    Wrong(String),
}

/// Holds `hit` against all of `triangles`: it must lie on its triangle, and nothing may be
/// certainly nearer by more than 4 roundings. `margin` is how far, in barycentric weight, a
/// crossing must be from an edge to be certain.
pub fn compare(triangles: &Triangles, ray: &Ray, hit: Option<Hit>, margin: f64) -> Verdict {
    let unit = f64::from(UNIT_ROUNDOFF);
    let tolerance = 4.0 * unit;
    // No hit can tell of a parameter beyond the largest number.
    let (t_min, t_max) = (f64::from(ray.t_min), f64::from(ray.t_max.min(f32::MAX)));
    // Where a ray starts in a triangle's plane, the sign of t is not certain.
    let size = |i: usize| {
        let far = triangles
            .corners(i)
            .map(|p| (p - ray.origin).abs().max_element());
        f64::from(far[0].max(far[1]).max(far[2])) / f64::from(ray.direction.abs().max_element())
    };
    let crossings = (0..triangles.indices.len())
        .filter_map(|i| cross(ray, triangles.corners(i), i as u32))
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
        return if nearest == f64::INFINITY {
            Verdict::Miss
        } else {
            Verdict::Wrong(format!("missed: {ray:?}"))
        };
    };
    let Some(own) = own else {
        return Verdict::Wrong(format!("{hit:?} is no crossing: {ray:?}"));
    };
    let off = |a: f32, b: f64| (f64::from(a) - b).abs() > margin + tolerance;
    let rounding = |t: f64| unit * t.max(f32::MIN_POSITIVE.into());
    if f64::from(hit.t) > nearest + 4.0 * rounding(nearest) {
        Verdict::Wrong(format!("{hit:?}, nearer {nearest}: {ray:?}"))
    } else if off(hit.u, own.u) || off(hit.v, own.v) {
        Verdict::Wrong(format!("{hit:?}, weights {} {}: {ray:?}", own.u, own.v))
    } else {
        let error = (f64::from(hit.t) - own.t).abs() / rounding(own.t);
        Verdict::Hit { error }
    }
}
