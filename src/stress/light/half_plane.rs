//! L1: the penumbra of a half plane.

use rayon::prelude::*;

use crate::light::Light;
use crate::math::Vec3;
use crate::sampling::Pattern;
use crate::scene::Scene;
use crate::stress::check::deviation;
use crate::stress::closed_form::{disk_irradiance, share_beyond};
use crate::stress::floor::{disk, irradiances, matte, plane, settings};
use crate::stress::scenes::{add_light, add_quad, point_light};
use crate::stress::{Check, Curve, Effort, Sweep};

const RADIUS: f32 = 0.5;
/// Blocker below the light, and above the floor: so far that shares of solid angle are shares of
/// area, and that the disk of a point light is all but parallel to the floor.
const ABOVE: f32 = 200.0;
const BELOW: f32 = 400.0;

/// Follows the visible share across the penumbra, for a disk light and a point light with a radius.
pub fn run(effort: Effort) -> Vec<Check> {
    let height = ABOVE + BELOW;
    let lights = [
        ("disk light", disk(RADIUS, height, 0.0, 1)),
        ("point light", point_light(Vec3::Y * height, 3.0, RADIUS, 1)),
    ];
    let curves = lights.map(|(name, light)| {
        let scene = half_plane(light);
        let points: Vec<_> = (-24..=24)
            .collect::<Vec<_>>()
            .into_par_iter()
            .map(|i| {
                let x = i as f32 * 0.05;
                (f64::from(x) + 1.25, off(&scene, &light, x, effort))
            })
            .collect();
        Curve::new(name, points)
    });
    let what = "visible share across the penumbra: error in standard errors";
    let sweep = Sweep::several(
        "place across the penumbra; 1.25 is under the edge",
        "standard errors",
        curves.into(),
    );
    vec![Check::worst(what, 4.0, sweep)]
}

fn half_plane(light: Light) -> Scene {
    let mut scene = plane();
    // Covers x < 0 at height `BELOW`.
    let center = Vec3::new(-25.0, BELOW, 0.0);
    add_quad(&mut scene, center, Vec3::Z * 50.0, Vec3::X * 25.0, matte());
    add_light(&mut scene, light);
    scene
}

/// How many standard errors the share that reaches `x` is off.
fn off(scene: &Scene, light: &Light, x: f32, effort: Effort) -> f64 {
    let (x64, radius, height) = (f64::from(x), f64::from(RADIUS), f64::from(ABOVE + BELOW));
    let free = match light {
        Light::Disk(_) => 3.0 * disk_irradiance(radius, height, x64),
        _ => 3.0 * height / (x64 * x64 + height * height).powf(1.5),
    };
    let expected = share_beyond(f64::from(x * ABOVE / BELOW / RADIUS));
    let point = Vec3::new(x, 0.0, 0.0);
    let settings = settings(256, Pattern::Sobol);
    let mut values = irradiances(scene, point, &settings, effort.pick(32, 400));
    values.iter_mut().for_each(|value| *value /= free);
    deviation(&values, expected)
}
