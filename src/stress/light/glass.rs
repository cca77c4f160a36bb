//! L9: glass of index 1, nearly 1, and 100; total reflection.

use std::f64::consts::PI;

use crate::color::Rgb;
use crate::material::Material;
use crate::math::Vec3;
use crate::sampling::Pattern;
use crate::scene::{Background, Scene, Settings};
use crate::stress::closed_form::fresnel;
use crate::stress::floor::{RHO, matte, plane, settings};
use crate::stress::scenes::{
    add_box, add_light, add_quad, add_sphere, bits, look_at, phong, picture, point_light, radiance,
};
use crate::stress::{Check, Curve, Effort, Sweep};
use crate::texture::TexturedRgb;

/// Compares with Fresnel's equations.
pub fn run(effort: Effort) -> Vec<Check> {
    let steps = effort.pick(1, 10);
    vec![
        Check::none("index 1: pixels that differ from none", invisible()),
        Check::worst(
            "index 1+1e-7..100, 0..80 degrees: relative error of what a slab lets through",
            1e-4,
            slabs(steps),
        ),
        Check::at_most(
            "index 1+1e-7..100 in a furnace: energy lost or made",
            furnace(),
            2e-3,
        )
        .noted("what the depth and the least weight cut off stays below 2e-3"),
        total_reflection(steps),
        partial_reflection(steps),
    ]
}

fn clear(index: f32) -> Material {
    phong(|p| {
        p.transmit = Rgb::WHITE;
        p.index_of_refraction = index;
    })
}

/// Pixels that a ball of index 1 changes.
fn invisible() -> u64 {
    let mut scene = plane();
    let (min, max) = (Vec3::new(-0.5, 0.5, -0.5), Vec3::new(0.5, 1.0, 0.5));
    add_box(&mut scene, min, max, matte());
    add_light(
        &mut scene,
        point_light(Vec3::new(1.0, 4.0, 1.0), 40.0, 0.3, 2),
    );
    add_sphere(&mut scene, Vec3::new(0.2, 2.0, 1.5), 0.8, 12, clear(1.0));
    scene.background = Background {
        radiance: Rgb::new(0.2, 0.3, 0.5),
        ambient: Rgb::splat(0.1),
    };
    let mut without = scene.clone();
    without.instances.pop();
    let camera = look_at(Vec3::new(0.0, 4.0, 6.0), Vec3::ZERO);
    let settings = settings(4, Pattern::Sobol);
    let [with, without] = [scene, without].map(|scene| bits(&picture(&scene, &camera, &settings)));
    with.iter().zip(&without).filter(|(a, b)| a != b).count() as u64
}

/// A shadow ray crosses both faces of a slab at the same outside angle.
fn slabs(steps: u32) -> Sweep {
    let through = |n: f32, degrees: f64| {
        let angle = degrees.to_radians();
        let mut scene = plane();
        let (min, max) = (Vec3::new(-40.0, 1.0, -40.0), Vec3::new(40.0, 1.1, 40.0));
        add_box(&mut scene, min, max, clear(n));
        let light = Vec3::new((2.0 * angle.tan()) as f32, 2.0, 0.0);
        add_light(&mut scene, point_light(light, 1.0, 0.0, 1));
        // From below the slab, so that only the shadow ray crosses it.
        let eye = Vec3::new(-0.2, 0.5, 0.1);
        let got = radiance(&scene, eye, -eye, &settings(1, Pattern::Sobol)).g;
        let d2 = light.as_dvec3().length_squared();
        let passed = (1.0 - fresnel(angle, n.into())).powi(2);
        let expected = f64::from(RHO) / PI * (2.0 / d2.sqrt()) / d2 * passed;
        (degrees, (f64::from(got) / expected - 1.0).abs())
    };
    let curves = [1.0 + 1e-7, 1.33, 1.5, 2.4, 100.0f32].map(|n| {
        let points = (0..=8 * steps).map(|i| through(n, f64::from(10 * i) / f64::from(steps)));
        Curve::new(format!("index {n}"), points.collect())
    });
    Sweep::several(
        "angle, degrees",
        "relative error of the light let through",
        curves.into(),
    )
}

/// In a uniform surrounding glass is invisible: all energy comes out again.
fn furnace() -> f64 {
    let deep = Settings {
        max_depth: Some(1024),
        ..settings(1, Pattern::Sobol)
    };
    let lost = |n: f32| {
        let mut scene = Scene::default();
        add_box(&mut scene, Vec3::splat(-1.0), Vec3::splat(1.0), clear(n));
        scene.background.radiance = Rgb::WHITE;
        let sum = radiance(&scene, Vec3::new(0.1, 0.2, 5.0), -Vec3::Z, &deep).g;
        f64::from((sum - 1.0).abs())
    };
    [1.0 + 1e-7, 1.5, 2.4, 100.0]
        .map(lost)
        .into_iter()
        .fold(0.0, f64::max)
}

/// A slab of index 1.5 in a bright surrounding, with a lamp inside of it where a ray from `eye`, mirrored by the
/// upper face at this angle, meets it.
fn lamp_in_glass(degrees: f64, drop: f32, size: f32) -> f64 {
    let angle = degrees.to_radians();
    let direction = Vec3::new(angle.sin() as f32, angle.cos() as f32, 0.0);
    let eye = Vec3::new(-0.5, 0.0, 0.0);
    let mut scene = Scene::default();
    let (min, max) = (Vec3::new(-9.0, -1.0, -9.0), Vec3::new(9.0, 1.0, 9.0));
    add_box(&mut scene, min, max, clear(1.5));
    scene.background.radiance = Rgb::splat(100.0);
    let mut lamp = Material::matte("lamp", Rgb::BLACK);
    lamp.emission = TexturedRgb::constant(Rgb::splat(5.0));
    let place = eye + Vec3::X * (2.0 * angle.tan()) as f32 - Vec3::Y * drop;
    add_quad(&mut scene, place, Vec3::Z * size, Vec3::X * size, lamp);
    f64::from(radiance(&scene, eye, direction, &settings(1, Pattern::Sobol)).g)
}

/// Beyond the critical angle of 41.81 degrees a face shows the inside alone.
fn total_reflection(steps: u32) -> Check {
    let angles = (0..=10 * steps).map(|i| 41.9 + 2.8 * f64::from(i) / f64::from(steps));
    let points = angles.map(|degrees| {
        (
            degrees,
            (lamp_in_glass(degrees, 0.0, 0.3) / 5.0 - 1.0).abs(),
        )
    });
    let sweep = Sweep::of("angle, degrees", "relative error", points.collect());
    Check::worst(
        "total reflection, 41.9..70 degrees: relative error",
        1e-5,
        sweep,
    )
}

/// Below it, both sides by their shares.
fn partial_reflection(steps: u32) -> Check {
    let angles = (0..=4 * steps).map(|i| 10.0 * f64::from(i) / f64::from(steps));
    let points = angles.map(|degrees| {
        let got = lamp_in_glass(degrees, 0.5, 0.9);
        let reflected = fresnel(degrees.to_radians(), 1.0 / 1.5);
        let expected = 100.0 * (1.0 - reflected) + 5.0 * reflected;
        (degrees, (got / expected - 1.0).abs())
    });
    let sweep = Sweep::of("angle, degrees", "relative error", points.collect());
    Check::worst(
        "reflection from inside, 0..40 degrees: relative error",
        1e-4,
        sweep,
    )
}
