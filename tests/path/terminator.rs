//! Light on coarse meshes with smooth normals: no facets show, and both ways of finding a light agree.

use std::f64::consts::PI;

use halfshade::bvh::Builder;
use halfshade::color::Rgb;
use halfshade::integrate::Weighing;
use halfshade::light::{Environment, Light};
use halfshade::material::Material;
use halfshade::math::Vec3;
use halfshade::prepare::prepare;
use halfshade::sampling::{Pattern, SamplingConfig};
use halfshade::scene::{Attributes, Background, Scene, Settings};

use crate::common::build::*;
use crate::transport::{mean, path, sphere_light};

/// A sphere of radius 1 around the origin with smooth normals, of 20 rows.
fn sphere(reflectance: f32) -> Scene {
    let mut scene = Scene::default();
    let matte = Material::matte("matte", Rgb::splat(reflectance));
    add_sphere(&mut scene, Vec3::ZERO, 1.0, 20, matte);
    let mesh = scene.meshes.pop().unwrap();
    let normals = mesh.positions().to_vec();
    scene.meshes.push(mesh.with_normals(normals).unwrap());
    scene
}

fn lit_by(light: Light) -> Scene {
    let mut scene = sphere(0.5);
    add_light(&mut scene, light);
    scene
}

fn switched(settings: Settings, is_on: bool) -> Settings {
    Settings {
        shadow_terminator: is_on,
        ..settings
    }
}

/// Towards the lights, along no edge of the mesh.
fn toward() -> Vec3 {
    Vec3::new(1.0, 0.3, 0.2).normalize()
}

/// The place on the sphere at this angle from [`toward`].
fn place(radians: f64) -> Vec3 {
    let across = toward().any_orthonormal_vector();
    toward() * radians.cos() as f32 + across * radians.sin() as f32
}

/// Radiance on the meridian from the place nearest to the light to that farthest from it, as a share of full light.
fn meridian(scene: &Scene, is_on: bool) -> Vec<f64> {
    const STEPS: u32 = 600;
    let settings = switched(path(1, 1), is_on);
    let prepared = prepare(scene, Builder::default()).scene;
    let values = (0..=STEPS).map(|i| {
        let place = place(PI * f64::from(i) / f64::from(STEPS));
        f64::from(radiance_in(&prepared, 3.0 * place, -place, &settings).g)
    });
    let values: Vec<f64> = values.collect();
    values.iter().map(|value| value / values[0]).collect()
}

#[test]
fn the_terminator_of_a_point_light_shows_no_facets() {
    // So far away that its rays are parallel.
    let scene = lit_by(point_light(toward() * 1e4, 1e8, 0.0, 1));
    let error = |values: &[f64]| {
        let steps = (values.len() - 1) as f64;
        let cosines = (0..values.len()).map(|i| (PI * i as f64 / steps).cos());
        let near: Vec<f64> = (values.iter().zip(cosines))
            .filter(|(_, cos)| cos.abs() < 0.2)
            .map(|(value, cos)| (value - cos.max(0.0)).powi(2))
            .collect();
        (near.iter().sum::<f64>() / near.len() as f64).sqrt()
    };
    let jump = |values: &[f64]| {
        let jumps = values.windows(2).map(|w| (w[1] - w[0]).abs());
        jumps.fold(0.0, f64::max)
    };
    let [with, without] = [true, false].map(|is_on| meridian(&scene, is_on));
    let (errors, jumps) = (
        [error(&with), error(&without)],
        [jump(&with), jump(&without)],
    );
    println!("errors {errors:?}, jumps {jumps:?}");
    // A cosine falls by 0.0052 from one place to the next.
    assert!(errors[0] < 0.05 * errors[1] && jumps[0] < 0.006 && jumps[1] > 0.02);
}

#[test]
fn flat_meshes_keep_their_bits() {
    let mut scene = lit_by(point_light(Vec3::new(5.0, 1.0, 0.0), 50.0, 0.3, 1));
    for mesh in &mut scene.meshes {
        mesh.retain_attributes(Attributes::default());
    }
    let camera = look_at(Vec3::new(1.0, 2.0, 4.0), Vec3::ZERO);
    let [with, without] =
        [true, false].map(|is_on| picture(&scene, &camera, &switched(path(4, 3), is_on)));
    assert_eq!(bits(&with), bits(&without));
    // The same with normals moves pixels: the switch is seen.
    let scene = lit_by(point_light(Vec3::new(5.0, 1.0, 0.0), 50.0, 0.3, 1));
    let [with, without] =
        [true, false].map(|is_on| picture(&scene, &camera, &switched(path(4, 3), is_on)));
    assert_ne!(bits(&with), bits(&without));
}

/// Whichever way finds it, the mean of the light of a lamp is the same: in the middle of the day, and where the lamp is
/// partly below the horizon of the triangle, the surface, or both.
#[test]
fn both_ways_of_finding_a_lamp_agree_on_what_is_seen() {
    let scene = lit_by(sphere_light(toward() * 4.0, 2.0, true));
    let settings = path(1 << 15, 1);
    for degrees in [10.0f64, 60.0, 75.0, 84.0, 90.0, 94.0, 98.0] {
        let place = place(degrees.to_radians());
        let [both, looking, scattering] = [
            Weighing::Power,
            Weighing::LightsOnly,
            Weighing::ScatteringOnly,
        ]
        .map(|weighing| mean(&scene, weighing, 1.5 * place, -place, &settings));
        println!("{degrees}: {both:?} {looking:?} {scattering:?}");
        for [value, error] in [looking, scattering] {
            let sigma = error.hypot(both[1]);
            assert!((value - both[0]).abs() <= 4.5 * sigma, "{degrees}");
        }
    }
}

/// A white sphere in white light: as bright as what is around it, where that is not looked at as a light bit for bit
/// as before; where it is, no more than that and no darker than from the facets.
#[test]
fn the_white_furnace_stays_white() {
    let sampling = SamplingConfig {
        samples: 64,
        pattern: Pattern::Sobol,
        ..SamplingConfig::default()
    };
    let settings = Settings {
        sampling,
        ..path(64, 64)
    };
    let camera = look_at(Vec3::new(1.0, 2.0, 4.0), Vec3::ZERO);
    let mut scene = sphere(1.0);
    scene.background = Background {
        radiance: Rgb::WHITE,
        ..Background::default()
    };
    let [with, without] =
        [true, false].map(|is_on| picture(&scene, &camera, &switched(settings.clone(), is_on)));
    assert_eq!(bits(&with), bits(&without));

    scene.background = Background::default();
    let white = vec![[1.0; 3]; 8];
    scene.environment = Some(Environment::new("white", [4, 2], white, Rgb::WHITE, 0.0).unwrap());
    let [with, without] = [true, false].map(|is_on| {
        let film = picture(&scene, &camera, &switched(settings.clone(), is_on));
        let values = film.means();
        values.iter().map(|c| f64::from(c.g)).sum::<f64>() / values.len() as f64
    });
    println!("{with} {without}");
    assert!(with <= 1.001 && with >= without - 1e-4, "{with} {without}");
}
