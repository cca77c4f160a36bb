//! The command line: one file a command.
//!
//! Results go to standard output, everything else to standard error. Exit status: 0 done, 1 the
//! job failed, 2 the arguments are wrong.

mod arguments;
#[cfg(feature = "report")]
mod bench;
#[cfg(feature = "report")]
mod compare;
#[cfg(feature = "report")]
mod comparison;
mod console;
#[cfg(feature = "report")]
mod converge;
#[cfg(feature = "report")]
mod curve_tables;
#[cfg(feature = "report")]
mod difference;
#[cfg(feature = "gltf")]
mod extensions;
mod failure;
mod info;
mod interrupt;
mod layers;
mod left_out;
mod limits;
mod load;
#[cfg(feature = "report")]
mod machine;
mod measure;
mod memory;
mod metadata;
mod names;
mod options;
mod process;
mod progress;
mod render;
mod stats;
#[cfg(feature = "report")]
mod stress;
#[cfg(feature = "report")]
mod table;
mod targets;
#[cfg(feature = "report")]
mod threshold;

use clap::{Parser, Subcommand};

pub use failure::Failure;

/// Renders glTF and OBJ models with soft shadows, on the processor.
#[derive(Debug, Parser)]
#[command(
    name = "halfshade",
    version,
    arg_required_else_help = true,
    after_help = "Example:\n  halfshade render scenes/house.toml     makes house.png\n\n\
        Exit status: 0 done, 1 the job failed, 2 the arguments are wrong."
)]
pub struct Arguments {
    #[command(subcommand)]
    command: Command,
}

#[derive(Debug, Subcommand)]
enum Command {
    Render(Box<options::RenderOptions>),
    Info(info::InfoOptions),
    #[cfg(feature = "report")]
    Compare(compare::CompareOptions),
    #[cfg(feature = "report")]
    Converge(Box<converge::ConvergeOptions>),
    #[cfg(feature = "report")]
    Bench(bench::BenchOptions),
    #[cfg(feature = "report")]
    Stress(stress::StressOptions),
}

/// Does what the arguments say.
pub fn run(arguments: &Arguments) -> Result<(), Failure> {
    match &arguments.command {
        Command::Render(arguments) => render::run(arguments),
        Command::Info(arguments) => info::run(arguments),
        #[cfg(feature = "report")]
        Command::Compare(arguments) => compare::run(arguments),
        #[cfg(feature = "report")]
        Command::Converge(arguments) => converge::run(arguments),
        #[cfg(feature = "report")]
        Command::Bench(arguments) => bench::run(arguments),
        #[cfg(feature = "report")]
        Command::Stress(arguments) => stress::run(arguments),
    }
}
