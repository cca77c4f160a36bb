//! Sample points: patterns, targets, warps and keyed random numbers.
//!
//! Every number is a pure function of (seed, pixel, sample index, dimension); no state is
//! carried from one sample to the next.

mod cells;
mod key;
mod pattern;
mod row;
mod sampler;
mod sobol;
mod warp;

pub use key::mix;
pub use pattern::{Pattern, SamplingConfig, Target};
pub use row::SamplerRow;
pub use sampler::{Sampler, Samplers};
pub use warp::{square_to_cone, square_to_disk, square_to_hemisphere};
