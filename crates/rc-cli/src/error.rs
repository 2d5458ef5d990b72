//! Errors that end a command early, with their exit codes.

use std::path::Path;

use clap::error::ErrorKind;
use rc_sweep::files::FileError;
use rc_sweep::memory::{Bound, MemoryError};
use thiserror::Error;

/// Exit code of an interrupted process, as shells use it.
pub(crate) const INTERRUPTED: u8 = 130;

/// Why a command failed.
///
/// Each message is one line that says what is wrong, where, and what would be right.
#[derive(Clone, Debug, PartialEq, Eq, Error)]
pub enum CliError {
    /// The input cannot be used, and nothing was computed or written. Exit code 2.
    #[error("{0}")]
    Input(String),
    /// The solver did not reach the tolerance. The results are written and marked. Exit code 3.
    #[error("{0}")]
    NotConverged(String),
    /// The command was interrupted. The results up to then are written and marked. Exit code 130.
    #[error("{0}")]
    Interrupted(String),
    /// A result could not be written. Exit code 4.
    #[error("{0}")]
    Write(String),
}

impl CliError {
    /// Exit code of the process.
    ///
    /// It is 2 for bad input, 3 for not converged, 4 for could not write, and 130 for interrupted.
    #[must_use]
    pub fn exit_code(&self) -> u8 {
        match self {
            Self::Input(_) => 2,
            Self::NotConverged(_) => 3,
            Self::Write(_) => 4,
            Self::Interrupted(_) => INTERRUPTED,
        }
    }

    /// The error of another rank, from its exit code and message.
    pub(crate) fn of_code(code: u8, message: String) -> Self {
        match code {
            3 => Self::NotConverged(message),
            4 => Self::Write(message),
            INTERRUPTED => Self::Interrupted(message),
            _ => Self::Input(message),
        }
    }

    /// The error for bad input.
    ///
    /// Messages of parsers may have line breaks, which become "; ".
    pub(crate) fn input(message: impl std::fmt::Display) -> Self {
        let message = message.to_string();
        let lines: Vec<&str> = message.lines().map(str::trim).filter(|line| !line.is_empty()).collect();
        Self::Input(lines.join("; "))
    }

    /// The error for bad input in a file.
    pub(crate) fn in_file(path: &Path, message: impl std::fmt::Display) -> Self {
        Self::input(format_args!("{}: {message}", path.display()))
    }

    /// The error for a file that could not be written.
    pub(crate) fn write(path: &Path, cause: impl std::fmt::Display) -> Self {
        Self::Write(format!("cannot write {}: {cause}", path.display()))
    }
}

impl From<rc_heights::ReadError> for CliError {
    fn from(error: rc_heights::ReadError) -> Self {
        Self::input(error)
    }
}

impl From<FileError> for CliError {
    fn from(error: FileError) -> Self {
        match error {
            FileError::Folder { .. } => Self::input(format_args!("out: {error}")),
            _ => Self::Write(error.to_string()),
        }
    }
}

impl From<MemoryError> for CliError {
    fn from(error: MemoryError) -> Self {
        let MemoryError { what, needed, available, bound, remedy } = error;
        match bound {
            Bound::Limit => Self::input(format_args!(
                "memory_limit: {what} needs about {needed}, more than the limit of {available}{remedy}"
            )),
            Bound::Machine => Self::input(format_args!(
                "grid: {what} needs about {needed} of memory, but this machine has {available}{remedy}"
            )),
        }
    }
}

/// The error for invalid arguments, without the usage that clap adds.
impl From<&clap::Error> for CliError {
    fn from(error: &clap::Error) -> Self {
        let text = error.to_string();
        let before_usage = text.split("\n\nUsage:").next().unwrap_or_default();
        let before_usage = before_usage.split("\n\nFor more information").next().unwrap_or_default();
        let message = in_words(before_usage.trim_start_matches("error: "));
        Self::input(match error.kind() {
            ErrorKind::MissingRequiredArgument => {
                let missing: Vec<&str> = message.lines().skip(1).map(str::trim).collect();
                let be = if missing.len() == 1 { "argument is" } else { "arguments are" };
                format!("required {be} missing: {}", missing.join(", "))
            }
            ErrorKind::InvalidSubcommand if !message.contains("tip: ") => {
                format!("{message}; rc --help lists the commands")
            }
            // A flag that does not exist is hardly meant as a value.
            ErrorKind::UnknownArgument if message.contains("to pass '") => {
                let first = message.lines().next().unwrap_or_default();
                format!("{first}; --help lists the flags")
            }
            _ => message,
        })
    }
}

/// The message with the standard library's words on numbers replaced by what would be right.
fn in_words(message: &str) -> String {
    const WORDS: [(&str, &str); 5] = [
        ("invalid digit found in string", "must be a whole number, not negative"),
        ("cannot parse integer from empty string", "must be a whole number"),
        ("number too large to fit in target type", "the number is too large"),
        ("invalid float literal", "must be a number, such as 4.5e5"),
        ("cannot parse float from empty string", "must be a number, such as 4.5e5"),
    ];
    WORDS.iter().fold(message.to_owned(), |text, (said, meant)| text.replace(said, meant))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_message_of_several_lines_becomes_one() {
        let error = CliError::input("expected a number\n\n  at line 3\n");
        assert_eq!(error.to_string(), "expected a number; at line 3");
        assert_eq!(error.exit_code(), 2);
    }
}
