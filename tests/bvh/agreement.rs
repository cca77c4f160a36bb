//! Every builder and width finds the very same hit, beyond what the numerical cases G10, G12 and G13 try
//! (`tests/stress.rs`).

use glam::Vec3;
use halfshade::bvh::{Builder, Bvh, Hit};
use halfshade::math::Ray;
use proptest::prelude::*;

use super::meshes::{Mesh, Random, bunny, soup, sphere};
use super::reference::check;

fn bits(hit: Option<Hit>) -> Option<[u32; 5]> {
    hit.map(|h| {
        [
            h.t.to_bits(),
            h.u.to_bits(),
            h.v.to_bits(),
            h.triangle,
            h.instance,
        ]
    })
}

/// What all of `trees` find; panics where two differ.
fn agreed(trees: &[(String, Bvh)], ray: &Ray) -> Option<Hit> {
    let hit = trees[0].1.closest_hit(ray);
    for (name, tree) in trees {
        let other = tree.closest_hit(ray);
        assert_eq!(
            bits(other),
            bits(hit),
            "{name} against {}: {ray:?}",
            trees[0].0
        );
        // Where somebody is to be asked no hit is held without the exact test.
        let asked = tree.closest_hit_if(ray, |_| true);
        assert_eq!(bits(asked), bits(hit), "asked, {name}: {ray:?}");
        for any in [tree.any_hit(ray), tree.any_hit_if(ray, |_| true)] {
            assert_eq!(any, hit.is_some(), "any hit, {name}: {ray:?}");
        }
    }
    hit
}

#[test]
fn coordinates_at_the_end_of_the_range() {
    let mesh = soup(300, 12).map(|p| 1e38 * p);
    let rays = mesh.rays(500, 13);
    let trees = mesh.trees();
    let hits = rays
        .iter()
        .filter(|ray| agreed(&trees, ray).is_some())
        .count();
    assert!(hits > 100, "{hits}");
}

#[test]
fn the_range_of_t_is_open() {
    let mesh = soup(300, 15);
    let trees = mesh.trees();
    for ray in mesh.rays(1000, 16) {
        let Some(first) = agreed(&trees, &ray) else {
            continue;
        };
        let t_max = Ray {
            t_max: first.t,
            ..ray
        };
        assert_eq!(agreed(&trees, &t_max), None);
        let t_max = Ray {
            t_max: first.t.next_up(),
            ..ray
        };
        assert_eq!(agreed(&trees, &t_max), Some(first));
        let beyond = agreed(
            &trees,
            &Ray {
                t_min: first.t,
                ..ray
            },
        );
        assert!(beyond.is_none_or(|hit| hit.t > first.t));
        let t_min = Ray {
            t_min: first.t.next_down(),
            ..ray
        };
        assert_eq!(agreed(&trees, &t_min), Some(first));
    }
}

#[test]
fn walking_through_all_hits_in_order() {
    let mesh = soup(400, 19);
    let trees = mesh.trees();
    for ray in mesh.rays(200, 20) {
        let all: Vec<Vec<_>> = trees.iter().map(|(_, tree)| walk(tree, &ray)).collect();
        assert!(all.iter().all(|hits| *hits == all[0]));
        assert!(all[0].is_sorted());
        let count = (0..400)
            .filter_map(|i| super::reference::cross(&ray, mesh.corners(i), 0))
            .filter(|c| c.inside > 0.0 && c.t > 0.0)
            .count();
        assert_eq!(all[0].len(), count, "{ray:?}");
    }
}

/// All hits, front to back, as a renderer walks through transparent ones.
fn walk(tree: &Bvh, ray: &Ray) -> Vec<(u32, u32)> {
    let place = |hit: &Hit| (hit.t.to_bits(), hit.triangle);
    let mut found = Vec::new();
    while let Some(hit) = tree.closest_hit_if(ray, |hit| Some(&place(hit)) > found.last()) {
        found.push(place(&hit));
    }
    found
}

#[test]
fn turned_down_hits_do_not_hide_others() {
    let mesh = soup(500, 21);
    let trees = mesh.trees();
    let odd = |hit: &Hit| hit.triangle % 2 == 1;
    let half = Mesh {
        indices: mesh.indices.iter().copied().skip(1).step_by(2).collect(),
        ..mesh.clone()
    };
    let half = half.tree(Builder::Balanced);
    for ray in mesh.rays(1000, 22) {
        let expected = half
            .closest_hit(&ray)
            .map(|hit| (hit.t, 2 * hit.triangle + 1));
        for (name, tree) in &trees {
            let hit = tree.closest_hit_if(&ray, odd);
            assert_eq!(hit.map(|hit| (hit.t, hit.triangle)), expected, "{name}");
            assert_eq!(tree.any_hit_if(&ray, odd), expected.is_some(), "{name}");
        }
    }
}

#[test]
fn rays_that_are_not_numbers_hit_nothing() {
    for (name, tree) in sphere(2).trees() {
        for bad in [f32::NAN, f32::INFINITY, f32::NEG_INFINITY] {
            for k in 0..3 {
                let mut place = Vec3::ZERO;
                place[k] = bad;
                let bad = [
                    Ray::new(place, Vec3::X),
                    Ray::new(Vec3::ZERO, place + Vec3::Y),
                ];
                assert!(bad.iter().all(|ray| !tree.any_hit(ray)), "{name}");
            }
        }
    }
    let trees = sphere(2).trees();
    for direction in [Vec3::X, Vec3::new(0.9, 0.3, 0.2)] {
        for [t_min, t_max] in [
            [2.0, 1.0],
            [0.0, f32::NAN],
            [0.0; 2],
            [0.0, -1.0],
            [-3.0, -0.5],
        ] {
            let nowhere = Ray {
                t_min,
                t_max,
                ..Ray::new(Vec3::ZERO, direction)
            };
            assert_eq!(agreed(&trees, &nowhere), None, "{nowhere:?}");
        }
    }
}

#[test]
fn the_bunny() {
    let Some(mesh) = bunny() else { return };
    let trees = mesh.trees();
    let mut rays = mesh.rays(300, 23);
    let mut random = Random(24);
    for _ in 0..300 {
        let at = mesh.positions[random.below(mesh.positions.len())];
        let origin = at + 0.2 * random.vector();
        rays.push(Ray::new(origin, at - origin));
    }
    let hits = rays
        .iter()
        .filter(|ray| check(&mesh, ray, agreed(&trees, ray), 1e-9));
    assert!(hits.count() > 300);
}

/// Few distinct values, so that points coincide, align and meet planes; and any others.
fn coordinate() -> impl Strategy<Value = f32> {
    prop_oneof![
        4 => (-2i32..=2).prop_map(|i| i as f32),
        2 => -2.0f32..2.0,
        1 => prop::sample::select(vec![-0.0, 1e-20, -1e-30, 1e-8, 1e3, 1e-42]),
    ]
}

fn point() -> impl Strategy<Value = Vec3> {
    [coordinate(), coordinate(), coordinate()].prop_map(Vec3::from)
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 2000, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn all_trees_agree_on_adversarial_coordinates(
        positions in prop::collection::vec(point(), 3..40),
        picks in prop::collection::vec(any::<[u8; 3]>(), 1..80),
        rays in prop::collection::vec((point(), point()), 1..20),
    ) {
        let pick = |i: u8| u32::from(i) % positions.len() as u32;
        let indices = picks.iter().map(|triangle| triangle.map(pick)).collect();
        let mesh = Mesh { positions, indices };
        let trees = mesh.trees();
        for (origin, direction) in rays {
            agreed(&trees, &Ray::new(origin, direction));
        }
    }
}
