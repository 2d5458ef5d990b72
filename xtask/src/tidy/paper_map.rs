//! Rules for docs/paper-map.md: every equation and figure of the paper has a place, and every place exists.
//!
//! The function that evaluates an equation has the tag `Eq. (n)` in its documentation, and nothing else has it.

use rc_figures::repository::{Sources, has_extension};

const MAP: &str = "docs/paper-map.md";
const LAST_EQUATION: usize = 14;
const LAST_FIGURE: usize = 8;

/// Checks rows, links and tags.
pub(super) fn check(sources: &Sources) -> Vec<String> {
    let map = sources.get(MAP).map_or("", String::as_str);
    let row = |name: &str| map.lines().find(|line| line.starts_with(&format!("| {name} |")));
    let figures = (1..=LAST_FIGURE).map(|n| format!("Fig. {n}"));
    let missing =
        figures.filter(|figure| row(figure).is_none()).map(|figure| format!("{MAP}: no row for {figure}; add it"));
    let equations = (1..=LAST_EQUATION).filter_map(|n| {
        let tag = format!("Eq. ({n})");
        let found = tagged(&tag, sources);
        let [named] = &found[..] else {
            return Some(format!("{tag} is a tag at {found:?}; the function that evaluates it has the only one"));
        };
        let is_there = row(&tag).is_some_and(|row| row.contains(named));
        (!is_there).then(|| format!("{MAP}: the row of {tag} does not name {named}, which has its tag; add it"))
    });
    let rows = map.lines().filter(|line| line.starts_with("| ") && line.contains(".rs`"));
    missing.chain(equations).chain(rows.flat_map(|row| check_row(row, sources))).collect()
}

/// Checks the cells "code" and "test" of a row.
///
/// Their format is: `path`: `Item`, `other item`; `another path`: `Item`.
fn check_row(row: &str, sources: &Sources) -> Vec<String> {
    let mut complaints = Vec::new();
    for cell in row.split('|').skip(3).take(2) {
        let (mut text, mut n_items) = (None, 0);
        for quoted in cell.split('`').skip(1).step_by(2) {
            if quoted.contains('/') {
                text = sources.get(quoted);
            } else {
                n_items += 1;
            }
            if text.is_none_or(|text| !quoted.contains('/') && !defines(text, quoted)) {
                complaints.push(format!("{MAP}: there is no {quoted}, or not in the file before it; correct the name"));
            }
        }
        if n_items == 0 {
            complaints.push(format!("{MAP}: no `path`: `item` in the cell{cell}of {row}; add it"));
        }
    }
    complaints
}

/// Whether `text` defines `item`.
pub(super) fn defines(text: &str, item: &str) -> bool {
    const KEYWORDS: &[&str] = &["fn", "struct", "enum", "trait", "const", "static", "type", "mod", "macro_rules!"];
    text.match_indices(item).any(|(at, _)| {
        let is_whole = !text[at + item.len()..].starts_with(|c: char| c.is_alphanumeric() || c == '_');
        is_whole && KEYWORDS.iter().any(|keyword| text[..at].ends_with(&format!("{keyword} ")))
    })
}

/// Path and name of each function with a tag, as the map writes them; of other places a remark.
fn tagged(tag: &str, sources: &Sources) -> Vec<String> {
    let mut found = Vec::new();
    for (path, text) in sources.iter().filter(|(path, _)| path.starts_with("crates/") && has_extension(path, "rs")) {
        for (at, _) in text.match_indices(tag) {
            let is_documentation = text[..at].lines().last().is_some_and(|line| line.trim_start().starts_with("///"));
            let item = text[at..]
                .lines()
                .skip(1)
                .map(str::trim)
                .find(|line| !line.starts_with("///") && !line.starts_with("#["));
            let function = item.filter(|_| is_documentation).and_then(|item| item.split_once("fn "));
            let name = function.and_then(|(_, rest)| rest.split(|c: char| !c.is_alphanumeric() && c != '_').next());
            found.push(name.map_or(format!("another place of {path}"), |name| format!("`{path}`: `{name}`")));
        }
    }
    found
}

#[cfg(test)]
mod tests {
    use super::*;

    const PATH: &str = "crates/rc-kernel/src/love.rs";

    /// Complaints about a map whose row of Eq. 5 has `link`, and code whose tag of Eq. 5 is in `tag`.
    fn complaints(link: &str, tag: &str) -> Vec<String> {
        let good = format!("`{PATH}`: `love`");
        let mut map = vec![format!("| Eq. (5) | Love | {link} | {good} |")];
        let mut code = vec![format!("{tag}\n#[must_use]\npub fn love() {{}}")];
        for n in (1..=LAST_EQUATION).filter(|n| *n != 5) {
            map.push(format!("| Eq. ({n}) | {n} | `{PATH}`: `f{n}` | {good} |"));
            code.push(format!("/// Eq. ({n}).\nfn f{n}() {{}}"));
        }
        map.extend((1..=LAST_FIGURE).map(|n| format!("| Fig. {n} | {n} | {good} | {good} |")));
        check(&[(MAP, map), (PATH, code)].map(|(path, lines)| (path.to_owned(), lines.join("\n"))).into())
    }

    #[test]
    fn one_tag_at_the_function_of_the_map_passes() {
        assert_eq!(complaints(&format!("`{PATH}`: `love`"), "/// Eq. (5).\n/// More."), Vec::<String>::new());
    }

    #[test]
    fn missing_repeated_misplaced_and_unnamed_places_are_found() {
        let good = format!("`{PATH}`: `love`");
        for (link, tag) in [
            (good.as_str(), "/// Eq. 5."),
            (&good, "/// Eq. (5), Eq. (5)."),
            (&good, "// Eq. (5)"),
            (&good, "/// Eq. (5).\nstruct Love;"),
            (&good.replace("love.rs", "gone.rs"), "/// Eq. (5)."),
            (&good.replace(": `love`", ": `hate`"), "/// Eq. (5)."),
            (&format!("`{PATH}`"), "/// Eq. (5)."),
        ] {
            assert!(!complaints(link, tag).is_empty(), "{link} {tag}");
        }
    }
}
