//! The finished rows of a running sweep.

use std::path::{Path, PathBuf};
use std::sync::MutexGuard;

use crate::content::SweepRows;
use crate::error::SweepError;
use crate::journal::Journal;
use crate::table;

/// The rows that are stored so far. No other row is stored during its lifetime.
#[derive(Debug)]
pub struct Kept<'a> {
    folder: &'a Path,
    journal: MutexGuard<'a, Journal>,
}

impl<'a> Kept<'a> {
    /// The rows of the journal in `folder`.
    pub(crate) fn new(folder: &'a Path, journal: MutexGuard<'a, Journal>) -> Self {
        Self { folder, journal }
    }

    /// The rows.
    #[must_use]
    pub fn rows(&self) -> &SweepRows {
        &self.journal.rows
    }

    /// Writes the table of the rows, if there are any, and returns its path.
    ///
    /// # Errors
    /// [`SweepError::File`] when it cannot be written. An earlier table is not changed.
    pub fn write_table(&self) -> Result<PathBuf, SweepError> {
        table::write(self.folder, &self.journal.rows)
    }

    /// Removes a sweep without rows.
    pub(crate) fn discard_empty(&self) {
        self.journal.discard_empty(self.folder);
    }
}
