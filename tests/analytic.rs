//! Whole renders against closed forms; extremes are numerical cases.
#![allow(clippy::unwrap_used, clippy::expect_used)]

mod common;

use common::build::*;
use common::floor::*;
use halfshade::math::Vec3;
use halfshade::sampling::Pattern;

#[test]
fn a_point_light_obeys_the_inverse_square_and_cosine_laws() {
    let mut scene = plane();
    add_light(
        &mut scene,
        point_light(Vec3::new(0.0, 2.0, 0.0), 7.0, 0.0, 1),
    );
    for x in [0.0, 0.5, 3.0, 20.0f32] {
        let d2 = x * x + 4.0;
        let expected = 7.0 * (2.0 / d2.sqrt()) / d2;
        let got = irradiance(&scene, Vec3::new(x, 0.0, 0.0), &settings(1, Pattern::Sobol));
        assert_close(got, expected, 1e-5, &format!("x = {x}"));
    }
}

/// L2, with every pattern, on the axis and off it.
#[test]
fn a_disk_light_has_its_closed_form() {
    for pattern in [Pattern::Jittered, Pattern::Random, Pattern::Sobol] {
        for (radius, height, offset) in [(0.5f32, 2.0f32, 0.0f32), (1.5, 1.0, 0.0), (1.0, 1.5, 2.5)]
        {
            let mut scene = plane();
            add_light(&mut scene, disk(radius, height, offset, 1));
            let got = irradiance(&scene, Vec3::ZERO, &settings(1 << 16, pattern));
            let expected =
                3.0 * disk_irradiance(radius.into(), height.into(), offset.into()) as f32;
            let tolerance = if pattern == Pattern::Random {
                2e-2
            } else {
                3e-3
            };
            assert_close(
                got,
                expected,
                tolerance,
                &format!("{pattern:?} {radius} {offset}"),
            );
        }
    }
}
