//! Pictures whose figures are known without computing them.

use halfshade::color::{Rgb, linear_to_srgb};
use halfshade::math::UVec2;
use halfshade::report::Picture;
use halfshade::report::metrics::{
    Figures, NonFinite, Pair, PairError, WorstPixel, flip, hdr_flip, mae, psnr, relative_error,
    relmse, rmse, ssim, worst_pixels,
};

use super::{assert_near, constant, pair, picture};

const SIZE: UVec2 = UVec2::new(31, 23);

fn blocks(size: UVec2) -> Picture {
    picture(size, |x, y, c| ((x / 5 + y / 4 + c) % 3) as f32 / 2.0)
}

#[test]
fn equal_pictures_have_no_error() {
    let picture = blocks(SIZE);
    let figures = Figures::of(&pair(&picture, &picture));
    let expected = Figures {
        rmse: 0.0,
        relmse: 0.0,
        mae: 0.0,
        psnr: f64::INFINITY,
        ssim: Some(1.0),
        flip: 0.0,
        hdr_flip: 0.0,
        non_finite: [0, 0],
    };
    assert_eq!(figures, expected);
    assert_eq!(worst_pixels(&pair(&picture, &picture), 9), []);
}

#[test]
fn constant_pictures_follow_the_formulae() {
    let (a, b) = (0.75f32, 0.25f32);
    let pair = pair(
        &constant(SIZE, Rgb::splat(a)),
        &constant(SIZE, Rgb::splat(b)),
    );
    assert_near(rmse(&pair), 0.5, 1e-12);
    assert_near(mae(&pair), 0.5, 1e-12);
    assert_near(relmse(&pair), 0.25 / (0.0625 + 0.01), 1e-12);
    let [a, b] = [a, b].map(|v| f64::from(linear_to_srgb(v)));
    assert_near(psnr(&pair), -20.0 * (a - b).log10(), 1e-9);
    let means = (2.0 * a * b + 1e-4) / (a * a + b * b + 1e-4);
    assert_near(ssim(&pair).unwrap(), means, 1e-9);
    let errors = relative_error(&pair).values;
    let expected = (0.25f64 / 0.0725).sqrt() as f32;
    assert!(errors.iter().all(|&e| e == Some(expected)));
}

#[test]
fn only_relmse_and_hdr_flip_tell_the_reference() {
    let (a, b) = (blocks(SIZE), constant(SIZE, Rgb::new(0.1, 0.5, 0.9)));
    let (there, back) = (pair(&a, &b), pair(&b, &a));
    for metric in [rmse, mae, psnr, |p: &Pair| ssim(p).unwrap()] {
        assert_near(metric(&there), metric(&back), 1e-12);
    }
    assert_eq!(flip(&there), flip(&back));
    assert!((relmse(&there) / relmse(&back) - 1.0).abs() > 0.1);
    assert_ne!(hdr_flip(&there), hdr_flip(&back));
}

#[test]
fn flip_spans_from_nothing_to_the_farthest_colours() {
    // The scale is fixed by green against blue (Andersson et al. 2020, section 4.1).
    let [green, blue] = [[0.0, 1.0, 0.0], [0.0, 0.0, 1.0]].map(|c| constant(SIZE, c.into()));
    assert_near(flip(&pair(&green, &blue)).mean(), 1.0, 1e-6);
    // What is clipped looks the same.
    let [bright, brighter] = [1.0, 50.0].map(|v| constant(SIZE, Rgb::splat(v)));
    assert_eq!(flip(&pair(&bright, &brighter)).mean(), 0.0);
    assert!(hdr_flip(&pair(&bright, &brighter)).mean() > 0.3);
}

#[test]
fn hdr_flip_knows_no_unit() {
    let reference = picture(SIZE, |x, y, c| 0.1 + ((x * 3 + y * 5 + c) % 7) as f32);
    let test = picture(SIZE, |x, y, c| 0.1 + ((x * 3 + y * 4 + c) % 7) as f32);
    let at = |scale: f32| {
        let [test, reference] = [&test, &reference].map(|picture| Picture {
            size: SIZE,
            pixels: picture.pixels.iter().map(|&c| c * scale).collect(),
        });
        hdr_flip(&pair(&test, &reference)).mean()
    };
    let plain = at(1.0);
    assert!(plain > 0.1);
    for exponent in [-30, -4, 4, 30] {
        assert_near(at((exponent as f32).exp2()), plain, 1e-5);
    }
}

#[test]
fn pixels_that_are_not_finite_are_counted_and_left_out() {
    let good = (
        constant(SIZE, Rgb::splat(0.5)),
        constant(SIZE, Rgb::splat(0.25)),
    );
    let (mut test, mut reference) = good.clone();
    test.pixels[0] = Rgb::new(f32::NAN, 0.5, 0.5);
    test.pixels[40] = Rgb::new(0.5, f32::INFINITY, 0.5);
    reference.pixels[40] = Rgb::splat(f32::NEG_INFINITY);
    reference.pixels[99] = Rgb::splat(f32::NAN);
    let (pair, good) = (pair(&test, &reference), pair(&good.0, &good.1));
    let [in_test, in_reference] = pair.non_finite();
    let first = |x, y| Some(UVec2::new(x, y));
    assert_eq!((in_test.count, in_test.first), (2, first(0, 0)));
    assert_eq!((in_reference.count, in_reference.first), (2, first(9, 1)));
    assert_eq!(good.non_finite(), [NonFinite::default(); 2]);
    for metric in [rmse, relmse, mae, psnr] {
        assert_near(metric(&pair), metric(&good), 1e-12);
    }
    for map in [flip, hdr_flip, relative_error] {
        let map = map(&pair);
        let left_out: Vec<usize> = (0..map.values.len())
            .filter(|&i| map.values[i].is_none())
            .collect();
        assert_eq!(left_out, [0, 40, 99]);
        assert!(map.mean().is_finite());
    }
    assert!(ssim(&pair).unwrap().is_finite());
    assert!(
        worst_pixels(&pair, usize::MAX)
            .iter()
            .all(|w| w.relative_error < 1.0)
    );
}

#[test]
fn a_pair_has_one_size_and_something_to_count() {
    let [small, large] = [UVec2::new(3, 4), UVec2::new(4, 3)].map(|s| constant(s, Rgb::WHITE));
    let error = Pair::new(&small, &large).unwrap_err();
    assert_eq!(error.to_string(), "the sizes differ: 3x4 and 4x3 pixels");
    let bad = constant(small.size, Rgb::splat(f32::NAN));
    for (test, reference) in [(&bad, &small), (&small, &bad)] {
        let error = Pair::new(test, reference).unwrap_err();
        assert_eq!(error, PairError::NothingFinite);
    }
    let empty = constant(UVec2::new(0, 7), Rgb::WHITE);
    assert_eq!(
        Pair::new(&empty, &empty).unwrap_err(),
        PairError::NothingFinite
    );
}

#[test]
fn similarity_needs_a_window() {
    for (x, y, is_known) in [
        (10, 40, false),
        (40, 10, false),
        (11, 11, true),
        (1, 1, false),
    ] {
        let picture = blocks(UVec2::new(x, y));
        let pair = pair(&picture, &picture);
        assert_eq!(ssim(&pair), is_known.then_some(1.0), "{x}x{y}");
        assert_eq!(flip(&pair).mean(), 0.0);
    }
}

#[test]
fn the_worst_pixels_come_in_order() {
    let reference = constant(SIZE, Rgb::splat(1.0));
    let mut test = reference.clone();
    for (i, value) in [(3, 1.5), (50, 9.0), (32, 1.5), (7, 1.25)] {
        test.pixels[i] = Rgb::splat(value);
    }
    let pair = pair(&test, &reference);
    let places = |count| -> Vec<UVec2> {
        let worst = worst_pixels(&pair, count);
        worst.iter().map(|worst| worst.pixel).collect()
    };
    let all = [(19, 1), (3, 0), (1, 1), (7, 0)].map(|(x, y)| UVec2::new(x, y));
    assert_eq!(places(9), all);
    assert_eq!(places(2), all[..2]);
    assert_eq!(places(0), []);
    let WorstPixel {
        test,
        reference,
        relative_error,
        ..
    } = worst_pixels(&pair, 1)[0];
    assert_eq!((test, reference), (Rgb::splat(9.0), Rgb::splat(1.0)));
    assert_near(relative_error, (64.0f64 / 1.01).sqrt(), 1e-12);
}

#[test]
fn any_finite_picture_has_finite_figures() {
    let huge = constant(SIZE, Rgb::splat(f32::MAX));
    let tiny = constant(SIZE, Rgb::splat(f32::MIN_POSITIVE));
    let negative = constant(SIZE, Rgb::new(-1.0, -f32::MAX, 0.0));
    let black = constant(SIZE, Rgb::BLACK);
    let half = picture(SIZE, |x, _, _| if x < 16 { 0.0 } else { 30.0 });
    let pictures = [huge, tiny, negative, black, half];
    for (i, test) in pictures.iter().enumerate() {
        for (j, reference) in pictures.iter().enumerate() {
            let figures = Figures::of(&pair(test, reference));
            let Figures {
                rmse,
                relmse,
                mae,
                psnr,
                ssim,
                flip,
                hdr_flip,
                ..
            } = figures;
            for value in [rmse, relmse, mae, ssim.unwrap(), flip, hdr_flip] {
                assert!(value.is_finite(), "{i} {j}: {figures:?}");
            }
            assert!(!psnr.is_nan(), "{i} {j}: {figures:?}");
            for value in [flip, hdr_flip] {
                assert!((0.0..=1.0).contains(&value), "{i} {j}: {figures:?}");
            }
        }
    }
}

#[test]
fn figures_are_the_same_bits_for_any_number_of_threads() {
    let size = UVec2::new(67, 45);
    let reference = blocks(size);
    let test = picture(size, |x, y, c| ((x * 7 + y * 3 + c) % 11) as f32 / 10.0);
    let pair = pair(&test, &reference);
    let with = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads);
        pool.build().unwrap().install(|| Figures::of(&pair))
    };
    let one = with(1);
    for threads in [2, 7] {
        assert_eq!(with(threads), one, "{threads} threads");
    }
}
