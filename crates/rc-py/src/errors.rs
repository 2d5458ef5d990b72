//! Errors of the command line as exceptions of Python.
//!
//! The sentences are the same, with keywords and types of Python in place of flags and types of Rust.

use pyo3::PyErr;
use pyo3::exceptions::{PyOSError, PyRuntimeError, PyValueError};
use rc_cli::error::CliError;

/// The exception for an error of the command line.
///
/// Bad input is a `ValueError`, and a file that could not be written an `OSError`.
pub(crate) fn raised(error: CliError) -> PyErr {
    match error {
        CliError::Input(message) => PyValueError::new_err(in_keywords(&message)),
        CliError::Write(message) => PyOSError::new_err(in_keywords(&message)),
        other => PyRuntimeError::new_err(other.to_string()),
    }
}

/// The exception for bad input.
pub(crate) fn bad_input(message: impl std::fmt::Display) -> PyErr {
    PyValueError::new_err(in_keywords(&message.to_string()))
}

/// The exception for points that are no map. Advice about files is of no use to them.
pub(crate) fn raised_by_points(error: &rc_heights::FormatError) -> PyErr {
    let message = error.to_string();
    bad_input(message.split_once("; layout = ").map_or(message.as_str(), |(said, _)| said))
}

/// The exception for a key with a wrong value.
///
/// The value has the wrong type, or is not among the allowed ones.
pub(crate) fn wrong_value(error: CliError) -> PyErr {
    match error {
        CliError::Input(message) => bad_input(in_words(&message)),
        other => raised(other),
    }
}

/// Phrases of the command line about its flags, and their replacements in Python.
const SAID_OF_FLAGS: [(&str, &str); 7] = [
    ("rc surface --fill laplace fills", "roughcontact.prepare(heights, fill=\"laplace\") fills"),
    ("give --heights FILE or --spectrum FILE", "give heights or spectrum"),
    ("give --heights FILE", "give heights"),
    ("the --out folder", "the folder"),
    ("--method uniform", "method=\"uniform\""),
    ("--layout matrix", "layout=\"matrix\""),
    ("--resume", "resume=True"),
];

/// The message with keywords in place of flags.
fn in_keywords(message: &str) -> String {
    let message = SAID_OF_FLAGS.iter().fold(message.to_owned(), |text, (said, here)| text.replace(said, here));
    let mut parts = message.split("--");
    let mut text = parts.next().unwrap_or_default().to_owned();
    for part in parts {
        let end = part.find(|c: char| !(c.is_ascii_lowercase() || c == '-')).unwrap_or(part.len());
        let (flag, rest) = part.split_at(end);
        text.push_str(&flag.replace('-', "_"));
        text.push_str(rest);
    }
    text
}

/// The message of a wrong value in the words of Python.
fn in_words(message: &str) -> String {
    const WORDS: [(&str, &str); 3] = [
        ("must be a number without quotes,", "must be a number,"),
        ("must be text in quotes,", "must be text,"),
        ("must be true or false,", "must be True or False,"),
    ];
    let text = WORDS.iter().fold(message.to_owned(), |text, (said, here)| text.replace(said, here));
    for (said, here) in [(", not true", ", not True"), (", not false", ", not False")] {
        if let Some(start) = text.strip_suffix(said) {
            return format!("{start}{here}");
        }
    }
    text
}
