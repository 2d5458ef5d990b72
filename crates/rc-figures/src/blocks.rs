//! Pages with blocks of numbers that a program writes.
//!
//! People write the text. A block is between `<!-- numbers: name -->` and `<!-- end of numbers -->`. Blocks of archived
//! figures (`shown.rs`) are written by `cargo xtask reproduction` and every `--archive`. `cargo xtask tidy` compares them.

use std::fs;

use anyhow::{Context, Result};

use crate::repository::{self, Sources};
use crate::shown;

/// Beginning of a block, which the name and ` -->` follow.
pub const BEGIN: &str = "<!-- numbers: ";
/// End of a block.
pub const END: &str = "<!-- end of numbers -->";

/// The page with blocks of archived figures.
const PAGE: &str = "docs/reproduction.md";

/// Rewrites the numbers of the archived figures.
///
/// # Errors
/// When a number is missing in an archived run, or the page cannot be written.
pub fn update() -> Result<()> {
    rewrite([PAGE], |_, sources| render(sources))
}

/// A complaint if the page has other numbers than the archived figures.
#[must_use]
pub fn check(sources: &Sources) -> Vec<String> {
    let cure = "data/runs/; run `cargo xtask reproduction`, and review what changed";
    complaint(PAGE, sources, render(sources), cure).into_iter().collect()
}

fn render(sources: &Sources) -> Result<String, String> {
    fill(PAGE, sources, |name| shown::block(name, sources))
}

/// The page at `path` with its blocks filled by `block` from their names.
///
/// # Errors
/// When the page or a marker is missing, and the errors of `block`.
pub fn fill(path: &str, sources: &Sources, block: impl Fn(&str) -> Result<String, String>) -> Result<String, String> {
    let page = sources.get(path).ok_or_else(|| format!("{path} is missing; restore it from history"))?;
    let mut text = String::new();
    let mut rest = page.as_str();
    while let Some((before, after)) = rest.split_once(BEGIN) {
        let (name, after) =
            after.split_once(" -->").ok_or_else(|| format!("{path}: `{BEGIN}` without ` -->`; close it"))?;
        let (_, after) = after.split_once(END).ok_or_else(|| format!("{path}: no `{END}` after {name}; add it"))?;
        text.extend([before, BEGIN, name, " -->\n\n", &block(name)?, "\n", END]);
        rest = after;
    }
    Ok(text + rest)
}

/// Rewrites the pages at the paths `pages` of this repository.
///
/// `render` makes the text of a page from its path and the sources.
///
/// # Errors
/// Those of `render`, and when a page cannot be written.
pub fn rewrite<'a>(
    pages: impl IntoIterator<Item = &'a str>,
    render: impl Fn(&str, &Sources) -> Result<String, String>,
) -> Result<()> {
    let sources = repository::read_sources(&repository::root())?;
    for page in pages {
        let text = render(page, &sources).map_err(anyhow::Error::msg)?;
        let path = repository::root().join(page);
        fs::write(&path, text).with_context(|| format!("could not write {}", path.display()))?;
    }
    Ok(())
}

/// A complaint if the page at `path` differs from its rendered text.
///
/// `cure` says which run the page has to agree with, and which command rewrites it.
#[must_use]
pub fn complaint(path: &str, sources: &Sources, rendered: Result<String, String>, cure: &str) -> Option<String> {
    match rendered {
        Ok(text) if sources.get(path) == Some(&text) => None,
        Ok(_) => Some(format!("{path} has other numbers than {cure}")),
        Err(complaint) => Some(complaint),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Complaints about this page, and the rendered page.
    fn checked(page: &str) -> (Vec<String>, Result<String, String>) {
        let files = [(PAGE, page), ("data/runs/gfmd/run.toml", "seconds = 5.0\n")];
        let sources = files.map(|(path, text)| (path.to_owned(), text.to_owned())).into();
        (check(&sources), render(&sources))
    }

    #[test]
    fn numbers_of_a_page_are_those_of_the_archive() {
        let (complaints, rendered) = checked(&format!("before\n{BEGIN}gfmd-run -->stale{END}\nafter\n"));
        let text = rendered.expect("the run is there");
        assert!(complaints.len() == 1 && complaints[0].contains("cargo xtask reproduction"), "{complaints:?}");
        assert!(text.contains("5.0 s on") && text.contains("after") && !text.contains("stale"), "{text}");
        assert_eq!(checked(&text).0, Vec::<String>::new());
    }

    #[test]
    fn what_is_missing_is_named() {
        for (block, named) in [
            (format!("{BEGIN}fig9 -->{END}"), "`fig9`"),
            (format!("{BEGIN}fig6 -->"), END),
            (format!("{BEGIN}paper-run -->{END}"), "run.toml"),
        ] {
            let (complaints, _) = checked(&block);
            assert!(complaints.len() == 1 && complaints[0].contains(named), "{complaints:?}");
        }
    }
}
