//! A lock that lets only one process write to the folder of a sweep.

use std::fs::File;
use std::path::Path;

use crate::error::SweepError;
use crate::held::{Attempt, Held, attempt};

/// A lock that is held until it is dropped or the process ends.
#[derive(Debug)]
pub(crate) struct Lock {
    _held: Option<Held>,
}

impl Lock {
    /// Locks `file` of the sweep in `folder`.
    ///
    /// On a file system without locks there is no lock.
    ///
    /// # Errors
    /// [`SweepError::AnotherProcess`] when another process holds the lock.
    pub(crate) fn take(file: &File, folder: &Path) -> Result<Self, SweepError> {
        match file.try_clone().map(attempt) {
            Ok(Attempt::Held(held)) => Ok(Self { _held: Some(held) }),
            Ok(Attempt::ByAnother) => Err(SweepError::AnotherProcess { folder: folder.to_owned() }),
            Ok(Attempt::NoLocks) | Err(_) => Ok(Self { _held: None }),
        }
    }
}
