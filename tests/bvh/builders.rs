//! Builders: shape, determinism, memory, names.

use glam::Vec3;
use halfshade::bvh::{Builder, Bvh, TraversalCounts, Width};
use halfshade::math::Ray;

use super::meshes::{Mesh, bunny, room, soup, sphere, terrain};
use super::reference::check;

#[test]
fn the_tree_is_the_same_for_any_number_of_threads() {
    let mesh = terrain(220);
    for builder in Builder::ALL {
        for width in Width::available() {
            let with = |threads: usize| {
                let pool = rayon::ThreadPoolBuilder::new().num_threads(threads);
                let build = || Bvh::build_with(&mesh.positions, &mesh.indices, builder, width);
                pool.build().unwrap().install(build).unwrap()
            };
            let one = with(1);
            assert!(one.stats().triangles == mesh.indices.len());
            assert!(one == with(2) && one == with(7), "{builder}, {width:?}");
        }
    }
}

#[test]
fn balanced_beats_median_beats_none() {
    let mesh = bunny().unwrap_or_else(|| sphere(5));
    let rays = mesh.rays(1000, 51);
    let visits = |builder: Builder| {
        let tree = mesh.tree(builder);
        let mut counts = TraversalCounts::default();
        for ray in &rays {
            tree.closest_hit_counted(ray, &mut counts);
        }
        counts.nodes + counts.leaves
    };
    let [median, balanced, none] = [Builder::Median, Builder::Balanced, Builder::None].map(visits);
    assert!(
        balanced < median && 20 * median < none,
        "{balanced} {median} {none}"
    );
}

/// The tree of `Fast` is not much worse than that of `Balanced`, and `Quality` no worse.
#[test]
fn builders_are_worth_their_time() {
    let mesh = room();
    let rays = mesh.rays(2000, 54);
    let work = |builder: Builder| {
        let tree = mesh.tree(builder);
        let mut counts = TraversalCounts::default();
        for ray in &rays {
            tree.closest_hit_counted(ray, &mut counts);
        }
        // About the time that each takes.
        (2 * counts.nodes + 7 * counts.leaves) as f64
    };
    let [fast, balanced, quality] = [Builder::Fast, Builder::Balanced, Builder::Quality].map(work);
    println!("fast {fast}, balanced {balanced}, quality {quality}");
    assert!(fast < 1.4 * balanced, "{fast} {balanced}");
    assert!(quality < 0.98 * balanced, "{quality} {balanced}");
}

/// A mesh whose triangles `Quality` cuts by the thousand, against brute force.
#[test]
fn cut_triangles_are_hit_as_if_they_were_whole() {
    let mesh = room();
    let rays = mesh.rays(300, 55);
    for (name, tree) in mesh.trees() {
        assert_eq!(tree.stats().triangles, mesh.indices.len(), "{name}");
        for ray in &rays {
            let hit = tree.closest_hit(ray);
            assert_eq!(hit.is_some(), tree.any_hit(ray), "{name}");
            check(&mesh, ray, hit, 1e-9);
        }
    }
}

#[test]
fn memory_is_at_most_60_bytes_a_triangle() {
    for mesh in [Some(terrain(300)), Some(sphere(6)), bunny()]
        .into_iter()
        .flatten()
    {
        let tree = mesh.tree(Builder::Balanced);
        let bytes = tree.memory_bytes() as f64 / mesh.indices.len() as f64;
        println!("{bytes:.1} bytes a triangle, {:?}", tree.stats());
        assert!(bytes <= 60.0, "{bytes}");
    }
}

#[test]
fn counting_changes_no_hit() {
    let mesh = soup(2000, 52);
    for (name, tree) in mesh.trees() {
        let mut counts = TraversalCounts::default();
        for ray in mesh.rays(300, 53) {
            assert_eq!(
                tree.closest_hit(&ray),
                tree.closest_hit_counted(&ray, &mut counts)
            );
            assert_eq!(tree.any_hit(&ray), tree.any_hit_counted(&ray, &mut counts));
        }
        assert!(
            counts.leaves > 300 && counts.triangles > 100,
            "{name}: {counts:?}"
        );
        assert_eq!(
            counts.nodes == 0,
            name.starts_with("none"),
            "{name}: {counts:?}"
        );
    }
}

/// What is certain to be hit is held until the end.
#[test]
fn most_rays_take_the_exact_test_once() {
    let mesh = sphere(5);
    for (name, tree) in mesh.trees() {
        if name.starts_with("none") {
            continue; // once for each block
        }
        let mut counts = TraversalCounts::default();
        let rays = mesh.rays(3000, 54);
        let hits = rays
            .iter()
            .filter(|ray| tree.closest_hit_counted(ray, &mut counts).is_some());
        let hits = hits.count() as f64;
        assert!(
            hits > 500.0 && (counts.triangles as f64) < 1.2 * hits,
            "{name}: {hits} {counts:?}"
        );
    }
}

#[test]
fn stats_tell_the_shape() {
    let mesh = terrain(100);
    let stats = mesh.tree(Builder::Balanced).stats();
    assert_eq!(stats.triangles, 20_000);
    assert!(stats.depth >= 3 && stats.depth <= 8, "{stats:?}");
    assert!(stats.sah_cost > 2.0 && stats.sah_cost < 40.0, "{stats:?}");
    assert!(
        stats.children_per_node > 5.0 && stats.triangles_per_leaf > 5.0,
        "{stats:?}"
    );
    let one = Mesh {
        indices: mesh.indices[..1].to_vec(),
        ..mesh
    };
    let stats = one.tree(Builder::Balanced).stats();
    assert_eq!((stats.nodes, stats.leaves, stats.depth), (0, 1, 0));
}

#[test]
fn builders_have_names() {
    for builder in Builder::ALL {
        assert_eq!(builder.to_string().parse(), Ok(builder));
    }
    assert!(
        "fastest"
            .parse::<Builder>()
            .unwrap_err()
            .contains("balanced")
    );
}

#[test]
fn rays_reach_all_triangles() {
    // A ray through the middle of each triangle, from close by, finds that triangle.
    let mesh = sphere(4);
    for (name, tree) in mesh.trees() {
        for i in 0..mesh.indices.len() {
            let [a, b, c] = mesh.corners(i);
            let middle: Vec3 = (a + b + c) / 3.0;
            let hit = tree.closest_hit(&Ray::new(0.9 * middle, middle)).unwrap();
            assert_eq!(hit.triangle as usize, i, "{name}");
            assert!((hit.u - 1.0 / 3.0).abs() < 1e-3 && (hit.v - 1.0 / 3.0).abs() < 1e-3);
        }
    }
}
