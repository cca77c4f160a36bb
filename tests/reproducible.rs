//! The same input gives the same bits, whatever the threads, the crop and the scale.
#![allow(clippy::unwrap_used, clippy::expect_used)]

mod common;

use std::sync::atomic::AtomicBool;

use common::build::*;
use halfshade::bvh::Builder;
use halfshade::camera::Camera;
use halfshade::color::Rgb;
use halfshade::film::{Rect, StoppedBy};
use halfshade::light::{DiskLight, Light};
use halfshade::material::{Material, Phong, Surface};
use halfshade::math::{UVec2, UnitVec3, Vec3};
use halfshade::prepare::prepare;
use halfshade::render::{Event, Job, render, replay};
use halfshade::sampling::{Pattern, SamplingConfig};
use halfshade::scene::{Background, Placed, Scene, Settings};

/// Everything in it: matte, mirror, glass, hard and soft lights. All lengths times `scale`, a
/// power of two, and intensities times its square.
fn scene(scale: f32) -> Scene {
    let mut scene = Scene::default();
    let matte = Material::matte("matte", Rgb::new(0.7, 0.5, 0.3));
    add_quad(
        &mut scene,
        Vec3::ZERO,
        Vec3::Z * 5.0 * scale,
        Vec3::X * 5.0 * scale,
        matte.clone(),
    );
    add_sphere(
        &mut scene,
        Vec3::new(-1.1, 1.0, 0.3) * scale,
        scale,
        16,
        matte,
    );
    let special = |edit: fn(&mut Phong)| {
        let mut phong = Phong::matte(Rgb::splat(0.05));
        edit(&mut phong);
        Material {
            surface: Surface::Phong(phong),
            ..Material::matte("special", Rgb::BLACK)
        }
    };
    let glass = special(|p| {
        p.transmit = Rgb::splat(0.9);
        p.index_of_refraction = 1.5;
    });
    let mirror = special(|p| p.reflect = Rgb::splat(0.8));
    add_sphere(
        &mut scene,
        Vec3::new(1.2, 0.8, 0.9) * scale,
        0.8 * scale,
        16,
        glass,
    );
    add_box(
        &mut scene,
        Vec3::new(0.3, 0.0, -1.7) * scale,
        Vec3::new(1.9, 1.3, -1.1) * scale,
        mirror,
    );
    let intensity = 60.0 * scale * scale;
    let position = Vec3::new(3.0, 5.0, 2.0) * scale;
    add_light(&mut scene, point_light(position, intensity, 0.4 * scale, 2));
    add_light(
        &mut scene,
        point_light(Vec3::new(-3.0, 2.0, 2.0) * scale, intensity, 0.0, 1),
    );
    add_light(
        &mut scene,
        Light::Disk(DiskLight {
            center: Vec3::new(0.0, 4.0, 0.0) * scale,
            normal: -UnitVec3::Y,
            radius: 0.5 * scale,
            radiance: Rgb::splat(3.0),
            is_visible: true,
            samples: 1,
        }),
    );
    scene.background = Background {
        radiance: Rgb::new(0.2, 0.3, 0.5),
        ambient: Rgb::splat(0.1),
    };
    scene
}

fn camera(scale: f32) -> Placed<Camera> {
    look_at(
        Vec3::new(0.5, 3.0, 6.0) * scale,
        Vec3::new(0.0, 0.7, 0.0) * scale,
    )
}

fn settings(pattern: Pattern) -> Settings {
    Settings {
        size: UVec2::new(50, 37),
        sampling: SamplingConfig {
            samples: 5,
            pattern,
            ..SamplingConfig::default()
        },
        ..Settings::default()
    }
}

const PATTERNS: [Pattern; 4] = [
    Pattern::Grid,
    Pattern::Jittered,
    Pattern::Random,
    Pattern::Sobol,
];

#[test]
fn one_two_and_seven_threads_give_the_same_bits() {
    let scene = scene(1.0);
    for pattern in PATTERNS {
        let pictures: Vec<_> = [1, 2, 7]
            .map(|threads| {
                let pool = rayon::ThreadPoolBuilder::new().num_threads(threads);
                let pool = pool.build().unwrap();
                pool.install(|| picture(&scene, &camera(1.0), &settings(pattern)))
            })
            .into();
        assert!(pictures[0].means().iter().any(|c| !c.is_black()));
        for other in &pictures[1..] {
            assert_eq!(bits(&pictures[0]), bits(other), "{pattern:?}");
            assert_eq!(pictures[0].rays, other.rays);
        }
    }
}

/// G4: no length of ours is hidden anywhere.
#[test]
fn powers_of_two_give_the_same_bits() {
    let settings = settings(Pattern::Sobol);
    let reference = bits(&picture(&scene(1.0), &camera(1.0), &settings));
    for k in -40..=40 {
        let scale = 2f32.powi(k);
        let scaled = bits(&picture(&scene(scale), &camera(scale), &settings));
        assert!(reference == scaled, "scaled by 2^{k}");
    }
}

#[test]
fn a_crop_is_a_part_of_the_whole() {
    let scene = scene(1.0);
    let settings = settings(Pattern::Sobol);
    let whole = picture(&scene, &camera(1.0), &settings);
    let prepared = prepare(&scene, Builder::default()).scene;
    let crop = Rect {
        x: 7,
        y: 5,
        width: 23,
        height: 30,
    };
    let job = Job {
        scene: &prepared,
        camera: prepared.camera(&camera(1.0)),
        settings: &settings,
        crop,
        layers: Vec::new(),
    };
    let part = render(&job, &AtomicBool::new(false), &|_| {});
    for (pixel, value) in crop.pixels().zip(part.means()) {
        let i = pixel.y * settings.size.x + pixel.x;
        assert_eq!(value, whole.means()[i as usize], "{pixel}");
    }
}

#[test]
fn other_seeds_give_other_pictures() {
    let scene = scene(1.0);
    let with = |seed| {
        let mut settings = settings(Pattern::Random);
        settings.sampling.seed = seed;
        bits(&picture(&scene, &camera(1.0), &settings))
    };
    assert_ne!(with(1), with(2));
}

#[test]
fn a_replayed_sample_is_the_sample() {
    let scene = scene(1.0);
    let settings = Settings {
        sampling: SamplingConfig {
            samples: 1,
            ..SamplingConfig::default()
        },
        ..settings(Pattern::Sobol)
    };
    let film = picture(&scene, &camera(1.0), &settings);
    let prepared = prepare(&scene, Builder::default()).scene;
    let job = Job {
        scene: &prepared,
        camera: prepared.camera(&camera(1.0)),
        settings: &settings,
        crop: Rect::full(settings.size),
        layers: Vec::new(),
    };
    let mut rays = 0;
    for pixel in Rect::full(settings.size).pixels() {
        let again = replay(&job, pixel, 0);
        let i = pixel.y * settings.size.x + pixel.x;
        assert_eq!(again.value, film.means()[i as usize]);
        rays += again.rays.len() as u64;
    }
    let counts = film.rays;
    assert_eq!(rays, counts.camera + counts.shadow + counts.secondary);
}

#[test]
fn a_cancelled_render_keeps_what_there_is() {
    let scene = scene(1.0);
    let prepared = prepare(&scene, Builder::default()).scene;
    let settings = Settings {
        sampling: SamplingConfig {
            samples: 64,
            ..SamplingConfig::default()
        },
        ..settings(Pattern::Sobol)
    };
    let job = Job {
        scene: &prepared,
        camera: prepared.camera(&camera(1.0)),
        settings: &settings,
        crop: Rect::full(settings.size),
        layers: Vec::new(),
    };
    let cancel = AtomicBool::new(false);
    let area = job.crop.area();
    let film = render(&job, &cancel, &|event| {
        // After the first pass every pixel has a sample.
        if let Event::Progress(progress) = event
            && progress.done > area
        {
            cancel.store(true, std::sync::atomic::Ordering::Relaxed);
        }
    });
    assert_eq!(film.stopped_by, StoppedBy::Interrupt);
    let (least, _, most) = film.sample_counts();
    assert!(least >= 1 && most < 64, "{least} {most}");
}
