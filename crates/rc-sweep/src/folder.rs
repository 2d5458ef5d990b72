//! Names in the folder of a sweep.

use std::io;
use std::path::{Path, PathBuf};

use crate::files::FileError;

/// Name of the journal.
pub(crate) const JOURNAL_FILE: &str = "sweep.jsonl";

/// Name of the table.
pub const TABLE_FILE: &str = "sweep.csv";

/// Name of the folder with a folder for the fields of each row.
pub(crate) const ROWS_FOLDER: &str = "rows";

/// Names of everything that a sweep has in its folder.
pub(crate) const FILES: [&str; 3] = [JOURNAL_FILE, TABLE_FILE, ROWS_FOLDER];

/// The file that is written last in the folder of a row.
const LAST_FILE: &str = "summary.json";

/// The folder for the fields of row `index` in the folder of a sweep.
///
/// Its number counts from 1, like the lines of the table.
pub(crate) fn fields_folder(sweep: &Path, index: usize) -> PathBuf {
    sweep.join(ROWS_FOLDER).join(row_name(index))
}

/// The name of the folder of row `index`.
pub(crate) fn row_name(index: usize) -> String {
    format!("{:04}", index + 1)
}

/// Whether the fields of a row are complete. The summary is written last.
pub(crate) fn has_fields(sweep: &Path, index: usize) -> bool {
    fields_folder(sweep, index).join(LAST_FILE).exists()
}

/// Writes the result folder of a row completely or not at all.
///
/// An earlier folder is removed first. If `write` fails, its files are removed. `write` writes `summary.json` last.
///
/// # Errors
/// Those of `write`, and a [`FileError`] when an earlier folder cannot be removed.
pub fn replace_fields<E: From<FileError>>(folder: &Path, write: impl FnOnce() -> Result<(), E>) -> Result<(), E> {
    // The folder of a row that is still to be solved exists only if a process was killed while it wrote the folder.
    match std::fs::remove_dir_all(folder) {
        Err(cause) if cause.kind() != io::ErrorKind::NotFound => return Err(FileError::write(folder, cause).into()),
        _ => {}
    }
    write().inspect_err(|_| {
        // Files that remain are replaced when the row is solved again.
        let _ = std::fs::remove_dir_all(folder);
    })
}
