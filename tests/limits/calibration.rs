//! numerics.md 3: the interval that a render states holds the true error as often as it says. The whole
//! measurement is `cargo bench --bench limits -- calibration`.

use halfshade::render::Limits;
use halfshade::sampling::Pattern;

use crate::subject::{settings, true_error, with_renderer};

const SEEDS: u64 = 60;

/// By the samples' own variance, as if they were independent.
fn naive_error(film: &halfshade::film::Film) -> f64 {
    let mut sum = 0.0;
    for pixel in &film.pixels {
        for (c, weight) in halfshade::film::relative_weights(pixel.value())
            .into_iter()
            .enumerate()
        {
            let of =
                |half: &halfshade::film::Moments| half.sample_variance()[c] / half.count() as f64;
            sum += weight * 0.25 * pixel.halves().iter().map(of).sum::<f64>();
        }
    }
    (sum / (3 * film.pixels.len()) as f64).sqrt()
}

#[test]
fn the_interval_holds_the_true_error() {
    with_renderer(|render| {
        let uniform = |pattern, samples, seed| {
            let settings = settings(pattern, samples, seed);
            render(&settings, &Limits::of(&settings), &|_| {})
        };
        let reference = uniform(Pattern::Sobol, 8192, u64::MAX);
        for pattern in [Pattern::Random, Pattern::Jittered, Pattern::Sobol] {
            let (mut held, mut stated, mut naive, mut truth) = (0, 0.0, 0.0, 0.0);
            for seed in 0..SEEDS {
                let film = uniform(pattern, 64, seed);
                let (error, true_error) = (film.error().unwrap(), true_error(&film, &reference));
                held += u64::from(error.low <= true_error && true_error <= error.high);
                stated += error.estimate.powi(2);
                naive += naive_error(&film).powi(2);
                truth += true_error.powi(2);
            }
            let (ratio, naive) = ((stated / truth).sqrt(), (naive / truth).sqrt());
            println!("{pattern:?}: {held} of {SEEDS} held, stated {ratio:.3}, naive {naive:.3}");
            // 57 ± 1.7 by chance.
            assert!((51..=SEEDS).contains(&held), "{pattern:?}: {held}");
            assert!((ratio - 1.0).abs() < 0.04, "{pattern:?}: {ratio}");
            // What the halves are for.
            if pattern == Pattern::Sobol {
                assert!(naive > 1.3, "{naive}");
            }
        }
    });
}

#[test]
fn what_cannot_be_known_is_not_stated() {
    with_renderer(|render| {
        for (pattern, samples) in [(Pattern::Grid, 16), (Pattern::Sobol, 1)] {
            let settings = settings(pattern, samples, 0);
            let film = render(&settings, &Limits::of(&settings), &|_| {});
            assert_eq!(film.error(), None, "{pattern:?}");
        }
    });
}
