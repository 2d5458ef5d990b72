//! The finished rows of a sweep on disk, with one line each, appended and synced.
//!
//! The first line identifies the sweep, and appears together with the file. If a process ends at any moment, only the
//! last line can be incomplete. That line is then removed.

use std::fs::{File, OpenOptions};
use std::io::{self, Write as _};
use std::path::{Path, PathBuf};

use crate::content::{Cells, Content, Header, SweepRows, row_line};
use crate::error::SweepError;
use crate::extended;
use crate::files::{self, FileError};
use crate::folder::{FILES, JOURNAL_FILE, ROWS_FOLDER, TABLE_FILE};
use crate::lock::Lock;

/// The journal of a running sweep.
#[derive(Debug)]
pub(crate) struct Journal {
    path: PathBuf,
    file: File,
    /// Number of bytes of complete lines.
    length: u64,
    /// The first line.
    pub(crate) header: Header,
    pub(crate) rows: SweepRows,
    /// Whether this process created the folder.
    made_folder: bool,
    /// Reason why a row could not be stored. No row is stored after that.
    failure: Option<SweepError>,
    /// Locks that are held while this process may write. One is that of a journal which this one replaces.
    _locks: Vec<Lock>,
}

impl Journal {
    /// Starts the journal of a new sweep in `folder`, or continues a sweep with `resume`.
    ///
    /// A sweep to continue must have the same first line, or lack some surfaces or loads.
    ///
    /// # Errors
    /// When the folder contains something else, or cannot be written.
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
        // If another process has created the journal meanwhile, that process keeps it. It may have removed this
        // temporary file as a leftover.
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
            _locks: vec![lock],
        })
    }

    fn reopen(folder: &Path, header: &Header) -> Result<Self, SweepError> {
        let path = folder.join(JOURNAL_FILE);
        let fail = |cause: io::Error| SweepError::from(FileError::write(&path, cause));
        let file = OpenOptions::new().append(true).open(&path).map_err(fail)?;
        // The lock is taken before reading, because another process may still be writing.
        let lock = Lock::take(&file, folder)?;
        let content = Content::read(folder)?;
        if let Some(places) = extended::places(&content.header, header) {
            return Self::extend(folder, (content, lock), header, &places);
        }
        header.check_same(&content.header, folder)?;
        file.set_len(content.whole).map_err(fail)?;
        Ok(Self::with_content(path, (file, vec![lock]), content))
    }

    /// Replaces a journal by that of a sweep with more rows. Its finished rows get these places.
    fn extend(
        folder: &Path,
        (content, lock): (Content, Lock),
        header: &Header,
        places: &[usize],
    ) -> Result<Self, SweepError> {
        let path = folder.join(JOURNAL_FILE);
        let fail = |cause: io::Error| SweepError::from(FileError::write(&path, cause));
        let content = extended::moved(content, header.clone(), places);
        let mut new = files::temporary_in(folder).map_err(fail)?;
        new.write_all(content.text().as_bytes()).and_then(|()| new.as_file().sync_all()).map_err(fail)?;
        let other_lock = Lock::take(new.as_file(), folder)?;
        let fields = extended::MovedFields::hide(folder, places)?;
        new.persist(&path).map_err(|error| fail(error.error))?;
        fields.show()?;
        let file = OpenOptions::new().append(true).open(&path).map_err(fail)?;
        Ok(Self::with_content(path, (file, vec![lock, other_lock]), content))
    }

    fn with_content(path: PathBuf, (file, locks): (File, Vec<Lock>), content: Content) -> Self {
        let Content { header, rows, whole } = content;
        Self { path, file, length: whole, header, rows, made_folder: false, failure: None, _locks: locks }
    }

    /// Stores a row.
    ///
    /// After success, the row is on disk. After an error, the rows before it are on disk, and no part of this row is.
    ///
    /// # Errors
    /// [`SweepError::Append`] when the line cannot be written.
    pub(crate) fn append(&mut self, row: usize, cells: Cells) -> Result<(), SweepError> {
        if let Some(failure) = &self.failure {
            return Err(failure.clone());
        }
        let line = row_line(row, &cells);
        if let Err(cause) = self.file.write_all(line.as_bytes()).and_then(|()| self.file.sync_data()) {
            // An incomplete line that cannot be removed now is removed when the sweep is resumed.
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

    /// Removes a sweep without rows, and its folder if this process created it.
    ///
    /// There is nothing to continue.
    pub(crate) fn discard_empty(&self, folder: &Path) {
        if self.rows.is_empty() {
            // Files that cannot be removed are harmless, because --resume accepts them. The journal is removed last, so
            // that it exists as long as the other files.
            let _ = std::fs::remove_dir_all(folder.join(ROWS_FOLDER));
            let _ = std::fs::remove_file(folder.join(TABLE_FILE));
            let _ = std::fs::remove_file(&self.path);
            if self.made_folder {
                let _ = std::fs::remove_dir(folder);
            }
        }
    }
}

/// Refuses a folder with files that do not belong to a new sweep.
///
/// Without `resume`, no file may have a name that a sweep uses. With `resume`, there may be no files at all.
fn check_unused(folder: &Path, resume: bool) -> Result<(), SweepError> {
    let Ok(entries) = std::fs::read_dir(folder) else { return Ok(()) };
    let names = entries.filter_map(|entry| Some(entry.ok()?.file_name().to_string_lossy().into_owned()));
    // Hidden files may remain from a process that was killed before its first row.
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
        assert!(refused(header(9)).contains("waves is 8 in the folder and 9 now"), "{}", refused(header(9)));
        let mut shard = header(8);
        shard.shard = Shard { index: 1, count: 2 };
        let message = refused(shard);
        assert!(message.contains("shard 1/1, not 1/2"), "{message}");
    }
}
