//! Links from items in the paper map to their lines in the crates' documentation.

use rc_figures::repository::Sources;

/// `page` with links at the items that follow the path of a library's file.
///
/// An example is `` `crates/rc-core/src/grid.rs`: `Grid` ``. A link leads to the item's line in rustdoc's page of the
/// source. These pages are in the folder `doc` beside the book.
pub(super) fn to_lines(page: &str, sources: &Sources) -> String {
    let mut linked = String::new();
    let mut file = None;
    for (place, part) in page.split('`').enumerate() {
        let quoted = place % 2 == 1;
        if quoted && part.contains('/') {
            file = sources.get(part).zip(shown(part));
        }
        let link = file.as_ref().filter(|_| quoted && !part.contains('/'));
        let link = link.and_then(|(text, shown)| Some(format!("[`{part}`]({shown}#{})", line_of(text, part)?)));
        match link {
            Some(link) => linked.push_str(&link),
            None if quoted => linked.extend(["`", part, "`"]),
            None => linked.push_str(part),
        }
    }
    linked
}

/// Path from the book to rustdoc's page of the source file at `path`.
///
/// `None` if the file is not a library's, or has only tests, which rustdoc does not see.
fn shown(path: &str) -> Option<String> {
    let (name, file) = path.strip_prefix("crates/")?.split_once("/src/")?;
    let has_only_tests = file.split('/').any(|part| part == "tests" || part == "tests.rs");
    (!has_only_tests).then(|| format!("../doc/src/{}/{file}.html", name.replace('-', "_")))
}

/// Number of the line that defines `item`, from 1.
fn line_of(text: &str, item: &str) -> Option<usize> {
    const KEYWORDS: &[&str] = &["fn", "struct", "enum", "trait", "const", "type", "mod"];
    let defines = |line: &str| {
        let mut words = line.split(|c: char| !(c.is_alphanumeric() || c == '_')).filter(|word| !word.is_empty());
        let is_comment = line.trim_start().starts_with("//");
        !is_comment && words.any(|word| KEYWORDS.contains(&word)) && words.next() == Some(item)
    };
    text.lines().position(defines).map(|line| line + 1)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn items_of_libraries_lead_to_their_lines() {
        let text = "//! fn love\n\n/// Love.\npub fn love(x: f64) {}\n".to_owned();
        let tests = ["crates/rc-a/tests/t.rs", "crates/rc-a/src/b/tests.rs"];
        let sources: Sources =
            ["crates/rc-a/src/b.rs"].iter().chain(&tests).map(|path| ((*path).to_owned(), text.clone())).collect();
        let page = "| Eq. (5) | `crates/rc-a/src/b.rs`: `love`, `hate` |";
        let expected = "| Eq. (5) | `crates/rc-a/src/b.rs`: [`love`](../doc/src/rc_a/b.rs.html#4), `hate` |";
        assert_eq!(to_lines(page, &sources), expected);
        for path in tests {
            let page = format!("| `{path}`: `love` |");
            assert_eq!(to_lines(&page, &sources), page);
        }
    }
}
