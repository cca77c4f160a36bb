//! The same input gives the same bits, whatever the threads and the crop; scales are case G4.
#![allow(clippy::unwrap_used, clippy::expect_used)]

mod common;

use std::sync::atomic::AtomicBool;

use common::build::*;
use halfshade::bvh::Builder;
use halfshade::color::Rgb;
use halfshade::film::{RayCounts, Rect, StoppedBy};
use halfshade::integrate::{Account, CameraRow, LightGroups, LightPart, RayLog, integrator};
use halfshade::light::{DistantLight, Light, RectangleLight};
use halfshade::material::{AlphaMode, Material};
use halfshade::math::{DAffine3, DQuat, DVec3, ROW, UVec2, UnitVec3, Vec2, Vec3};
use halfshade::prepare::prepare;
use halfshade::render::{Event, Job, render, replay};
use halfshade::sampling::{Pattern, Sampler, SamplingConfig};
use halfshade::scene::{IntegratorKind, Settings};
use halfshade::stress::still_life::{camera, scene, settings};
use halfshade::texture::{TexturedRgb, TexturedScalar};

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

fn sun() -> Light {
    Light::Distant(DistantLight {
        direction: UnitVec3::normalize(Vec3::new(0.3, -1.0, -0.4)).unwrap(),
        irradiance: Rgb::WHITE,
        angle_radians: 0.02,
        samples: 1,
    })
}

/// Plain surfaces are lit in rows of samples; those with a mask, holes or not, one by one.
#[test]
fn surfaces_that_are_lit_in_rows_have_the_bits_of_those_that_are_not() {
    let mut plain = scene(1.0);
    let glossy = phong(|p| {
        p.diffuse = TexturedRgb::constant(Rgb::splat(0.3));
        p.specular = TexturedRgb::constant(Rgb::splat(0.5));
        p.exponent = TexturedScalar::constant(20.0);
    });
    add_sphere(&mut plain, Vec3::new(-0.4, 0.4, 1.8), 0.4, 12, glossy);
    // Smooth, mirrored, and seen from one side.
    let body = phong(|p| p.diffuse = TexturedRgb::constant(Rgb::splat(0.6)));
    add_sphere(&mut plain, Vec3::ZERO, 0.5, 8, body.clone());
    let mesh = plain.meshes.pop().unwrap();
    let normals = mesh.positions().to_vec();
    plain.meshes.push(mesh.with_normals(normals).unwrap());
    let mut mirrored = plain.instances.last().unwrap().clone();
    plain.instances.last_mut().unwrap().transform.translation = DVec3::new(0.4, 0.5, 2.2);
    mirrored.transform = DAffine3::from_scale_rotation_translation(
        DVec3::new(-1.0, 0.7, 1.0),
        DQuat::IDENTITY,
        DVec3::new(-1.8, 0.4, 1.6),
    );
    plain.instances.push(mirrored);
    let sided = Material {
        is_double_sided: false,
        ..body
    };
    add_quad(
        &mut plain,
        Vec3::new(2.0, 1.0, -2.0),
        Vec3::X,
        Vec3::Y,
        sided,
    );
    let rectangle = RectangleLight {
        center: Vec3::new(-2.0, 3.0, 3.0),
        half_u: Vec3::X * 0.5,
        half_v: Vec3::new(0.0, 0.3, 0.3),
        radiance: Rgb::splat(4.0),
        is_visible: true,
        samples: 1,
    };
    add_light(&mut plain, Light::Rectangle(rectangle));
    add_light(&mut plain, sun());
    let mut masked = plain.clone();
    for material in &mut masked.materials {
        material.alpha_mode = AlphaMode::Mask { cutoff: 0.5 };
    }
    for (pattern, shadow_terminator) in PATTERNS.into_iter().zip([true, false, false, true]) {
        let settings = Settings {
            shadow_terminator,
            ..settings(pattern)
        };
        let [plain, masked] =
            [&plain, &masked].map(|scene| picture(scene, &camera(1.0), &settings));
        assert_eq!(bits(&plain), bits(&masked), "{pattern:?}");
        assert_eq!(plain.rays, masked.rays, "{pattern:?}");
    }
}

/// Rows of any number of samples, by themselves and with all that layers ask for.
#[test]
fn samples_of_a_row_are_those_that_are_taken_one_by_one() {
    let mut scene = scene(1.0);
    add_light(&mut scene, sun());
    let prepared = prepare(&scene, Builder::default()).scene;
    let camera = prepared.camera(&camera(1.0));
    let kinds = [IntegratorKind::Whitted, IntegratorKind::Path];
    for (kind, pattern) in kinds.into_iter().flat_map(|k| PATTERNS.map(|p| (k, p))) {
        let settings = Settings {
            integrator: kind,
            light_samples: Some(2),
            ..settings(pattern)
        };
        let integrator = integrator(&prepared, &settings);
        for count in [1, 11, 12, 13, 63, ROW as u32] {
            let mut row = CameraRow::EMPTY;
            for i in 0..count {
                let pixel = UVec2::new(i * 7 % settings.size.x, i * 11 % settings.size.y);
                let sampler = Sampler::new(&settings.sampling, pixel, i % 4);
                let film = pixel.as_vec2() + sampler.camera();
                let ray = camera.rays(settings.size).at(film, Vec2::ZERO);
                row.rays.push(&ray);
                row.samplers.push(&sampler);
            }
            for told in [0, count as usize] {
                let account = || Account::new(LightGroups::default());
                let accounts = |count| std::iter::repeat_with(account).take(count).collect();
                let mut log = RayLog::told(accounts(told));
                let mut together = [Rgb::BLACK; ROW];
                integrator.radiances(&row, &mut together, &mut log);
                let mut counts = RayCounts::default();
                for (i, (ray, sampler)) in row.iter().enumerate() {
                    let mut own = RayLog::told(accounts(told.min(1)));
                    let alone = integrator.radiance(&ray, &sampler, &mut own);
                    assert_eq!(alone, together[i], "{kind:?}, {pattern:?}, {i} of {count}");
                    counts.add(&own.counts);
                    if told > 0 {
                        let parts = [LightPart::Direct, LightPart::Indirect];
                        let of = |log: &RayLog, i: usize| parts.map(|p| log.accounts[i].light(p));
                        assert_eq!(of(&own, 0), of(&log, i), "{kind:?}, {i} of {count}");
                    }
                }
                assert_eq!(log.counts, counts, "{kind:?}, {pattern:?}, {count}");
            }
        }
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
        // After the first pass each half of every pixel has a sample.
        if let Event::Progress(progress) = event
            && progress.done > 2 * area
        {
            cancel.store(true, std::sync::atomic::Ordering::Relaxed);
        }
    });
    assert_eq!(film.stopped_by, StoppedBy::Interrupt);
    let (least, _, most) = film.sample_counts();
    assert!(least >= 1 && most < 64, "{least} {most}");
}
