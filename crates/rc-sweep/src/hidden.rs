//! Hidden folders for files that are not complete yet.

use std::fs::File;
use std::io;
use std::path::Path;

use tempfile::TempDir;

use crate::held::{Attempt, Held, attempt};

/// First part of the names of temporary files and folders.
pub(crate) const PARTIAL: &str = ".rc-partial-";

/// Number of attempts to lock a new folder before other processes do.
const ATTEMPTS: usize = 8;

/// A hidden folder inside another one. It is removed when it is dropped, and a killed process leaves it.
///
/// Its lock tells other processes that it is in use.
#[derive(Debug)]
pub(crate) struct Hidden {
    // The folder is removed before its lock ends.
    folder: TempDir,
    _held: Option<Held>,
}

impl Hidden {
    /// A new hidden folder in `folder`.
    ///
    /// # Errors
    /// Errors of the file system.
    pub(crate) fn new(folder: &Path) -> io::Result<Self> {
        let made = || tempfile::Builder::new().prefix(PARTIAL).tempdir_in(folder);
        for _ in 0..ATTEMPTS {
            let hidden = made()?;
            match File::open(hidden.path()).map(attempt) {
                // Before it was locked, another process may have taken it for a leftover.
                Ok(Attempt::Held(held)) if hidden.path().is_dir() => {
                    return Ok(Self { folder: hidden, _held: Some(held) });
                }
                Ok(Attempt::NoLocks) => return Ok(Self { folder: hidden, _held: None }),
                _ => {}
            }
        }
        Ok(Self { folder: made()?, _held: None })
    }

    /// The path of the folder.
    pub(crate) fn path(&self) -> &Path {
        self.folder.path()
    }
}

/// Removes the hidden folders that killed processes have left in `folder`, where possible.
///
/// Those of running processes are locked and stay. Without locks, all stay.
pub(crate) fn remove_dead(folder: &Path) {
    let Ok(entries) = std::fs::read_dir(folder) else { return };
    let hidden = entries.flatten().filter(|entry| entry.file_name().to_string_lossy().starts_with(PARTIAL));
    for path in hidden.map(|entry| entry.path()).filter(|path| path.is_dir()) {
        if let Ok(Attempt::Held(_held)) = File::open(&path).map(attempt) {
            // A folder that cannot be removed is hidden and harmless.
            let _ = std::fs::remove_dir_all(&path);
        }
    }
}
