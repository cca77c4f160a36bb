//! `--error` and `--time`: asked against stated, true, and forecast.

use std::time::{Duration, Instant};

use halfshade::film::Pixel;
use halfshade::math::UVec2;
use halfshade::render::Limits;
use halfshade::sampling::Pattern;

use crate::subject::{Outcome, Subject, true_error, with_scene};

/// Seeds over which squared errors are averaged.
const SEEDS: u64 = 3;

/// What is asked of each scene, √relMSE: what takes it a second or so, some, and up to a minute.
const SCENES: [(&str, [f64; 3]); 5] = [
    ("penumbra", [0.05, 0.02, 0.01]),
    ("house", [0.05, 0.02, 0.01]),
    ("cornell", [0.05, 0.02, 0.01]),
    ("glass", [0.1, 0.05, 0.03]),
    ("terrain", [0.02, 0.01, 0.005]),
];

/// Scenes that are rendered with as many samples of each pixel, too.
const UNIFORM: [&str; 2] = ["penumbra", "cornell"];

const OPEN: Limits = Limits {
    samples: 1 << 20,
    deadline: None,
    error: None,
    is_adaptive: true,
};

pub fn run(scenes: &[String]) {
    println!("forecast over outcome: of the samples, and of the seconds or the error, by seed");
    println!(
        "scene     asked          stated    true  stated/true  samples  seconds  forecast over outcome"
    );
    for (name, errors) in SCENES {
        if scenes.is_empty() || scenes.iter().any(|s| s == name) {
            with_scene(name, UVec2::new(160, 90), |subject| {
                of_scene(name, errors, subject);
            });
        }
    }
}

fn of_scene(name: &str, errors: [f64; 3], subject: &Subject) {
    let reference = subject.reference(1024);
    let print = |asked: &str, limits: &dyn Fn() -> Limits| {
        let (mut stated, mut truth, mut seconds, mut samples) = (0.0, 0.0, 0.0, 0.0);
        let mut forecasts = Vec::new();
        for seed in 0..SEEDS {
            let settings = subject.settings(Pattern::Sobol, 16, seed);
            let limits = limits();
            let got = subject.render(&settings, &limits);
            stated += got.film.error().unwrap().estimate.powi(2);
            truth += true_error(&got.film, &reference).powi(2);
            seconds += got.seconds;
            samples += got.film.sample_counts().1;
            forecasts.push(forecast_over_outcome(&got, limits.deadline.is_some()));
        }
        let mean = |sum: f64| sum / SEEDS as f64;
        println!(
            "{name:9} {asked:14} {:.5} {:.5} {:12.3} {:8.1} {:8.2}  {}",
            mean(stated).sqrt(),
            mean(truth).sqrt(),
            (stated / truth).sqrt(),
            mean(samples),
            mean(seconds),
            forecasts.join("  ")
        );
    };
    for error in errors {
        let error = Some(error);
        let limits = Limits { error, ..OPEN };
        print(&format!("{}", limits.error.unwrap()), &|| limits);
        if UNIFORM.contains(&name) {
            let limits = Limits {
                is_adaptive: false,
                ..limits
            };
            print(&format!("{} uniform", limits.error.unwrap()), &|| limits);
        }
    }
    for seconds in [1.0, 3.0, 6.0] {
        print(&format!("{seconds} s"), &|| Limits {
            deadline: Some(Instant::now() + Duration::from_secs_f64(seconds)),
            ..OPEN
        });
    }
}

fn forecast_over_outcome(got: &Outcome, is_by_time: bool) -> String {
    let Some(forecast) = got.forecast else {
        return String::from("none");
    };
    let samples: u64 = got.film.pixels.iter().map(Pixel::count).sum();
    let of_samples = forecast.samples as f64 / samples as f64;
    let other = if is_by_time {
        forecast.error / got.film.error().unwrap().estimate
    } else {
        forecast.seconds / got.seconds
    };
    format!("{of_samples:.2} {other:.2}")
}
