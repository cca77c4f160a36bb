//! The scene builders of the numerical cases, for tests.

pub use halfshade::stress::scenes::*;
