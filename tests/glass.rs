//! Glass in whole renders against Fresnel's equations.
#![allow(clippy::unwrap_used, clippy::expect_used)]

mod common;

use std::f32::consts::PI;

use common::build::*;
use common::floor::*;
use halfshade::color::Rgb;
use halfshade::light::Light;
use halfshade::material::Material;
use halfshade::math::Vec3;
use halfshade::sampling::Pattern;
use halfshade::scene::{Background, Scene, Settings};
use halfshade::texture::TexturedRgb;

/// A scene with a blocker between a light and a floor.
fn lit_box(light: Light) -> Scene {
    let mut scene = plane();
    let (min, max) = (Vec3::new(-0.5, 0.5, -0.5), Vec3::new(0.5, 1.0, 0.5));
    add_box(&mut scene, min, max, matte());
    add_light(&mut scene, light);
    scene
}

fn clear_glass(index: f32) -> Material {
    phong(|p| {
        p.transmit = Rgb::WHITE;
        p.index_of_refraction = index;
    })
}

/// Share of unpolarised light that a border reflects, from Snell's law and Fresnel's equations
/// for both polarisations by angles; `n` is the index beyond over the index before.
fn fresnel(angle: f64, n: f64) -> f64 {
    if angle == 0.0 {
        return ((n - 1.0) / (n + 1.0)).powi(2);
    }
    let beyond = (angle.sin() / n).asin();
    let s = (angle - beyond).sin() / (angle + beyond).sin();
    let p = (angle - beyond).tan() / (angle + beyond).tan();
    0.5 * (s * s + p * p)
}

fn glass_scene(index: f32) -> Scene {
    let mut scene = lit_box(point_light(Vec3::new(1.0, 4.0, 1.0), 40.0, 0.3, 2));
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

/// L9: a shadow ray crosses both faces of a slab at the same outside angle.
#[test]
fn a_slab_of_glass_dims_oblique_light_as_fresnel_says() {
    for n in [1.33, 1.5, 2.4f32] {
        for degrees in [0.0, 30.0, 60.0, 80.0f32] {
            let angle = degrees.to_radians();
            let mut scene = plane();
            let (min, max) = (Vec3::new(-40.0, 1.0, -40.0), Vec3::new(40.0, 1.1, 40.0));
            add_box(&mut scene, min, max, clear_glass(n));
            let light = Vec3::new(2.0 * angle.tan(), 2.0, 0.0);
            add_light(&mut scene, point_light(light, 1.0, 0.0, 1));
            // From below the slab, so that only the shadow ray crosses it.
            let eye = Vec3::new(-0.2, 0.5, 0.1);
            let got = radiance(&scene, eye, -eye, &settings(1, Pattern::Sobol)).g;
            let passed = (1.0 - fresnel(angle.into(), n.into())).powi(2) as f32;
            let expected = RHO / PI * angle.cos() / light.length_squared() * passed;
            assert_close(got, expected, 1e-4, &format!("n = {n}, {degrees} degrees"));
        }
    }
}

/// L9: beyond the critical angle a face shows the inside, mirrored, and nothing of the outside.
#[test]
fn total_reflection_shows_the_inside_alone() {
    let mut scene = Scene::default();
    let (min, max) = (Vec3::new(-9.0, -1.0, -9.0), Vec3::new(9.0, 1.0, 9.0));
    add_box(&mut scene, min, max, clear_glass(1.5));
    let mut lamp = Material::matte("lamp", Rgb::BLACK);
    lamp.emission = TexturedRgb::constant(Rgb::splat(5.0));
    scene.background.radiance = Rgb::splat(100.0);
    let eye = Vec3::new(-0.5, 0.0, 0.0);
    // Up to the face, and mirrored down to the lamp in the plane of the eye.
    let toward = |degrees: f32| {
        let angle = degrees.to_radians();
        (Vec3::new(angle.sin(), angle.cos(), 0.0), 2.0 * angle.tan())
    };
    let settings = settings(1, Pattern::Sobol);
    // The critical angle is 41.81 degrees.
    for degrees in [41.9, 45.0, 53.0, 70.0] {
        let (direction, lateral) = toward(degrees);
        let mut scene = scene.clone();
        let place = eye + Vec3::X * lateral;
        add_quad(
            &mut scene,
            place,
            Vec3::Z * 0.3,
            Vec3::X * 0.3,
            lamp.clone(),
        );
        let got = radiance(&scene, eye, direction, &settings).g;
        assert_close(got, 5.0, 1e-5, &format!("{degrees} degrees"));
    }
    for degrees in [0.0, 20.0, 41.0f32] {
        let (direction, lateral) = toward(degrees);
        let mut scene = scene.clone();
        let place = eye + Vec3::X * lateral - Vec3::Y * 0.5;
        add_quad(
            &mut scene,
            place,
            Vec3::Z * 0.9,
            Vec3::X * 0.9,
            lamp.clone(),
        );
        let got = radiance(&scene, eye, direction, &settings).g;
        let reflected = fresnel(f64::from(degrees).to_radians(), 1.0 / 1.5) as f32;
        let expected = 100.0 * (1.0 - reflected) + 5.0 * reflected;
        assert_close(got, expected, 2e-4, &format!("{degrees} degrees"));
    }
}
