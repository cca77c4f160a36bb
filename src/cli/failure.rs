//! Errors, as the person at the terminal sees them.

use std::fmt::{self, Display};
use std::fs;
use std::io::{self, IsTerminal, Write};
use std::process::ExitCode;

use clap::CommandFactory;
use clap::error::ErrorKind;
use halfshade::import::ImportError;
use halfshade::output::OutputError;
use miette::{Diagnostic, GraphicalReportHandler, GraphicalTheme, NamedSource, SourceSpan};
use rayon::ThreadPoolBuildError;
use thiserror::Error;

use super::Arguments;
use super::console::printable;

/// Why the program ends without having done what it was asked for.
#[derive(Debug)]
pub enum Failure {
    /// The arguments are wrong, or ask for help: exit status 2, or 0 for help.
    Usage(clap::Error),
    /// The job failed: exit status 1.
    Job(Box<JobError>),
    /// The job was ended by the user, who was told so: exit status 1.
    Interrupted,
    /// Whoever reads our output has seen enough: exit status 0, in silence.
    ClosedPipe,
}

/// Why a job failed.
#[derive(Debug, Error, Diagnostic)]
#[error("{message}")]
pub struct JobError {
    message: String,
    #[help]
    help: Option<String>,
    /// The text file that is wrong, to show the place in it.
    #[source_code]
    source_text: Option<NamedSource<String>>,
    #[label]
    place: Option<SourceSpan>,
}

impl Failure {
    /// Wrong arguments to the subcommand of this name, such as `render` or `bench bvh`.
    pub fn usage(subcommand: &str, message: impl Display) -> Self {
        let mut program = Arguments::command();
        program.build();
        let mut command = subcommand.split(' ').fold(program, |command, name| {
            command.find_subcommand(name).cloned().unwrap_or(command)
        });
        Self::Usage(command.error(ErrorKind::ValueValidation, printable(message)))
    }

    /// A job that failed for this reason.
    pub fn job(message: impl Display) -> Self {
        Self::Job(Box::new(JobError {
            message: message.to_string(),
            help: None,
            source_text: None,
            place: None,
        }))
    }

    /// An error of standard output.
    pub fn from_stdout(error: io::Error) -> Self {
        if error.kind() == io::ErrorKind::BrokenPipe {
            Self::ClosedPipe
        } else {
            Self::job(format_args!("standard output: {error}"))
        }
    }

    /// Says it, and gives the exit status.
    pub fn report(&self) -> ExitCode {
        match self {
            Self::Usage(error) => {
                // Fails where nobody listens.
                let _ = error.print();
                ExitCode::from(error.exit_code() as u8)
            }
            Self::Job(error) => {
                let _ = write!(io::stderr(), "{}", Shown(error));
                ExitCode::FAILURE
            }
            Self::Interrupted => ExitCode::FAILURE,
            Self::ClosedPipe => ExitCode::SUCCESS,
        }
    }
}

impl Failure {
    /// A scene that could not be imported for the subcommand of this name.
    pub fn of_import(subcommand: &str, error: &ImportError) -> Self {
        if error.is_argument() {
            return Self::usage(subcommand, error);
        }
        let is_folder = error.path.is_dir();
        let help = "a scene is a file: .toml, .gltf, .glb or .obj";
        let (source_text, place) = source_line(error).unzip();
        Self::Job(Box::new(JobError {
            message: error.to_string(),
            help: is_folder.then(|| help.to_owned()),
            source_text,
            place,
        }))
    }
}

/// The text of a small file in which a line is wrong, and where the line is in it; `None` where
/// that line, or one beside it, which is shown as well, is too long for a terminal.
fn source_line(error: &ImportError) -> Option<(NamedSource<String>, SourceSpan)> {
    const LARGEST: u64 = 1 << 20;
    const LONGEST_LINE: usize = 200;
    let number: usize = error.place.as_ref()?.strip_prefix("line ")?.parse().ok()?;
    if fs::metadata(&error.path).ok()?.len() > LARGEST {
        return None;
    }
    let text = fs::read_to_string(&error.path).ok()?;
    let mut shown = text.lines().skip(number.saturating_sub(2)).take(3);
    if shown.any(|line| line.len() > LONGEST_LINE) {
        return None;
    }
    let before: usize = text
        .split_inclusive('\n')
        .take(number.checked_sub(1)?)
        .map(str::len)
        .sum();
    let line = text.get(before..)?.lines().next()?;
    let indent = line.len() - line.trim_start().len();
    let span = (before + indent, line.trim().len());
    let name = error.path.display().to_string();
    Some((NamedSource::new(name, text), span.into()))
}

impl From<ThreadPoolBuildError> for Failure {
    fn from(error: ThreadPoolBuildError) -> Self {
        Self::job(format_args!("threads could not be started: {error}"))
    }
}

impl From<OutputError> for Failure {
    fn from(error: OutputError) -> Self {
        Self::job(error)
    }
}

/// A job's error as miette lays it out, in one paragraph.
struct Shown<'a>(&'a JobError);

impl Display for Shown<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let mut theme = if io::stderr().is_terminal() {
            GraphicalTheme::unicode_nocolor()
        } else {
            GraphicalTheme::none()
        };
        theme.characters.error = "error:".to_owned();
        let handler = GraphicalReportHandler::new_themed(theme)
            .without_cause_chain()
            .with_wrap_lines(false);
        let mut text = String::new();
        handler.render_report(&mut text, self.0)?;
        let text = printable(text);
        for line in text.lines().map(str::trim_end).filter(|l| !l.is_empty()) {
            writeln!(f, "{}", line.strip_prefix("  ").unwrap_or(line))?;
        }
        Ok(())
    }
}
