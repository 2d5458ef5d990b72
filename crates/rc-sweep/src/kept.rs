//! The rows of a running sweep that are finished.

use std::path::{Path, PathBuf};
use std::sync::MutexGuard;

use crate::content::SweepRows;
use crate::error::SweepError;
use crate::journal::Journal;
use crate::table;

/// The rows that are kept so far. No other row is kept as long as this lives.
#[derive(Debug)]
pub struct Kept<'a> {
    folder: &'a Path,
    journal: MutexGuard<'a, Journal>,
}

impl<'a> Kept<'a> {
    /// Those of the journal in `folder`.
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
    /// [`SweepError::File`]; an earlier table is left as it was.
    pub fn write_table(&self) -> Result<PathBuf, SweepError> {
        table::write(self.folder, &self.journal.rows)
    }

    /// Takes away a sweep without rows.
    pub(crate) fn discard_empty(&self) {
        self.journal.discard_empty(self.folder);
    }
}
