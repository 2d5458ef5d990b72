//! What differs in the scenes of two results.

use std::path::Path;

use serde::Serialize;
use toml::{Table, Value};

use crate::error::CliError;
use crate::files::names::SCENE_FILE;

/// A key of a scene with different values.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub(super) struct OtherKey {
    key: String,
    /// The values as in the scene file; null where it does not have the key.
    a: Option<String>,
    b: Option<String>,
}

/// The keys whose values differ in the scenes of two folders.
///
/// # Errors
/// [`CliError::Input`] for a scene that is not TOML.
pub(super) fn differences(a: &Path, b: &Path) -> Result<Vec<OtherKey>, CliError> {
    let [a, b] = [read(a)?, read(b)?];
    let only_b = b.keys().filter(|key| !a.contains_key(*key));
    let keys = a.keys().chain(only_b).filter(|key| a.get(*key) != b.get(*key));
    let text = |table: &Table, key: &str| table.get(key).map(Value::to_string);
    Ok(keys.map(|key| OtherKey { key: key.clone(), a: text(&a, key), b: text(&b, key) }).collect())
}

fn read(folder: &Path) -> Result<Table, CliError> {
    let path = folder.join(SCENE_FILE);
    let text = std::fs::read_to_string(&path)
        .map_err(|cause| CliError::in_file(&path, format_args!("cannot read this scene file: {cause}")))?;
    text.parse().map_err(|cause| CliError::in_file(&path, cause))
}

/// A line that says what differs; `None` for equal scenes.
pub(super) fn line(others: &[OtherKey]) -> Option<String> {
    let absent = || "not given".to_owned();
    let one = |other: &OtherKey| {
        let [a, b] = [&other.a, &other.b].map(|value| value.clone().unwrap_or_else(absent));
        format!("{} ({a}; {b})", other.key)
    };
    let all: Vec<String> = others.iter().map(one).collect();
    (!all.is_empty()).then(|| format!("the scenes differ in {}", all.join(", ")))
}
