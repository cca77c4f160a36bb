//! What is said to the person at the terminal, on standard error.

use std::fmt::Display;
use std::io::{self, IsTerminal, Write};

use clap::Args;
use halfshade::import::Warnings;

use super::Failure;

/// How much is said.
#[derive(Args, Clone, Copy, Debug, Default)]
pub struct Console {
    /// Say nothing but errors
    #[arg(short, long, conflicts_with = "verbose", help_heading = "Messages")]
    quiet: bool,
    /// Say more: threads, rays, memory
    #[arg(short, long, help_heading = "Messages")]
    verbose: bool,
}

impl Console {
    /// Says something that most people want to know.
    pub fn say(self, message: impl Display) {
        if !self.quiet {
            // There is nobody to tell that standard error is closed.
            let _ = writeln!(io::stderr(), "{message}");
        }
    }

    /// Says something that some people want to know.
    pub fn detail(self, message: impl Display) {
        if self.verbose {
            self.say(message);
        }
    }

    /// Says what an author should know.
    pub fn warn(self, message: impl Display) {
        self.say(format_args!("warning: {message}"));
    }

    /// Says each warning once, with its count where it is not 1.
    pub fn warn_all(self, warnings: &Warnings) {
        for warning in warnings.iter() {
            match warning.count {
                1 => self.warn(warning.message),
                count => self.warn(format_args!("{} ({count} times)", warning.message)),
            }
        }
    }

    /// Whether progress bars are wanted and somebody can see them.
    pub fn shows_progress(self) -> bool {
        !self.quiet && io::stderr().is_terminal()
    }
}

/// Prints a result to standard output.
pub fn print(text: impl Display) -> Result<(), Failure> {
    let mut stdout = io::stdout().lock();
    writeln!(stdout, "{text}")
        .and_then(|()| stdout.flush())
        .map_err(Failure::from_stdout)
}
