//! Standard output and standard error.

use std::io::{self, Write as _};
use std::path::Path;

use crate::error::CliError;

/// Prints the files that a command has written into `folder`, a line each.
///
/// # Errors
/// [`CliError::Write`].
pub(crate) fn print_names(folder: &Path, names: &[String]) -> Result<(), CliError> {
    print(&names.iter().fold(String::new(), |text, name| text + &format!("{}\n", folder.join(name).display())))
}

/// Prints `text` to standard output. A reader that has closed the pipe has what it wanted.
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

/// Tells the user something on standard error, as far as it listens.
pub(crate) fn tell(text: &str) {
    // There is nowhere left to report that standard error is closed.
    let _ = writeln!(io::stderr().lock(), "{text}");
}
