//! Figures of pictures made by a formula against those of other programs: flip-evaluator 1.7 (the
//! FLIP authors' own) on linear values, and scikit-image 0.26 on sRGB-encoded double precision,
//! with 11 × 11 Gaussian windows of σ = 1.5 and no sample covariance.

use halfshade::math::UVec2;
use halfshade::report::Picture;
use halfshade::report::metrics::{flip, hdr_flip, psnr, ssim};

use super::{assert_near, constant, pair, picture};

const SIZE: UVec2 = UVec2::new(64, 48);

fn blocks(x: u32, y: u32, c: u32) -> f32 {
    ((x / 8 + y / 6 + c) % 3) as f32 / 2.0
}

fn noisy(x: u32, y: u32, c: u32) -> f32 {
    let noise = ((x * 31 + y * 17 + c * 7) % 13) as f32 - 6.0;
    (blocks(x, y, c) + noise / 64.0).clamp(0.0, 1.0)
}

fn stripes(x: u32, y: u32, c: u32) -> f32 {
    ((x * (c + 2) + y * (5 - c)) % 29) as f32 / 28.0
}

/// From 1/32 to 16.
fn steps(x: u32, y: u32, c: u32) -> f32 {
    (x as f32 / 8.0).floor().exp2() / 8.0 * (1 + (y + c) % 4) as f32 / 4.0
}

fn noisy_steps(x: u32, y: u32, c: u32) -> f32 {
    let noise = ((x * 5 + y * 3 + c) % 7) as f32 - 3.0;
    steps(x, y, c) * (1.0 + noise / 16.0)
}

struct Case {
    test: fn(u32, u32, u32) -> f32,
    reference: fn(u32, u32, u32) -> f32,
    flip: f64,
    /// FLIP at column 20, row 10.
    flip_at: f64,
    hdr_flip: f64,
    psnr: f64,
    ssim: f64,
}

const CASES: [Case; 4] = [
    Case {
        test: noisy,
        reference: blocks,
        flip: 0.122_724_83,
        flip_at: 0.084_211_53,
        hdr_flip: 0.268_061_85,
        psnr: 19.642_925_100_15,
        ssim: 0.929_661_785_497,
    },
    Case {
        test: |x, y, c| blocks(x + 1, y, c),
        reference: blocks,
        flip: 0.349_963_64,
        flip_at: 0.194_701_63,
        hdr_flip: 0.351_070_20,
        psnr: 11.731_734_442_07,
        ssim: 0.700_682_632_117,
    },
    Case {
        test: stripes,
        reference: blocks,
        flip: 0.835_007_01,
        flip_at: 0.611_041_6,
        hdr_flip: 0.851_707_52,
        psnr: 5.978_536_027_22,
        ssim: 0.007_216_171_736,
    },
    Case {
        test: noisy_steps,
        reference: steps,
        flip: 0.038_179_38,
        flip_at: 0.036_030_5,
        hdr_flip: 0.035_122_71,
        psnr: 31.966_823_302_56,
        ssim: 0.950_016_822_695,
    },
];

#[test]
fn flip_is_that_of_its_authors() {
    for (i, case) in CASES.iter().enumerate() {
        let pair = pair(&picture(SIZE, case.test), &picture(SIZE, case.reference));
        let map = flip(&pair);
        let at = map.values[10 * 64 + 20].map(f64::from);
        for (what, got, expected) in [
            ("flip", map.mean(), case.flip),
            ("flip of a pixel", at.unwrap(), case.flip_at),
            ("hdr_flip", hdr_flip(&pair).mean(), case.hdr_flip),
        ] {
            let error = (got - expected).abs();
            assert!(error < 2e-5, "case {i}, {what}: {got}, not {expected}");
        }
    }
}

#[test]
fn flip_of_plain_colours_is_that_of_its_authors() {
    let of = |color: [f32; 3]| -> Picture { constant(UVec2::new(32, 24), color.into()) };
    for (test, reference, expected) in [
        ([0.0, 0.0, 0.0], [1.0, 1.0, 1.0], 0.967_391_07),
        ([0.5, 0.1, 0.1], [0.1, 0.5, 0.1], 0.958_064_56),
        ([0.5, 0.5, 0.5], [0.52, 0.5, 0.5], 0.065_405_64),
    ] {
        let mean = flip(&pair(&of(test), &of(reference))).mean();
        assert_near(mean, expected, 1e-5);
    }
}

#[test]
fn signal_and_similarity_are_those_of_scikit_image() {
    for case in &CASES {
        let pair = pair(&picture(SIZE, case.test), &picture(SIZE, case.reference));
        assert_near(psnr(&pair), case.psnr, 2e-6);
        assert_near(ssim(&pair).unwrap(), case.ssim, 2e-6);
    }
}
