//! Hits against brute force in f64.

use halfshade::bvh::Hit;
use halfshade::math::Ray;
pub use halfshade::stress::reference::cross;
use halfshade::stress::reference::{Verdict, compare};

use super::meshes::Mesh;

/// Holds `hit` against all triangles, its `t` to 4 roundings. Returns whether something was hit.
pub fn check(mesh: &Mesh, ray: &Ray, hit: Option<Hit>, margin: f64) -> bool {
    match compare(mesh, ray, hit, margin) {
        Verdict::Miss => false,
        Verdict::Hit { error } => {
            assert!(error <= 4.0, "{hit:?} is off by {error} roundings: {ray:?}");
            true
        }
        Verdict::Wrong(how) => panic!("{how}"),
    }
}
