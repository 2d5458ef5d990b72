//! The worker threads of the process.

use crate::error::CliError;

/// Checks the number of worker threads and starts them. When it is not given, they are all cores, or as many as this
/// process has already.
///
/// # Errors
/// [`CliError::Input`]: a number out of range, or another one than this process has already.
pub(crate) fn start(threads: Option<usize>) -> Result<usize, CliError> {
    // All cores are started on first use.
    if let Some(n) = checked(threads)? {
        match rayon::ThreadPoolBuilder::new().num_threads(n).build_global() {
            Err(_) if rayon::current_num_threads() == n => {}
            started => started.map_err(|cause| CliError::input(format_args!("threads: {cause}")))?,
        }
    }
    Ok(rayon::current_num_threads())
}

/// A number of worker threads that there can be.
///
/// # Errors
/// [`CliError::Input`] for a number out of range.
pub fn checked(threads: Option<usize>) -> Result<Option<usize>, CliError> {
    const MAX: usize = 1024;
    match threads {
        Some(n) if !(1..=MAX).contains(&n) => {
            Err(CliError::input(format_args!("threads: must be from 1 to {MAX}, not {n}")))
        }
        _ => Ok(threads),
    }
}
