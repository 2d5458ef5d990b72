//! Rules for the guide: every document is a chapter, and links lead somewhere.
//!
//! Links of chapters must work in the book too.

use rc_figures::repository::{Sources, has_extension};

const SUMMARY: &str = "docs/SUMMARY.md";

/// Checks that each document is in the summary, and that links between texts work.
pub(super) fn check(sources: &Sources) -> Vec<String> {
    let summary = sources.get(SUMMARY).map_or("", String::as_str);
    let documents =
        sources.keys().filter_map(|path| path.strip_prefix("docs/")).filter(|name| has_extension(name, "md"));
    // Folders of docs/ hold what is no chapter: pictures, and the paper.
    let chapters = documents.filter(|name| *name != "SUMMARY.md" && !name.contains('/'));
    let missing = chapters.filter(|name| !summary.contains(&format!("({name})")));
    let missing = missing.map(|name| format!("docs/{name} is not a chapter; add it to {SUMMARY}"));
    let texts = sources.iter().filter(|(path, _)| has_extension(path, "md"));
    missing.chain(texts.flat_map(|(path, text)| check_links(path, text, sources))).collect()
}

fn check_links(path: &str, text: &str, sources: &Sources) -> Vec<String> {
    let folder = path.rsplit_once('/').map_or("", |(folder, _)| folder);
    let links = text.split("](").skip(1).filter_map(|rest| rest.split(')').next());
    // Folders and pictures are not texts, and other addresses are outside of the repository.
    let files = links.map(|link| link.split('#').next().unwrap_or_default());
    let ours = files.filter(|link| !link.contains("://"));
    let complaint = |link: &str| {
        let target = joined(folder, link);
        if folder == "docs" && !link.is_empty() && !target.starts_with("docs/") {
            return Some(format!("{path}: the link {link} leads out of the book; name the file without a link"));
        }
        let is_text = ["md", "rs"].iter().any(|e| has_extension(link, e));
        (is_text && !sources.contains_key(&target)).then(|| format!("{path}: no file at the link {link}; correct it"))
    };
    ours.filter_map(complaint).collect()
}

/// Path of the target of a link from a file in `folder`.
fn joined(folder: &str, link: &str) -> String {
    let mut parts: Vec<&str> = folder.split('/').filter(|part| !part.is_empty()).collect();
    for part in link.split('/') {
        match part {
            "." => {}
            ".." => drop(parts.pop()),
            name => parts.push(name),
        }
    }
    parts.join("/")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn documents_that_are_no_chapters_and_lost_links_are_found() {
        let mut sources = Sources::new();
        let mut add = |path: &str, text: &str| drop(sources.insert(path.to_owned(), text.to_owned()));
        add(SUMMARY, "- [A](a.md)\n");
        add("docs/a.md", "[up](#use) [picture](images/a.png) [out](https://example.org/b.md)");
        add("README.md", "[a](docs/a.md) [data](data)");
        add("docs/paper/paper.md", "A paper [@a2012].");
        assert_eq!(check(&sources), Vec::<String>::new());
        sources.insert("docs/b.md".to_owned(), "[nowhere](c.md) [out](../data)".to_owned());
        let complaints = check(&sources);
        let expected = ["b.md is not a chapter", "c.md; correct", "../data leads out"];
        assert_eq!(complaints.len(), expected.len(), "{complaints:?}");
        for (complaint, expected) in complaints.iter().zip(expected) {
            assert!(complaint.contains(expected), "{complaints:?}");
        }
    }
}
