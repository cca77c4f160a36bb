//! L5 and L6: lights of no size, and of any size anywhere.

use std::f64::consts::PI;

use rayon::prelude::*;

use crate::camera::Camera;
use crate::color::Rgb;
use crate::film::Film;
use crate::light::{Light, SphereLight};
use crate::math::Vec3;
use crate::sampling::Pattern;
use crate::scene::{Placed, Scene};
use crate::stress::check::deviation;
use crate::stress::closed_form::disk_irradiance;
use crate::stress::floor::{disk, irradiances, matte, plane, settings};
use crate::stress::scenes::{
    add_box, add_light, bits, look_at, picture, point_light, relative_rmse,
};
use crate::stress::{Check, Effort, Sweep};

/// L5: the hard shadow is the limit.
pub fn vanishing(effort: Effort) -> Vec<Check> {
    let film = |radius, light_samples, samples| {
        let light = point_light(Vec3::new(1.0, 4.0, 1.0), 40.0, radius, light_samples);
        picture(
            &shadow(light),
            &camera(),
            &settings(samples, Pattern::Sobol),
        )
    };
    let hard = film(0.0, 1, 4);
    let asked = film(0.0, 16, 4);
    let tiny: u64 = [20, 25, 30]
        .map(|k| moved(&hard, &film(10f32.powi(-k), 1, 4)))
        .iter()
        .sum();
    let samples = effort.pick(64, 1024);
    let hard_again = film(0.0, 1, samples);
    let points: Vec<(f64, f64)> = (0..=15)
        .collect::<Vec<i32>>()
        .into_par_iter()
        .map(|k| {
            let radius = 10f32.powi(-k);
            (
                f64::from(radius),
                relative_rmse(&hard_again, &film(radius, 1, samples)),
            )
        })
        .collect();
    let rises = points.windows(2).filter(|w| w[1].1 > w[0].1).count();
    // A penumbra of 1e-7 is narrower than the distance between camera samples.
    let left = points[8..].iter().map(|p| p.1).fold(0.0, f64::max);
    let sweep = Sweep::of(
        "radius of the light",
        "relative RMSE against the hard shadow",
        points,
    );
    vec![
        Check::none(
            "radius 0: pixels that differ from one hard shadow ray",
            moved(&hard, &asked),
        ),
        Check::none(
            "radius 0, 16 samples asked for: rays beyond those of 1",
            asked.rays.total().abs_diff(hard.rays.total()),
        ),
        Check::none(
            "radius 1e-20..1e-30: pixels that differ from radius 0",
            tiny,
        ),
        Check::none(
            "radius 1..1e-15: steps away from the hard shadow",
            rises as u64,
        )
        .shown(sweep),
        Check::at_most(
            "radius 1e-8..1e-15: relative RMSE against radius 0",
            left,
            0.0,
        ),
    ]
}

/// L6: lights that touch, enclose or dwarf the scene.
pub fn huge(effort: Effort) -> Vec<Check> {
    let once = settings(4, Pattern::Sobol);
    let mut dropped = 0;
    for radius in [0.1, 10.0, 1e6, 1e18f32] {
        for position in [Vec3::ZERO, Vec3::Y, Vec3::new(0.0, 0.75, 0.0)] {
            let lights = [
                point_light(position, 1.0, radius, 2),
                disk(radius, position.y, 0.0, 2),
                sphere(radius, position),
            ];
            let films = lights.map(|light| picture(&shadow(light), &camera(), &once));
            dropped += films.iter().map(|film| film.rejected).sum::<u64>();
        }
    }
    let lights = [
        (1e6f32, 1.0f32, 0.0f32),
        (1e6, 1.0, 1000.0),
        (1e12, 1.0, 0.0),
        (1.0, 1e-3, 0.0),
        (1.0, 1e-6, 0.5),
    ]
    .map(|(r, h, a)| {
        let [r64, h64, a64] = [r, h, a].map(f64::from);
        (disk(r, h, a, 1), 3.0 * disk_irradiance(r64, h64, a64))
    });
    // From inside a sphere the floor sees nothing else.
    let inside = [(1.0, Vec3::ZERO), (1e6, Vec3::Y), (2.0, Vec3::X)]
        .map(|(radius, center)| (sphere(radius, center), 3.0 * PI));
    let points = [(1e-3, 0.0), (1e-3, 1.0), (1.0, 1e6f32)].map(|(height, radius)| {
        let light = point_light(Vec3::Y * height, 1.0, radius, 1);
        (light, 1.0 / f64::from(height * height))
    });
    let all: Vec<_> = lights.into_iter().chain(inside).chain(points).collect();
    vec![
        Check::none(
            "radius 0.1..1e18, on and in the geometry: dropped samples",
            dropped,
        ),
        closed_forms(&all, effort),
    ]
}

/// How far the floor under each light is from what it is known to receive.
fn closed_forms(lights: &[(Light, f64)], effort: Effort) -> Check {
    let worst = lights
        .par_iter()
        .map(|(light, exact)| {
            let mut scene = plane();
            add_light(&mut scene, *light);
            let settings = settings(64, Pattern::Sobol);
            let mut values = irradiances(&scene, Vec3::ZERO, &settings, effort.pick(100, 1000));
            values.iter_mut().for_each(|value| *value /= exact);
            deviation(&values, 1.0)
        })
        .reduce(|| 0.0, |a, b| if b <= a { a } else { b });
    Check::at_most(
        "disks 1e12 wide or 1e-6 away, from inside spheres: error in standard errors",
        worst,
        4.0,
    )
}

fn sphere(radius: f32, center: Vec3) -> Light {
    Light::Sphere(SphereLight {
        center,
        radius,
        radiance: Rgb::splat(3.0),
        is_visible: false,
        samples: 1,
    })
}

fn camera() -> Placed<Camera> {
    look_at(Vec3::new(0.0, 4.0, 6.0), Vec3::ZERO)
}

/// A floor under a box under `light`.
fn shadow(light: Light) -> Scene {
    let mut scene = plane();
    let (min, max) = (Vec3::new(-0.5, 0.5, -0.5), Vec3::new(0.5, 1.0, 0.5));
    add_box(&mut scene, min, max, matte());
    add_light(&mut scene, light);
    scene
}

fn moved(a: &Film, b: &Film) -> u64 {
    bits(a).iter().zip(&bits(b)).filter(|(a, b)| a != b).count() as u64
}
