//! G8: two sheets with next to nothing between them.

use crate::bvh::{Builder, Hit};
use crate::interaction::Interaction;
use crate::math::{DVec3, Ray, UNIT_ROUNDOFF, Vec3};
use crate::prepare::{PreparedScene, prepare};
use crate::scene::Scene;
use crate::stress::floor::matte;
use crate::stress::meshes::Random;
use crate::stress::scenes::{add_light, add_mesh, point_light};
use crate::stress::{Check, Curve, Effort, Sweep};

/// Gaps above this many roundings of the largest coordinate can be resolved.
const RESOLVABLE: f64 = 32.0 * UNIT_ROUNDOFF as f64;

/// Half the width of the sheets.
const HALF: f64 = 0.5;

/// Tries gaps of 1e-1 to 1e-8 of the sheets' width, tilted so that nothing is exact.
pub fn run(effort: Effort) -> Vec<Check> {
    let rays = effort.pick(2_000, 200_000);
    let (mut resolvable, mut below) = ([Vec::new(), Vec::new()], 0.0);
    let mut is_finite = true;
    for k in 1..=8 {
        let gap = 10f64.powi(-k);
        let scene = sheets(gap);
        let largest = scene
            .bounds()
            .map_or(HALF, |(min, max)| min.abs().max(max.abs()).max_element());
        let [leaked, shadowed] = wrong(&scene, rays);
        if gap > RESOLVABLE * largest {
            resolvable[0].push((gap, leaked as f64));
            resolvable[1].push((gap, shadowed as f64));
        } else {
            is_finite &= leaked + shadowed <= 2 * u64::from(rays);
            below += (leaked + shadowed) as f64;
        }
    }
    let [leaked, shadowed] = resolvable;
    let sweep = |name, y, points| Sweep::several("gap, widths", y, vec![Curve::new(name, points)]);
    vec![
        Check::worst(
            "gaps above 32u: leaks",
            0.0,
            sweep("leaks", "points", leaked),
        ),
        Check::worst(
            "gaps above 32u: shadows on the lit side",
            0.0,
            sweep("shadows", "points", shadowed),
        ),
        Check::at_most(
            "gaps below 32u of the largest coordinate: wrong points",
            below,
            0.0,
        )
        .refused("unresolvable: the sheets' own corners are rounded by as much as the gap"),
        Check::none(
            "gaps below 32u: answers that are none",
            u64::from(!is_finite),
        ),
    ]
}

fn normal() -> DVec3 {
    DVec3::new(1.0, 2.0, -0.5).normalize()
}

/// Two parallel squares, the lower one `gap` below, with a light above both.
fn sheets(gap: f64) -> Scene {
    let mut scene = Scene::default();
    let (u, v) = normal().any_orthonormal_pair();
    for depth in [0.0, gap] {
        let corners = [(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)]
            .map(|(a, b)| (HALF * (a * u + b * v) - depth * normal()).as_vec3());
        add_mesh(
            &mut scene,
            corners.into(),
            vec![[0, 1, 2], [0, 2, 3]],
            matte(),
        );
    }
    add_light(&mut scene, point_light(light_place(), 1.0, 0.0, 1));
    scene
}

/// Points of the lower sheet that see the light, and points of the upper one that do not.
fn wrong(scene: &Scene, rays: u32) -> [u64; 2] {
    let prepared = prepare(scene, Builder::default()).scene;
    let light = prepared.placement.point(light_place().as_dvec3());
    let (u, v) = normal().any_orthonormal_pair();
    let mut random = Random(81);
    let (mut leaked, mut shadowed) = (0, 0);
    for _ in 0..rays {
        let mut coordinate = || 0.9 * HALF * f64::from(2.0 * random.unit() - 1.0);
        let target = coordinate() * u + coordinate() * v;
        let eye = target + normal() + coordinate() * u + coordinate() * v;
        let from_above = ray(&prepared, eye, target);
        let from_below = ray(&prepared, target - normal(), target);
        let sees = |ray: &Ray, hit: &Hit| {
            let at = prepared.surface(ray, hit).interaction;
            sees_light(&prepared, &at, light)
        };
        let upper = prepared.closest_hit(&from_above, None);
        let lower = upper.and_then(|hit| prepared.closest_hit(&from_above, Some(&hit)));
        shadowed += u64::from(!upper.is_some_and(|hit| sees(&from_above, &hit)));
        leaked += u64::from(lower.is_some_and(|hit| sees(&from_above, &hit)));
        let under = prepared.closest_hit(&from_below, None);
        leaked += u64::from(under.is_none_or(|hit| sees(&from_below, &hit)));
    }
    [leaked, shadowed]
}

fn light_place() -> Vec3 {
    let (u, v) = normal().any_orthonormal_pair();
    (normal() + 0.3 * u - 0.2 * v).as_vec3()
}

fn ray(prepared: &PreparedScene, eye: DVec3, target: DVec3) -> Ray {
    let [from, to] = [eye, target].map(|p| prepared.placement.point(p));
    Ray::new(from, to - from)
}

/// Whether light of `light` reaches the side that is seen.
fn sees_light(prepared: &PreparedScene, at: &Interaction, light: Vec3) -> bool {
    let faces = at.geometric_normal.dot(light - at.point) > 0.0;
    faces && prepared.crossings(&at.spawn_ray_to(light)).is_some()
}
