//! `rc sweep merge`: the shards of a sweep merged into one sweep.

use super::args::MergeArgs;
use super::messages;
use crate::error::CliError;
use crate::terminal;

/// Runs `rc sweep merge`.
///
/// # Errors
/// [`CliError::Input`] when the folders are not all shards of one sweep, complete; [`CliError::Write`];
/// [`CliError::NotConverged`] as for the whole sweep.
pub(super) fn run(args: &MergeArgs) -> Result<(), CliError> {
    let merged = rc_sweep::merge(&args.folders, &args.out)?;
    if !args.quiet {
        let (n_rows, n_shards) = (merged.rows.len(), args.folders.len());
        let table = merged.table.display();
        terminal::print(&format!("{n_rows} rows of {n_shards} shards\n\nwritten to {table}\n"))?;
    }
    messages::check_converged(&merged.rows, &merged.table)
}
