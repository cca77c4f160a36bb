//! The command line: one file a command.
//!
//! Results go to standard output, everything else to standard error. Exit status: 0 done, 1 the
//! job failed, 2 the arguments are wrong.

mod arguments;
mod bench;
mod compare;
mod comparison;
mod console;
mod converge;
mod curve_tables;
mod difference;
mod failure;
mod info;
mod interrupt;
mod layers;
mod left_out;
mod limits;
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
mod stress;
mod table;
mod targets;
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
    Compare(compare::CompareOptions),
    Converge(Box<converge::ConvergeOptions>),
    Bench(bench::BenchOptions),
    Stress(stress::StressOptions),
}

/// Does what the arguments say.
pub fn run(arguments: &Arguments) -> Result<(), Failure> {
    match &arguments.command {
        Command::Render(arguments) => render::run(arguments),
        Command::Info(arguments) => info::run(arguments),
        Command::Compare(arguments) => compare::run(arguments),
        Command::Converge(arguments) => converge::run(arguments),
        Command::Bench(arguments) => bench::run(arguments),
        Command::Stress(arguments) => stress::run(arguments),
    }
}
