//! Trees of instances against the same triangles, flattened.

use glam::{DAffine3, DQuat, DVec3, Vec3};
use halfshade::bvh::{Builder, Hit, Tracer};
use halfshade::math::Ray;

use super::meshes::{Mesh, Random, soup, sphere};
use super::reference::cross;

fn placements(count: usize, seed: u64) -> Vec<(u32, DAffine3)> {
    let mut random = Random(seed);
    let mut vector = || random.vector().as_dvec3();
    (0..count)
        .map(|i| {
            let scale = DVec3::splat(0.3) + 0.2 * vector();
            let mirror = DVec3::new(if i % 3 == 0 { -1.0 } else { 1.0 }, 1.0, 1.0);
            let turn = DQuat::from_scaled_axis(3.0 * vector());
            let to_world =
                DAffine3::from_scale_rotation_translation(scale * mirror, turn, 4.0 * vector());
            ((i % 2) as u32, to_world)
        })
        .collect()
}

fn flatten(meshes: &[Mesh], instances: &[(u32, DAffine3)]) -> (Mesh, Vec<(u32, u32)>) {
    let mut flat = Mesh::default();
    let mut names = Vec::new();
    for (i, (tree, to_world)) in instances.iter().enumerate() {
        let mesh = &meshes[*tree as usize];
        for triangle in 0..mesh.indices.len() {
            let place = |p: Vec3| to_world.transform_point3(p.as_dvec3()).as_vec3();
            flat.add(mesh.corners(triangle).map(place));
            names.push((i as u32, triangle as u32));
        }
    }
    (flat, names)
}

#[test]
fn instances_are_hit_as_if_they_were_flattened() {
    let meshes = [sphere(2), soup(200, 61)];
    let trees = || {
        meshes
            .iter()
            .map(|m| m.tree(Builder::Balanced))
            .collect::<Vec<_>>()
    };
    for count in [1, 2, 8, 9, 60, 300] {
        let instances = placements(count, 62);
        let tracer = Tracer::new(trees(), &instances);
        assert!(matches!(tracer, Tracer::Instanced(_)));
        let (flat, names) = flatten(&meshes, &instances);
        let tree = flat.tree(Builder::Balanced);
        let (mut hits, mut others) = (0, 0);
        for ray in flat.rays(3000, 63) {
            let hit = tracer.closest_hit(&ray);
            assert_eq!(tracer.any_hit(&ray), hit.is_some());
            let expected = tree.closest_hit(&ray);
            let name = |hit: Hit| names[hit.triangle as usize];
            let (Some(a), Some(b)) = (hit, expected) else {
                others += usize::from(hit.is_some() || expected.is_some());
                continue;
            };
            hits += 1;
            if (a.instance, a.triangle) == name(b) {
                let [p, q, r] = flat.corners(b.triangle as usize);
                let normal = (q - p).cross(r - p).normalize();
                let cosine = normal.dot(ray.direction.normalize()).abs();
                assert!((a.t - b.t).abs() < 3e-6 / cosine, "{a:?}, {b:?}");
            } else {
                others += 1;
            }
        }
        // Rays that pass an edge within rounding may find its other side.
        assert!(
            hits > 30 && others <= 3,
            "{count} instances: {hits} hits, {others} others"
        );
    }
}

#[test]
fn one_tree_that_stands_still_is_flat() {
    let mesh = sphere(3);
    let tree = mesh.tree(Builder::Balanced);
    let flat = Tracer::new(
        vec![mesh.tree(Builder::Balanced)],
        &[(0, DAffine3::IDENTITY)],
    );
    assert!(matches!(flat, Tracer::Flat(_)));
    // Twice the same place: the first instance wins every tie, and nothing is moved.
    let twice = [(0, DAffine3::IDENTITY), (0, DAffine3::IDENTITY)];
    let twice = Tracer::new(vec![mesh.tree(Builder::Balanced)], &twice);
    for ray in mesh.rays(2000, 64) {
        let hit = tree.closest_hit(&ray);
        assert_eq!(flat.closest_hit(&ray), hit);
        assert_eq!(twice.closest_hit(&ray), hit);
        let second = twice.closest_hit_if(&ray, |hit| hit.instance == 1);
        assert_eq!(second.map(|h| Hit { instance: 0, ..h }), hit);
        assert_eq!(
            twice.any_hit_if(&ray, |hit| hit.instance == 1),
            hit.is_some()
        );
    }
}

#[test]
fn the_tree_over_instances_hides_none() {
    // Far apart, tiny, large and thin ones: each is hit by a ray at the middle of a triangle.
    let mesh = sphere(1);
    let mut random = Random(65);
    let mut instances = Vec::new();
    for i in 0..500 {
        let size = 10f64.powi(i % 5 - 2) * DVec3::new(1.0, 1.0, 10f64.powi(-(i / 5 % 3)));
        let turn = DQuat::from_scaled_axis(3.0 * random.vector().as_dvec3());
        let place = 1e4 * random.vector().as_dvec3();
        instances.push((
            0,
            DAffine3::from_scale_rotation_translation(size, turn, place),
        ));
    }
    let trees = || vec![mesh.tree(Builder::Balanced)];
    let tracer = Tracer::new(trees(), &instances);
    let mut hits = 0;
    for (i, instance) in (0..).zip(&instances) {
        let alone = Tracer::new(trees(), std::slice::from_ref(instance));
        for triangle in 0..mesh.indices.len() {
            let middle = mesh.corners(triangle).iter().sum::<Vec3>() / 3.0;
            let target = instance.1.transform_point3(middle.as_dvec3()).as_vec3();
            let origin = 1e4 * random.vector();
            let ray = Ray::new(origin, target - origin);
            if let Some(hit) = alone.closest_hit(&ray) {
                let own = tracer.closest_hit_if(&ray, |hit| hit.instance == i);
                assert_eq!(own, Some(Hit { instance: i, ..hit }), "{ray:?}");
                hits += 1;
            }
        }
    }
    // The others are so small that rounding of the coordinates misses them.
    assert!(hits > 25_000, "{hits} of {}", 500 * mesh.indices.len());
}

#[test]
fn transforms_that_cannot_be_inverted_are_never_hit() {
    let mesh = sphere(1);
    let flat = DAffine3::from_scale(DVec3::new(1.0, 0.0, 1.0));
    let nan = DAffine3::from_translation(DVec3::NAN);
    let instances = [(0, flat), (0, DAffine3::IDENTITY), (0, nan)];
    let tracer = Tracer::new(vec![mesh.tree(Builder::Balanced)], &instances);
    for ray in mesh.rays(500, 66) {
        if let Some(hit) = tracer.closest_hit(&ray) {
            assert_eq!(hit.instance, 1);
            let corners = mesh.corners(hit.triangle as usize);
            assert!(cross(&ray, corners, 0).unwrap().inside > -1e-9);
        }
    }
    let nothing = Tracer::new(vec![mesh.tree(Builder::Balanced)], &[]);
    assert!(!nothing.any_hit(&Ray::new(Vec3::ZERO, Vec3::X)));
    assert!(nothing.bounds().is_empty());
}
