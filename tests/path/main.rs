//! The path tracer and what it chooses its lights with: closed forms, densities, conservation.
#![allow(clippy::unwrap_used, clippy::expect_used)]

#[path = "../common/mod.rs"]
mod common;
#[path = "../common/project.rs"]
mod project;

mod environment;
mod formats;
mod light_tree;
mod terminator;
mod transport;
mod triangle;

use halfshade::math::{UVec2, Vec2};
use halfshade::sampling::{Pattern, Sampler, SamplingConfig};

/// Independent points of the unit square.
fn random(count: u32, seed: u64) -> impl Iterator<Item = Vec2> {
    let config = SamplingConfig {
        samples: count,
        pattern: Pattern::Random,
        seed,
        ..SamplingConfig::default()
    };
    (0..count).map(move |i| Sampler::new(&config, UVec2::ZERO, i).camera())
}
