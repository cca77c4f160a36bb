//! `--error` and `--time`: asked against got.

use std::time::{Duration, Instant};

use halfshade::film::Pixel;
use halfshade::math::UVec2;
use halfshade::render::Limits;
use halfshade::sampling::Pattern;

use crate::subject::{Subject, true_error, with_scene};

pub fn run(scenes: &[String]) {
    println!(
        "scene     asked        got est (true)    seconds   forecast (of it; samples)  samples"
    );
    for name in ["penumbra", "house", "cornell", "glass", "terrain"] {
        if scenes.is_empty() || scenes.iter().any(|s| s == name) {
            with_scene(name, UVec2::new(160, 90), |subject| of_scene(name, subject));
        }
    }
}

fn of_scene(name: &str, subject: &Subject) {
    let reference = subject.reference(1024);
    let settings = subject.settings(Pattern::Sobol, 16, 1);
    for is_adaptive in [true, false] {
        let limits = Limits {
            samples: 1 << 20,
            deadline: None,
            error: None,
            is_adaptive,
        };
        let print = |asked: String, limits: Limits, is_time: bool| {
            let got = subject.render(&settings, &limits);
            let error = got.film.error().unwrap();
            let forecast = got.forecast.map_or(String::from("none"), |f| {
                let (forecast, outcome) = if is_time {
                    (f.error, error.estimate)
                } else {
                    (f.seconds, got.seconds)
                };
                let samples: u64 = got.film.pixels.iter().map(Pixel::count).sum();
                let share = f.samples as f64 / samples as f64;
                format!("{forecast:.4} ({:.2}; {share:.2})", forecast / outcome)
            });
            println!(
                "{name:9} {asked:12} {:.5} ({:.5}) {:8.2}  {forecast:16}  {:.1}{}",
                error.estimate,
                true_error(&got.film, &reference),
                got.seconds,
                got.film.sample_counts().1,
                if is_adaptive { "" } else { " uniform" }
            );
        };
        for error in [0.05, 0.02, 0.01] {
            print(
                format!("{error}"),
                Limits {
                    error: Some(error),
                    ..limits
                },
                false,
            );
        }
        for seconds in [1.0, 3.0, 6.0] {
            let deadline = Some(Instant::now() + Duration::from_secs_f64(seconds));
            print(format!("{seconds} s"), Limits { deadline, ..limits }, true);
        }
    }
}
