//! G3: input without area, without extent, without anything.

use glam::Vec3;
use halfshade::bvh::{Builder, TraversalCounts};
use halfshade::math::Ray;

use super::meshes::{Mesh, Random, soup, sphere};

const BUILDERS: [Builder; 4] = [
    Builder::Median,
    Builder::Fast,
    Builder::Balanced,
    Builder::Quality,
];

#[test]
fn nothing_is_never_hit() {
    for (name, tree) in Mesh::default().trees() {
        assert!(!tree.any_hit(&Ray::new(Vec3::ZERO, Vec3::X)), "{name}");
        assert!(tree.bounds().is_empty());
        assert_eq!(tree.stats().triangles, 0);
    }
}

#[test]
fn triangles_without_area_are_never_hit_and_disturb_nothing() {
    let plain = sphere(2);
    let mut mesh = Mesh::default();
    let mut random = Random(41);
    let mut original = Vec::new();
    for i in 0..plain.indices.len() {
        let (p, q) = (random.vector(), random.vector());
        mesh.add([p, p, p]);
        mesh.add([p, q, p]);
        mesh.add([p, p + 0.5 * (q - p).round(), p + (q - p).round()]);
        mesh.add([Vec3::splat(f32::NAN), p, q]);
        mesh.add([p, q, Vec3::new(0.0, f32::INFINITY, 0.0)]);
        original.push(mesh.indices.len() as u32);
        mesh.add(plain.corners(i));
    }
    let clean = plain.tree(Builder::Balanced);
    for (name, tree) in mesh.trees() {
        assert!(tree.bounds() == clean.bounds(), "{name}");
        for ray in plain.rays(1000, 42) {
            let expected = clean
                .closest_hit(&ray)
                .map(|h| (h.t, original[h.triangle as usize]));
            let found = tree.closest_hit(&ray).map(|h| (h.t, h.triangle));
            // A sliver of `p, q` above can have an area after rounding: then it may be hit.
            let thin = found.is_some_and(|(_, i)| original.binary_search(&i).is_err());
            assert!(
                found == expected || thin,
                "{name}: {found:?}, not {expected:?}"
            );
            assert!(!thin || tree.stats().triangles > plain.indices.len());
        }
    }
}

#[test]
fn a_hundred_thousand_identical_triangles() {
    let triangle = [Vec3::X, Vec3::Y, Vec3::Z];
    let mut mesh = Mesh::default();
    (0..100_000).for_each(|_| mesh.add(triangle));
    for builder in BUILDERS {
        let tree = mesh.tree(builder);
        assert!(
            tree.stats().depth <= 16,
            "{builder}: depth {}",
            tree.stats().depth
        );
        let hit = tree.closest_hit(&Ray::new(Vec3::ZERO, Vec3::ONE)).unwrap();
        assert_eq!(hit.triangle, 0);
    }
}

#[test]
fn all_centroids_equal() {
    let mut random = Random(43);
    let mut mesh = Mesh::default();
    for _ in 0..20_000 {
        // The box of these three points is centred on the origin.
        let a = random.vector();
        mesh.add([a, -a, Vec3::new(a.y, -a.x, 0.0).clamp(-a.abs(), a.abs())]);
    }
    for builder in BUILDERS {
        let tree = mesh.tree(builder);
        assert!(
            tree.stats().depth <= 16,
            "{builder}: depth {}",
            tree.stats().depth
        );
    }
}

/// Spacing that halves from one triangle to the next drives binned splits to their worst.
#[test]
fn depth_is_bounded_for_geometric_spacing() {
    let mut mesh = Mesh::default();
    for i in 0..200_000 {
        let x = 0.999f32.powi(i % 100_000) * if i < 100_000 { 1.0 } else { 1e-20 };
        mesh.add([
            Vec3::splat(x),
            x * Vec3::new(1.0, 1.001, 1.0),
            x * Vec3::new(1.001, 1.0, 1.0),
        ]);
    }
    for (name, tree) in mesh.trees() {
        assert!(
            tree.stats().depth <= 64,
            "{name}: depth {}",
            tree.stats().depth
        );
    }
    for k in 0..127 {
        let x = 2f32.powi(-k);
        (0..17).for_each(|i| mesh.add([x * Vec3::X, x * Vec3::Y, (1.0 + i as f32) * x * Vec3::Z]));
    }
    for (name, tree) in mesh.trees() {
        assert!(
            tree.stats().depth <= 64,
            "{name}: depth {}",
            tree.stats().depth
        );
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
