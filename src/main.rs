//! The program: parses the arguments, runs one command, turns errors into text and exit statuses.

mod cli;

use std::process::ExitCode;

use clap::Parser;

fn main() -> ExitCode {
    let result = cli::Arguments::try_parse()
        .map_err(cli::Failure::Usage)
        .and_then(|arguments| cli::run(&arguments));
    match result {
        Ok(()) => ExitCode::SUCCESS,
        Err(failure) => failure.report(),
    }
}
