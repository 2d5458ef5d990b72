//! Files of a crate do not use each other in circles, and rooms of rc-solver only as ARCHITECTURE.md draws it.
//!
//! `cargo modules` would check circles too, but takes minutes to install and one run for each crate. Here, paths are read
//! from the text, and re-exports (`pub use`) are followed to the file that defines an item.

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

/// A path in code.
struct Named {
    path: String,
    /// The word by which the code names it, the last of the path or that after `as`.
    name: String,
    is_reexport: bool,
}

/// The code of each module before its tests and without comments, and the paths in it.
type Modules = BTreeMap<String, (String, Vec<Named>)>;

/// The arrows between the modules of a crate, whose sources are in `folder`.
fn arrows(folder: &str, sources: &Sources) -> Arrows {
    let of_folder = |path: &str| folder_and_module(path).filter(|(of, _)| *of == folder).map(|(_, module)| module);
    // From last to first, so that the root is lib.rs where there is main.rs too.
    let modules = sources.iter().rev().filter_map(|(path, text)| Some((of_folder(path)?, read(text))));
    let modules: Modules = modules.collect();
    let used = |(name, (_, names)): (&String, &(String, Vec<Named>))| {
        let uses = names.iter().filter(|named| !named.is_reexport);
        let used = uses.filter_map(|named| resolved(name, &named.path, &modules, HOPS));
        (name.clone(), used.filter(|other| other != name).collect())
    };
    modules.iter().map(used).collect()
}

/// How many re-exports lead from a name to its item. Lists of all names (`*`) could lead on without end.
const HOPS: usize = 4;

/// The module that defines what a path in the module `from` names; `None` for names of other crates.
fn resolved(from: &str, path: &str, modules: &Modules, hops: usize) -> Option<String> {
    let mut at: Vec<&str> = from.split("::").filter(|name| !name.is_empty()).collect();
    let words: Vec<&str> = path.trim_start_matches('*').split("::").collect();
    for (i, word) in words.iter().enumerate() {
        match (i, *word) {
            (0, "crate") => at.clear(),
            (_, "self" | "*") => {}
            (_, "super") => drop(at.pop()),
            _ if modules.contains_key(&[&at[..], &[word]].concat().join("::")) => at.push(word),
            (0, _) => return None,
            _ => return defining(&at.join("::"), &words[i..], modules, hops),
        }
    }
    Some(at.join("::"))
}

/// The module that defines the first of `words`, a name in `module` or one that it re-exports.
fn defining(module: &str, words: &[&str], modules: &Modules, hops: usize) -> Option<String> {
    let (code, names) = modules.get(module)?;
    if defines(code, words[0]) {
        return Some(module.to_owned());
    }
    let hops = hops.checked_sub(1)?;
    names.iter().filter(|named| named.is_reexport).find_map(|Named { path, name, .. }| match &**name {
        "*" => resolved(module, &path.replace('*', &words.join("::")), modules, hops),
        name if name == words[0] => resolved(module, &[&[&**path], &words[1..]].concat().join("::"), modules, hops),
        _ => None,
    })
}

fn read(text: &str) -> (String, Vec<Named>) {
    let code = text.split("mod tests {").next().unwrap_or_default();
    let code: Vec<&str> = code.lines().map(|line| line.split("//").next().unwrap_or_default()).collect();
    (code.join("\n"), names(&code))
}

/// The paths `a::b` in lines of code.
fn names(code: &[&str]) -> Vec<Named> {
    let is_in_path = |c: char| c.is_alphanumeric() || "_:*".contains(c);
    let (mut found, mut is_reexport, mut is_renamed): (Vec<Named>, _, _) = (Vec::new(), false, false);
    // What each open brace puts before the names in it: the path of a list, or nothing.
    let mut before = vec![String::new()];
    for line in code {
        // A visibility uses no module.
        let line =
            line.split_once("pub(in ").and_then(|(_, rest)| rest.split_once(')')).map_or(*line, |(_, rest)| rest);
        is_reexport |= line.trim_start().starts_with("pub") && line.contains(" use ");
        for piece in line.split_inclusive(|c| !is_in_path(c)) {
            let word = piece.trim_end_matches(|c| !is_in_path(c));
            let path = before.last().map_or("", String::as_str).to_owned() + word;
            if piece.ends_with('{') {
                before.push(if word.ends_with("::") { path.clone() } else { String::new() });
            }
            if piece.ends_with('}') && before.len() > 1 {
                before.pop();
            }
            if let Some(last) = found.last_mut().filter(|_| is_renamed) {
                word.clone_into(&mut last.name);
            } else if !["", "as"].contains(&word) && (is_reexport || path.contains("::")) && !path.ends_with(':') {
                let name = path.rsplit("::").next().unwrap_or_default().to_owned();
                found.push(Named { path, name, is_reexport });
            }
            is_renamed = word == "as" && is_reexport;
        }
        is_reexport &= !line.contains(';');
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
            "use a::T;",
        ] {
            assert_eq!(found("use crate::b::S;", b), Vec::<String>::new(), "{b}");
        }
    }

    #[test]
    fn circles_through_reexports_are_found() {
        for (root, b) in [
            ("pub use a::T;", "use crate::T;"),
            ("pub use a::T as V;", "fn f(v: crate::V) {}"),
            ("pub(crate) use self::a::{U, T};", "fn f() { *super::T; }"),
            ("pub use c::{\n    U,\n    *,\n};", "use crate::T;"),
            ("pub use a as d;", "use crate::d::*;"),
        ] {
            let a = "use crate::b::S;\npub static T: U = 1;";
            let c = "pub use crate::a::*;\npub use super::*;";
            let b = format!("struct S;\n{b}");
            let found = check_circles(&sources(&[("lib.rs", root), ("a.rs", a), ("b.rs", &b), ("c.rs", c)]));
            assert!(found.len() == 1 && found[0].contains(": a, b use"), "{root} {b}: {found:?}");
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
