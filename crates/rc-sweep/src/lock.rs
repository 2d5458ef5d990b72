//! A lock that lets only one process write to the folder of a sweep.

use std::fs::File;
use std::path::Path;

use crate::error::SweepError;

/// A lock that is held until it is dropped or the process ends.
#[derive(Debug)]
pub(crate) struct Lock {
    #[cfg(unix)]
    _file: Option<nix::fcntl::Flock<File>>,
}

impl Lock {
    /// Locks `file` of the sweep in `folder`.
    ///
    /// On a file system without locks there is no lock.
    ///
    /// # Errors
    /// [`SweepError::AnotherProcess`] when another process holds the lock.
    #[cfg(unix)]
    pub(crate) fn take(file: &File, folder: &Path) -> Result<Self, SweepError> {
        use nix::errno::Errno;
        use nix::fcntl::{Flock, FlockArg};
        let Ok(file) = file.try_clone() else { return Ok(Self { _file: None }) };
        match Flock::lock(file, FlockArg::LockExclusiveNonblock) {
            Ok(file) => Ok(Self { _file: Some(file) }),
            Err((_, Errno::EWOULDBLOCK)) => Err(SweepError::AnotherProcess { folder: folder.to_owned() }),
            Err(_) => Ok(Self { _file: None }),
        }
    }

    /// Returns without a lock, because the system has no such locks.
    #[cfg(not(unix))]
    #[expect(clippy::unnecessary_wraps, reason = "the same signature on every system")]
    pub(crate) fn take(_file: &File, _folder: &Path) -> Result<Self, SweepError> {
        Ok(Self {})
    }
}
