//! What is said to the person at the terminal, on standard error.

use std::fmt::{self, Display};
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
            let _ = writeln!(io::stderr(), "{}", printable(message));
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

/// The text with every control character but the end of a line escaped: names come from files,
/// and a terminal obeys what it is shown.
pub fn printable(text: impl Display) -> String {
    let text = text.to_string();
    let mut printable = String::with_capacity(text.len());
    for c in text.chars() {
        match c {
            c if c.is_control() && c != '\n' => printable.extend(c.escape_debug()),
            c => printable.push(c),
        }
    }
    printable
}

/// A number of bytes as people read it.
pub struct Bytes(pub u64);

impl Display for Bytes {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        const MIB: f64 = (1 << 20) as f64;
        match self.0 {
            bytes @ ..10_000 => write!(f, "{bytes} bytes"),
            bytes @ ..0x4000_0000 => write!(f, "{:.1} MiB", bytes as f64 / MIB),
            bytes => write!(f, "{:.1} GiB", bytes as f64 / MIB / 1024.0),
        }
    }
}

/// Prints a result to standard output.
pub fn print(text: impl Display) -> Result<(), Failure> {
    let mut stdout = io::stdout().lock();
    writeln!(stdout, "{text}")
        .and_then(|()| stdout.flush())
        .map_err(Failure::from_stdout)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn control_characters_are_escaped() {
        assert_eq!(
            printable("a\u{1b}[2Jb\u{9b}31m\n\"é\"\\ \r"),
            "a\\u{1b}[2Jb\\u{9b}31m\n\"é\"\\ \\r"
        );
    }

    #[test]
    fn bytes_have_a_fitting_unit() {
        let shown = [9_999, 10 << 20, 3 << 29].map(|bytes| Bytes(bytes).to_string());
        assert_eq!(shown, ["9999 bytes", "10.0 MiB", "1.5 GiB"]);
    }
}
