//! Pages with blocks of numbers that a program writes.
//!
//! People write the text. A block is between `<!-- numbers: name -->` and `<!-- end of numbers -->`. Blocks of archived
//! figures (`shown.rs`) may stand on every page. `cargo xtask reproduction` and every `--archive` write them, and
//! `cargo xtask tidy` compares them.

use std::fs;

use anyhow::{Context, Result};

use crate::repository::{self, Sources};
use crate::shown;

/// Beginning of a block, which the name and ` -->` follow.
pub const BEGIN: &str = "<!-- numbers: ";
/// End of a block.
pub const END: &str = "<!-- end of numbers -->";

/// The pages with blocks of archived figures. Other programs write the other blocks of the second one.
const PAGES: [&str; 2] = ["docs/reproduction.md", "docs/benchmarks.md"];

/// Rewrites the numbers of the archived figures.
///
/// # Errors
/// When a number is missing in an archived run, or a page cannot be written.
pub fn update() -> Result<()> {
    rewrite(PAGES, render)
}

/// Complaints about pages whose numbers differ from the archived figures.
#[must_use]
pub fn check(sources: &Sources) -> Vec<String> {
    let cure = "data/runs/; run `cargo xtask reproduction`, and review what changed";
    PAGES.into_iter().filter_map(|page| complaint(page, sources, render(page, sources), cure)).collect()
}

/// A page of [`PAGES`] with the numbers of the archived figures.
fn render(page: &str, sources: &Sources) -> Result<String, String> {
    filled(page, sources, |name| match page {
        "docs/reproduction.md" => {
            Err(format!("{page}: no numbers are called `{name}`; add a table in crates/rc-figures/src/shown.rs"))
        }
        _ => Ok(None),
    })
}

/// The page at `path` with its blocks filled: those of archived figures, and all others by `block` from their names.
///
/// # Errors
/// When the page or a marker is missing, and the errors of `block`.
pub fn fill(path: &str, sources: &Sources, block: impl Fn(&str) -> Result<String, String>) -> Result<String, String> {
    filled(path, sources, |name| block(name).map(Some))
}

/// As [`fill`]. A block stays as it is if `block` returns `None`.
fn filled(
    path: &str,
    sources: &Sources,
    block: impl Fn(&str) -> Result<Option<String>, String>,
) -> Result<String, String> {
    let page = sources.get(path).ok_or_else(|| format!("{path} is missing; restore it from history"))?;
    let mut text = String::new();
    let mut rest = page.as_str();
    while let Some((before, after)) = rest.split_once(BEGIN) {
        let (name, after) =
            after.split_once(" -->").ok_or_else(|| format!("{path}: `{BEGIN}` without ` -->`; close it"))?;
        let (old, after) = after.split_once(END).ok_or_else(|| format!("{path}: no `{END}` after {name}; add it"))?;
        let new = shown::block(name, sources).map_or_else(|| block(name), |text| text.map(Some))?;
        let inside = new.map_or_else(|| old.to_owned(), |text| format!("\n\n{text}\n"));
        text.extend([before, BEGIN, name, " -->", &inside, END]);
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

    /// Complaints about these two pages, and the rendered pages.
    fn checked(pages: [&str; 2]) -> (Vec<String>, [Result<String, String>; 2]) {
        let mut sources: Sources =
            PAGES.into_iter().zip(pages).map(|(path, text)| (path.into(), text.into())).collect();
        sources.insert("data/runs/gfmd/run.toml".to_owned(), "seconds = 5.0\n".to_owned());
        (check(&sources), PAGES.map(|page| render(page, &sources)))
    }

    #[test]
    fn figures_may_stand_beside_blocks_of_other_programs() {
        let page = format!("before\n{BEGIN}gfmd-run -->stale{END}\n{BEGIN}bench-times -->theirs{END}\n");
        let (complaints, [_, rendered]) = checked(["no numbers", &page]);
        let text = rendered.expect("the run is there");
        assert!(complaints.len() == 1 && complaints[0].contains("cargo xtask reproduction"), "{complaints:?}");
        assert!(text.contains("5.0 s on") && text.contains("theirs") && !text.contains("stale"), "{text}");
        assert_eq!(checked(["no numbers", &text]).0, Vec::<String>::new());
    }

    #[test]
    fn what_is_missing_is_named() {
        for (block, named) in [
            (format!("{BEGIN}fig9 -->{END}"), "`fig9`"),
            (format!("{BEGIN}fig6 -->"), END),
            (format!("{BEGIN}paper-run -->{END}"), "run.toml"),
        ] {
            let (complaints, _) = checked([&block, "no numbers"]);
            assert!(complaints.len() == 1 && complaints[0].contains(named), "{complaints:?}");
        }
    }
}
