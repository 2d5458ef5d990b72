//! The text files of the repository in memory, for checks that are pure functions.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::{fs, io};

use anyhow::{Context, Result};

/// Entries of the root that are not sources, since they are history or results.
///
/// Folders that a tool marks as its cache (`CACHEDIR.TAG`) are not sources either.
const RESULTS: &[&str] = &[".git", "figures", "rc-result", "target"];

/// The root of the repository.
#[must_use]
pub fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).ancestors().nth(2).map(Path::to_path_buf).unwrap_or_default()
}

/// Folder of cargo's build results.
#[must_use]
pub fn target() -> PathBuf {
    std::env::var_os("CARGO_TARGET_DIR").map_or_else(|| root().join("target"), |folder| root().join(folder))
}

/// Text files by path from the root, with `/` between folders.
///
/// Files that are not UTF-8 (arrays, pictures, fonts) are left out.
pub type Sources = BTreeMap<String, String>;

/// Whether the file at `path` has the extension `extension`.
#[must_use]
pub fn has_extension(path: &str, extension: &str) -> bool {
    Path::new(path).extension().is_some_and(|found| found == extension)
}

/// Reads every text file under `root`, except results.
///
/// # Errors
/// When a folder or file cannot be read.
pub fn read_sources(root: &Path) -> Result<Sources> {
    let mut sources = Sources::new();
    let mut folders = vec![root.to_path_buf()];
    while let Some(folder) = folders.pop() {
        for entry in fs::read_dir(&folder).with_context(|| format!("could not list {}", folder.display()))? {
            let path = entry?.path();
            let relative = path.strip_prefix(root)?.to_string_lossy().replace('\\', "/");
            if RESULTS.contains(&relative.as_str()) || path.join("CACHEDIR.TAG").exists() {
                continue;
            }
            if path.is_dir() {
                folders.push(path);
            } else {
                match fs::read_to_string(&path) {
                    Ok(text) => drop(sources.insert(relative, text)),
                    Err(error) if error.kind() == io::ErrorKind::InvalidData => {}
                    Err(error) => return Err(error).with_context(|| format!("could not read {relative}")),
                }
            }
        }
    }
    Ok(sources)
}
