//! Sample points: range, strata, uniformity, independence of order, and no bias at any count.

#![allow(clippy::unwrap_used, clippy::expect_used)]

mod common;

use common::chi_square::{Moments, uniform_p_value};
use halfshade::math::{DVec3, UVec2, Vec2, Vec3};
use halfshade::sampling::{
    Pattern, Sampler, SamplingConfig, Target, square_to_cone, square_to_disk, square_to_hemisphere,
};

const PATTERNS: [Pattern; 4] = [
    Pattern::Grid,
    Pattern::Jittered,
    Pattern::Random,
    Pattern::Sobol,
];

/// Fails with one run in 10,000 of a right sampler; the seeds are fixed.
const SIGNIFICANCE: f64 = 1e-4;

fn config(pattern: Pattern, samples: u32, seed: u64) -> SamplingConfig {
    SamplingConfig {
        samples,
        pattern,
        target: Target::Rectangle,
        seed,
    }
}

fn samplers(config: SamplingConfig, pixel: UVec2) -> impl Iterator<Item = Sampler> {
    (0..config.samples_per_pixel()).map(move |i| Sampler::new(&config, pixel, i))
}

/// The samplers of each of a pixel's sets, `samples` in each.
fn sets(config: SamplingConfig, pixel: UVec2) -> Vec<Vec<Sampler>> {
    let sets = config.pattern.sets() as usize;
    let all: Vec<_> = samplers(config, pixel).collect();
    (0..sets)
        .map(|set| all.iter().skip(set).step_by(sets).copied().collect())
        .collect()
}

/// What each use of a sample gives when it is the only one of its camera sample.
fn uses(sampler: &Sampler) -> [Vec2; 4] {
    [
        sampler.camera(),
        sampler.light(1, 0, 0, 1),
        sampler.light(1, 1, 0, 1),
        sampler.light(2, 0, 0, 1),
    ]
}

/// The numbers (column and row) of the cells of a `columns` × `rows` grid that hold `points`.
fn cells_of(points: &[Vec2], columns: u32, rows: u32) -> Vec<u32> {
    points
        .iter()
        .map(|p| {
            let column = (f64::from(p.x) * f64::from(columns)) as u32;
            let row = (f64::from(p.y) * f64::from(rows)) as u32;
            row * columns + column
        })
        .collect()
}

fn assert_one_per_cell(points: &[Vec2], columns: u32, rows: u32, what: &str) {
    let mut cells = cells_of(points, columns, rows);
    cells.sort_unstable();
    assert!(
        cells.into_iter().eq(0..columns * rows),
        "{what}: {columns} × {rows}"
    );
}

#[test]
fn cells_are_those_documented() {
    for (asked, taken) in [
        (0, 1),
        (1, 1),
        (2, 2),
        (3, 3),
        (5, 6),
        (10, 12),
        (13, 15),
        (81, 81),
    ] {
        assert_eq!(Pattern::Grid.cells(asked), taken, "grid of {asked}");
        assert_eq!(Pattern::Jittered.cells(asked), taken, "jittered of {asked}");
        assert_eq!(Pattern::Random.cells(asked), asked.max(1));
        assert_eq!(Pattern::Sobol.cells(asked), asked.max(1));
    }
}

#[test]
fn every_number_is_in_its_range() {
    let unit = |p: Vec2| p.cmpge(Vec2::ZERO).all() && p.cmplt(Vec2::ONE).all();
    for pattern in PATTERNS {
        for samples in [1, 3, 81, 4096, 1 << 24, u32::MAX] {
            let config = config(pattern, samples, 7);
            let last = config.samples_per_pixel() - 1;
            for index in (0..300).chain(last.saturating_sub(300)..=last) {
                let circle = SamplingConfig {
                    target: Target::Circle,
                    ..config
                };
                let pixel = UVec2::new(index, 5);
                let sampler = Sampler::new(&config, pixel, index);
                for u in uses(&sampler) {
                    assert!(unit(u), "{pattern:?} {samples} {index}: {u}");
                }
                for count in [2, 12, 4096] {
                    let count = pattern.cells(count);
                    assert!(unit(sampler.light(1, 0, count - 1, count)));
                }
                assert!(sampler.lens().length() < 1.0 + 1e-6);
                let u = Sampler::new(&circle, pixel, index).camera();
                assert!(unit(u) && u.distance(Vec2::splat(0.5)) < 0.5 + 1e-6, "{u}");
            }
        }
    }
}

#[test]
fn grid_and_jittered_samples_take_each_cell_once() {
    for pattern in [Pattern::Grid, Pattern::Jittered] {
        for (samples, columns, rows) in
            [(1, 1, 1), (3, 3, 1), (10, 4, 3), (81, 9, 9), (1000, 33, 31)]
        {
            let config = config(pattern, pattern.sets() * samples, 3);
            for pixel in [UVec2::ZERO, UVec2::new(17, 4)] {
                for set in sets(config, pixel) {
                    for k in 0..4 {
                        let points: Vec<_> = set.iter().map(|s| uses(s)[k]).collect();
                        let what = format!("{pattern:?}, use {k}");
                        assert_one_per_cell(&points, columns, rows, &what);
                    }
                    let count = pattern.cells(samples);
                    let shadow: Vec<_> = (0..count).map(|j| set[0].light(1, 0, j, count)).collect();
                    assert_one_per_cell(&shadow, columns, rows, &format!("{pattern:?}, light"));
                }
            }
        }
    }
}

#[test]
fn grid_samples_are_the_centres() {
    let points = samplers(config(Pattern::Grid, 81, 0), UVec2::ONE).map(|s| s.camera());
    for p in points {
        let inside = (p * 9.0).fract();
        assert!((inside - 0.5).abs().max_element() < 1e-5, "{p}");
    }
}

/// In two dimensions, 2^k Sobol points take every cell of every 2^a × 2^(k-a) grid once
/// (Owen scrambling keeps that), for each use with a set of its own.
#[test]
fn sobol_samples_take_each_elementary_interval_once() {
    for log_samples in 0..11 {
        let samples = 1 << log_samples;
        for seed in 0..3 {
            let config = config(Pattern::Sobol, 2 * samples, seed);
            let all = &sets(config, UVec2::new(3, 9))[seed as usize % 2];
            let camera: Vec<_> = all.iter().map(Sampler::camera).collect();
            let bounce: Vec<_> = all.iter().map(|s| s.light(2, 0, 0, 1)).collect();
            // Four shadow rays per camera sample: all of them together.
            let shadow: Vec<_> = all[..samples.div_ceil(4) as usize]
                .iter()
                .flat_map(|s| (0..samples.min(4)).map(|j| s.light(1, 0, j, samples.min(4))))
                .collect();
            for log_columns in 0..=log_samples {
                let (columns, rows) = (1 << log_columns, 1 << (log_samples - log_columns));
                assert_one_per_cell(&camera, columns, rows, "camera");
                assert_one_per_cell(&bounce, columns, rows, "second vertex");
                assert_one_per_cell(&shadow, columns, rows, "first light, four each");
            }
            let first: Vec<_> = all.iter().map(|s| s.light(1, 0, 0, 1)).collect();
            assert_one_per_cell(&first, samples, 1, "first light, across");
            assert_one_per_cell(&first, 1, samples, "first light, up");
        }
    }
}

/// Over pixels, the errors of the means of two sets have nothing to do with each other: what the
/// estimate of a picture's error rests on.
#[test]
fn sets_of_a_pixel_are_independent() {
    for pattern in [Pattern::Jittered, Pattern::Random, Pattern::Sobol] {
        for samples in [2, 8, 32] {
            let config = config(pattern, samples, 4);
            for k in 0..4 {
                let (mut products, mut squares) = (Moments::default(), Moments::default());
                for pixel in 0..20_000 {
                    let error = |set: &Vec<Sampler>| {
                        let values = set.iter().map(|s| integrand(uses(s)[k]));
                        values.sum::<f64>() / set.len() as f64 - integral()
                    };
                    let sets = sets(config, UVec2::new(pixel, 2));
                    products.add(error(&sets[0]) * error(&sets[1]));
                    squares.add(error(&sets[0]).powi(2));
                }
                let off = products.mean() / products.standard_error();
                println!(
                    "{pattern:?} {samples}: {:.4}",
                    products.mean() / squares.mean()
                );
                assert!(off.abs() < 4.5, "{pattern:?}, {samples}, use {k}: {off}");
            }
        }
    }
}

/// A sample is a function of its key: order, threads and the number of other samples are nothing to it.
#[test]
fn samples_do_not_depend_on_order_threads_or_their_number() {
    for pattern in PATTERNS {
        let config = config(pattern, 64, 11);
        let numbers = |index: u32| {
            let s = Sampler::new(&config, UVec2::new(5, 6), index);
            (uses(&s), s.lens(), s.light(1, 2, 3, 4))
        };
        let forward: Vec<_> = (0..64).map(numbers).collect();
        let mut backward: Vec<_> = (0..64).rev().map(numbers).collect();
        backward.reverse();
        assert_eq!(forward, backward, "{pattern:?}");
        std::thread::scope(|scope| {
            let threads: Vec<_> = (0..4)
                .map(|k| {
                    scope.spawn(move || (16 * k..16 * k + 16).map(numbers).collect::<Vec<_>>())
                })
                .collect();
            let joined: Vec<_> = threads
                .into_iter()
                .flat_map(|t| t.join().unwrap())
                .collect();
            assert_eq!(forward, joined, "{pattern:?}");
        });
    }
    for pattern in [Pattern::Random, Pattern::Sobol] {
        let few = Sampler::new(&config(pattern, 7, 1), UVec2::ONE, 6);
        let many = Sampler::new(&config(pattern, 1 << 20, 1), UVec2::ONE, 6);
        assert_eq!(uses(&few), uses(&many), "{pattern:?}");
    }
}

#[test]
fn seeds_pixels_indices_and_lights_give_other_numbers() {
    for pattern in [Pattern::Jittered, Pattern::Random, Pattern::Sobol] {
        let mut seen = Vec::new();
        for seed in [0, 1, 1 << 32] {
            for pixel in [UVec2::ZERO, UVec2::X, UVec2::Y] {
                for sampler in samplers(config(pattern, 16, seed), pixel) {
                    for vertex in 1..4 {
                        seen.extend((0..4).map(|light| sampler.light(vertex, light, 0, 1)));
                    }
                }
            }
        }
        let count = seen.len();
        seen.sort_by(|a, b| a.x.total_cmp(&b.x).then(a.y.total_cmp(&b.y)));
        seen.dedup();
        assert_eq!(seen.len(), count, "{pattern:?}");
    }
}

/// Bins a point of the unit square into `side`².
fn bin(u: Vec2, side: u32) -> usize {
    let cell = (u * side as f32).as_uvec2();
    (cell.y * side + cell.x) as usize
}

/// Over many pixels, any one sample is uniform, and has nothing to do with the sample's other uses.
#[test]
fn any_single_sample_is_uniform_over_pixels() {
    const SIDE: u32 = 12;
    for pattern in [Pattern::Jittered, Pattern::Random, Pattern::Sobol] {
        for (samples, index) in [(1, 0), (3, 2), (16, 0), (81, 40)] {
            let config = config(pattern, samples, 5);
            let mut counts = [const { [0; (SIDE * SIDE) as usize] }; 8];
            for pixel in 0..100_000 {
                let sampler = Sampler::new(&config, UVec2::new(pixel % 400, pixel / 400), index);
                let [camera, first, second, bounce] = uses(&sampler);
                let shadow = sampler.light(1, 0, 1, pattern.cells(12));
                let singles = [camera, first, second, bounce, shadow];
                let pairs = [
                    Vec2::new(camera.x, first.x),
                    Vec2::new(first.y, second.y),
                    Vec2::new(second.x, bounce.y),
                ];
                for (counts, u) in counts.iter_mut().zip(singles.into_iter().chain(pairs)) {
                    counts[bin(u, SIDE)] += 1;
                }
            }
            for (what, counts) in counts.iter().enumerate() {
                let p = uniform_p_value(counts);
                assert!(
                    p > SIGNIFICANCE,
                    "{pattern:?} {index}/{samples}, number {what}: p = {p}"
                );
            }
        }
    }
}

/// Uniform points through `warp` must be uniform in the coordinates that `unwarp` gives.
fn assert_warp_is_uniform(name: &str, place: impl Fn(Vec2) -> Vec2) {
    const SIDE: u32 = 16;
    let mut counts = [0; (SIDE * SIDE) as usize];
    for sampler in samplers(config(Pattern::Random, 200_000, 2), UVec2::ZERO) {
        let place = place(sampler.camera()).clamp(Vec2::ZERO, Vec2::splat(0.999_999));
        counts[bin(place, SIDE)] += 1;
    }
    let p = uniform_p_value(&counts);
    assert!(p > SIGNIFICANCE, "{name}: p = {p}");
}

/// From an angle in (-π, π] to [0, 1).
fn turn(y: f64, x: f64) -> f32 {
    (0.5 + y.atan2(x) / std::f64::consts::TAU) as f32
}

#[test]
fn warps_keep_areas_in_proportion() {
    assert_warp_is_uniform("disk", |u| {
        let p = square_to_disk(u);
        Vec2::new(p.length_squared(), turn(p.y.into(), p.x.into()))
    });
    // By the cosine: the square of the height is uniform.
    assert_warp_is_uniform("hemisphere", |u| {
        let v = square_to_hemisphere(u);
        assert!((v.length() - 1.0).abs() < 1e-6 && v.z >= 0.0, "{v}");
        Vec2::new(v.z * v.z, turn(v.y.into(), v.x.into()))
    });
    for one_minus_cos in [1e-200, 1e-12, 0.01, 0.5, 1.0, 1.7, 2.0] {
        assert_warp_is_uniform(&format!("cone {one_minus_cos}"), |u| {
            let v = square_to_cone(u, one_minus_cos);
            assert!((v.length() - 1.0).abs() < 1e-6, "{v}");
            assert!(1.0 - v.z <= one_minus_cos * 1.000_001 + 1e-15, "{v}");
            // 1 - z, without cancellation.
            let depth = if v.z > 0.0 {
                let sin = v.x.hypot(v.y);
                sin / one_minus_cos * sin / (1.0 + v.z)
            } else {
                (1.0 - v.z) / one_minus_cos
            };
            Vec2::new(depth as f32, turn(v.y, v.x))
        });
    }
}

#[test]
fn warps_keep_the_middle_and_the_edge() {
    assert_eq!(square_to_disk(Vec2::splat(0.5)), Vec2::ZERO);
    assert_eq!(square_to_hemisphere(Vec2::splat(0.5)), Vec3::Z);
    assert_eq!(square_to_cone(Vec2::splat(0.5), 0.3), DVec3::Z);
    for u in [Vec2::ZERO, Vec2::new(0.0, 0.7), Vec2::new(0.2, 0.0)] {
        assert!((square_to_disk(u).length() - 1.0).abs() < 1e-6, "{u}");
    }
}

/// A step, a ramp and a wave; the exact mean over the unit square.
fn integrand(u: Vec2) -> f64 {
    let (x, y) = (f64::from(u.x), f64::from(u.y));
    let step = if 0.3 * x + y < 0.61 { 1.0 } else { 0.0 };
    step + x * y + (5.0 * x).sin()
}

/// (0.61 - 0.15) + 1/4 + (1 - cos 5)/5.
fn integral() -> f64 {
    0.46 + 0.25 + (1.0 - 5.0_f64.cos()) / 5.0
}

/// numerics.md L13, for all uses of a sample, and for parts of a pixel's samples too.
#[test]
fn no_count_biases_the_mean() {
    for pattern in [Pattern::Jittered, Pattern::Random, Pattern::Sobol] {
        for count in [1_u32, 2, 3, 7, 13, 81] {
            for taken in [count, count.div_ceil(3)] {
                let mut means = [Moments::default(); 5];
                for seed in 0..4000 {
                    let config = config(pattern, count, seed);
                    let mut sums = [0.0; 5];
                    for sampler in samplers(config, UVec2::new(8, 1)).take(taken as usize) {
                        let shadows = pattern.cells(3);
                        let shadow = (0..shadows)
                            .map(|j| integrand(sampler.light(1, 0, j, shadows)))
                            .sum::<f64>();
                        let uses = uses(&sampler).map(integrand);
                        for (sum, value) in sums.iter_mut().zip(uses) {
                            *sum += value;
                        }
                        sums[4] += shadow / f64::from(shadows);
                    }
                    for (mean, sum) in means.iter_mut().zip(sums) {
                        mean.add(sum / f64::from(taken));
                    }
                }
                for (what, mean) in means.iter().enumerate() {
                    mean.assert_mean(
                        integral(),
                        &format!("{pattern:?}, {taken} of {count}, use {what}"),
                    );
                }
            }
        }
    }
}

/// numerics.md L12.
#[test]
fn millions_of_samples_in_one_pixel_go_on() {
    for pattern in PATTERNS {
        let samples = 1 << 22;
        let config = config(pattern, samples, 1);
        let mean: Moments = samplers(config, UVec2::ZERO)
            .map(|s| integrand(s.light(1, 0, 0, 1)))
            .collect();
        let error = (mean.mean() - integral()).abs();
        assert!(
            error < 4.0 * mean.standard_error(),
            "{pattern:?}: off by {error}"
        );
        let at = |index| Sampler::new(&config, UVec2::ZERO, index);
        for index in [0, 1, 12_345] {
            let other = index + (1 << 24);
            assert_ne!(
                at(index).camera(),
                at(other).camera(),
                "{pattern:?} {index}"
            );
        }
    }
    // 2^32 camera samples of 2^20 shadow rays each: still other points.
    let config = config(Pattern::Sobol, u32::MAX, 1);
    let last = Sampler::new(&config, UVec2::ZERO, u32::MAX - 1);
    assert_ne!(last.light(1, 0, 0, 1 << 20), last.light(1, 0, 1, 1 << 20));
    assert_ne!(
        last.light(1, 0, 5, 1 << 20),
        Sampler::new(&config, UVec2::ZERO, 5).light(1, 0, 5, 1 << 20)
    );
}

/// Root mean square error, over pixels, of the visible share of a disk behind a half-plane
/// (numerics.md L1) with `samples` camera samples of one shadow ray each.
fn penumbra_error(pattern: Pattern, samples: u32) -> f64 {
    let config = config(pattern, samples, 21);
    let errors: Moments = (0..1500)
        .map(|pixel| {
            let s = (f64::from(pixel) + 0.5) / 750.0 - 1.0;
            let exact = ((-s).acos() + s * (1.0 - s * s).sqrt()) / std::f64::consts::PI;
            let visible = samplers(config, UVec2::new(pixel, 0))
                .filter(|sampler| {
                    let p = square_to_disk(sampler.light(1, 0, 0, 1));
                    // An edge along no axis.
                    f64::from(0.8 * p.x + 0.6 * p.y) < s
                })
                .count();
            (visible as f64 / f64::from(config.samples_per_pixel()) - exact).powi(2)
        })
        .collect();
    errors.mean().sqrt()
}

/// Slope of log error against log samples, from 16 to 1024.
fn slope(pattern: Pattern) -> f64 {
    (penumbra_error(pattern, 1024) / penumbra_error(pattern, 16)).log2() / 6.0
}

#[test]
fn stratified_points_converge_faster_at_a_penumbra() {
    for samples in [16, 64, 256, 1024] {
        let errors = PATTERNS.map(|pattern| penumbra_error(pattern, samples));
        println!("{samples:5} samples: RMSE of {PATTERNS:?} {errors:.5?}");
        let [_, jittered, random, sobol] = errors;
        assert!(jittered < 0.7 * random, "{samples}");
        // Two sets of 8 points are few for a net in four dimensions.
        let bound = if samples > 16 { 0.7 } else { 0.9 };
        assert!(sobol < bound * random, "{samples}");
    }
    let [_, jittered, random, sobol] = PATTERNS.map(slope);
    println!("slopes: jittered {jittered:.3}, random {random:.3}, sobol {sobol:.3}");
    assert!((random + 0.5).abs() < 0.03, "random {random}");
    assert!((jittered + 0.75).abs() < 0.05, "jittered {jittered}");
    assert!(sobol < -0.69, "sobol {sobol}");
}

/// With more than one light, their samples must not be of one mind: across the camera samples of
/// a pixel, the points on two lights correlate no more than random orders do by chance.
///
/// Consecutive Sobol points lie in opposite halves, in every set. That makes chance correlations
/// larger (their square by less than 2), though never of one sign.
#[test]
fn the_points_of_two_lights_are_not_correlated_within_a_pixel() {
    for (pattern, largest) in [
        (Pattern::Grid, 1.1),
        (Pattern::Jittered, 1.1),
        (Pattern::Sobol, 1.6),
    ] {
        let config = config(pattern, 64, 9);
        let correlations = (0..4000).map(|pixel| {
            let points = samplers(config, UVec2::new(pixel, 1));
            correlation(points.map(|s| (s.light(1, 1, 0, 1).x, s.light(1, 2, 0, 1).x)))
        });
        let correlations: Moments = correlations.collect();
        // Random permutations of 64 values have a correlation of variance 1/63.
        let excess = correlations.variance() * 63.0;
        println!("{pattern:?}: {} {excess:.3}", correlations.mean());
        correlations.assert_mean(0.0, &format!("{pattern:?}"));
        assert!(excess < largest, "{pattern:?}: {excess}");
    }
}

/// Correlation of pairs of numbers that are uniform in `[0, 1)`.
fn correlation(pairs: impl Iterator<Item = (f32, f32)>) -> f64 {
    let centered = |(a, b): (f32, f32)| (f64::from(a) - 0.5, f64::from(b) - 0.5);
    let (mut ab, mut aa, mut bb) = (0.0, 0.0, 0.0);
    for (a, b) in pairs.map(centered) {
        ab += a * b;
        aa += a * a;
        bb += b * b;
    }
    ab / (aa * bb).sqrt()
}
