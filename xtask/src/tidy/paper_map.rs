//! Rules for docs/paper-map.md: every equation and figure of the paper has a place.
//!
//! Every place in the map must exist.

use rc_figures::repository::{Sources, has_extension};
use std::collections::BTreeSet;

use super::complaint::Complaint;

const MAP: &str = "docs/paper-map.md";
/// Heading of the rows that are promises, which have no links.
const NOT_YET: &str = "## Not there yet";
const LAST_EQUATION: usize = 14;
const LAST_FIGURE: usize = 8;

/// An equation or figure that a row of the map or a comment names.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
enum Tag {
    Equation(usize),
    Figure(usize),
}

impl std::fmt::Display for Tag {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::Equation(n) => write!(f, "Eq. ({n})"),
            Self::Figure(n) => write!(f, "Fig. {n}"),
        }
    }
}

/// Checks that the map is complete and that its links exist.
///
/// Equations that the code names must exist in the paper.
pub(super) fn check(sources: &Sources) -> Vec<Complaint> {
    let Some(map) = sources.get(MAP) else {
        return vec![format!("{MAP} is missing; restore it from history")];
    };
    let (built, not_yet) = map.split_once(NOT_YET).unwrap_or((map, ""));
    let mut complaints = check_complete(map);
    complaints.extend(rows(built).flat_map(|row| check_links(row, sources)));
    complaints.extend(
        rows(not_yet)
            .filter(|row| row.contains(".rs"))
            .map(|row| format!("{MAP}: `{row}` links to code below `{NOT_YET}`; move the row up, or drop the link")),
    );
    let code = sources.iter().filter(|(path, _)| path.starts_with("crates/") && has_extension(path, "rs"));
    complaints.extend(code.flat_map(|(path, text)| check_tags(path, text)));
    complaints
}

/// Table rows that begin with an equation or figure.
fn rows(text: &str) -> impl Iterator<Item = &str> {
    text.lines().filter(|line| line.starts_with('|') && !tags_of(cell(line, 0)).is_empty())
}

fn cell(row: &str, n: usize) -> &str {
    row.split('|').nth(n + 1).map_or("", str::trim)
}

fn check_complete(map: &str) -> Vec<Complaint> {
    let listed: BTreeSet<Tag> = rows(map).flat_map(|row| tags_of(cell(row, 0))).collect();
    let equations = (1..=LAST_EQUATION).map(Tag::Equation);
    let missing = equations.chain((1..=LAST_FIGURE).map(Tag::Figure)).filter(|tag| !listed.contains(tag));
    missing.map(|tag| format!("{MAP}: no row for {tag}; add one, under `{NOT_YET}` if it is not built")).collect()
}

/// Checks the cells "code" and "test" of a row.
///
/// Their format is: `path`: `Item`, `other item`; `another path`: `Item`. A code file of the row must name one of the
/// row's equations or figures.
fn check_links(row: &str, sources: &Sources) -> Vec<Complaint> {
    let tag = cell(row, 0);
    let mut complaints = Vec::new();
    let code: Vec<&String> = cell(row, 2).split('`').filter_map(|quoted| sources.get(quoted)).collect();
    if !code.is_empty() && code.iter().all(|text| tags_of(text).is_disjoint(&tags_of(tag))) {
        complaints.push(format!("{MAP}: no code file of {tag} names it; name it there, beside the formula"));
    }
    for (column, what) in [(2, "code"), (3, "test")] {
        let mut text = None;
        let mut n_items = 0;
        for quoted in cell(row, column).split('`').skip(1).step_by(2) {
            if quoted.contains('/') {
                text = sources.get(quoted);
                if text.is_none() {
                    complaints.push(format!("{MAP}: {tag} names `{quoted}`, which does not exist; correct the path"));
                }
                continue;
            }
            n_items += 1;
            if text.is_some_and(|text| !defines(text, quoted)) {
                complaints.push(format!("{MAP}: {tag}: no `{quoted}` in the file named before it; correct the name"));
            }
        }
        if n_items == 0 {
            complaints
                .push(format!("{MAP}: {tag} names no {what}; add `path`: `item`, or move the row to `{NOT_YET}`"));
        }
    }
    complaints
}

/// Whether `text` defines `item`. For `Type::item` it must define both.
fn defines(text: &str, item: &str) -> bool {
    const KEYWORDS: &[&str] = &["fn", "struct", "enum", "trait", "const", "type", "mod", "impl"];
    item.split("::").all(|name| {
        let mut places = text.match_indices(name);
        places.any(|(at, _)| {
            let whole = !text[at + name.len()..].starts_with(|c: char| c.is_alphanumeric() || c == '_');
            let before = text[..at].trim_end();
            whole && before.len() < at && KEYWORDS.iter().any(|keyword| before.ends_with(keyword))
        })
    })
}

fn check_tags(path: &str, text: &str) -> Vec<Complaint> {
    let exists = |tag: &Tag| match tag {
        Tag::Equation(n) => (1..=LAST_EQUATION).contains(n),
        Tag::Figure(n) => (1..=LAST_FIGURE).contains(n),
    };
    let unknown = tags_of(text).into_iter().filter(|tag| !exists(tag));
    unknown
        .map(|tag| format!("{path}: {tag} is not in the paper nor in {MAP}; correct it, or name its source"))
        .collect()
}

/// The equations and figures that `text` names.
///
/// Examples are "Eq. 3", "Eq. (3)", "Eq. 3-5", "Eqs. (3), (4)" and "Fig. 4". Numbers like 3.25 belong to other sources.
fn tags_of(text: &str) -> BTreeSet<Tag> {
    let mut tags = BTreeSet::new();
    for (prefix, tag) in [
        ("Eq. ", Tag::Equation as fn(usize) -> Tag),
        ("Eqs. ", Tag::Equation),
        ("Fig. ", Tag::Figure),
        ("Figs. ", Tag::Figure),
    ] {
        for (at, _) in text.match_indices(prefix) {
            tags.extend(numbers(&text[at + prefix.len()..]).into_iter().map(tag));
        }
    }
    tags
}

/// The numbers at the start of `text`: single, in parentheses, ranges, lists.
fn numbers(mut text: &str) -> Vec<usize> {
    let mut found: Vec<usize> = Vec::new();
    let mut in_range = false;
    loop {
        text = text.strip_prefix('(').unwrap_or(text);
        let digits = text.len() - text.trim_start_matches(|c: char| c.is_ascii_digit()).len();
        let Ok(number) = text[..digits].parse() else { return found };
        text = &text[digits..];
        if text.strip_prefix('.').is_some_and(|rest| rest.starts_with(|c: char| c.is_ascii_digit())) {
            return found;
        }
        match found.last() {
            Some(&first) if in_range => found.extend(first + 1..=number),
            _ => found.push(number),
        }
        text = text.strip_prefix(')').unwrap_or(text);
        in_range = text.starts_with(['-', '–']);
        let Some(rest) = ["-", "–", ", ", " and "].iter().find_map(|joint| text.strip_prefix(joint)) else {
            return found;
        };
        text = rest;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const CODE: &str = "//! Sums.\n/// Eq. (5).\npub fn love() {}\nimpl Kernel {\n    fn symbol(&self) {}\n}\n";

    fn sources(map: &str, code: &str) -> Sources {
        let files = [(MAP, map), ("crates/rc-kernel/src/love.rs", code)];
        files.map(|(path, text)| (path.to_owned(), text.to_owned())).into()
    }

    fn complete_map(row: &str) -> String {
        format!("{row}\n{NOT_YET}\n\n| Eq. 1-14 | the rest |\n| Fig. 1-8 | the rest |\n")
    }

    #[test]
    fn a_complete_map_with_good_links_passes() {
        let link = "`crates/rc-kernel/src/love.rs`: `love`, `Kernel::symbol`";
        let map = complete_map(&format!("| Eq. (5) | Love | {link} | {link} |"));
        assert_eq!(check(&sources(&map, CODE)), Vec::<String>::new());
    }

    #[test]
    fn a_missing_equation_is_found() {
        let map = complete_map("").replace("1-14", "1-12, 14");
        assert_eq!(check(&sources(&map, CODE)).len(), 1, "{:?}", check(&sources(&map, CODE)));
    }

    #[test]
    fn links_to_what_is_not_there_are_found() {
        for link in ["`crates/rc-kernel/src/gone.rs`: `love`", "`crates/rc-kernel/src/love.rs`: `lov`", "see above"] {
            let map = complete_map(&format!("| Eq. (5) | Love | {link} | `crates/rc-kernel/src/love.rs`: `love` |"));
            assert_eq!(check(&sources(&map, CODE)).len(), 1, "{link}: {:?}", check(&sources(&map, CODE)));
        }
    }

    #[test]
    fn code_that_does_not_name_its_equation_is_found() {
        let link = "`crates/rc-kernel/src/love.rs`: `love`";
        let map = complete_map(&format!("| Eq. (7) | Love | {link} | {link} |"));
        assert!(check(&sources(&map, CODE))[0].contains("names it"), "{:?}", check(&sources(&map, CODE)));
    }

    #[test]
    fn a_promise_with_a_link_is_found() {
        let map = format!("{}| Fig. 3 | `crates/rc-kernel/src/love.rs` |\n", complete_map(""));
        assert!(check(&sources(&map, CODE))[0].contains("links to code"), "{:?}", check(&sources(&map, CODE)));
    }

    #[test]
    fn an_equation_that_the_paper_does_not_have_is_found() {
        let complaints = check(&sources(&complete_map(""), "//! Eq. (15).\n"));
        assert!(complaints[0].contains("Eq. (15)"), "{complaints:?}");
    }

    #[test]
    fn tags_are_read_in_every_spelling() {
        let equations = |text| tags_of(text).into_iter().collect::<Vec<_>>();
        let expected = |numbers: &[usize]| numbers.iter().map(|&n| Tag::Equation(n)).collect::<Vec<_>>();
        assert_eq!(equations("Eq. 3 and more"), expected(&[3]));
        assert_eq!(equations("(Eq. (9)-(11))"), expected(&[9, 10, 11]));
        assert_eq!(equations("Eq. 1, 8-10"), expected(&[1, 8, 9, 10]));
        assert_eq!(equations("Eqs. 5 and 6"), expected(&[5, 6]));
        assert_eq!(equations("Johnson 1985, Eq. 3.25"), expected(&[]));
        assert_eq!(equations("Fig. 4."), vec![Tag::Figure(4)]);
    }
}
