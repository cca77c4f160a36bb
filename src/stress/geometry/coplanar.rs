//! G10: of coincident triangles the same one wins, always.

use rayon::ThreadPoolBuilder;
use rayon::prelude::*;

use crate::bench::Triangles;
use crate::bvh::{Builder, Hit};
use crate::color::Rgb;
use crate::material::Material;
use crate::math::{Ray, Vec3};
use crate::prepare::prepare;
use crate::sampling::Pattern;
use crate::scene::Scene;
use crate::stress::meshes::soup;
use crate::stress::scenes::{add_light, add_quad, bits, look_at, picture_of, point_light};
use crate::stress::still_life::settings;
use crate::stress::{Check, Effort};

/// Tries stacks of coincident triangles in trees and in pictures.
pub fn run(effort: Effort) -> Vec<Check> {
    vec![
        stacks(effort.pick(2_000, 50_000)),
        pictures(effort.pick(20, 1000)),
    ]
}

/// Rays on which trees differ, or on which another copy than the first nearest wins.
fn stacks(rays: usize) -> Check {
    let mut mesh = Triangles::default();
    let layers = soup(40, 17);
    for copy in 0..50 {
        for i in 0..40 {
            let mut corners = layers.corners(i);
            corners.rotate_left(copy % 3);
            mesh.add(corners);
        }
    }
    let trees = mesh.trees();
    // Whether a ray hits, and whether what it hits is wrong.
    let look = |ray: &Ray| {
        let hit = trees[0].1.closest_hit(ray);
        let mut is_wrong = trees.iter().any(|(_, tree)| tree.closest_hit(ray) != hit);
        if let Some(hit) = hit {
            // Copies with other first corners round u and v, and perhaps t, differently.
            let is_copy = |other: u32| other % 40 == hit.triangle % 40 && other < hit.triangle;
            let nearest = |h: &Hit| h.t <= hit.t && is_copy(h.triangle);
            is_wrong |= trees[0].1.any_hit_if(ray, nearest);
        }
        [hit.is_some(), is_wrong].map(u64::from)
    };
    let [hits, wrong] = mesh
        .rays(rays, 18)
        .par_iter()
        .map(look)
        .reduce(|| [0; 2], |a, b| [a[0] + b[0], a[1] + b[1]]);
    Check::none(
        format!("50 copies of triangles, every tree: other winners in {hits} hits"),
        wrong,
    )
}

/// Pixels of a stack of coloured squares that change with threads or trees.
fn pictures(layers: u32) -> Check {
    let mut scene = Scene::default();
    for i in 0..layers {
        let share = i as f32 / layers as f32;
        let material = Material::matte("layer", Rgb::new(share, 1.0 - share, 0.5));
        add_quad(&mut scene, Vec3::ZERO, Vec3::Z, Vec3::X, material);
    }
    add_light(
        &mut scene,
        point_light(Vec3::new(1.0, 3.0, 1.0), 30.0, 0.2, 1),
    );
    let camera = look_at(Vec3::new(0.3, 2.0, 1.0), Vec3::ZERO);
    let settings = settings(Pattern::Sobol);
    let render = |builder| {
        bits(&picture_of(
            &prepare(&scene, builder).scene,
            &camera,
            &settings,
        ))
    };
    let reference = render(Builder::default());
    let moved = |other: Vec<[u32; 3]>| reference.iter().zip(&other).filter(|(a, b)| a != b).count();
    let mut wrong: usize = Builder::ALL.into_iter().map(|b| moved(render(b))).sum();
    for threads in [1, 2, 7] {
        wrong += match ThreadPoolBuilder::new().num_threads(threads).build() {
            Ok(pool) => moved(pool.install(|| render(Builder::default()))),
            Err(_) => reference.len(),
        };
    }
    let what =
        format!("{layers} coincident squares, 1 2 7 threads, every tree: pixels that differ");
    Check::none(what, wrong as u64)
}
