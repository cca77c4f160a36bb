//! The scene builders of the numerical cases, for tests.
#![allow(unused_imports)] // each test file uses its own part of it

pub use halfshade::stress::scenes::*;
