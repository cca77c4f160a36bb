//! Sample points: patterns, targets, warps and keyed random numbers.
//!
//! Every number is a pure function of (seed, pixel, sample index, dimension); no state is
//! carried from one sample to the next.

mod pattern;
mod sampler;

pub use pattern::{Pattern, SamplingConfig, Target};
pub use sampler::Sampler;
