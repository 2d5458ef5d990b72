//! Documents whose words are people's and whose numbers are a program's: blocks between `<!-- numbers: name -->` and
//! `<!-- end of numbers -->`.

use std::fs;

use anyhow::{Context, Result};

use crate::repository::{self, Sources};

/// Begins a block; the name and ` -->` follow.
pub const BEGIN: &str = "<!-- numbers: ";
/// Ends a block.
pub const END: &str = "<!-- end of numbers -->";

/// The document at `path` with each block filled by `block`, which is given its name.
///
/// # Errors
/// When the document or a marker is missing, or with what `block` says.
pub fn fill(path: &str, sources: &Sources, block: impl Fn(&str) -> Result<String, String>) -> Result<String, String> {
    let document = sources.get(path).ok_or_else(|| format!("{path} is missing; restore it from history"))?;
    let mut text = String::new();
    let mut rest = document.as_str();
    while let Some((before, after)) = rest.split_once(BEGIN) {
        let (name, after) =
            after.split_once(" -->").ok_or_else(|| format!("{path}: `{BEGIN}` without ` -->`; close it"))?;
        let (_, after) = after.split_once(END).ok_or_else(|| format!("{path}: no `{END}` after {name}; add it"))?;
        text.extend([before, BEGIN, name, " -->\n\n", &block(name)?, "\n", END]);
        rest = after;
    }
    Ok(text + rest)
}

/// Rewrites the documents at the paths `documents` of this repository by `render`, which is given a path and the
/// sources.
///
/// # Errors
/// With what `render` says, or when a document cannot be written.
pub fn rewrite<'a>(
    documents: impl IntoIterator<Item = &'a str>,
    render: impl Fn(&str, &Sources) -> Result<String, String>,
) -> Result<()> {
    let sources = repository::read_sources(&repository::root())?;
    for document in documents {
        let text = render(document, &sources).map_err(anyhow::Error::msg)?;
        let path = repository::root().join(document);
        fs::write(&path, text).with_context(|| format!("could not write {}", path.display()))?;
    }
    Ok(())
}

/// The complaint about the document at `path` that differs from what `render` makes of it; `cure` says which run it
/// shall agree with and which command rewrites it.
#[must_use]
pub fn complaint(path: &str, sources: &Sources, rendered: Result<String, String>, cure: &str) -> Option<String> {
    match rendered {
        Ok(text) if sources.get(path) == Some(&text) => None,
        Ok(_) => Some(format!("{path} has other numbers than {cure}")),
        Err(complaint) => Some(complaint),
    }
}
