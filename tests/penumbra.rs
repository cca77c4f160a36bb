//! Soft shadows of whole renders against closed forms, and at the ends of the range of radii.
#![allow(clippy::unwrap_used, clippy::expect_used)]

mod common;

use std::f32::consts::PI;

use common::build::*;
use common::floor::*;
use halfshade::color::Rgb;
use halfshade::light::{Light, SphereLight};
use halfshade::math::Vec3;
use halfshade::sampling::Pattern;
use halfshade::scene::Scene;

const SAMPLES: u32 = 4096;

/// Error of a share of `share` that is allowed after `SAMPLES` samples: four standard errors of
/// independent ones; of stratified ones four times what N^-3/4 leaves.
fn share_tolerance(pattern: Pattern, share: f64) -> f64 {
    let n = f64::from(SAMPLES);
    if pattern == Pattern::Random {
        4.0 * (share * (1.0 - share) / n).sqrt()
    } else {
        4.0 * n.powf(-0.75)
    }
}

/// L1: the light is so far away that shares of solid angle are shares of area, and that the disk
/// of a point light is all but parallel to the floor.
#[test]
fn the_penumbra_of_a_half_plane_has_its_closed_form() {
    const RADIUS: f32 = 0.5;
    let (above, below) = (20.0f32, 40.0f32);
    let height = above + below;
    let point = point_light(Vec3::Y * height, 3.0, RADIUS, 1);
    for (light, is_disk) in [(disk(RADIUS, height, 0.0, 1), true), (point, false)] {
        let mut scene = plane();
        // Covers x < 0 at height `below`.
        let center = Vec3::new(-25.0, below, 0.0);
        add_quad(&mut scene, center, Vec3::Z * 50.0, Vec3::X * 25.0, matte());
        add_light(&mut scene, light);
        for pattern in [Pattern::Random, Pattern::Jittered, Pattern::Sobol] {
            for x in -24..=24 {
                let x = x as f32 * 0.05;
                let free = if is_disk {
                    3.0 * disk_irradiance(RADIUS.into(), height.into(), x.into())
                } else {
                    let d2 = f64::from(x * x + height * height);
                    3.0 * f64::from(height) / d2.powf(1.5)
                };
                let at = Vec3::new(x, 0.0, 0.0);
                let got = irradiance(&scene, at, &settings(SAMPLES, pattern));
                let got = f64::from(got) / free;
                let expected = share_beyond(f64::from(x * above / below / RADIUS));
                // The last term is what "far away" leaves out.
                let tolerance = share_tolerance(pattern, expected) + 1e-3;
                assert!(
                    (got - expected).abs() <= tolerance,
                    "{pattern:?}, disk {is_disk}, x = {x}: {got} instead of {expected}"
                );
            }
        }
    }
}

/// The disk of a soft point light faces the shading point, so near the horizon a part of it is
/// below: that part is dark on an open plane as on the top of a solid box.
#[test]
fn what_is_below_the_horizon_stays_dark() {
    for (lateral, height, radius) in [(4.0, 0.5, 2.0), (4.0, 0.1, 1.0), (3.0, 1.0, 0.5f32)] {
        let light = || point_light(Vec3::new(lateral, height, 0.0), 5.0, radius, 1);
        let mut open = plane();
        add_light(&mut open, light());
        let mut solid = Scene::default();
        let (min, max) = (Vec3::new(-20.0, -9.0, -20.0), Vec3::new(20.0, 0.0, 20.0));
        add_box(&mut solid, min, max, matte());
        add_light(&mut solid, light());

        let distance = f64::from(lateral).hypot(height.into());
        let (sin, cos) = (f64::from(height) / distance, f64::from(lateral) / distance);
        let share = share_beyond(f64::from(height) / (f64::from(radius) * cos));
        let free = 5.0 * sin / (distance * distance);
        for pattern in [Pattern::Random, Pattern::Sobol] {
            let [open, solid] = [&open, &solid].map(|scene| {
                let got = irradiance(scene, Vec3::ZERO, &settings(SAMPLES, pattern));
                f64::from(got) / free
            });
            let tolerance = share_tolerance(pattern, share) + 1e-5;
            assert!(
                (open - share).abs() <= tolerance && (solid - share).abs() <= tolerance,
                "{pattern:?}, radius {radius}: {open} and {solid} instead of {share}"
            );
            assert!((open - solid).abs() <= 1e-5, "{open} {solid}");
        }
    }
}

/// A scene with a blocker between a light and a floor.
fn shadow_scene(light: Light) -> Scene {
    let mut scene = plane();
    add_box(
        &mut scene,
        Vec3::new(-0.5, 0.5, -0.5),
        Vec3::new(0.5, 1.0, 0.5),
        matte(),
    );
    add_light(&mut scene, light);
    scene
}

/// L5: without a radius there is no sampling work, and small radii converge to that.
#[test]
fn a_light_without_radius_gives_the_hard_shadow_bit_for_bit() {
    let camera = look_at(Vec3::new(0.0, 4.0, 6.0), Vec3::ZERO);
    let light = |radius, samples| point_light(Vec3::new(1.0, 4.0, 1.0), 40.0, radius, samples);
    let settings = settings(4, Pattern::Sobol);
    let hard = picture(&shadow_scene(light(0.0, 1)), &camera, &settings);
    let asked = picture(&shadow_scene(light(0.0, 16)), &camera, &settings);
    assert_eq!(bits(&hard), bits(&asked));
    assert_eq!(hard.rays, asked.rays);
    for k in [20, 25, 30] {
        let tiny = picture(&shadow_scene(light(10f32.powi(-k), 1)), &camera, &settings);
        assert_eq!(bits(&hard), bits(&tiny), "radius 1e-{k}");
    }
}

/// L5: the smaller the radius, the nearer the hard shadow; at last it is the hard shadow.
#[test]
fn small_radii_converge_to_the_hard_shadow() {
    let camera = look_at(Vec3::new(0.0, 4.0, 6.0), Vec3::ZERO);
    let light = |radius| point_light(Vec3::new(1.0, 4.0, 1.0), 40.0, radius, 1);
    let settings = settings(64, Pattern::Sobol);
    let hard = picture(&shadow_scene(light(0.0)), &camera, &settings);
    let differences: Vec<f64> = (0..=15)
        .map(|k| {
            let soft = shadow_scene(light(10f32.powi(-k)));
            relative_rmse(&hard, &picture(&soft, &camera, &settings))
        })
        .collect();
    assert!(differences[0] > 0.01, "{differences:?}");
    assert!(
        differences.windows(2).all(|d| d[1] <= d[0]),
        "{differences:?}"
    );
    // A penumbra of 1e-7 is narrower than the distance between camera samples.
    assert!(
        differences[8..].iter().all(|&d| d == 0.0),
        "{differences:?}"
    );
}

/// L6: lights that touch, enclose or dwarf the scene.
#[test]
fn enormous_and_touching_lights_stay_finite() {
    let camera = look_at(Vec3::new(0.0, 4.0, 6.0), Vec3::ZERO);
    let settings = settings(4, Pattern::Sobol);
    for radius in [0.1, 10.0, 1e6, 1e18f32] {
        for position in [Vec3::ZERO, Vec3::Y, Vec3::new(0.0, 0.75, 0.0)] {
            for light in [
                point_light(position, 1.0, radius, 2),
                disk(radius, position.y, 0.0, 2),
            ] {
                let film = picture(&shadow_scene(light), &camera, &settings);
                assert_eq!(film.rejected, 0, "{light:?}");
            }
        }
    }
}

/// L6: the values are those of the closed forms where there are any.
#[test]
fn enormous_and_touching_lights_have_their_closed_form() {
    let got = |light, point| {
        let mut scene = plane();
        add_light(&mut scene, light);
        irradiance(&scene, point, &settings(SAMPLES, Pattern::Sobol))
    };
    for (radius, height, offset) in [
        (1e6f32, 1.0f32, 0.0f32),
        (1e6, 1.0, 1000.0),
        (1e12, 1.0, 0.0),
        (1.0, 1e-3, 0.0),
        (1.0, 1e-6, 0.5),
    ] {
        let expected = 3.0 * disk_irradiance(radius.into(), height.into(), offset.into()) as f32;
        let got = got(disk(radius, height, offset, 1), Vec3::ZERO);
        let what = format!("disk of radius {radius} at {height}, {offset}");
        assert_close(got, expected, 5e-3, &what);
    }
    for (height, radius) in [(1e-3, 0.0), (1e-3, 1.0), (1.0, 1e6f32)] {
        let light = point_light(Vec3::Y * height, 1.0, radius, 1);
        let what = format!("point light of radius {radius} at {height}");
        assert_close(got(light, Vec3::ZERO), 1.0 / (height * height), 1e-4, &what);
    }
    // From inside a sphere the floor sees nothing else.
    for (radius, center) in [(1.0, Vec3::ZERO), (1e6, Vec3::Y), (2.0, Vec3::X)] {
        let light = Light::Sphere(SphereLight {
            center,
            radius,
            radiance: Rgb::splat(3.0),
            is_visible: false,
            samples: 1,
        });
        let what = format!("sphere of radius {radius}");
        assert_close(got(light, Vec3::ZERO), 3.0 * PI, 1e-2, &what);
    }
}
