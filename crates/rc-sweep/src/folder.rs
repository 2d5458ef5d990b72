//! Names in the folder of a sweep.

use std::io;
use std::path::{Path, PathBuf};

use crate::files::FileError;

/// The journal.
pub(crate) const JOURNAL_FILE: &str = "sweep.jsonl";

/// The table.
pub const TABLE_FILE: &str = "sweep.csv";

/// The folder with a folder for the fields of each row.
pub(crate) const ROWS_FOLDER: &str = "rows";

/// What a sweep has in its folder.
pub(crate) const FILES: [&str; 3] = [JOURNAL_FILE, TABLE_FILE, ROWS_FOLDER];

/// The file of a row's folder that is written last.
const LAST_FILE: &str = "summary.json";

/// The folder for the fields of row `index` in the folder of a sweep: numbered from 1, as the lines of the table.
pub(crate) fn fields_folder(sweep: &Path, index: usize) -> PathBuf {
    sweep.join(ROWS_FOLDER).join(row_name(index))
}

/// The name of the folder of row `index`.
pub(crate) fn row_name(index: usize) -> String {
    format!("{:04}", index + 1)
}

/// Whether the fields of a row are there; the summary is written last.
pub(crate) fn has_fields(sweep: &Path, index: usize) -> bool {
    fields_folder(sweep, index).join(LAST_FILE).exists()
}

/// Writes the result folder of a row, whole or not at all: removes an earlier one first, and what `write` leaves when
/// it fails. `write` writes `summary.json` last.
///
/// # Errors
/// Those of `write`, and a [`FileError`] when an earlier folder cannot be removed.
pub fn replace_fields<E: From<FileError>>(folder: &Path, write: impl FnOnce() -> Result<(), E>) -> Result<(), E> {
    // A row that is solved has no folder, unless a process was killed while it wrote it.
    match std::fs::remove_dir_all(folder) {
        Err(cause) if cause.kind() != io::ErrorKind::NotFound => return Err(FileError::write(folder, cause).into()),
        _ => {}
    }
    write().inspect_err(|_| {
        // What stays is replaced when the row is solved again.
        let _ = std::fs::remove_dir_all(folder);
    })
}
