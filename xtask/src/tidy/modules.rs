//! Files of a crate do not use each other in circles, and rooms of rc-solver only as ARCHITECTURE.md draws it.
//!
//! `cargo modules` would check circles too, but takes minutes to install and one run for each crate. Here, paths are read
//! from the text: imports name the file that defines an item, so no re-export has to be followed.

use std::collections::{BTreeMap, BTreeSet};

use rc_figures::repository::Sources;

use super::paper_map::defines;

const PAGE: &str = "ARCHITECTURE.md";
const HEADING: &str = "## Rooms of rc-solver";
const SOLVER: &str = "crates/rc-solver/src/";

/// Modules, such as `grid::margin`, and the modules that each uses. The root of a crate has no name.
type Arrows = BTreeMap<String, BTreeSet<String>>;

/// Checks each crate for circles.
pub(super) fn check_circles(sources: &Sources) -> Vec<String> {
    let folders: BTreeSet<&str> = sources.keys().filter_map(|path| Some(folder_and_module(path)?.0)).collect();
    let circle = |folder: &str| {
        let arrows = arrows(folder, sources);
        let files = circle(&arrows);
        let cure = "move what both need to a file of its own";
        (!files.is_empty()).then(|| format!("{folder}: {} use each other in a circle; {cure}", files.join(", ")))
    };
    folders.into_iter().filter_map(circle).collect()
}

/// Compares the drawing of rooms with the paths in the code.
pub(super) fn check_rooms(sources: &Sources) -> Vec<String> {
    let Some(drawn) = sources.get(PAGE).and_then(|page| drawing(page)) else {
        return vec![format!("{PAGE}: the drawing below `{HEADING}` is missing; draw each room and its arrows")];
    };
    let mut used = Arrows::new();
    for (module, others) in arrows(SOLVER, sources) {
        let Some((room, _)) = module.split_once("::") else { continue };
        let others = others.iter().filter_map(|other| Some(other.split_once("::")?.0)).filter(|other| *other != room);
        used.entry(room.to_owned()).or_default().extend(others.map(str::to_owned));
    }
    let mut complaints = Vec::new();
    for (i, (room, others)) in drawn.iter().enumerate() {
        let found = used.remove(room).unwrap_or_default();
        if found != *others {
            complaints.push(format!("{SOLVER}{room} uses {found:?}, {PAGE} draws {others:?}; mend one of them"));
        }
        let is_above = |other: &String| drawn[..i].iter().any(|(above, _)| above == other);
        for other in others.iter().filter(|other| !is_above(other)) {
            complaints.push(format!("{PAGE}: {room} ─> {other} leads down the drawing; rooms use those above them"));
        }
    }
    complaints.extend(used.keys().map(|room| format!("{PAGE}: the room {room} of {SOLVER} is not drawn; draw it")));
    complaints
}

/// The arrows in the first block below the heading: lines `room ─> room, room`.
fn drawing(page: &str) -> Option<Vec<(String, BTreeSet<String>)>> {
    let block = page.split_once(HEADING)?.1.split("```").nth(1)?;
    let line = |line: &str| {
        let (room, others) = line.split_once("─>").unwrap_or((line, ""));
        let words = |text: &str| text.split([',', ' ']).filter(|word| !word.is_empty()).map(str::to_owned).collect();
        Some((room.split_whitespace().next()?.to_owned(), words(others)))
    };
    Some(block.lines().filter_map(line).collect())
}

/// The modules that are in a circle, or between two circles.
fn circle(arrows: &Arrows) -> Vec<&str> {
    let mut left: BTreeSet<&str> = arrows.keys().map(String::as_str).collect();
    loop {
        let leads_to = |from: &str, to: &str| arrows[from].contains(to);
        let is_between =
            |at: &&str| left.iter().any(|other| leads_to(at, other)) && left.iter().any(|other| leads_to(other, at));
        let fewer: BTreeSet<&str> = left.iter().copied().filter(is_between).collect();
        if fewer == left {
            return left.into_iter().collect();
        }
        left = fewer;
    }
}

/// Folder of the sources and module of a Rust file in a crate. Files of tests have none.
fn folder_and_module(path: &str) -> Option<(&str, String)> {
    let (at, _) = path.match_indices("src/").next()?;
    let (folder, file) = path.split_at(at + 4);
    let file = file.strip_suffix(".rs").filter(|file| !file.split('/').any(|part| part.ends_with("tests")))?;
    let name = file.strip_suffix("/mod").unwrap_or(file);
    Some((folder, if ["lib", "main"].contains(&name) { String::new() } else { name.replace('/', "::") }))
}

/// The arrows between the modules of a crate, whose sources are in `folder`.
fn arrows(folder: &str, sources: &Sources) -> Arrows {
    let of_folder = |path: &str| folder_and_module(path).filter(|(of, _)| *of == folder).map(|(_, module)| module);
    let modules = sources.iter().filter_map(|(path, text)| Some((of_folder(path)?, code(text))));
    let modules: BTreeMap<String, &str> = modules.collect();
    let used = |(module, code): (&String, &&str)| {
        let used = paths(code).into_iter().filter_map(|path| resolved(module, &path, &modules));
        (module.clone(), used.filter(|other| other != module).collect())
    };
    modules.iter().map(used).collect()
}

/// The module that defines what a path in the module `from` names.
///
/// `None` for names of other crates, and for those that a module only re-exports.
fn resolved(from: &str, path: &str, modules: &BTreeMap<String, &str>) -> Option<String> {
    let mut at: Vec<&str> = from.split("::").filter(|name| !name.is_empty()).collect();
    let mut item = None;
    for (i, word) in path.split("::").enumerate() {
        match (i, word) {
            (0, "crate") => at.clear(),
            (0, "self") => {}
            (_, "super") => drop(at.pop()),
            _ if modules.contains_key(&[&at[..], &[word]].concat().join("::")) => at.push(word),
            (0, _) => return None,
            _ => {
                item = Some(word);
                break;
            }
        }
    }
    let module = at.join("::");
    let code = modules.get(&module)?;
    item.is_none_or(|item| defines(code, item)).then_some(module)
}

/// The code of a file before its tests.
fn code(text: &str) -> &str {
    text.split("mod tests {").next().unwrap_or_default()
}

/// The paths `a::b` in code, outside of what it re-exports.
fn paths(code: &str) -> Vec<String> {
    let is_in_path = |c: char| c.is_alphanumeric() || c == '_' || c == ':';
    let (mut found, mut is_reexport) = (Vec::new(), false);
    // What each open brace puts before the names in it: the path of a list, or nothing.
    let mut before = vec![String::new()];
    for line in code.lines().map(|line| line.split("//").next().unwrap_or_default()) {
        // A visibility uses no module.
        let line = line.split_once("pub(in ").and_then(|(_, rest)| rest.split_once(')')).map_or(line, |(_, rest)| rest);
        is_reexport |= line.trim_start().starts_with("pub") && line.contains(" use ");
        if is_reexport {
            is_reexport = !line.contains(';');
            continue;
        }
        for piece in line.split_inclusive(|c| !is_in_path(c)) {
            let word = piece.trim_end_matches(|c| !is_in_path(c));
            let path = before.last().map_or("", String::as_str).to_owned() + word;
            if piece.ends_with('{') {
                before.push(if word.ends_with("::") { path.clone() } else { String::new() });
            }
            if piece.ends_with('}') && before.len() > 1 {
                before.pop();
            }
            found.extend(Some(path).filter(|path| !word.is_empty() && path.contains("::") && !path.ends_with(':')));
        }
    }
    found
}

#[cfg(test)]
mod tests {
    use super::*;

    fn sources(files: &[(&str, &str)]) -> Sources {
        let files = files.iter().map(|(file, text)| (format!("{SOLVER}{file}"), (*text).to_owned()));
        files.collect()
    }

    #[test]
    fn circles_are_found_and_declarations_comments_and_tests_are_none() {
        let found = |a: &str, b: &str| {
            let (a, b) = (format!("struct T;\n{a}"), format!("mod c;\nstruct S;\n{b}"));
            check_circles(&sources(&[
                ("lib.rs", "mod a; mod b;\npub use b::S;"),
                ("a.rs", &a),
                ("b/mod.rs", &b),
                ("b/c.rs", ""),
            ]))
        };
        for (a, b) in [
            ("use crate::b::S;", "use crate::a::T;"),
            ("use crate::{\n    b::{S, c},\n};", "fn f() -> super::a::T {}"),
            ("fn f(s: crate::b::S) {}", "use c::U;\nuse super::a;"),
        ] {
            let complaint =
                format!("{SOLVER}: a, b use each other in a circle; move what both need to a file of its own");
            assert_eq!(found(a, b), [complaint], "{a} {b}");
        }
        for b in [
            "// crate::a::T",
            "pub(crate) use crate::a::T;",
            "pub(in crate::a) fn f() {}",
            "#[cfg(test)]\nmod tests {\n    use crate::a::T;\n}",
            "use crate::S;",
            "use a::T;",
        ] {
            assert_eq!(found("use crate::b::S;", b), Vec::<String>::new(), "{b}");
        }
    }

    #[test]
    fn a_child_may_use_its_parent_only_if_the_parent_does_not_use_it() {
        let of = |parent: &str| {
            let parent = format!("mod b;\nstruct S;\n{parent}");
            check_circles(&sources(&[("lib.rs", ""), ("a/mod.rs", &parent), ("a/b.rs", "struct T;\nuse super::S;")]))
        };
        assert_eq!(of("pub(crate) use b::T;"), Vec::<String>::new());
        assert_eq!(of("use b::T;").len(), 1);
    }

    #[test]
    fn rooms_use_each_other_as_drawn() {
        let complaints = |page: &str| {
            let b = "use crate::a::y::Y;\nuse crate::lone::f;";
            let rooms = [("a/mod.rs", ""), ("a/y.rs", "struct Y;"), ("b/x.rs", b), ("lone.rs", "fn f() {}")];
            let page = format!("{HEADING}\n\n```\n{page}\n```\n");
            check_rooms(&sources(&rooms).into_iter().chain([(PAGE.to_owned(), page)]).collect())
        };
        assert_eq!(complaints("a\nb ─> a"), Vec::<String>::new());
        for (page, part) in [
            ("a\nb", "draws {}"),
            ("b ─> a\na", "leads down"),
            ("c\na\nb ─> a, c", "uses {\"a\"}"),
            ("a", "is not drawn"),
        ] {
            let found = complaints(page);
            assert!(found.len() == 1 && found[0].contains(part), "{page:?}: {found:?}");
        }
    }
}
