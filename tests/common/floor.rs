//! The matte floor of the numerical cases, for tests.
#![allow(unused_imports)] // each test file uses its own part of it

pub use halfshade::stress::closed_form::*;
pub use halfshade::stress::floor::*;

/// Fails where `got` is off by more than the share `relative` of what is expected.
pub fn assert_close(got: f32, expected: f32, relative: f32, what: &str) {
    let error = (got - expected).abs() / expected.abs();
    assert!(
        error <= relative,
        "{what}: {got} instead of {expected}, off by {error}"
    );
}
