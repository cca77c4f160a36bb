//! `halfshade bench`: how long things take.

mod bvh;
mod features;
mod growth;
mod report;
mod scaling;

use clap::{Args, Subcommand};

use super::Failure;

/// Measure the tracing core, or what a scene's features cost
#[derive(Args, Debug)]
#[command(after_help = "\
Examples:
  halfshade bench bvh bunny.obj
  halfshade bench features scenes/house.toml")]
pub struct BenchOptions {
    #[command(subcommand)]
    command: BenchCommand,
}

#[derive(Debug, Subcommand)]
enum BenchCommand {
    Bvh(bvh::BvhOptions),
    Features(features::FeatureOptions),
}

/// Does what the options say.
pub fn run(options: &BenchOptions) -> Result<(), Failure> {
    match &options.command {
        BenchCommand::Bvh(options) => bvh::run(options),
        BenchCommand::Features(options) => features::run(options),
    }
}
