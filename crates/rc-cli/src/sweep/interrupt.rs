//! Ctrl-C and a job system's signal to end: what is done is put into the table, then the process ends.

use std::sync::Arc;

use rc_sweep::Sweep;

use super::bar::RowBar;
use crate::error::{CliError, INTERRUPTED};
use crate::terminal;

/// From now on an interrupt writes the table of the rows so far and ends the process.
pub(super) fn install(sweep: Arc<Sweep>, bar: RowBar) {
    let handler = move || {
        // Held until the end, so that no row is kept which the table does not have.
        let kept = sweep.kept();
        bar.clear();
        let (n_kept, n_rows) = (kept.rows().len(), sweep.n_rows());
        terminal::tell(&match kept.write_table().map_err(CliError::from) {
            Ok(path) => format!("interrupted: {n_kept} of {n_rows} rows are in {}; --resume goes on", path.display()),
            Err(error) => format!("interrupted: {n_kept} of {n_rows} rows are kept, --resume goes on; {error}"),
        });
        std::process::exit(INTERRUPTED.into());
    };
    // Without a handler an interrupt ends the process at once, which loses no row either.
    let _ = ctrlc::set_handler(handler);
}
