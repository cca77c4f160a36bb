//! G9: light and views close to the horizon.

use std::f32::consts::PI;

use crate::math::Vec3;
use crate::sampling::Pattern;
use crate::stress::floor::{RHO, irradiance, plane, settings};
use crate::stress::scenes::{add_light, point_light, radiance};
use crate::stress::{Check, Curve, Effort, Sweep};

/// Tries 1e-1 to 1e-7 radians above a plane.
pub fn run(effort: Effort) -> Vec<Check> {
    let steps = effort.pick(1, 8);
    let angles = || (steps..=7 * steps).map(move |k| 10f64.powf(-f64::from(k) / f64::from(steps)));
    let once = settings(1, Pattern::Sobol);
    let light = |angle: f64| {
        let mut scene = plane();
        let position = Vec3::new(angle.cos() as f32, angle.sin() as f32, 0.0);
        add_light(&mut scene, point_light(position, 1.0, 0.0, 1));
        let got = irradiance(&scene, Vec3::ZERO, &once);
        let d2 = position.as_dvec3().length_squared();
        (angle, off(got, f64::from(position.y) / d2.powf(1.5)))
    };
    let mut lit = plane();
    add_light(&mut lit, point_light(Vec3::new(0.0, 2.0, 0.0), 1.0, 0.0, 1));
    let view = |angle: f64| {
        let eye = Vec3::new(angle.cos() as f32, angle.sin() as f32, 0.0);
        let got = radiance(&lit, eye, -eye, &once).g * PI / RHO;
        (angle, off(got, 0.25))
    };
    let curves = vec![
        Curve::new("light", angles().map(light).collect()),
        Curve::new("view", angles().map(view).collect()),
    ];
    let sweep = Sweep::several("angle above the plane, rad", "relative error", curves);
    vec![Check::worst(
        "irradiance I sin(θ)/d², 1e-1..1e-7 rad: relative error",
        1e-4,
        sweep,
    )]
}

fn off(got: f32, expected: f64) -> f64 {
    (f64::from(got) / expected - 1.0).abs()
}
