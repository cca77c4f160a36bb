//! Adaptive against uniform sampling at equal time, and at an equal number of rays, which no other
//! work of the machine changes.

use halfshade::math::UVec2;
use halfshade::render::Limits;
use halfshade::sampling::Pattern;

use crate::subject::{Subject, with_scene};

/// Seeds over which squared errors and times are averaged.
const SEEDS: u64 = 2;

pub fn run(scenes: &[String]) {
    println!(
        "scene      samples   uniform      time  adaptive      time  uniform/adaptive relMSE at equal time, rays"
    );
    for name in ["penumbra", "house", "cornell", "glass", "terrain"] {
        if scenes.is_empty() || scenes.iter().any(|s| s == name) {
            with_scene(name, UVec2::new(240, 135), |subject| {
                of_scene(name, subject)
            });
        }
    }
}

/// Means over the seeds.
#[derive(Clone, Copy, Default)]
struct Measured {
    relmse: f64,
    seconds: f64,
    rays: f64,
}

fn measure(subject: &Subject, samples: u32, is_adaptive: bool) -> Measured {
    let mut mean = Measured::default();
    for seed in 0..SEEDS {
        let settings = subject.settings(Pattern::Sobol, samples, seed);
        let limits = Limits {
            is_adaptive,
            ..Limits::of(&settings)
        };
        let got = subject.render(&settings, &limits);
        mean.relmse += got.film.error().unwrap().estimate.powi(2) / SEEDS as f64;
        mean.seconds += got.seconds / SEEDS as f64;
        mean.rays += got.film.rays.total() as f64 / SEEDS as f64;
    }
    mean
}

/// The relMSE of uniform sampling at another cost than that of `few`, on the line through two of
/// its points.
fn at_cost(few: Measured, more: Measured, cost: f64) -> f64 {
    let slope = (more.relmse / few.relmse).ln() / (more.rays / few.rays).ln();
    few.relmse * cost.powf(slope)
}

fn of_scene(name: &str, subject: &Subject) {
    for samples in [16, 64] {
        let uniform = measure(subject, samples, false);
        let adaptive = measure(subject, samples, true);
        let more = measure(subject, 2 * samples, false);
        let gain = |cost| at_cost(uniform, more, cost) / adaptive.relmse;
        println!(
            "{name:10} {samples:7} {:9.5} {:9.2} {:9.5} {:9.2} {:8.2} x {:8.2} x",
            uniform.relmse.sqrt(),
            uniform.seconds,
            adaptive.relmse.sqrt(),
            adaptive.seconds,
            gain(adaptive.seconds / uniform.seconds),
            gain(adaptive.rays / uniform.rays),
        );
    }
}
