//! Errors of the command line as exceptions: the same sentences.

use pyo3::PyErr;
use pyo3::exceptions::{PyOSError, PyRuntimeError, PyValueError};
use rc_cli::error::CliError;

/// Bad input is a `ValueError`, a file that could not be written an `OSError`.
pub(crate) fn raised(error: CliError) -> PyErr {
    match error {
        CliError::Input(message) => PyValueError::new_err(message),
        CliError::Write(message) => PyOSError::new_err(message),
        other => PyRuntimeError::new_err(other.to_string()),
    }
}

/// Bad input.
pub(crate) fn bad_input(message: impl std::fmt::Display) -> PyErr {
    PyValueError::new_err(message.to_string())
}
