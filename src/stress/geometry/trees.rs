//! G12 and G13: every tree finds the very same hit, and it is the right one.

use rayon::prelude::*;

use crate::bench::Triangles;
use crate::bvh::{Bvh, Hit};
use crate::math::{Ray, Vec3};
use crate::stress::meshes::{Random, soup, sphere, terrain};
use crate::stress::reference::{Verdict, compare};
use crate::stress::{Check, Effort};

/// G12: rays along axes from the faces of boxes, with zeros of both signs.
pub fn along_axes(effort: Effort) -> Vec<Check> {
    // A grid of unit cells: origins and targets on its planes, edges and corners.
    let mut mesh = Triangles::default();
    let mut random = Random(14);
    for _ in 0..400 {
        let mut cell = || Vec3::from([0, 1, 2].map(|_| random.below(5) as f32 - 2.0));
        let corner = cell();
        mesh.add([corner, corner + cell().signum(), corner - cell().signum()]);
    }
    let values = [-0.0, 0.0, 1.0, -1.0];
    let mut rays = Vec::new();
    for i in 0..64 {
        let direction = Vec3::new(values[i % 4], values[i / 4 % 4], values[i / 16]);
        for _ in 0..effort.pick(40, 1000) {
            let coordinate = |_| 0.5 * (random.below(11) as f32 - 5.0);
            rays.push(Ray::new(Vec3::from([0, 1, 2].map(coordinate)), direction));
        }
    }
    let (still, moving): (Vec<Ray>, Vec<Ray>) = rays
        .into_iter()
        .partition(|ray| ray.direction == Vec3::ZERO);
    let hits_of_nothing = mesh
        .trees()
        .iter()
        .flat_map(|(_, tree)| still.iter().filter(|ray| tree.any_hit(ray)))
        .count();
    // Crossings on edges are not certain, so a margin is left to the reference.
    let mut checks = compare_all("through grids", vec![(mesh, moving, 1e-9)]);
    checks.push(Check::none(
        "rays without direction: hits",
        hits_of_nothing as u64,
    ));
    checks
}

/// G13: random and adversarial meshes.
pub fn against_brute_force(effort: Effort) -> Vec<Check> {
    let many = effort.pick(1, 20);
    let soups = [(1, 1), (5, 2), (16, 3), (17, 4), (300, 5), (3000, 6)].map(|(count, seed)| {
        let mesh = soup(count, seed);
        let rays = mesh.rays(500 * many, seed);
        (mesh, rays, 1e-9)
    });
    let with_rays = |mesh: Triangles, seed| {
        let rays = mesh.rays(250 * many, seed);
        (mesh, rays, 1e-9)
    };
    let scales = [1e-30, 1e-12, 1.0, 1e12, 1e17];
    let scaled = scales.map(|scale| with_rays(sphere(3).map(|p| scale * p), 7));
    let moved = [1e2, 1e4, 1e6].map(|shift| with_rays(sphere(3).map(|p| p + shift), 8));
    let mut random = Random(9);
    // Seen at grazing angles from so far, f64 itself leaves barycentric weights unsure.
    let distant = [1e3, 1e5, 1e6].map(|distance| {
        let rays = (0..500 * many).map(|_| {
            let target = Vec3::new(random.unit(), random.unit(), 0.0);
            let origin = target + distance * random.vector();
            Ray::new(origin, target - origin)
        });
        (terrain(20), rays.collect(), 1e-4)
    });
    let stretched = [1e-38, 1e-25, 1e-10, 1e10, 1e25, 1e37].map(|length| {
        let mesh = soup(500, 10);
        let stretch = |ray: &Ray| Ray::new(ray.origin, length * ray.direction.normalize());
        let rays = mesh.rays(300 * many, 11).iter().map(stretch).collect();
        (mesh, rays, 1e-4)
    });
    [
        compare_all("soups of 1..3000 triangles", soups.into()),
        compare_all("spheres of size 1e-30..1e17", scaled.into()),
        compare_all("spheres moved by 1e2..1e6", moved.into()),
        compare_all("views from 1e3..1e6 away", distant.into()),
        compare_all("directions of length 1e-38..1e37", stretched.into()),
    ]
    .concat()
}

/// Triangles, rays, and the margin of [`compare`].
type Group = (Triangles, Vec<Ray>, f64);

/// Holds all trees of all groups against each other and against brute force.
fn compare_all(what: &str, groups: Vec<Group>) -> Vec<Check> {
    let (mut hits, mut error, mut wrong) = (0u64, 0.0f64, Vec::new());
    for (mesh, rays, margin) in &groups {
        let trees = mesh.trees();
        let verdicts: Vec<Verdict> = rays
            .par_iter()
            .map(|ray| match agreed(&trees, ray) {
                Ok(hit) => compare(mesh, ray, hit, *margin),
                Err(name) => Verdict::Wrong(format!("{name} finds another hit: {ray:?}")),
            })
            .collect();
        for verdict in verdicts {
            match verdict {
                Verdict::Miss => {}
                Verdict::Hit { error: own } => {
                    hits += 1;
                    error = if own <= error { error } else { own };
                }
                Verdict::Wrong(how) => wrong.push(how),
            }
        }
    }
    let check = Check::none(
        format!("{what}: wrong answers beside {hits} hits"),
        wrong.len() as u64,
    );
    let check = match wrong.into_iter().next() {
        Some(first) => check.noted(first),
        None => check,
    };
    vec![
        check,
        Check::at_most(format!("{what}: error of t in roundings"), error, 4.0),
    ]
}

/// What all of `trees` find; the name of one that finds something else.
fn agreed<'a>(trees: &'a [(String, Bvh)], ray: &Ray) -> Result<Option<Hit>, &'a str> {
    let hit = trees[0].1.closest_hit(ray);
    let odd = trees
        .iter()
        .find(|(_, tree)| tree.closest_hit(ray) != hit || tree.any_hit(ray) != hit.is_some());
    odd.map_or(Ok(hit), |(name, _)| Err(name))
}
