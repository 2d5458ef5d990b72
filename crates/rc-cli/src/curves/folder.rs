//! What a folder with the rows of a sweep or a study is.

use std::path::Path;

use rc_sweep::{TABLE_FILE, settings_in};

use crate::error::CliError;
use crate::study::record::StudyRecord;

/// A folder with several results.
pub(crate) enum Rows {
    /// Of `rc sweep`, with its table.
    Sweep,
    /// Of `rc study`.
    Study(Box<StudyRecord>),
}

impl Rows {
    /// The rows in `folder`; `None` if it is neither a sweep nor a study.
    ///
    /// # Errors
    /// [`CliError::Input`] for a sweep without a table, a mean over realisations, and a damaged study.
    pub(crate) fn of(folder: &Path) -> Result<Option<Self>, CliError> {
        if !folder.is_dir() {
            return Ok(None);
        }
        if let Some(record) = StudyRecord::read(folder)? {
            return Ok(Some(Self::Study(Box::new(record))));
        }
        let settings = settings_in(folder);
        if settings.as_ref().is_some_and(|settings| !settings["ensemble"].is_null()) {
            let message = format_args!(
                "a mean of rc sweep --error-of-mean, whose numbers are in mean.json; rc report {} draws it",
                folder.display()
            );
            return Err(CliError::in_file(folder, message));
        }
        match (folder.join(TABLE_FILE).is_file(), settings) {
            (true, _) => Ok(Some(Self::Sweep)),
            (false, Some(_)) => Err(no_table(folder)),
            (false, None) => Ok(None),
        }
    }
}

/// The error for a sweep that is not finished.
pub(crate) fn no_table(folder: &Path) -> CliError {
    CliError::in_file(folder, format_args!("this sweep has no {TABLE_FILE} yet; finish it with --resume"))
}
