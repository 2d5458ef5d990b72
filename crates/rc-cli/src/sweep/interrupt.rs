//! Ctrl-C and a job system's signal to end a sweep.
//!
//! The finished rows are written into the table, then the process ends.

use std::path::PathBuf;

use rc_core::quantity::count;
use rc_sweep::{Kept, SweepRows};

use super::bar::RowBar;
use crate::error::{CliError, INTERRUPTED};
use crate::terminal;

/// Writes files of the finished rows, and returns the path of their table.
pub(crate) type WriteRows = dyn Fn(&SweepRows) -> Result<PathBuf, CliError> + Send + Sync;

/// Makes an interrupt run `end`, which ends the process.
pub(super) fn install(end: impl Fn() + Send + 'static) {
    // Without a handler an interrupt ends the process at once, and no row is lost either.
    let _ = ctrlc::set_handler(end);
}

/// Writes the table of the finished rows and ends the process.
///
/// `n_rows` is the number of all rows, if it is known. `write` writes what is told of instead of the table. `kept` is locked until the end, so that no row is stored which
/// is not in the table.
pub(super) fn end(kept: &Kept<'_>, n_rows: Option<usize>, bar: &RowBar, write: Option<&WriteRows>) {
    bar.clear();
    let finished = kept.rows().len();
    let rows = n_rows.map_or_else(|| count(finished, "row"), |all| format!("{finished} of {}", count(all, "row")));
    let table = kept.write_table().map_err(CliError::from);
    let written = write.filter(|_| finished > 0).map_or(Ok(None), |write| write(kept.rows()).map(Some));
    terminal::tell(&match table.and_then(|table| Ok(written?.unwrap_or(table))) {
        Ok(path) => format!("interrupted with {rows} in {}; --resume continues", path.display()),
        Err(error) => format!("interrupted with {rows} kept; --resume continues; {error}"),
    });
    std::process::exit(INTERRUPTED.into());
}
