//! Adaptive sampling: the same bits, no bias, and less error.

use halfshade::film::{Film, Pixel};
use halfshade::math::UVec2;
use halfshade::render::Limits;
use halfshade::sampling::Pattern;
use halfshade::scene::Settings;

use crate::subject::{settings, with_renderer};

fn adaptive(settings: &Settings) -> Limits {
    Limits {
        is_adaptive: true,
        ..Limits::of(settings)
    }
}

fn values(film: &Film) -> Vec<[f64; 3]> {
    film.pixels.iter().map(Pixel::value).collect()
}

#[test]
fn one_two_and_seven_threads_give_the_same_bits() {
    with_renderer(|render| {
        for pattern in [Pattern::Jittered, Pattern::Random, Pattern::Sobol] {
            let settings = settings(pattern, 16, 3);
            let by_samples = Limits {
                samples: 40,
                ..adaptive(&settings)
            };
            let by_error = Limits {
                samples: 4096,
                error: Some(0.03),
                ..by_samples
            };
            for limits in [by_samples, by_error] {
                let films = [1, 2, 7].map(|threads| {
                    let pool = rayon::ThreadPoolBuilder::new().num_threads(threads);
                    pool.build()
                        .unwrap()
                        .install(|| render(&settings, &limits, &|_| {}))
                });
                let (least, mean, most) = films[0].sample_counts();
                assert!(
                    least >= 2 && mean < most as f64,
                    "{pattern:?}: {least} {mean} {most}"
                );
                for other in &films[1..] {
                    assert_eq!(values(&films[0]), values(other), "{pattern:?}");
                }
            }
        }
    });
}

#[test]
fn samples_stay_within_their_number_and_lower_the_error() {
    with_renderer(|render| {
        for pattern in [Pattern::Random, Pattern::Sobol] {
            let mut squares = [0.0; 2];
            for seed in 0..3 {
                let mut settings = settings(pattern, 64, seed);
                settings.size = UVec2::new(80, 48);
                let films = [Limits::of(&settings), adaptive(&settings)]
                    .map(|limits| render(&settings, &limits, &|_| {}));
                assert!((60.0..=64.0).contains(&films[1].sample_counts().1));
                for (sum, film) in squares.iter_mut().zip(&films) {
                    *sum += film.error().unwrap().estimate.powi(2);
                }
            }
            let gain = squares[0] / squares[1];
            println!("{pattern:?}: relMSE {gain:.2} times smaller");
            assert!(gain > 1.5, "{pattern:?}: {gain}");
        }
    });
}

/// The mean over many seeds is that of uniform sampling: in the whole picture, and pixel by pixel but for the
/// bias of second order that `src/render/allot.rs` speaks of. With 16 samples a pixel, the fewest that
/// make sense, its square is 0.3 % of the squared error (400 seeds); chance makes it 0.6 % here.
#[test]
fn there_is_no_bias() {
    const SEEDS: u64 = 200;
    with_renderer(|render| {
        let reference = {
            let settings = settings(Pattern::Sobol, 8192, u64::MAX);
            values(&render(&settings, &Limits::of(&settings), &|_| {}))
        };
        for pattern in [Pattern::Random, Pattern::Sobol] {
            let mut errors = vec![(0.0, 0.0); reference.len()];
            let mut pictures = Vec::new();
            for seed in 0..SEEDS {
                let settings = settings(pattern, 16, seed);
                let film = render(&settings, &adaptive(&settings), &|_| {});
                let mut whole = 0.0;
                for ((sums, value), truth) in errors.iter_mut().zip(values(&film)).zip(&reference) {
                    let error = value[1] - truth[1];
                    sums.0 += error;
                    sums.1 += error * error;
                    whole += error;
                }
                pictures.push(whole);
            }
            let n = SEEDS as f64;
            // The squared bias over the squared error of one picture; 1/n of it is chance.
            let bias: f64 = errors.iter().map(|(sum, _)| (sum / n).powi(2)).sum();
            let error: f64 = errors.iter().map(|(_, squares)| squares / n).sum();
            let share = bias / error - 1.0 / n;
            let mean = pictures.iter().sum::<f64>() / n;
            let deviation = (pictures.iter().map(|p| (p - mean).powi(2)).sum::<f64>() / n).sqrt();
            let off = mean / (deviation / n.sqrt());
            println!("{pattern:?}: bias² is {share:.5} of the squared error; mean off by {off:.2}");
            assert!(off.abs() < 4.0, "{pattern:?}: {off}");
            assert!(share.abs() < 0.012, "{pattern:?}: {share}");
        }
    });
}
