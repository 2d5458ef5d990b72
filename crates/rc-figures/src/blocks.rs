//! Documents whose words are people's and whose numbers are a program's: blocks between `<!-- numbers: name -->` and
//! `<!-- end of numbers -->`.

use crate::repository::Sources;

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
