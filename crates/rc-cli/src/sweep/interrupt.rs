//! Ctrl-C and a job system's signal to end: what is done is put into the table, then the process ends.

use std::path::PathBuf;
use std::sync::{Arc, Mutex};

use super::bar::RowBar;
use super::journal::Journal;
use super::table;
use super::workers::locked;
use crate::output;
use crate::stop::INTERRUPTED;

/// From now on an interrupt writes the table of the rows so far and ends the process.
pub(super) fn install(folder: PathBuf, journal: Arc<Mutex<Journal>>, bar: RowBar, n_rows: usize) {
    let handler = move || {
        // Held until the end, so that no row is kept which the table does not have.
        let journal = locked(&journal);
        bar.clear();
        let written = table::write(&folder, &journal.rows);
        let kept = journal.rows.len();
        output::tell(&match written {
            Ok(path) => format!("interrupted: {kept} of {n_rows} rows are in {}; --resume goes on", path.display()),
            Err(error) => format!("interrupted: {kept} of {n_rows} rows are kept, --resume goes on; {error}"),
        });
        std::process::exit(INTERRUPTED.into());
    };
    // Without a handler an interrupt ends the process at once, which loses no row either.
    let _ = ctrlc::set_handler(handler);
}
