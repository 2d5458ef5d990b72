//! Standard output and standard error.

use std::io::{self, Write as _};
use std::path::Path;

use crate::error::CliError;

/// Prints the names of the files that a command has written, one per line.
///
/// `folder` is their folder.
///
/// # Errors
/// [`CliError::Write`].
pub(crate) fn print_names(folder: &Path, names: &[String]) -> Result<(), CliError> {
    print(&names.iter().fold(String::new(), |text, name| text + &format!("{}\n", folder.join(name).display())))
}

/// Prints `text` to standard output.
///
/// A reader that has closed the pipe is not an error, since it has what it wanted.
///
/// # Errors
/// [`CliError::Write`] for any other failure.
pub(crate) fn print(text: &str) -> Result<(), CliError> {
    let mut stdout = io::stdout().lock();
    match stdout.write_all(text.as_bytes()).and_then(|()| stdout.flush()) {
        Err(cause) if cause.kind() != io::ErrorKind::BrokenPipe => {
            Err(CliError::Write(format!("cannot write to standard output: {cause}")))
        }
        _ => Ok(()),
    }
}

/// Prints a line for the user on standard error, if that is open.
pub(crate) fn tell(text: &str) {
    // If standard error is closed, there is no place to report it.
    let _ = writeln!(io::stderr().lock(), "{text}");
}
