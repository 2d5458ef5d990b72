//! Documents with blocks of numbers that a program writes.
//!
//! People write the text. A block is between `<!-- numbers: name -->` and `<!-- end of numbers -->`.

use std::fs;

use anyhow::{Context, Result};

use crate::repository::{self, Sources};

/// Beginning of a block, which the name and ` -->` follow.
pub const BEGIN: &str = "<!-- numbers: ";
/// End of a block.
pub const END: &str = "<!-- end of numbers -->";

/// The document at `path`, with each block filled by `block` from its name.
///
/// # Errors
/// When the document or a marker is missing, and the errors of `block`.
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

/// Rewrites the documents at the paths `documents` of this repository.
///
/// `render` makes the text of a document from its path and the sources.
///
/// # Errors
/// Those of `render`, and when a document cannot be written.
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

/// A complaint if the document at `path` differs from its rendered text.
///
/// `cure` says which run the document has to agree with, and which command rewrites it.
#[must_use]
pub fn complaint(path: &str, sources: &Sources, rendered: Result<String, String>, cure: &str) -> Option<String> {
    match rendered {
        Ok(text) if sources.get(path) == Some(&text) => None,
        Ok(_) => Some(format!("{path} has other numbers than {cure}")),
        Err(complaint) => Some(complaint),
    }
}
