//! L2, L3, L4: irradiance from disks, spheres and rectangles.

use std::f64::consts::PI;

use rayon::prelude::*;

use crate::color::Rgb;
use crate::light::{DiskLight, Light, RectangleLight, SphereLight};
use crate::math::{DVec3, Ray, UVec2, UnitVec3, Vec3};
use crate::sampling::{Pattern, Sampler, SamplingConfig};
use crate::scene::{Scene, Settings};
use crate::stress::check::deviation;
use crate::stress::closed_form::{disk_irradiance, polygon_irradiance, sphere_irradiance};
use crate::stress::floor::{RHO, matte, paths};
use crate::stress::scenes::{add_light, add_quad, means};
use crate::stress::{Check, Effort};

/// L2.
pub fn disks(effort: Effort) -> Vec<Check> {
    let cases = [
        (1.0f32, 3.0f32, 0.0f32),
        (1.0, 3.0, 2.0),
        (1.5, 1.0, 0.0),
        (1.0, 0.2, 0.5),
        (1.0, 0.01, 1.0),
        (1.0, 0.01, 0.3),
        (1.0, 1e-4, 0.9999),
        (1e-3, 3.0, 1.0),
        (1e6, 1.0, 1e5),
        (1e-6, 1e-6, 1e-6),
        (1e15, 3e15, 2e15),
    ];
    let lights = cases.map(|(radius, height, offset)| {
        let [r, h, a] = [radius, height, offset].map(f64::from);
        let light = DiskLight {
            center: Vec3::new(offset, height, 0.0),
            normal: -UnitVec3::Y,
            radius,
            radiance: Rgb::WHITE,
            is_visible: true,
            samples: 1,
        };
        (Light::Disk(light), disk_irradiance(r, h, a))
    });
    let what = "disks of radius 1e-6..1e15, on and off the axis";
    vec![
        check(what, &lights, effort),
        by_paths(what, &lights, effort),
    ]
}

/// L3, and from inside.
pub fn spheres(effort: Effort) -> Vec<Check> {
    let sphere = |center: Vec3, radius| {
        Light::Sphere(SphereLight {
            center,
            radius,
            radiance: Rgb::WHITE,
            is_visible: true,
            samples: 1,
        })
    };
    let cases = [
        (1.0f32, 3.0f64, 0.0f64),
        (1.0, 3.0, 1.0),
        (1.0, 1.0001, 0.0),
        (1e-3, 5.0, 1.2),
        (1e-9, 1e3, 0.5),
        (1e12, 4e12, 0.7),
    ];
    let outside = cases.map(|(radius, distance, angle)| {
        let (sin, cos) = angle.sin_cos();
        let center = (DVec3::new(sin, cos, 0.0) * distance).as_vec3();
        let exact = center.as_dvec3();
        let distance = exact.length();
        let expected = sphere_irradiance(radius.into(), distance, exact.y / distance);
        (sphere(center, radius), expected)
    });
    let centers = [Vec3::ZERO, Vec3::new(-0.3, -0.9, -0.1), Vec3::X];
    let inside = centers.map(|center| (sphere(center, 1.0), PI));
    let what = "spheres of radius 1e-9..1e12";
    vec![
        check(what, &outside, effort),
        check("from inside of a sphere", &inside, effort),
        by_paths(what, &outside, effort),
    ]
}

/// L4.
pub fn rectangles(effort: Effort) -> Vec<Check> {
    let x = |s: f32| Vec3::new(s, 0.0, 0.0);
    let z = |s: f32| Vec3::new(0.0, 0.0, s);
    let up = |h: f32| Vec3::new(0.0, h, 0.0);
    let cases = [
        (up(3.0), x(1.0), z(0.5)),
        (up(3.0) + x(2.0), x(1.0), z(0.5)),
        (up(0.01) + x(0.4), x(1.0), z(1.0)),
        (up(1.0), x(1e5), z(1e4)),
        (up(3.0), x(1.0), z(1e-5)),
        (up(300.0), x(1.0), z(0.5)),
        // A wall, seen edge-on but for a little.
        (up(2.0) + x(1e-3), up(1.0), z(1.0)),
        // Tilted.
        (up(3.0), Vec3::new(0.8, 0.6, 0.0), z(1.0)),
        // Parallelograms.
        (up(3.0), x(1.0), z(0.5) + x(0.7)),
        (up(2.0) + x(1.0), Vec3::new(0.8, 0.6, 0.3), z(1.0)),
        (up(3e15), x(1e15), z(1e15)),
        (up(3e-15), x(1e-15), z(1e-15)),
    ];
    let lights = cases.map(|(center, half_u, half_v)| {
        let corners = [(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)]
            .map(|(u, v)| center.as_dvec3() + u * half_u.as_dvec3() + v * half_v.as_dvec3());
        // Whichever order of the edges makes it shine to the origin.
        let faces = half_u.cross(half_v).dot(center) < 0.0;
        let (half_u, half_v) = if faces {
            (half_u, half_v)
        } else {
            (half_v, half_u)
        };
        let light = RectangleLight {
            center,
            half_u,
            half_v,
            radiance: Rgb::WHITE,
            is_visible: true,
            samples: 1,
        };
        (
            Light::Rectangle(light),
            polygon_irradiance(&corners, DVec3::Y),
        )
    });
    let what = "rectangles and parallelograms of size 1e-15..1e15";
    vec![
        check(what, &lights, effort),
        by_paths(what, &lights, effort),
    ]
}

/// The same by `path`, which finds lights by looking at them and by scattering: the radiance of a matte floor
/// that receives them, and whose size is that of the light's distance.
fn by_paths(what: &str, lights: &[(Light, f64)], effort: Effort) -> Check {
    let settings = Settings {
        max_depth: Some(1),
        ..paths(Pattern::Random)
    };
    let worst = lights.iter().map(|(light, exact)| {
        let size = light.surface_bounds().map_or(1.0, |bounds| bounds.reach());
        let mut scene = Scene::default();
        let (x, z) = (Vec3::X * size, Vec3::Z * size);
        add_quad(&mut scene, Vec3::ZERO, z, x, matte());
        add_light(&mut scene, *light);
        // So low that no light is between the eye and the floor.
        let eye = Vec3::new(0.3, 0.1, 0.2) * (1e-3 * lowest(light));
        let received = means(&scene, eye, -eye, &settings, effort.pick(50, 500));
        let expected = exact * f64::from(RHO) / PI;
        let relative: Vec<f64> = received.iter().map(|value| value / expected).collect();
        deviation(&relative, 1.0)
    });
    let worst = worst.fold(0.0, |a: f64, b| if b <= a { a } else { b });
    Check::at_most(
        format!("path, {what}: error in standard errors"),
        worst,
        4.0,
    )
}

/// About how far the light's nearest point is from the origin.
fn lowest(light: &Light) -> f32 {
    let seen = |direction: Vec3| {
        let ray = Ray::new(Vec3::ZERO, direction);
        light.met(&ray).map(|(t, _)| t)
    };
    let nearest = (0..64).filter_map(|i| {
        let angle = 2.4 * i as f32;
        let height = (i as f32 + 0.5) / 64.0;
        let ring = (1.0 - height * height).sqrt();
        seen(Vec3::new(ring * angle.cos(), height, ring * angle.sin()))
    });
    let center = light
        .surface_bounds()
        .map_or(Vec3::Y, |bounds| bounds.center());
    nearest.fold(center.length(), f32::min)
}

/// The largest error of the irradiance at the origin of a horizontal surface, in standard errors.
fn check(what: &str, lights: &[(Light, f64)], effort: Effort) -> Check {
    let worst = lights
        .par_iter()
        .map(|(light, exact)| {
            let values: Vec<f64> = (0..effort.pick(100, 1000))
                .map(|seed| irradiance(light, seed) / exact)
                .collect();
            deviation(&values, 1.0)
        })
        .reduce(|| 0.0, |a, b| if b <= a { a } else { b });
    Check::at_most(format!("{what}: error in standard errors"), worst, 4.0)
}

/// The mean of 1024 independent samples at the origin, on a surface that faces up.
fn irradiance(light: &Light, seed: u64) -> f64 {
    const SAMPLES: u32 = 1024;
    let config = SamplingConfig {
        samples: SAMPLES,
        pattern: Pattern::Random,
        seed,
        ..SamplingConfig::default()
    };
    let sum: f64 = (0..SAMPLES)
        .filter_map(|i| {
            let u = Sampler::new(&config, UVec2::ZERO, i).light(1, 0, 0, 1);
            let sample = light.sample(Vec3::ZERO, u)?;
            Some(f64::from(sample.weight.r) * f64::from(sample.wi.y).max(0.0))
        })
        .sum();
    sum / f64::from(SAMPLES)
}
