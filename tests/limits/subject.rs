//! A ball on a floor under two lamps: penumbrae, silhouettes, and wide parts where nothing happens.

use std::sync::atomic::AtomicBool;

use halfshade::bvh::Builder;
use halfshade::color::Rgb;
use halfshade::film::{Film, RELATIVE_FLOOR, Rect};
use halfshade::material::Material;
use halfshade::math::{UVec2, Vec3};
use halfshade::prepare::prepare;
use halfshade::render::{Event, Job, Limits, render_within};
use halfshade::sampling::{Pattern, SamplingConfig};
use halfshade::scene::{Scene, Settings};

use crate::common::build::*;

pub fn scene() -> Scene {
    let mut scene = Scene::default();
    let matte = |value| Material::matte("matte", Rgb::splat(value));
    let (right, back) = (Vec3::X * 6.0, Vec3::Z * 6.0);
    add_quad(&mut scene, Vec3::ZERO, back, right, matte(0.7));
    add_sphere(&mut scene, Vec3::Y, 1.0, 12, matte(0.4));
    let lamp = |x: f32, radius| point_light(Vec3::new(x, 5.0, 2.0), 90.0, radius, 1);
    add_light(&mut scene, lamp(3.0, 0.9));
    add_light(&mut scene, lamp(-2.0, 0.2));
    scene
}

pub fn settings(pattern: Pattern, samples: u32, seed: u64) -> Settings {
    Settings {
        size: UVec2::new(40, 24),
        sampling: SamplingConfig {
            samples,
            pattern,
            seed,
            ..SamplingConfig::default()
        },
        ..Settings::default()
    }
}

/// Renders the scene; the last argument observes it.
pub type Renderer<'a> = dyn Fn(&Settings, &Limits, &(dyn Fn(Event) + Sync)) -> Film + Sync + 'a;

/// Hands `with` a renderer of the scene.
pub fn with_renderer<T>(with: impl FnOnce(&Renderer) -> T) -> T {
    let scene = scene();
    let prepared = prepare(&scene, Builder::default()).scene;
    let camera = look_at(Vec3::new(1.0, 3.5, 6.0), Vec3::new(0.0, 0.6, 0.0));
    with(&|settings, limits, observe| {
        let job = Job {
            scene: &prepared,
            camera: prepared.camera(&camera),
            settings,
            crop: Rect::full(settings.size),
            layers: Vec::new(),
        };
        render_within(&job, limits, &AtomicBool::new(false), observe)
    })
}

/// √relMSE against a reference.
pub fn true_error(film: &Film, reference: &Film) -> f64 {
    let mut sum = 0.0;
    for (a, b) in film.pixels.iter().zip(&reference.pixels) {
        for (a, b) in a.value().into_iter().zip(b.value()) {
            sum += (a - b).powi(2) / (b * b + RELATIVE_FLOOR);
        }
    }
    (sum / (3 * film.pixels.len()) as f64).sqrt()
}
