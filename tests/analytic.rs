//! Whole renders against closed forms (the cases L of the numerical stability page).
#![allow(clippy::unwrap_used, clippy::expect_used)]

mod common;

use std::f32::consts::PI;

use common::build::*;
use halfshade::bvh::Builder;
use halfshade::color::Rgb;
use halfshade::light::{DiskLight, Light};
use halfshade::material::{Material, Phong, Surface};
use halfshade::math::{Ray, UVec2, UnitVec3, Vec2, Vec3};
use halfshade::prepare::prepare;
use halfshade::sampling::{Pattern, SamplingConfig};
use halfshade::scene::{Background, Scene, Settings};
use halfshade::texture::TexturedRgb;

const RHO: f32 = 0.6;

fn matte() -> Material {
    Material::matte("matte", Rgb::splat(RHO))
}

fn settings(samples: u32, pattern: Pattern) -> Settings {
    Settings {
        size: UVec2::new(24, 18),
        sampling: SamplingConfig {
            samples,
            pattern,
            ..SamplingConfig::default()
        },
        ..Settings::default()
    }
}

/// A horizontal plane of reflectance `RHO` through the origin.
fn plane() -> Scene {
    let mut scene = Scene::default();
    add_quad(
        &mut scene,
        Vec3::ZERO,
        Vec3::Z * 50.0,
        Vec3::X * 50.0,
        matte(),
    );
    scene
}

/// Irradiance at `point` of the plane, from what a ray from above brings back.
fn irradiance(scene: &Scene, point: Vec3, settings: &Settings) -> f32 {
    let eye = point + Vec3::new(0.3, 1.0, 0.2);
    radiance(scene, eye, point - eye, settings).g * PI / RHO
}

fn assert_close(got: f32, expected: f32, relative: f32, what: &str) {
    let error = (got - expected).abs() / expected.abs();
    assert!(
        error <= relative,
        "{what}: {got} instead of {expected}, off by {error}"
    );
}

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

fn disk(radius: f32, height: f32, offset: f32, samples: u32) -> Light {
    Light::Disk(DiskLight {
        center: Vec3::new(offset, height, 0.0),
        normal: -UnitVec3::Y,
        radius,
        radiance: Rgb::splat(3.0),
        is_visible: true,
        samples,
    })
}

/// L2, with every pattern, on the axis and off it.
#[test]
fn a_disk_light_has_its_closed_form() {
    for pattern in [Pattern::Jittered, Pattern::Random, Pattern::Sobol] {
        for (radius, height, offset) in [(0.5, 2.0, 0.0), (1.5, 1.0, 0.0), (1.0, 1.5, 2.5f32)] {
            let mut scene = plane();
            add_light(&mut scene, disk(radius, height, offset, 1));
            let got = irradiance(&scene, Vec3::ZERO, &settings(1 << 16, pattern));
            let expected = if offset == 0.0 {
                PI * 3.0 * radius * radius / (radius * radius + height * height)
            } else {
                let (h, rho) = (height / offset, radius / offset);
                let z = 1.0 + h * h + rho * rho;
                let root = (z * z - 4.0 * rho * rho).sqrt();
                0.5 * PI * 3.0 * (1.0 - (z - 2.0 * rho * rho) / root)
            };
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

/// L1: the share of a disk that a half-plane leaves free.
#[test]
fn the_penumbra_of_a_half_plane_has_its_closed_form() {
    const RADIUS: f32 = 0.5;
    // So far away that shares of solid angle are shares of area.
    let (above, below) = (20.0f32, 40.0f32);
    let mut scene = plane();
    // Covers x < 0 at height `below`; the light is `above` higher.
    let center = Vec3::new(-25.0, below, 0.0);
    add_quad(&mut scene, center, Vec3::Z * 50.0, Vec3::X * 25.0, matte());
    let light = disk(RADIUS, above + below, 0.0, 1);
    let prepared = prepare(&scene, Builder::default()).scene;
    let side = 400;
    for x in [-2.0, -0.9, -0.4, 0.0, 0.3, 0.7, 2.0f32] {
        let point = Vec3::new(x, 0.0, 0.0);
        let place = |p: Vec3| prepared.placement.point(p.as_dvec3());
        let mut free = 0;
        for i in 0..side * side {
            let u = Vec2::new((i % side) as f32 + 0.5, (i / side) as f32 + 0.5) / side as f32;
            let sample = light.sample(point, u).expect("above the plane");
            let halfshade::light::ShadowEnd::Point(end) = sample.shadow else {
                panic!("a disk is not at infinity");
            };
            let ray = Ray {
                t_max: 1.0,
                t_min: 1e-3,
                ..Ray::new(place(point), place(end) - place(point))
            };
            free += u32::from(!prepared.is_blocked(&ray));
        }
        let got = free as f32 / (side * side) as f32;
        let s = (x * above / below / RADIUS).clamp(-1.0, 1.0);
        let expected = ((-s).acos() + s * (1.0 - s * s).sqrt()) / PI;
        assert!((got - expected).abs() < 2e-3, "x = {x}: {got} {expected}");
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

fn phong(edit: impl FnOnce(&mut Phong)) -> Material {
    let mut phong = Phong::matte(Rgb::BLACK);
    edit(&mut phong);
    Material {
        surface: Surface::Phong(phong),
        ..Material::matte("special", Rgb::BLACK)
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

fn glass_scene(index: f32) -> Scene {
    let mut scene = shadow_scene(point_light(Vec3::new(1.0, 4.0, 1.0), 40.0, 0.3, 2));
    let glass = phong(|p| {
        p.transmit = Rgb::WHITE;
        p.index_of_refraction = index;
    });
    add_sphere(&mut scene, Vec3::new(0.2, 2.0, 1.5), 0.8, 12, glass);
    scene.background = Background {
        radiance: Rgb::new(0.2, 0.3, 0.5),
        ambient: Rgb::splat(0.1),
    };
    scene
}

/// L9: glass of index 1 is not there.
#[test]
fn glass_of_index_1_is_invisible_bit_for_bit() {
    let camera = look_at(Vec3::new(0.0, 4.0, 6.0), Vec3::ZERO);
    let settings = settings(4, Pattern::Sobol);
    let with = glass_scene(1.0);
    let mut without = glass_scene(1.0);
    without.instances.pop();
    assert_eq!(
        bits(&picture(&with, &camera, &settings)),
        bits(&picture(&without, &camera, &settings))
    );
}

/// L9: what passes two faces of a slab at normal incidence, and nothing is lost in it.
#[test]
fn a_slab_of_glass_transmits_what_fresnel_says() {
    for n in [1.0 + 1e-7, 1.5, 2.4, 100.0f32] {
        let glass = phong(|p| {
            p.transmit = Rgb::WHITE;
            p.index_of_refraction = n;
        });
        let mut scene = plane();
        let (min, max) = (Vec3::new(-9.0, 1.0, -9.0), Vec3::new(9.0, 1.1, 9.0));
        add_box(&mut scene, min, max, glass);
        add_light(&mut scene, point_light(Vec3::Y * 2.0, 1.0, 0.0, 1));
        // From below the slab, so that only the shadow ray crosses it.
        let got = radiance(
            &scene,
            Vec3::new(1e-4, 0.5, 0.0),
            Vec3::new(-1e-4, -0.5, 0.0),
            &settings(1, Pattern::Sobol),
        );
        let face = 1.0 - ((n - 1.0) / (n + 1.0)).powi(2);
        assert_close(
            got.g,
            RHO / PI / 4.0 * face * face,
            1e-4,
            &format!("n = {n}"),
        );

        // In a uniform surrounding glass is invisible too: all energy comes out again.
        let mut furnace = Scene::default();
        let glass = scene.materials[1].clone();
        add_box(&mut furnace, Vec3::splat(-1.0), Vec3::splat(1.0), glass);
        furnace.background.radiance = Rgb::WHITE;
        let deep = Settings {
            max_depth: 2000,
            ..settings(1, Pattern::Sobol)
        };
        let sum = radiance(&furnace, Vec3::new(0.1, 0.2, 5.0), -Vec3::Z, &deep).g;
        assert!((sum - 1.0).abs() < 2e-3, "n = {n}: {sum}");
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
