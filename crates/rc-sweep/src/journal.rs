//! The rows of a sweep on disk as they finish: one line each, appended and synced.
//!
//! The first line says what sweep it is; it appears together with the file. A process that ends at any moment can only
//! cut the last line, which is then taken off.

use std::fs::{File, OpenOptions};
use std::io::{self, Write as _};
use std::path::{Path, PathBuf};

use crate::content::{Cells, Content, Header, SweepRows, row_line};
use crate::error::SweepError;
use crate::files::{self, FileError};
use crate::folder::{FILES, JOURNAL_FILE, ROWS_FOLDER, TABLE_FILE};
use crate::lock::Lock;

/// The journal of a running sweep.
#[derive(Debug)]
pub(crate) struct Journal {
    path: PathBuf,
    file: File,
    /// Bytes of whole lines.
    length: u64,
    /// The first line.
    pub(crate) header: Header,
    pub(crate) rows: SweepRows,
    /// Whether the folder was not there before.
    made_folder: bool,
    /// Why a row could not be kept; after that none is.
    failure: Option<SweepError>,
    /// Held as long as this process may write.
    _lock: Lock,
}

impl Journal {
    /// Starts the journal of a new sweep in `folder`, or with `resume` goes on with what is there of the same sweep.
    ///
    /// # Errors
    /// When the folder holds something else, or cannot be written to.
    pub(crate) fn start(folder: &Path, header: Header, resume: bool) -> Result<Self, SweepError> {
        let path = folder.join(JOURNAL_FILE);
        let journal = match (path.symlink_metadata().is_ok(), resume) {
            (true, true) => Self::reopen(folder, &header)?,
            (true, false) => return Err(SweepError::HoldsSweep { folder: folder.to_owned() }),
            (false, _) => {
                check_unused(folder, resume)?;
                Self::create(folder, header)?
            }
        };
        if resume {
            files::remove_leftovers(folder);
        }
        Ok(journal)
    }

    fn create(folder: &Path, header: Header) -> Result<Self, SweepError> {
        files::check_folder(folder)?;
        let path = folder.join(JOURNAL_FILE);
        let fail = |cause: io::Error| SweepError::from(FileError::write(&path, cause));
        let made_folder = !folder.exists();
        std::fs::create_dir_all(folder).map_err(fail)?;
        let mut new = files::temporary_in(folder).map_err(fail)?;
        let line = header.to_line();
        new.write_all(line.as_bytes()).and_then(|()| new.as_file().sync_all()).map_err(fail)?;
        // Whoever made one in the meantime keeps it (and may have taken this temporary file for a leftover).
        let file = new.persist_noclobber(&path).map_err(|error| {
            if path.exists() { SweepError::AnotherProcess { folder: folder.to_owned() } } else { fail(error.error) }
        })?;
        let lock = Lock::take(&file, folder)?;
        let file = OpenOptions::new().append(true).open(&path).map_err(fail)?;
        Ok(Self {
            path,
            file,
            length: line.len() as u64,
            header,
            rows: SweepRows::new(),
            made_folder,
            failure: None,
            _lock: lock,
        })
    }

    fn reopen(folder: &Path, header: &Header) -> Result<Self, SweepError> {
        let path = folder.join(JOURNAL_FILE);
        let fail = |cause: io::Error| SweepError::from(FileError::write(&path, cause));
        let file = OpenOptions::new().append(true).open(&path).map_err(fail)?;
        // Before reading: another process may still be writing.
        let lock = Lock::take(&file, folder)?;
        let content = Content::read(folder)?;
        header.check_same(&content.header, folder)?;
        file.set_len(content.whole).map_err(fail)?;
        Ok(Self {
            path,
            file,
            length: content.whole,
            header: content.header,
            rows: content.rows,
            made_folder: false,
            failure: None,
            _lock: lock,
        })
    }

    /// Keeps a row. When it returns, the row is on disk; after an error the rows before still are, and no part of this
    /// one.
    ///
    /// # Errors
    /// [`SweepError::Append`].
    pub(crate) fn append(&mut self, row: usize, cells: Cells) -> Result<(), SweepError> {
        if let Some(failure) = &self.failure {
            return Err(failure.clone());
        }
        let line = row_line(row, &cells);
        if let Err(cause) = self.file.write_all(line.as_bytes()).and_then(|()| self.file.sync_data()) {
            // What cannot be cut now is cut when the sweep is resumed.
            let _ = self.file.set_len(self.length);
            let (path, kept) = (self.path.clone(), self.rows.len());
            let failure = SweepError::Append { path, cause: cause.to_string(), kept };
            self.failure = Some(failure.clone());
            return Err(failure);
        }
        self.length += line.len() as u64;
        self.rows.insert(row, cells);
        Ok(())
    }

    /// Takes away a sweep without rows, and its folder if this process made it: there is nothing to go on with.
    pub(crate) fn discard_empty(&self, folder: &Path) {
        if self.rows.is_empty() {
            // What cannot be removed does no harm: --resume takes it. The journal goes last, as long as it is there so
            // does the rest.
            let _ = std::fs::remove_dir_all(folder.join(ROWS_FOLDER));
            let _ = std::fs::remove_file(folder.join(TABLE_FILE));
            let _ = std::fs::remove_file(&self.path);
            if self.made_folder {
                let _ = std::fs::remove_dir(folder);
            }
        }
    }
}

/// Refuses a folder that would mix the files of a sweep with others of the same names, or, to resume, one with any
/// files.
fn check_unused(folder: &Path, resume: bool) -> Result<(), SweepError> {
    let Ok(entries) = std::fs::read_dir(folder) else { return Ok(()) };
    let names = entries.filter_map(|entry| Some(entry.ok()?.file_name().to_string_lossy().into_owned()));
    // Hidden files are what a process that was ended before its first row may have left.
    let in_the_way = |name: &String| if resume { !name.starts_with('.') } else { FILES.contains(&name.as_str()) };
    match names.into_iter().find(in_the_way) {
        None => Ok(()),
        Some(name) if resume => Err(SweepError::NothingToResume { folder: folder.to_owned(), name }),
        Some(name) => Err(SweepError::InTheWay { folder: folder.to_owned(), name }),
    }
}

#[cfg(test)]
mod tests {
    use serde_json::json;

    use super::*;
    use crate::shard::{Shard, SweepShape};

    fn header(waves: usize) -> Header {
        Header::whole(SweepShape { surfaces: 2, loads: 3 }, json!({ "waves": waves }))
    }

    fn cells(value: f64) -> Cells {
        Cells::from_iter([("value".to_owned(), json!(value)), ("status".to_owned(), json!("converged"))])
    }

    #[test]
    fn a_line_cut_at_any_byte_costs_only_its_row() {
        let dir = tempfile::tempdir().expect("a temporary folder");
        let folder = dir.path().join("s");
        let mut journal = Journal::start(&folder, header(8), false).expect("a journal");
        for row in [0, 2, 1] {
            journal.append(row, cells(0.1 + row as f64)).expect("a row");
        }
        let rows = journal.rows.clone();
        drop(journal);
        let path = folder.join(JOURNAL_FILE);
        let bytes = std::fs::read(&path).expect("the journal");
        let last = row_line(1, &rows[&1]).len();
        for cut in 1..=last {
            std::fs::write(&path, &bytes[..bytes.len() - cut]).expect("a cut journal");
            let mut journal = Journal::start(&folder, header(8), true).expect("a journal");
            assert_eq!(journal.rows.keys().copied().collect::<Vec<_>>(), [0, 2], "{cut} bytes cut");
            journal.append(1, cells(1.1)).expect("a row");
            assert_eq!(journal.rows, rows);
            drop(journal);
            assert!(std::fs::read(&path).expect("the journal") == bytes, "{cut} bytes cut: not the same journal");
        }
    }

    #[test]
    fn damage_before_the_last_line_is_named() {
        let dir = tempfile::tempdir().expect("a temporary folder");
        let mut journal = Journal::start(dir.path(), header(8), false).expect("a journal");
        journal.append(0, cells(0.5)).expect("a row");
        journal.append(1, cells(1.5)).expect("a row");
        drop(journal);
        let path = dir.path().join(JOURNAL_FILE);
        let text = std::fs::read_to_string(&path).expect("the journal");
        for (from, to, expected) in [("0.5", "0.5x", "line 2 is damaged"), ("rc_sweep", "sweep", "not a journal")] {
            std::fs::write(&path, text.replace(from, to)).expect("a damaged journal");
            let error = Journal::start(dir.path(), header(8), true).expect_err("damaged").to_string();
            assert!(error.contains(expected), "{error}");
        }
    }

    #[test]
    fn another_sweep_and_a_second_process_are_refused() {
        let dir = tempfile::tempdir().expect("a temporary folder");
        let journal = Journal::start(dir.path(), header(8), false).expect("a journal");
        let refused = |header: Header| Journal::start(dir.path(), header, true).expect_err("refused").to_string();
        if cfg!(unix) {
            assert!(refused(header(8)).contains("another process"), "{}", refused(header(8)));
        }
        drop(journal);
        assert!(refused(header(9)).contains("waves is 8 there and 9 here"), "{}", refused(header(9)));
        let mut shard = header(8);
        shard.shard = Shard { index: 1, count: 2 };
        let message = refused(shard);
        assert!(message.contains("shard 1/1, not 1/2"), "{message}");
    }
}
