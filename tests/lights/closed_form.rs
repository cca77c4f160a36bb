//! How lights are sampled, and the laws of attenuation.

use std::f64::consts::{FRAC_PI_2, PI, TAU};

use halfshade::color::Rgb;
use halfshade::light::{Falloff, Light, PointLight, SpotLight};
use halfshade::math::{DVec3, UnitVec3, Vec2, Vec3};
use halfshade::sampling::Pattern;

use crate::common::chi_square::Moments;
use crate::{disk, distant, irradiance, kind, numbers, point, rectangle, sphere, spot, unit};

/// The irradiance itself is held to its closed form by the cases L2 to L4 (`tests/stress.rs`).
#[test]
fn a_disk_is_sampled_by_solid_angle_and_shines_to_one_side() {
    for (radius, height, offset) in [(1.0, 3.0, 2.0), (1.0, 1e-4, 0.9999), (1e6, 1.0, 1e5)] {
        let center = Vec3::new(offset, height, 0.0);
        let light = Light::Disk(disk(center, -UnitVec3::Y, radius));
        let measured = irradiance(&light, Vec3::ZERO, UnitVec3::Y, 100_000);
        let relative = measured.standard_error() / measured.mean();
        // Only the cosine varies: less than 100 % a sample, wherever the disk is.
        assert!(relative < 1.0 / 100_000_f64.sqrt(), "{relative}");
        let behind = Light::Disk(disk(center, UnitVec3::Y, radius));
        assert!(behind.sample(Vec3::ZERO, Vec2::splat(0.3)).is_none());
    }
}

#[test]
fn a_rectangle_shines_to_one_side() {
    let center = Vec3::new(0.3, 2.0, 0.1);
    let sample = |u, v| {
        let light = Light::Rectangle(rectangle(center, u, v));
        light.sample(Vec3::ZERO, Vec2::splat(0.3))
    };
    assert!(sample(Vec3::X, Vec3::Z).is_some());
    assert!(sample(Vec3::Z, Vec3::X).is_none());
}

/// The stated irradiance on a facing surface, its cosine on a tilted one; exact in every sample
/// without an angle.
#[test]
fn a_distant_light_gives_its_irradiance() {
    for angle in [0.0_f32, 1e-30, 1e-6, 0.009, 0.5, 1.5, 3.0] {
        let light = distant(angle);
        let facing = -light.direction;
        let measured = irradiance(&Light::Distant(light), Vec3::ZERO, facing, 100_000);
        measured.assert_mean(1.0, &format!("{angle}, facing"));
        // Tilted so far that the whole cap stays above the horizon.
        let tilt = FRAC_PI_2 - 0.5 * f64::from(angle) - 0.05;
        let tangent = facing.as_dvec3().any_orthonormal_vector();
        let normal = facing.as_dvec3() * tilt.cos() + tangent * tilt.sin();
        let normal = UnitVec3::normalize(normal.as_vec3()).unwrap();
        let measured = irradiance(&Light::Distant(light), Vec3::ZERO, normal, 100_000);
        let cos = normal.as_dvec3().dot(facing.as_dvec3());
        measured.assert_mean(cos, &format!("{angle}, tilted by {tilt}"));
    }
    // More than the hemisphere: what is below the horizon does not count.
    for angle in [PI, 4.0, TAU] {
        let light = distant(angle as f32);
        let measured = irradiance(
            &Light::Distant(light),
            Vec3::ZERO,
            -light.direction,
            100_000,
        );
        measured.assert_mean(1.0, &format!("{angle}, facing"));
    }
}

#[test]
fn a_point_light_follows_its_falloff() {
    let at = |falloff, distance: f32| {
        let light = PointLight {
            falloff,
            ..point(Vec3::new(0.0, distance, 0.0), 0.0)
        };
        light.sample(Vec3::ZERO, Vec2::ZERO).map(|s| s.weight)
    };
    let law = Falloff::INVERSE_SQUARE;
    assert_eq!(at(law, 2.0), Some(Rgb::new(2.5, 5.0, 10.0)));
    let seed = Falloff {
        constant: 1.0,
        linear: 0.5,
        quadratic: 0.25,
        ..law
    };
    assert_eq!(
        at(seed, 2.0),
        Some(Rgb::new(10.0 / 3.0, 20.0 / 3.0, 40.0 / 3.0))
    );
    let ranged = Falloff { range: 4.0, ..law };
    assert_eq!(
        at(ranged, 2.0),
        Some(Rgb::new(2.5, 5.0, 10.0) * (15.0 / 16.0))
    );
    assert_eq!(at(ranged, 4.0), None);
    assert_eq!(at(ranged, 5.0), None);
    let constant = Falloff {
        constant: 1.0,
        linear: 0.0,
        quadratic: 0.0,
        ..law
    };
    assert_eq!(at(constant, 1e30), Some(Rgb::new(10.0, 20.0, 40.0)));
}

/// Full inside, none outside, and the square of a ramp in the cosine between, as
/// `KHR_lights_punctual` has it.
#[test]
fn a_spot_light_fades_between_its_cones() {
    let share = |light: &SpotLight, angle: f64| {
        let from = light.position.as_dvec3() + DVec3::new(angle.sin(), -angle.cos(), 0.0);
        let sample = light.sample(from.as_vec3(), Vec2::ZERO);
        sample.map_or(0.0, |s| f64::from(s.weight.r / light.intensity.r))
    };
    let light = spot(Vec3::ZERO, 0.0);
    for (angle, exact) in [
        (0.0, 1.0),
        (0.299, 1.0),
        (0.601, 0.0),
        (3.0, 0.0),
        (
            0.45,
            ((0.45_f64.cos() - 0.6_f64.cos()) / (0.3_f64.cos() - 0.6_f64.cos())).powi(2),
        ),
    ] {
        let share = share(&light, angle);
        assert!((share - exact).abs() < 1e-5, "{angle}: {share} for {exact}");
    }
    let laser = SpotLight {
        inner_angle_radians: 0.0,
        outer_angle_radians: 1e-3,
        ..light
    };
    assert_eq!(share(&laser, 0.0), 1.0);
    // cos is quadratic there: the share is (1 - (a/b)²)².
    assert!((share(&laser, 5e-4) - 0.5625).abs() < 1e-3);
    let hard = SpotLight {
        inner_angle_radians: 0.6,
        ..light
    };
    assert_eq!((share(&hard, 0.599), share(&hard, 0.601)), (1.0, 0.0));
}

/// What solid angle is for: stratified points on a smooth integrand beat random ones by far.
#[test]
fn unblocked_area_lights_are_smooth() {
    for light in [
        Light::Disk(disk(Vec3::new(0.7, 1.0, 0.2), unit(0.2, -1.0, 0.1), 1.0)),
        Light::Rectangle(rectangle(Vec3::new(0.7, 1.0, 0.2), Vec3::X, Vec3::Z)),
        Light::Sphere(sphere(Vec3::new(0.7, 2.0, 0.2), 1.0)),
    ] {
        let error = |pattern| {
            let values: Moments = (0..300)
                .map(|seed| {
                    let sum: f64 = numbers(pattern, 256, seed)
                        .filter_map(|u| light.sample(Vec3::ZERO, u))
                        .map(|s| f64::from(s.weight.r * s.wi.y))
                        .sum();
                    sum / 256.0
                })
                .collect();
            values.variance().sqrt() / values.mean()
        };
        let [random, sobol] = [Pattern::Random, Pattern::Sobol].map(error);
        println!(
            "{}: relative error of 256 samples, random {random:.1e}, sobol {sobol:.1e}",
            kind(&light)
        );
        assert!(sobol < 0.1 * random, "{}", kind(&light));
    }
}
