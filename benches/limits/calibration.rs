//! How often the 95 % interval holds the true error.

use halfshade::math::UVec2;
use halfshade::render::Limits;
use halfshade::sampling::Pattern;

use crate::subject::{Subject, true_error, with_scene};

const SEEDS: u64 = 200;

pub fn run(scenes: &[String]) {
    println!("scene      pattern   samples  covered  est/true  half-width");
    for name in ["penumbra", "house", "glass", "terrain", "cornell"] {
        if scenes.is_empty() || scenes.iter().any(|s| s == name) {
            with_scene(name, UVec2::new(64, 36), |subject| of_scene(name, subject));
        }
    }
}

fn of_scene(name: &str, subject: &Subject) {
    let reference = subject.reference(1 << 13);
    let uniform = [Pattern::Random, Pattern::Jittered, Pattern::Sobol].map(|p| (p, false));
    for (pattern, is_adaptive) in uniform.into_iter().chain([(Pattern::Sobol, true)]) {
        for samples in [8, 32, 128] {
            let (mut covered, mut widths, mut stated, mut true_square) = (0, 0.0, 0.0, 0.0);
            for seed in 0..SEEDS {
                let settings = subject.settings(pattern, samples, seed);
                let limits = Limits {
                    is_adaptive,
                    ..Limits::of(&settings)
                };
                let film = subject.render(&settings, &limits).film;
                let error = film.error().unwrap();
                let truth = true_error(&film, &reference);
                covered += u32::from(error.low <= truth && truth <= error.high);
                stated += error.estimate.powi(2);
                true_square += truth.powi(2);
                widths += (error.high / error.estimate).ln();
            }
            let mean = |sum: f64| sum / SEEDS as f64;
            println!(
                "{name:10} {:9} {samples:7} {:7.1}% {:9.3} {:10.3}{}",
                pattern.name(),
                100.0 * mean(covered.into()),
                (stated / true_square).sqrt(),
                mean(widths),
                if is_adaptive { "  adaptive" } else { "" }
            );
        }
    }
}
