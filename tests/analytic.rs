//! Whole renders against closed forms (the cases L of the numerical stability page).
#![allow(clippy::unwrap_used, clippy::expect_used)]

mod common;

use std::f32::consts::PI;

use common::build::*;
use common::floor::*;
use halfshade::bvh::Builder;
use halfshade::color::Rgb;
use halfshade::math::{Ray, UVec2, Vec2, Vec3};
use halfshade::prepare::prepare;
use halfshade::sampling::Pattern;
use halfshade::scene::{Scene, Settings};
use halfshade::texture::TexturedRgb;

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

/// G9: close to the horizon the cosine law still holds.
#[test]
fn a_grazing_point_light_keeps_its_cosine() {
    for k in 1..=7 {
        let angle = 10f32.powi(-k);
        let mut scene = plane();
        let position = Vec3::new(angle.cos(), angle.sin(), 0.0);
        add_light(&mut scene, point_light(position, 1.0, 0.0, 1));
        let got = irradiance(&scene, Vec3::ZERO, &settings(1, Pattern::Sobol));
        assert_close(got, angle.sin(), 1e-4, &format!("1e-{k} rad"));
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

/// L8: emitting mirrors that face each other.
#[test]
fn facing_mirrors_give_the_geometric_series() {
    for k in [0.2, 0.5, 0.9f32] {
        let mut mirror = phong(|p| p.reflect = Rgb::splat(k));
        mirror.emission = TexturedRgb::constant(Rgb::splat(2.0));
        let mut scene = Scene::default();
        add_quad(
            &mut scene,
            -Vec3::Z,
            Vec3::X * 9.0,
            Vec3::Y * 9.0,
            mirror.clone(),
        );
        add_quad(&mut scene, Vec3::Z, Vec3::Y * 9.0, Vec3::X * 9.0, mirror);
        for depth in [1, 4, 8, 64] {
            let settings = Settings {
                max_depth: depth,
                ..settings(1, Pattern::Sobol)
            };
            let got = radiance(&scene, Vec3::ZERO, Vec3::Z, &settings).r;
            let limit = 2.0 / (1.0 - k);
            // Cut off by the depth, or by the least weight that is followed.
            let cut = limit * k.powi(depth as i32) + limit * 1e-5;
            assert!(
                (limit - got).abs() <= cut + limit * 1e-6,
                "k {k}, depth {depth}: {got}"
            );
        }
    }
}

/// G7: a convex body has no shadow on its lit side and no light inside.
#[test]
fn a_convex_body_shows_neither_acne_nor_leaks() {
    for scale in [1e-6, 1.0, 1e6f32] {
        for offset in [0.0, 10.0, 1000.0f32] {
            let center = Vec3::new(offset, -0.3 * offset, 0.7 * offset) * scale;
            let mut scene = Scene::default();
            add_sphere(&mut scene, center, scale, 24, matte());
            let place = center + Vec3::new(3.0, 4.0, 5.0) * scale;
            add_light(&mut scene, point_light(place, 1e3 * scale * scale, 0.0, 1));
            let prepared = prepare(&scene, Builder::default()).scene;
            let settings = settings(1, Pattern::Sobol);
            let integrator = halfshade::integrate::Whitted::new(&prepared, &settings);
            let (mut lit, mut log) = (0, halfshade::integrate::RayLog::default());
            for i in 0..4000u32 {
                let angle = i as f32 * 2.399_963;
                let y = 1.0 - (2 * i + 1) as f32 / 4000.0;
                let ring = (1.0 - y * y).sqrt();
                let toward = Vec3::new(ring * angle.cos(), y, ring * angle.sin());
                let outside = center + toward * (2.0 * scale);
                let sampler = halfshade::sampling::Sampler::new(&settings.sampling, UVec2::ZERO, i);
                for (eye, direction, is_inside) in
                    [(outside, -toward, false), (center, toward, true)]
                {
                    let ray = Ray::new(prepared.placement.point(eye.as_dvec3()), direction);
                    let hit = prepared.closest_hit(&ray, None).expect("a closed body");
                    let at = prepared.surface(&ray, &hit).interaction;
                    let light = prepared.lights[0]
                        .sample(at.point, Vec2::splat(0.5))
                        .unwrap();
                    let cos = at.shading_normal.dot(*light.wi);
                    use halfshade::integrate::Integrator;
                    let got = integrator.radiance(&ray, &sampler, &mut log).g;
                    if is_inside {
                        assert_eq!(got, 0.0, "a leak at scale {scale}, offset {offset}");
                    } else if cos > 0.0 {
                        let expected = light.weight.g * RHO / PI * cos;
                        assert_close(got, expected, 1e-5, "acne");
                        lit += 1;
                    }
                }
            }
            assert!(lit > 1000);
        }
    }
}

/// L11: radiances of any size that `f32` holds, and very different ones in one pixel.
#[test]
fn intensities_of_any_size_add_up() {
    for (a, b) in [(1e-30, 1e-18), (1e18, 1e30f32), (1.0, 1e12)] {
        let light = |i| point_light(Vec3::Y * 2.0, i, 0.0, 1);
        let mut scene = plane();
        add_light(&mut scene, light(a));
        add_light(&mut scene, light(b));
        let got = irradiance(&scene, Vec3::ZERO, &settings(4, Pattern::Sobol));
        assert_close(got, (a + b) / 4.0, 1e-6, &format!("{a} + {b}"));
    }
}
