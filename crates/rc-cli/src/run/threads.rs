//! The worker threads of the process.

use crate::error::CliError;

/// Checks the number of worker threads and starts them. When it is not given, they are all cores, or as many as this process
/// has already.
///
/// # Errors
/// [`CliError::Input`]: a number out of range, or another one than this process has already.
pub(crate) fn start(threads: Option<usize>) -> Result<usize, CliError> {
    const MAX: usize = 1024;
    let builder = rayon::ThreadPoolBuilder::new();
    match threads {
        // Started on first use.
        None => {}
        Some(n @ 1..=MAX) => match builder.num_threads(n).build_global() {
            Err(_) if rayon::current_num_threads() == n => {}
            started => started.map_err(|cause| CliError::input(format_args!("threads: {cause}")))?,
        },
        Some(n) => return Err(CliError::input(format_args!("threads: must be from 1 to {MAX}, not {n}"))),
    }
    Ok(rayon::current_num_threads())
}
