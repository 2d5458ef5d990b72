//! Records beside the map in a folder.

use std::path::Path;

use serde::de::DeserializeOwned;

use super::names::{HEIGHTS_FILE, PSD_FILE, RECORD_FILE, SUMMARY_FILE};

/// The records in the folder of `rc surface`, `rc prepare` or `rc solve` whose map or table of a spectrum is at `path`, as far as they are `T`.
///
/// Any other file has none.
pub(crate) fn records<T: DeserializeOwned>(path: &Path) -> impl Iterator<Item = T> + '_ {
    let folder =
        path.parent().filter(|_| path.file_name().is_some_and(|name| name == HEIGHTS_FILE || name == PSD_FILE));
    [RECORD_FILE, SUMMARY_FILE].into_iter().filter_map(move |name| {
        let text = std::fs::read_to_string(folder?.join(name)).ok()?;
        serde_json::from_str(&text).ok()
    })
}
