//! Adaptive against uniform sampling at equal processor time.

use halfshade::math::UVec2;
use halfshade::render::Limits;
use halfshade::sampling::Pattern;

use crate::subject::{Subject, true_error, with_scene};

/// Seeds over which squared errors and times are averaged.
const SEEDS: u64 = 3;

pub fn run(scenes: &[String]) {
    println!("scene      samples   uniform      time  adaptive      time  relMSE at equal time");
    for name in ["penumbra", "house", "cornell", "glass", "terrain"] {
        if scenes.is_empty() || scenes.iter().any(|s| s == name) {
            with_scene(name, UVec2::new(320, 180), |subject| {
                of_scene(name, subject)
            });
        }
    }
}

/// Mean relMSE and seconds.
fn measure(subject: &Subject, samples: u32, is_adaptive: bool) -> (f64, f64) {
    let (mut squares, mut seconds) = (0.0, 0.0);
    for seed in 0..SEEDS {
        let settings = subject.settings(Pattern::Sobol, samples, seed);
        let limits = Limits {
            is_adaptive,
            ..Limits::of(&settings)
        };
        let got = subject.render(&settings, &limits);
        squares += got.film.error().unwrap().estimate.powi(2);
        seconds += got.seconds;
    }
    (squares / SEEDS as f64, seconds / SEEDS as f64)
}

fn of_scene(name: &str, subject: &Subject) {
    for samples in [16, 64, 256] {
        let (uniform, uniform_seconds) = measure(subject, samples, false);
        let (more, more_seconds) = measure(subject, 2 * samples, false);
        let (adaptive, seconds) = measure(subject, samples, true);
        // The uniform error at the adaptive time, on the line through two of its points.
        let slope = (more / uniform).ln() / (more_seconds / uniform_seconds).ln();
        let equal = uniform * (seconds / uniform_seconds).powf(slope);
        println!(
            "{name:10} {samples:7} {:9.5} {uniform_seconds:9.2} {:9.5} {seconds:9.2} {:8.2} x (slope {slope:.2})",
            uniform.sqrt(),
            adaptive.sqrt(),
            equal / adaptive
        );
    }
    let _ = true_error;
}
