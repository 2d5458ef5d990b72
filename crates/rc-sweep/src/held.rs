//! Locks of open files and folders, which end with their process.

use std::fs::File;

/// A lock that is held until it is dropped or the process ends.
#[derive(Debug)]
pub(crate) struct Held {
    #[cfg(unix)]
    _lock: nix::fcntl::Flock<File>,
}

/// What came of an attempt to lock a file or folder.
#[derive(Debug)]
pub(crate) enum Attempt {
    /// It is locked now.
    Held(Held),
    /// Another process, or another owner in this one, holds the lock.
    ByAnother,
    /// There are no such locks on this system or file system.
    NoLocks,
}

/// Tries to lock `file`, which may be a folder.
#[cfg(unix)]
pub(crate) fn attempt(file: File) -> Attempt {
    use nix::errno::Errno;
    use nix::fcntl::{Flock, FlockArg};
    match Flock::lock(file, FlockArg::LockExclusiveNonblock) {
        Ok(lock) => Attempt::Held(Held { _lock: lock }),
        Err((_, Errno::EWOULDBLOCK)) => Attempt::ByAnother,
        Err(_) => Attempt::NoLocks,
    }
}

/// Returns without a lock, because the system has no such locks.
#[cfg(not(unix))]
pub(crate) fn attempt(_file: File) -> Attempt {
    Attempt::NoLocks
}
