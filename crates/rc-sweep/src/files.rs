//! Files that are written completely or not at all.

use std::io::{self, Write as _};
use std::path::{Path, PathBuf};

use tempfile::NamedTempFile;
use thiserror::Error;

use crate::hidden::{self, Hidden, PARTIAL};

/// Reasons why files were not written.
#[derive(Clone, Debug, PartialEq, Eq, Error)]
#[non_exhaustive]
pub enum FileError {
    /// Files cannot be created in a folder. Nothing was written.
    #[error("cannot write to the folder {}: {cause}", folder.display())]
    Folder {
        /// The folder.
        folder: PathBuf,
        /// Cause of the failure.
        cause: String,
    },
    /// A file or folder could not be written.
    #[error("cannot write {}: {cause}", path.display())]
    Write {
        /// Final path of the file or folder.
        path: PathBuf,
        /// Cause of the failure.
        cause: String,
    },
}

impl FileError {
    /// The error of a `path` that could not be written.
    pub fn write(path: &Path, cause: impl std::fmt::Display) -> Self {
        Self::Write { path: path.to_owned(), cause: cause.to_string() }
    }
}

/// First part of the names of replaced files, inside the hidden folder.
const EARLIER: &str = "earlier-";

/// First part of the name of the temporary folder that [`check_folder`] creates.
const PROBE: &str = ".rc-probe-";

/// Checks that files can be created in `folder`, or that `folder` can be created.
///
/// Nothing remains afterwards, and what killed processes have left there is removed.
///
/// # Errors
/// [`FileError::Folder`] when this is not possible.
pub fn check_folder(folder: &Path) -> Result<(), FileError> {
    let refuse =
        |cause: &dyn std::fmt::Display| FileError::Folder { folder: folder.to_owned(), cause: cause.to_string() };
    // If the folder does not exist yet, the nearest existing folder above it must accept a new folder.
    let existing = folder.ancestors().map(or_here).find(|path| path.symlink_metadata().is_ok());
    let existing = existing.ok_or_else(|| refuse(&"no such folder"))?;
    if !existing.is_dir() {
        return Err(refuse(&format_args!("{} is not a folder", existing.display())));
    }
    tempfile::Builder::new().prefix(PROBE).tempdir_in(existing).map_err(|cause| refuse(&cause))?;
    hidden::remove_dead(folder);
    Ok(())
}

/// The current folder if the path is empty.
fn or_here(path: &Path) -> &Path {
    if path.as_os_str().is_empty() { Path::new(".") } else { path }
}

/// A set of files, or of folders with files, that is not yet complete.
///
/// They are written into a hidden folder inside the target folder, and get their final names together in
/// [`Staged::commit`]. They are removed if the set is dropped before.
#[derive(Debug)]
pub struct Staged {
    folder: PathBuf,
    hidden: Hidden,
    names: Vec<String>,
    /// Names of earlier files that the set replaces, whether it has such files or not.
    earlier: Vec<String>,
}

impl Staged {
    /// Starts a set of files for `folder`, which is created if it does not exist.
    ///
    /// # Errors
    /// [`FileError::Write`] when this is not possible.
    pub fn new(folder: &Path) -> Result<Self, FileError> {
        let folder = or_here(folder).to_owned();
        let fail = |cause: io::Error| FileError::write(&folder, cause);
        std::fs::create_dir_all(&folder).map_err(fail)?;
        hidden::remove_dead(&folder);
        let hidden = Hidden::new(&folder).map_err(fail)?;
        Ok(Self { folder, hidden, names: Vec::new(), earlier: Vec::new() })
    }

    /// The set, which removes earlier files and folders with these names from its folder when it is complete.
    #[must_use]
    pub fn instead_of<'a>(self, earlier: impl Iterator<Item = &'a str>) -> Self {
        Self { earlier: earlier.map(str::to_owned).collect(), ..self }
    }

    /// Adds the file or folder `name`. `write` writes it to the path in its argument.
    ///
    /// # Errors
    /// [`FileError::Write`] with the error of `write`.
    pub fn add<E: std::fmt::Display>(
        &mut self,
        name: &str,
        write: impl FnOnce(&Path) -> Result<(), E>,
    ) -> Result<(), FileError> {
        write(&self.hidden.path().join(name)).map_err(|cause| FileError::write(&self.folder.join(name), cause))?;
        self.names.push(name.to_owned());
        Ok(())
    }

    /// Adds the text file `name`.
    ///
    /// # Errors
    /// [`FileError::Write`] when the file cannot be written.
    pub fn add_text(&mut self, name: &str, text: &str) -> Result<(), FileError> {
        self.add(name, |path| write_synced(path, text.as_bytes()))
    }

    /// Names of the files so far.
    #[must_use]
    pub fn names(&self) -> &[String] {
        &self.names
    }

    /// Gives the files their final names, in the order in which they were added.
    ///
    /// The last file marks a complete set. An earlier file of its name is removed first, so that it never describes
    /// files of another run.
    ///
    /// # Errors
    /// [`FileError::Write`] when a file cannot be renamed.
    pub fn commit(self) -> Result<(), FileError> {
        if let Some(mark) = self.names.last() {
            self.make_room(mark)?;
        }
        for name in self.earlier.iter().filter(|name| !self.names.contains(name)) {
            self.set_aside(name)?;
        }
        for name in &self.names {
            let (from, path) = (self.hidden.path().join(name), self.folder.join(name));
            if from.is_dir() {
                // A renamed file replaces another file by itself. A folder does not.
                self.make_room(name)?;
            }
            std::fs::rename(from, &path).map_err(|cause| FileError::write(&path, cause))?;
        }
        Ok(())
    }

    /// Moves an existing file or folder with a staged name to the hidden folder.
    ///
    /// A folder is moved only if the staged one is a folder too.
    fn make_room(&self, name: &str) -> Result<(), FileError> {
        let path = self.folder.join(name);
        let Ok(earlier) = path.symlink_metadata() else { return Ok(()) };
        let refused: Result<(), _> = match (earlier.is_dir(), self.hidden.path().join(name).is_dir()) {
            (true, false) => Err(io::Error::from(io::ErrorKind::IsADirectory)),
            (false, true) => Err(io::Error::from(io::ErrorKind::NotADirectory)),
            _ => return self.set_aside(name),
        };
        refused.map_err(|cause| FileError::write(&path, cause))
    }

    /// Moves an existing file or folder to the hidden folder.
    fn set_aside(&self, name: &str) -> Result<(), FileError> {
        let path = self.folder.join(name);
        match std::fs::rename(&path, self.hidden.path().join(format!("{EARLIER}{name}"))) {
            Err(cause) if cause.kind() != io::ErrorKind::NotFound => Err(FileError::write(&path, cause)),
            _ => Ok(()),
        }
    }
}

/// Writes a file completely or not at all.
///
/// `write` gets the path of a temporary file beside it.
///
/// # Errors
/// [`FileError::Write`] with the error of `write`.
pub fn write_file<E: std::fmt::Display>(
    path: &Path,
    write: impl FnOnce(&Path) -> Result<(), E>,
) -> Result<(), FileError> {
    let folder = or_here(path.parent().unwrap_or(Path::new("")));
    let fail = |cause: &dyn std::fmt::Display| FileError::write(path, cause);
    std::fs::create_dir_all(folder).map_err(|cause| fail(&cause))?;
    let hidden = Hidden::new(folder).map_err(|cause| fail(&cause))?;
    let temporary = hidden.path().join(path.file_name().unwrap_or_default());
    write(&temporary).map_err(|cause| fail(&cause))?;
    std::fs::rename(&temporary, path).map_err(|cause| fail(&cause))
}

/// A hidden file in `folder`, which is to be filled and renamed.
///
/// Its permissions for others follow the settings of the user.
///
/// # Errors
/// Errors of the file system.
pub fn temporary_in(folder: &Path) -> io::Result<NamedTempFile> {
    let mut builder = tempfile::Builder::new();
    #[cfg(unix)]
    builder.permissions(std::os::unix::fs::PermissionsExt::from_mode(0o666));
    builder.prefix(PARTIAL).tempfile_in(folder)
}

/// Removes the files that killed processes have left in `folder`, where possible.
///
/// No other process may write to the folder.
pub fn remove_leftovers(folder: &Path) {
    let Ok(entries) = std::fs::read_dir(folder) else { return };
    for entry in entries.flatten() {
        let name = entry.file_name();
        let name = name.to_string_lossy();
        if name.starts_with(PARTIAL) || name.starts_with(PROBE) {
            let (path, is_folder) = (entry.path(), entry.file_type().is_ok_and(|kind| kind.is_dir()));
            // Files that cannot be removed are hidden and harmless.
            let _ = if is_folder { std::fs::remove_dir_all(path) } else { std::fs::remove_file(path) };
        }
    }
}

/// Writes a file, and waits until the system has stored it.
///
/// # Errors
/// Errors of the file system.
pub fn write_synced(path: &Path, bytes: &[u8]) -> io::Result<()> {
    let mut file = std::fs::File::create(path)?;
    file.write_all(bytes)?;
    file.sync_all()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn names(folder: &Path) -> Vec<String> {
        let entries = std::fs::read_dir(folder).expect("a folder");
        let mut names: Vec<String> =
            entries.map(|entry| entry.expect("an entry").file_name().to_string_lossy().into_owned()).collect();
        names.sort();
        names
    }

    #[test]
    fn a_set_that_is_not_committed_leaves_earlier_files_and_nothing_else() {
        let dir = tempfile::tempdir().expect("a temporary folder");
        std::fs::write(dir.path().join("a.txt"), "old").expect("a file");
        let mut staged = Staged::new(dir.path()).expect("a writable folder");
        staged.add_text("a.txt", "new").expect("a staged file");
        drop(staged);
        assert_eq!(names(dir.path()), ["a.txt"]);
        assert_eq!(std::fs::read_to_string(dir.path().join("a.txt")).expect("the file"), "old");
    }

    #[test]
    fn a_committed_set_replaces_earlier_files() {
        let dir = tempfile::tempdir().expect("a temporary folder");
        let folder = dir.path().join("new/folder");
        for text in ["first", "second"] {
            let mut staged = Staged::new(&folder).expect("a writable folder");
            staged.add_text("a.txt", text).expect("a staged file");
            staged.add_text("summary.json", text).expect("a staged file");
            staged.commit().expect("a committed set");
            assert_eq!(names(&folder), ["a.txt", "summary.json"]);
            assert_eq!(std::fs::read_to_string(folder.join("a.txt")).expect("the file"), text);
        }
    }

    #[test]
    fn earlier_files_vanish_only_with_a_committed_set() {
        let dir = tempfile::tempdir().expect("a temporary folder");
        for name in ["stale.npy", "own.txt"] {
            std::fs::write(dir.path().join(name), "").expect("a file");
        }
        std::fs::create_dir(dir.path().join("group")).expect("a folder");
        let staged = || {
            let earlier = ["stale.npy", "group", "a.txt", "absent"].into_iter();
            let mut staged = Staged::new(dir.path()).expect("a writable folder").instead_of(earlier);
            staged.add_text("a.txt", "").expect("a staged file");
            staged
        };
        drop(staged());
        assert_eq!(names(dir.path()), ["group", "own.txt", "stale.npy"]);
        staged().commit().expect("a committed set");
        assert_eq!(names(dir.path()), ["a.txt", "own.txt"]);
    }

    #[test]
    fn a_folder_replaces_a_folder_as_a_whole_and_nothing_else() {
        let dir = tempfile::tempdir().expect("a temporary folder");
        let staged = |inner: &str| {
            let mut staged = Staged::new(dir.path()).expect("a writable folder");
            let write = |path: &Path| {
                std::fs::create_dir(path)?;
                write_synced(&path.join(inner), b"")
            };
            staged.add("f", write).expect("a staged folder");
            staged.add_text("mark", "").expect("a staged file");
            staged.commit()
        };
        for inner in ["old", "new"] {
            staged(inner).expect("a committed set");
            assert_eq!(names(dir.path()), ["f", "mark"]);
            assert_eq!(names(&dir.path().join("f")), [inner]);
        }
        std::fs::remove_dir_all(dir.path().join("f")).expect("the folder");
        std::fs::write(dir.path().join("f"), "").expect("a file in its way");
        assert!(matches!(staged("new").expect_err("a file"), FileError::Write { .. }));
        assert!(dir.path().join("f").is_file(), "the file is gone");
    }

    #[test]
    fn leftovers_of_killed_processes_are_removed_and_folders_in_use_are_not() {
        let dir = tempfile::tempdir().expect("a temporary folder");
        let dead = dir.path().join(".rc-partial-dead");
        let leave = || {
            std::fs::create_dir(&dead).expect("a folder");
            std::fs::write(dead.join("gap.png"), "half").expect("a file");
        };
        leave();
        let mut staged = Staged::new(dir.path()).expect("a writable folder");
        staged.add_text("a.txt", "new").expect("a staged file");
        assert!(!dead.exists(), "the leftover is still there");
        leave();
        check_folder(dir.path()).expect("a writable folder");
        assert!(!dead.exists(), "the leftover is still there");
        Staged::new(dir.path()).expect("a second writer").add_text("b.txt", "").expect("a staged file");
        staged.commit().expect("nobody removed the set in use");
        assert_eq!(names(dir.path()), ["a.txt"]);
    }

    #[test]
    fn a_folder_that_cannot_be_is_refused_and_a_new_one_is_not_made_yet() {
        let dir = tempfile::tempdir().expect("a temporary folder");
        std::fs::write(dir.path().join("file"), "").expect("a file");
        for bad in ["file", "file/sub", "file/sub/sub"] {
            let error = check_folder(&dir.path().join(bad)).expect_err(bad);
            assert!(matches!(error, FileError::Folder { .. }), "{error}");
        }
        check_folder(&dir.path().join("new/folder")).expect("it could be made");
        assert_eq!(names(dir.path()), ["file"]);
    }
}
