//! G7: a convex body has no shadow on its lit side and no light inside.

use std::f32::consts::PI;

use rayon::prelude::*;

use crate::bvh::Builder;
use crate::integrate::{Integrator, RayLog, Whitted};
use crate::math::{Ray, UVec2, Vec2, Vec3};
use crate::prepare::prepare;
use crate::sampling::{Pattern, Sampler};
use crate::scene::Scene;
use crate::stress::floor::{RHO, matte, settings};
use crate::stress::scenes::{add_light, add_sphere, point_light};
use crate::stress::{Check, Effort};

/// What went wrong with the rays of one body.
#[derive(Default)]
struct Tally {
    lit: u64,
    shadowed: u64,
    leaked: u64,
}

/// Tries bodies of three sizes at three places.
pub fn run(effort: Effort) -> Vec<Check> {
    let rays = effort.pick(4_000, 400_000);
    let scales = [1e-6, 1.0, 1e6];
    let places: Vec<(f32, f32)> = scales
        .iter()
        .flat_map(|&scale| [0.0, 10.0, 1000.0].map(|offset| (scale, offset)))
        .collect();
    let tallies: Vec<Tally> = places
        .par_iter()
        .map(|&(scale, offset)| body(scale, offset, rays))
        .collect();
    let sum = |count: fn(&Tally) -> u64| tallies.iter().map(count).sum();
    let lit: u64 = sum(|t| t.lit);
    let empty = tallies
        .iter()
        .filter(|t| t.lit * 4 < u64::from(rays))
        .count();
    let places = "scales 1e-6 1 1e6, moved by 0 10 1000 radii";
    vec![
        Check::none(
            format!("{places}: wrongly shadowed of {lit} lit points"),
            sum(|t| t.shadowed),
        ),
        Check::none(format!("{places}: lit points inside"), sum(|t| t.leaked)),
        Check::none("bodies with fewer lit points than a quarter", empty as u64),
    ]
}

fn body(scale: f32, offset: f32, rays: u32) -> Tally {
    let center = Vec3::new(offset, -0.3 * offset, 0.7 * offset) * scale;
    let mut scene = Scene::default();
    add_sphere(&mut scene, center, scale, 24, matte());
    let place = center + Vec3::new(3.0, 4.0, 5.0) * scale;
    add_light(&mut scene, point_light(place, 1e3 * scale * scale, 0.0, 1));
    let prepared = prepare(&scene, Builder::default()).scene;
    let settings = settings(1, Pattern::Sobol);
    let integrator = Whitted::new(&prepared, &settings);
    let mut log = RayLog::default();
    let mut tally = Tally::default();
    for i in 0..rays {
        let angle = f64::from(i) * 2.399_963;
        let y = 1.0 - f64::from(2 * i + 1) / f64::from(rays);
        let ring = (1.0 - y * y).sqrt();
        let toward = Vec3::new(
            (ring * angle.cos()) as f32,
            y as f32,
            (ring * angle.sin()) as f32,
        );
        let sampler = Sampler::new(&settings.sampling, UVec2::ZERO, i);
        let from = |eye: Vec3, way| Ray::new(prepared.placement.point(eye.as_dvec3()), way);

        let inside = integrator.radiance(&from(center, toward), &sampler, &mut log);
        tally.leaked += u64::from(!inside.is_black());

        let ray = from(center + toward * (2.0 * scale), -toward);
        let Some(hit) = prepared.closest_hit(&ray, None) else {
            tally.shadowed += 1;
            continue;
        };
        let at = prepared.surface(&ray, &hit).interaction;
        let Some(light) = prepared.lights[0].sample(at.point, Vec2::splat(0.5)) else {
            tally.shadowed += 1;
            continue;
        };
        let cos = at.shading_normal.dot(*light.wi);
        if cos > 0.0 {
            let got = integrator.radiance(&ray, &sampler, &mut log).g;
            let expected = light.weight.g * RHO / PI * cos;
            tally.lit += 1;
            tally.shadowed += u64::from((got / expected - 1.0).abs().max(0.0) > 1e-5);
        }
    }
    tally
}
