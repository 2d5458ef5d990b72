//! `rc sweep merge`: the shards of a sweep merged into one sweep.

use rc_core::quantity::count;

use super::args::MergeArgs;
use super::messages;
use crate::error::CliError;
use crate::files::kind::Kind;
use crate::terminal;

/// Runs `rc sweep merge`.
///
/// # Errors
/// [`CliError::Input`] when the folders are not all shards of one sweep, complete; [`CliError::Write`];
/// [`CliError::NotConverged`] as for the whole sweep.
pub(super) fn run(args: &MergeArgs) -> Result<(), CliError> {
    Kind::Sweep.check_out(&args.out)?;
    let merged = rc_sweep::merge(&args.folders, &args.out)?;
    if !args.quiet {
        let (rows, shards) = (count(merged.rows.len(), "row"), count(args.folders.len(), "shard"));
        terminal::print(&format!("{rows} of {shards}\n\nwritten to {}\n", merged.table.display()))?;
    }
    messages::check_converged(&merged.rows, &merged.table)
}
