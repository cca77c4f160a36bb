//! Input without extent, without anything, and how work grows with size. The rest is case G3.

use glam::Vec3;
use halfshade::bvh::{Builder, TraversalCounts};
use halfshade::math::Ray;

use super::meshes::{Mesh, Random, soup};

#[test]
fn nothing_is_never_hit() {
    for (name, tree) in Mesh::default().trees() {
        assert!(!tree.any_hit(&Ray::new(Vec3::ZERO, Vec3::X)), "{name}");
        assert!(tree.bounds().is_empty());
        assert_eq!(tree.stats().triangles, 0);
    }
}

#[test]
fn flat_boxes_and_points_in_line() {
    let mut random = Random(44);
    for shape in [
        Vec3::new(1.0, 1.0, 0.0),
        Vec3::new(1.0, 0.0, 1e-30),
        Vec3::new(1e-3, 1.0, 1.0),
    ] {
        let mesh = soup(5000, random.bits()).map(|p| shape * p + Vec3::new(0.0, 0.0, 3.0));
        let trees = mesh.trees();
        for ray in mesh.rays(300, 45) {
            let hit = trees[0].1.closest_hit(&ray);
            assert!(trees.iter().all(|(_, tree)| tree.closest_hit(&ray) == hit));
        }
        let stats = mesh.tree(Builder::Balanced).stats();
        assert!(stats.depth <= 12, "{shape}: {stats:?}");
    }
}

/// Work, not seconds: visits of a ray grow no faster than the logarithm would allow.
#[test]
fn traversal_grows_slowly_with_size() {
    let visits = |triangles: usize| {
        let mesh = soup(triangles, 46).map(|p| p);
        let shrink = (triangles as f32).powf(-0.5);
        let mut small = Mesh::default();
        for i in 0..triangles {
            let [a, b, c] = mesh.corners(i);
            small.add([a, a + shrink * (b - a), a + shrink * (c - a)]);
        }
        let tree = small.tree(Builder::Balanced);
        let mut counts = TraversalCounts::default();
        for ray in small.rays(2000, 47) {
            tree.closest_hit_counted(&ray, &mut counts);
        }
        (counts.nodes + counts.leaves) as f64 / 2000.0
    };
    let (small, large) = (visits(2_000), visits(128_000));
    assert!(large < 6.0 * small, "{small} visits, then {large}");
}
