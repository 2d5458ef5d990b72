//! The rooms of rc-solver may use each other only as ARCHITECTURE.md draws it.

use std::collections::{BTreeMap, BTreeSet};

use rc_figures::repository::Sources;

use super::complaint::Complaint;
use super::rust::{tokens, without_tests};

const PAGE: &str = "ARCHITECTURE.md";
const HEADING: &str = "## Rooms of rc-solver";
const FOLDER: &str = "crates/rc-solver/src/";

/// Rooms, and the rooms that each uses.
type Arrows = BTreeMap<String, BTreeSet<String>>;

/// Compares the drawing with the imports of code that is not compiled for tests only.
pub(super) fn check(sources: &Sources) -> Vec<Complaint> {
    let Some(drawn) = sources.get(PAGE).and_then(|page| drawing(page)) else {
        return vec![format!("{PAGE}: the drawing below `{HEADING}` is missing; draw each room and its arrows")];
    };
    compare(&drawn, &used(sources))
}

/// The arrows in the first block below the heading: lines `room ─> room, room`.
///
/// A room may use rooms of lines above it only.
fn drawing(page: &str) -> Option<Vec<(String, BTreeSet<String>)>> {
    let block = page.split_once(HEADING)?.1.split("```").nth(1)?;
    let line = |line: &str| {
        let (room, others) = line.split_once("─>").unwrap_or((line, ""));
        let words = |text: &str| text.split([',', ' ']).filter(|word| !word.is_empty()).map(str::to_owned).collect();
        Some((room.split_whitespace().next()?.to_owned(), words(others)))
    };
    Some(block.lines().filter_map(line).collect())
}

fn used(sources: &Sources) -> Arrows {
    let files = sources.iter().filter_map(|(path, text)| Some((path.strip_prefix(FOLDER)?.split_once('/')?, text)));
    let files: Vec<_> = files.filter(|((_, file), _)| !file.contains("tests")).collect();
    let rooms: BTreeSet<&str> = files.iter().map(|((room, _), _)| *room).collect();
    let mut arrows = Arrows::new();
    for ((room, _), text) in files {
        let tokens = without_tests(&tokens(text));
        let paths = tokens.windows(3).filter(|path| path[0].text == "crate" && path[1].text == "::");
        let others = paths.map(|path| path[2].text).filter(|other| *other != room && rooms.contains(other));
        arrows.entry(room.to_owned()).or_default().extend(others.map(str::to_owned));
    }
    arrows
}

fn compare(drawn: &[(String, BTreeSet<String>)], used: &Arrows) -> Vec<Complaint> {
    let mut complaints = Vec::new();
    for (i, (room, others)) in drawn.iter().enumerate() {
        let is_above = |other: &String| drawn[..i].iter().any(|(above, _)| above == other);
        let found = used.get(room).cloned().unwrap_or_default();
        for other in others.iter().filter(|other| !is_above(other)) {
            complaints.push(format!("{PAGE}: {room} ─> {other} leads down the drawing; rooms use those above them"));
        }
        for other in found.difference(others) {
            complaints.push(format!(
                "{FOLDER}{room}: it uses {other}/, which {PAGE} does not draw; move what needs it, or draw the arrow"
            ));
        }
        for other in others.difference(&found) {
            complaints.push(format!("{PAGE}: {room} ─> {other} is drawn but not used; remove the arrow"));
        }
    }
    let missing = used.keys().filter(|room| !drawn.iter().any(|(name, _)| name == *room));
    complaints.extend(missing.map(|room| format!("{PAGE}: the room {room} of {FOLDER} is not drawn; draw it")));
    complaints
}

#[cfg(test)]
mod tests {
    use super::*;

    fn complaints(page: &str, files: &[(&str, &str)]) -> Vec<Complaint> {
        let page = format!("{HEADING}\n\n```\n{page}\n```\n");
        let files = files.iter().map(|(file, text)| (format!("{FOLDER}{file}"), (*text).to_owned()));
        check(&files.chain([(PAGE.to_owned(), page)]).collect())
    }

    #[test]
    fn arrows_that_are_drawn_pass() {
        let files = [("b/x.rs", "use crate::a::y::Y;\n#[cfg(test)]\nuse crate::c::Z;"), ("a/y.rs", ""), ("c/z.rs", "")];
        assert_eq!(complaints("a\nb ─> a\nc", &files), Vec::<String>::new());
    }

    #[test]
    fn other_arrows_are_found() {
        let files = [("b/x.rs", "fn f() { crate::a::y::g() }"), ("a/y.rs", "")];
        for (page, part) in [
            ("a\nb", "does not draw"),
            ("b ─> a\na", "leads down"),
            ("a\nb ─> a, c\nc", "leads down"),
            ("a\nc\nb ─> a, c", "not used"),
            ("a", "is not drawn"),
        ] {
            let found = complaints(page, &files);
            assert!(found.iter().any(|complaint| complaint.contains(part)), "{page:?}: {found:?}");
        }
    }
}
