//! Rays that are traced together find what each finds by itself, bit for bit.

use glam::Vec3;
use halfshade::bvh::{Builder, Bvh};
use halfshade::math::{ROW, Ray, RayRow};

use super::meshes::{Mesh, Random, bunny, soup, sphere, terrain};

/// Holds what all of `rays` find together against what each finds alone, in every tree of `mesh`; returns the share
/// that hit.
fn check(mesh: &Mesh, rays: &[Ray]) -> f64 {
    let mut share = 0.0;
    for (name, tree) in mesh.trees() {
        share = check_in(&tree, rays, &name);
    }
    share
}

fn check_in(tree: &Bvh, rays: &[Ray], name: &str) -> f64 {
    let rows: Vec<RayRow> = rays.chunks(ROW).map(|row| row.iter().collect()).collect();
    let (hits, blocked): (Vec<_>, Vec<_>) = rows
        .iter()
        .flat_map(|row| {
            let (hits, blocked) = (tree.closest_hits(row), tree.any_hits(row));
            (0..row.count()).map(move |i| (hits.get(i), blocked >> i & 1 != 0))
        })
        .unzip();
    for (i, ray) in rays.iter().enumerate() {
        let alone = tree.closest_hit(ray);
        let asked = tree.closest_hit_if(ray, |_| true);
        // `Debug` shows every bit of a float.
        for hit in [hits[i], asked] {
            assert_eq!(
                format!("{hit:?}"),
                format!("{alone:?}"),
                "{name}, ray {i}: {ray:?}"
            );
        }
        assert_eq!(blocked[i], alone.is_some(), "{name}, ray {i}: {ray:?}");
    }
    hits.iter().flatten().count() as f64 / rays.len() as f64
}

/// Rays from `eye` to points near `target`, as of `width`² neighbouring pixels.
fn camera(eye: Vec3, target: Vec3, size: f32, width: u32) -> Vec<Ray> {
    let ahead = target - eye;
    let forward = ahead.normalize();
    let right = forward.any_orthonormal_vector();
    let up = right.cross(forward);
    let place = |k: u32| 2.0 * (k as f32 + 0.5) / width as f32 - 1.0;
    let rays = (0..width * width).map(|i| {
        let aim = target + size * (place(i % width) * right + place(i / width) * up);
        Ray::new(eye, aim - eye)
    });
    rays.collect()
}

#[test]
fn camera_rays() {
    for (mesh, target) in [
        (sphere(4), Vec3::ZERO),
        (soup(3000, 1), Vec3::ZERO),
        (terrain(40), Vec3::ZERO),
    ] {
        for (eye, size) in [
            (Vec3::new(0.3, 2.0, 3.0), 1.0),
            (Vec3::new(-5.0, 0.4, 0.2), 0.02),
            (Vec3::new(0.0, 0.0, 4.0), 0.3),
            (Vec3::new(2.0, 2.0, 2.0), 0.5),
        ] {
            check(&mesh, &camera(eye, target, size, 24));
        }
    }
    let share = check(&sphere(4), &camera(4.0 * Vec3::X, Vec3::ZERO, 0.5, 16));
    assert!(share > 0.9, "{share}");
}

#[test]
fn shadow_rays_that_end_at_a_disk() {
    let mesh = sphere(4);
    let mut random = Random(3);
    let mut rays = Vec::new();
    for i in 0..640 {
        let start = Vec3::new(0.01 * (i % 25) as f32, -2.0, 0.01 * (i / 25) as f32);
        let end = Vec3::new(0.4 * random.unit(), 3.0, 0.4 * random.unit());
        rays.push(Ray {
            t_max: [0.1, 0.999, 1.0][i % 3],
            ..Ray::new(start, end - start)
        });
    }
    let share = check(&mesh, &rays);
    assert!(share > 0.3 && share < 1.0, "{share}");
}

#[test]
fn at_any_scale_and_place() {
    let rays = camera(Vec3::new(1.0, 2.0, 5.0), Vec3::ZERO, 0.2, 16);
    for scale in [1e-30, 1e-12, 1e12, 1e14, 1e17] {
        let mesh = sphere(3).map(|p| scale * p);
        // Packets need directions of ordinary lengths.
        for length in [scale, 1.0, 1e-8, 1e8] {
            let scaled = rays.iter().map(|ray| {
                let direction = ray.direction / ray.direction.abs().max_element();
                Ray::new(scale * ray.origin, length * direction)
            });
            let share = check(&mesh, &scaled.collect::<Vec<_>>());
            assert!(share > 0.9, "{scale}, {length}: {share}");
        }
    }
    for shift in [1e2, 1e4, 1e6] {
        let mesh = sphere(3).map(|p| p + shift);
        let eye = Vec3::splat(shift) + Vec3::new(1.0, 2.0, 5.0);
        check(&mesh, &camera(eye, Vec3::splat(shift), 0.2, 16));
    }
}

#[test]
fn rays_that_have_nothing_in_common_or_are_none() {
    let mesh = soup(300, 2);
    let mut rays = mesh.rays(500, 4);
    for direction in [
        Vec3::ZERO,
        Vec3::NAN,
        Vec3::new(f32::INFINITY, 0.0, 1.0),
        Vec3::new(1.0, f32::NAN, 0.0),
        Vec3::X,
    ] {
        rays.push(Ray::new(Vec3::ZERO, direction));
        rays.push(Ray::new(Vec3::NAN, direction));
    }
    check(&mesh, &rays);
    for few in 0..9 {
        check(&mesh, &rays[..few.min(rays.len())]);
    }
    // Parallel to an axis, along edges of the boxes.
    let along = (0..100).map(|i| Ray::new(Vec3::new(0.0, 0.1 * i as f32 - 5.0, -9.0), Vec3::Z));
    check(&mesh, &along.collect::<Vec<_>>());
    check(&soup(0, 1), &rays[..70]);
}

#[test]
fn a_ray_that_is_none_takes_nothing_from_its_neighbours() {
    let mesh = sphere(4);
    for broken in [7, 20, 63] {
        let mut rays = camera(4.0 * Vec3::X, Vec3::ZERO, 0.3, 8);
        rays[broken].direction.y = f32::NAN;
        check(&mesh, &rays);
        let mut rays = camera(4.0 * Vec3::X, Vec3::ZERO, 0.3, 8);
        rays[broken].t_max = f32::NAN;
        check(&mesh, &rays);
    }
}

#[test]
fn many_small_triangles() {
    let Some(mesh) = bunny() else {
        return;
    };
    let rays = camera(Vec3::new(0.0, 0.1, 0.5), Vec3::new(0.0, 0.1, 0.0), 0.15, 40);
    for (name, tree) in mesh.trees().into_iter().take(3) {
        check_in(&tree, &rays, &name);
    }
}

/// Sheets of small triangles, one behind the other: so close that bounds of depth overlap, coincident, or turned round.
fn sheets() -> Mesh {
    let mut mesh = terrain(24);
    let one = mesh.clone();
    for (number, shift) in [0.0, 1e-7, 2e-6, 1e-3, -1e-3, 0.0].into_iter().enumerate() {
        let first = mesh.positions.len() as u32;
        mesh.positions.extend(
            one.positions
                .iter()
                .map(|p| *p + Vec3::new(0.0, shift, 0.0)),
        );
        mesh.indices.extend(one.indices.iter().map(|&[a, b, c]| {
            let [a, b, c] = [a + first, b + first, c + first];
            if number % 2 == 0 {
                [a, b, c]
            } else {
                [c, b, a]
            }
        }));
    }
    mesh
}

#[test]
fn surfaces_that_nearly_coincide() {
    let mesh = sheets();
    let tree = Bvh::build(&mesh.positions, &mesh.indices, Builder::Balanced);
    for (eye, size) in [
        (Vec3::new(0.3, 2.0, 3.0), 1.0),
        (Vec3::new(0.3, 2.0, 3.0), 0.01),
        (Vec3::new(0.0, -4.0, 0.1), 0.3),
    ] {
        let mut rays = camera(eye, Vec3::ZERO, size, 24);
        let share = check(&mesh, &rays);
        assert!(share > 0.05, "{share}");
        // Ends at the surfaces, or beginnings.
        for ray in &mut rays {
            let Some(t) = tree.closest_hit(ray).map(|hit| hit.t) else {
                continue;
            };
            (ray.t_min, ray.t_max) = if ray.direction.x > 0.0 {
                (t, f32::INFINITY)
            } else {
                (0.0, t.next_up())
            };
        }
        check(&mesh, &rays);
    }
}

#[test]
fn rays_that_start_on_a_surface() {
    let mesh = terrain(40);
    let start = camera(Vec3::new(0.3, 2.0, 3.0), Vec3::ZERO, 0.5, 16);
    let tree = Bvh::build(&mesh.positions, &mesh.indices, Builder::Balanced);
    for above in [0.0, 1e-8, 1e-7, 1e-6, 1e-4] {
        let rays = start.iter().filter_map(|ray| {
            let hit = tree.closest_hit(ray)?;
            let point = ray.at(hit.t) + above * Vec3::Y;
            Some(Ray::new(point, Vec3::new(0.2, 1.0, 0.1)))
        });
        check(&mesh, &rays.collect::<Vec<_>>());
    }
}

/// Parameters with few digits, coordinates whose products overflow, a ray along an edge that ends at its triangle: what single rays
/// make of them holds for packets.
#[test]
fn where_single_precision_ends() {
    let one = |corners: [Vec3; 3], ray: Ray| {
        let mut mesh = Mesh::default();
        // Others, far away, so that there is a tree.
        mesh.add(corners);
        for i in 0..40 {
            let [a, b, c] = corners
                .map(|p| p + Vec3::X * (8.0 + i as f32) * 4.0 * (corners[0] - corners[1]).length());
            mesh.add([a, b, c]);
        }
        let share = check(&mesh, &[ray; 20]);
        (share > 0.0, mesh)
    };
    let low = 2f32.powi(-110) * (1.0 + 2f32.powi(-12));
    let flat = [[-1.0, -1.0, low], [1.0, -1.0, low], [0.0, 1.0, low]].map(Vec3::from);
    let oblique = Vec3::new(2f32.powi(-12), 2f32.powi(-13), 1.0);
    for direction in [Vec3::Z, oblique] {
        // Its parameter is rounded to another depth.
        let (is_hit, _) = one(flat, Ray::new(Vec3::ZERO, 2f32.powi(29) * direction));
        assert!(!is_hit);
    }

    // Sums for depths overflow, to either side.
    for (s, z) in [
        (44, [1.0, 1.0, 0.5]),
        (43, [0.5, 1.0, 1.0]),
        (48, [0.5, 1.0, 1.0]),
    ] {
        let s = 2f32.powi(s);
        let huge = [[0.0, 1.0, z[0]], [-1.0, -1.0, z[1]], [1.0, -1.0, z[2]]];
        for direction in [Vec3::Z, Vec3::new(0.01, 0.02, 1.0)] {
            for t_max in [f32::INFINITY, 8.0 * s] {
                let ray = Ray {
                    t_max,
                    ..Ray::new(Vec3::ZERO, direction)
                };
                let (is_hit, _) = one(huge.map(|p| s * Vec3::from(p)), ray);
                assert!(is_hit);
            }
        }
    }

    let edge = [[0.0; 3], [1.0, 0.5, 0.0], [-1.0, -15.0 / 32.0, 1.0]].map(Vec3::from);
    let origin = Vec3::new(0.0, -2f32.powi(-49), -2f32.powi(-45));
    let (is_hit, _) = one(edge, Ray::new(origin, Vec3::Z));
    assert!(is_hit);
}
