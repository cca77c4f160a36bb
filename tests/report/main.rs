//! How far two pictures are apart: closed forms, other programs' figures, files, pages.

#![allow(clippy::unwrap_used, clippy::expect_used)]

mod closed_form;
mod files;
mod pages;
mod peers;

use halfshade::color::Rgb;
use halfshade::math::UVec2;
use halfshade::report::Picture;
use halfshade::report::metrics::Pair;

fn constant(size: UVec2, color: Rgb) -> Picture {
    Picture::from_fn(size, |_, _| color)
}

fn pair(test: &Picture, reference: &Picture) -> Pair {
    Pair::new(test, reference).unwrap()
}

/// The picture whose channel `c` at column `x` and row `y` is `value(x, y, c)`.
fn picture(size: UVec2, value: impl Fn(u32, u32, u32) -> f32) -> Picture {
    Picture::from_fn(size, |x, y| [0, 1, 2].map(|c| value(x, y, c)).into())
}

#[track_caller]
fn assert_near(got: f64, expected: f64, tolerance: f64) {
    assert!(
        (got - expected).abs() <= tolerance,
        "{got} instead of {expected}"
    );
}
