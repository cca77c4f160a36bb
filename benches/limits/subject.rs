//! A scene with a reference.

use std::path::Path;
use std::sync::Mutex;
use std::sync::atomic::AtomicBool;
use std::time::Instant;

use halfshade::bvh::Builder;
use halfshade::film::{Film, RELATIVE_FLOOR, Rect};
use halfshade::import::{Imported, SceneOptions, import};
use halfshade::math::UVec2;
use halfshade::prepare::{PreparedScene, prepare};
use halfshade::render::{Event, Forecast, Job, Limits, render_within};
use halfshade::sampling::Pattern;
use halfshade::scene::Settings;

/// What came of a render.
pub struct Outcome {
    pub film: Film,
    pub forecast: Option<Forecast>,
    pub seconds: f64,
}

/// Calls `with` with the scene of that name, `size` pixels large.
pub fn with_scene(name: &str, size: UVec2, with: impl FnOnce(&Subject)) {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join(format!("scenes/{name}.toml"));
    let mut imported = import(&path, &SceneOptions::default()).unwrap();
    imported.settings.size = size;
    imported.settings.light_samples = Some(1);
    let prepared = prepare(&imported.scene, Builder::default());
    with(&Subject {
        imported: &imported,
        scene: &prepared.scene,
    });
}

pub struct Subject<'a> {
    imported: &'a Imported,
    scene: &'a PreparedScene<'a>,
}

impl Subject<'_> {
    pub fn settings(&self, pattern: Pattern, samples: u32, seed: u64) -> Settings {
        let mut settings = self.imported.settings.clone();
        settings.sampling.pattern = pattern;
        settings.sampling.samples = samples;
        settings.sampling.seed = seed;
        settings
    }

    pub fn render(&self, settings: &Settings, limits: &Limits) -> Outcome {
        let job = Job {
            scene: self.scene,
            camera: self.scene.camera(&self.imported.scene.cameras[0]),
            settings,
            crop: Rect::full(settings.size),
            layers: Vec::new(),
        };
        let forecast = Mutex::new(None);
        let start = Instant::now();
        let film = render_within(&job, limits, &AtomicBool::new(false), &|event| {
            if let Event::Forecast(f) = event {
                *forecast.lock().unwrap() = Some(f);
            }
        });
        Outcome {
            film,
            seconds: start.elapsed().as_secs_f64(),
            forecast: forecast.into_inner().unwrap(),
        }
    }

    pub fn uniform(&self, settings: &Settings) -> Outcome {
        self.render(settings, &Limits::of(settings))
    }

    /// With `samples` a pixel and a seed that no other render has.
    pub fn reference(&self, samples: u32) -> Film {
        self.uniform(&self.settings(Pattern::Sobol, samples, 0xffff_ffff))
            .film
    }
}

/// √relMSE against a reference, whose own error is subtracted.
pub fn true_error(film: &Film, reference: &Film) -> f64 {
    let mut sum = 0.0;
    for (a, b) in film.pixels.iter().zip(&reference.pixels) {
        let (value, truth, floor) = (a.value(), b.value(), b.squared_error());
        for c in 0..3 {
            let square = (value[c] - truth[c]).powi(2) - floor[c];
            sum += square / (truth[c] * truth[c] + RELATIVE_FLOOR);
        }
    }
    (sum / (3 * film.pixels.len()) as f64).max(0.0).sqrt()
}
