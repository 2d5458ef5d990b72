//! The file of `rc-mpi --checkpoint`.
//!
//! It keeps what the last solved level leaves for the next level.

use std::fs::File;
use std::io::{self, Read as _, Seek as _, SeekFrom, Write as _};
use std::path::{Path, PathBuf};
use std::sync::{Mutex, PoisonError};

use rc_solver::Checkpoint;
use rc_sweep::files;

use crate::error::CliError;

/// A file that keeps what each level leaves for the next, for one scene.
///
/// Every rank reads it, so it must be on a file system that all ranks see.
#[derive(Debug)]
pub struct CheckpointFile {
    path: PathBuf,
    /// Beginning of the file, which identifies its format and its scene.
    head: Vec<u8>,
    /// Why the file could not be written.
    failure: Mutex<Option<String>>,
}

impl CheckpointFile {
    /// The file at `path` for the scene with the text `scene`.
    ///
    /// The file need not exist yet.
    ///
    /// # Errors
    /// [`CliError::Input`] for a file of another scene, or a file of another kind.
    pub fn new(path: &Path, scene: &str) -> Result<Self, CliError> {
        let head = format!("rc {} checkpoint, {} bytes of scene\n{scene}\n", env!("CARGO_PKG_VERSION"), scene.len());
        let file = Self { path: path.to_owned(), head: head.into_bytes(), failure: Mutex::new(None) };
        if path.exists() && file.read_at(0, file.head.len()).ok().as_deref() != Some(&file.head) {
            return Err(CliError::in_file(
                path,
                "not a checkpoint of this scene by this version of rc; remove it, or name another --checkpoint",
            ));
        }
        Ok(file)
    }

    /// Why the file could not be written; `None` if it could.
    #[must_use]
    pub fn failure(&self) -> Option<String> {
        self.failure.lock().unwrap_or_else(PoisonError::into_inner).clone()
    }

    /// Removes the file, once its solution exists.
    pub fn remove(&self) {
        // If the file stays, it does no harm, since it belongs to the same scene.
        let _ = std::fs::remove_file(&self.path);
    }

    fn read_at(&self, offset: u64, len: usize) -> io::Result<Vec<u8>> {
        let mut file = File::open(&self.path)?;
        let end = offset.checked_add(len as u64).filter(|&end| file.metadata().is_ok_and(|data| end <= data.len()));
        end.ok_or(io::ErrorKind::UnexpectedEof)?;
        file.seek(SeekFrom::Start(offset))?;
        let mut bytes = vec![0; len];
        file.read_exact(&mut bytes)?;
        Ok(bytes)
    }
}

impl Checkpoint for CheckpointFile {
    fn read(&self, offset: u64, len: usize) -> Option<Vec<u8>> {
        self.read_at(self.head.len() as u64 + offset, len).ok()
    }

    fn replace(&self, pieces: &mut dyn Iterator<Item = Vec<u8>>) {
        let written = files::write_file(&self.path, |path| {
            let mut file = File::create(path)?;
            file.write_all(&self.head)?;
            for piece in pieces {
                file.write_all(&piece)?;
            }
            file.sync_all()
        });
        if let Err(error) = written {
            *self.failure.lock().unwrap_or_else(PoisonError::into_inner) = Some(error.to_string());
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_file_gives_back_what_it_keeps_and_is_of_one_scene() {
        let folder = tempfile::tempdir().expect("a temporary folder");
        let path = folder.path().join("levels");
        let file = CheckpointFile::new(&path, "waves = 8").expect("a new file");
        assert_eq!(file.read(0, 1), None, "nothing is kept yet");
        file.replace(&mut [vec![1, 2], vec![3]].into_iter());
        assert_eq!((file.read(1, 2), file.read(1, 3), file.failure()), (Some(vec![2, 3]), None, None));
        let again = CheckpointFile::new(&path, "waves = 8").expect("the same scene");
        assert_eq!(again.read(0, 3), Some(vec![1, 2, 3]));
        let other = CheckpointFile::new(&path, "waves = 9").expect_err("another scene");
        assert!(other.to_string().contains("not a checkpoint of this scene"), "{other}");
        again.remove();
        assert!(!path.exists());
        let nowhere = CheckpointFile::new(&path.join("below/file"), "").expect("not there yet");
        std::fs::write(&path, "a file in the way").expect("a file");
        nowhere.replace(&mut std::iter::empty());
        assert!(nowhere.failure().is_some_and(|failure| failure.contains("cannot write")));
    }
}
