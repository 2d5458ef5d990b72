//! Ctrl-C and a job system's signal to end a sweep.
//!
//! The finished rows are written into the table, then the process ends.

use rc_sweep::Kept;

use super::bar::RowBar;
use crate::error::{CliError, INTERRUPTED};
use crate::terminal;

/// Makes an interrupt run `end`, which ends the process.
pub(super) fn install(end: impl Fn() + Send + 'static) {
    // Without a handler an interrupt ends the process at once, and no row is lost either.
    let _ = ctrlc::set_handler(end);
}

/// Writes the table of the finished rows and ends the process.
///
/// `n_rows` is the number of all rows, if it is known. `kept` is locked until the end, so that no row is stored which
/// is not in the table.
pub(super) fn end(kept: &Kept<'_>, n_rows: Option<usize>, bar: &RowBar) {
    bar.clear();
    let of_all = n_rows.map_or_else(String::new, |n_rows| format!(" of {n_rows}"));
    let rows = format!("interrupted: {}{of_all} rows", kept.rows().len());
    terminal::tell(&match kept.write_table().map_err(CliError::from) {
        Ok(path) => format!("{rows} are in {}; --resume goes on", path.display()),
        Err(error) => format!("{rows} are kept, --resume goes on; {error}"),
    });
    std::process::exit(INTERRUPTED.into());
}
