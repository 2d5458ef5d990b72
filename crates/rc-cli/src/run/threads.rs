//! The worker threads of the process.

use crate::error::CliError;

/// Checks the number of worker threads and starts them.
///
/// By default the number is that of all cores, or of the threads that this process already has.
///
/// # Errors
/// [`CliError::Input`] for a number out of range, or one that differs from the threads that this process already has.
pub(crate) fn start(threads: Option<usize>) -> Result<usize, CliError> {
    // Without a number, the threads are started at their first use.
    if let Some(n) = checked(threads)? {
        match rayon::ThreadPoolBuilder::new().num_threads(n).build_global() {
            Err(_) if rayon::current_num_threads() == n => {}
            started => started.map_err(|cause| CliError::input(format_args!("threads: {cause}")))?,
        }
    }
    Ok(rayon::current_num_threads())
}

/// The number of worker threads, if it is in the allowed range.
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
