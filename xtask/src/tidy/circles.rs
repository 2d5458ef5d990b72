//! Modules of a crate must not use each other in a circle.
//!
//! A file uses another when a path in it (`use`, or in the code) names an item that the other file defines. A re-export
//! leads to the file that defines the item. A module that declares a child and re-exports from it does not thereby use
//! it. Code that is compiled for tests only does not count.

use std::collections::{BTreeMap, BTreeSet, VecDeque};

use rc_figures::repository::Sources;

use super::complaint::Complaint;
use super::rust::{Token, closing, tokens, without_tests};

/// Keywords before the name of an item.
const KEYWORDS: &[&str] = &["fn", "struct", "enum", "trait", "type", "const", "static", "union", "macro_rules", "mod"];

/// Checks the modules below each `lib.rs` and `main.rs`.
pub(super) fn check(sources: &Sources) -> Vec<Complaint> {
    let roots = sources.keys().filter(|path| path.ends_with("/lib.rs") || path.ends_with("/main.rs"));
    roots.flat_map(|root| Crate::read(root, sources).circles()).collect()
}

/// The modules of a crate, its root first.
struct Crate<'a> {
    modules: Vec<Module<'a>>,
}

/// A file of the crate.
#[derive(Default)]
struct Module<'a> {
    path: String,
    parent: usize,
    /// Modules that it declares and that are in other files.
    children: BTreeMap<&'a str, usize>,
    /// Names of its items.
    items: BTreeSet<&'a str>,
    imports: Vec<Import<'a>>,
    /// Paths in its code that begin with `crate`, `self`, `super` or a child.
    paths: Vec<Vec<&'a str>>,
    /// Words outside of imports.
    words: BTreeSet<&'a str>,
}

/// One name that a `use` brings in; `*` for all.
#[derive(Clone, Debug, PartialEq, Eq)]
struct Import<'a> {
    path: Vec<&'a str>,
    name: &'a str,
    /// Whether other modules see it too.
    is_public: bool,
}

impl<'a> Crate<'a> {
    fn read(root: &str, sources: &'a Sources) -> Self {
        let mut modules = vec![Module { path: root.to_owned(), ..Module::default() }];
        let mut next = 0;
        while next < modules.len() {
            let path = modules[next].path.clone();
            let text = sources.get(&path).map_or("", String::as_str);
            let tokens = without_tests(&tokens(text));
            for name in modules[next].read(&tokens) {
                let (folder, file) = path.rsplit_once('/').unwrap_or(("", &path));
                let stem = file.trim_end_matches(".rs");
                let of_folder = next == 0 || stem == "mod";
                let folder = if of_folder { folder.to_owned() } else { format!("{folder}/{stem}") };
                let files = [format!("{folder}/{name}.rs"), format!("{folder}/{name}/mod.rs")];
                if let Some(path) = files.into_iter().find(|file| sources.contains_key(file)) {
                    let child = modules.len();
                    modules[next].children.insert(name, child);
                    modules.push(Module { path, parent: next, ..Module::default() });
                }
            }
            next += 1;
        }
        let mut found = Self { modules };
        for module in &mut found.modules {
            let children = &module.children;
            module.paths.retain(|path| matches!(path[0], "crate" | "self" | "super") || children.contains_key(path[0]));
        }
        found
    }

    /// Index of the file that defines the item at `path` in `module`.
    ///
    /// `None` for items of other crates.
    fn resolve(&self, module: usize, path: &[&str], depth: usize) -> Option<usize> {
        let mut at = match path[0] {
            "crate" => 0,
            "self" => module,
            "super" => self.modules[module].parent,
            name => *self.modules[module].children.get(name)?,
        };
        for name in &path[1..] {
            match (*name, self.modules[at].children.get(name)) {
                ("super", _) => at = self.modules[at].parent,
                ("self" | "*", _) => {}
                (_, Some(child)) => at = *child,
                _ => return self.item(at, name, depth),
            }
        }
        Some(at)
    }

    /// Index of the file that defines the item `name`, which is visible in `module`.
    fn item(&self, module: usize, name: &str, depth: usize) -> Option<usize> {
        let Module { items, imports, .. } = &self.modules[module];
        // Real chains of re-exports are shorter.
        if items.contains(name) || depth > 8 {
            return Some(module);
        }
        if let Some(import) = imports.iter().find(|import| import.name == name) {
            return self.resolve(module, &import.path, depth + 1);
        }
        let globs = imports.iter().filter(|import| import.name == "*");
        let of_globs = globs.filter_map(|glob| self.resolve(module, &glob.path, depth + 1));
        let mut defining = of_globs.filter(|file| self.modules[*file].items.contains(name));
        // An exported macro is visible in the root, wherever it is defined.
        let exported = || self.modules.iter().position(|module| module.items.contains(name));
        defining.next().or_else(|| if module == 0 { exported() } else { None }).or(Some(module))
    }

    /// The files that each file uses, each with a path that shows the use.
    fn arrows(&self) -> Vec<BTreeMap<usize, String>> {
        let arrows_of = |(index, module): (usize, &Module<'a>)| {
            let imports = module.imports.iter();
            let used = imports.filter(|import| !import.is_public || module.words.contains(import.name));
            let paths = used.map(|import| &import.path).chain(&module.paths);
            let arrow = |path: &Vec<&str>| Some((self.resolve(index, path, 0)?, path.join("::")));
            paths.filter_map(arrow).filter(|(to, _)| *to != index).collect()
        };
        self.modules.iter().enumerate().map(arrows_of).collect()
    }

    /// A complaint for each set of files that use each other.
    ///
    /// Each file of a set uses all others, directly or through others.
    fn circles(&self) -> Vec<Complaint> {
        let arrows = self.arrows();
        let mut complaints = Vec::new();
        let mut seen = BTreeSet::new();
        for start in 0..arrows.len() {
            let Some(way) = shortest_circle(start, &arrows).filter(|_| !seen.contains(&start)) else { continue };
            let together =
                reachable(start, &arrows).into_iter().filter(|other| reachable(*other, &arrows).contains(&start));
            let together: Vec<usize> = together.collect();
            let step = |pair: &[usize]| {
                let [from, to] = [pair[0], pair[1]].map(|index| self.modules[index].path.as_str());
                format!("{from} uses {to} (`{}`)", arrows[pair[0]][&pair[1]])
            };
            let steps: Vec<String> = way.windows(2).map(step).collect();
            complaints.push(format!(
                "{} files use each other in circles, for example {}; move what both need to a file of its own",
                together.len(),
                steps.join(", ")
            ));
            seen.extend(together);
        }
        complaints
    }
}

/// Files that `start` uses, directly or through others.
fn reachable(start: usize, arrows: &[BTreeMap<usize, String>]) -> BTreeSet<usize> {
    let (mut reached, mut open) = (BTreeSet::new(), vec![start]);
    while let Some(at) = open.pop() {
        open.extend(arrows[at].keys().filter(|to| reached.insert(**to)));
    }
    reached
}

/// The shortest way from `start` back to it.
fn shortest_circle(start: usize, arrows: &[BTreeMap<usize, String>]) -> Option<Vec<usize>> {
    let mut ways = VecDeque::from([vec![start]]);
    let mut reached = BTreeSet::new();
    while let Some(way) = ways.pop_front() {
        for &to in arrows[*way.last()?].keys() {
            let longer = [&way[..], &[to]].concat();
            if to == start {
                return Some(longer);
            }
            if reached.insert(to) {
                ways.push_back(longer);
            }
        }
    }
    None
}

impl<'a> Module<'a> {
    /// Reads the words of the file, and returns the modules that it declares.
    ///
    /// These are the modules in other files.
    fn read(&mut self, tokens: &[Token<'a>]) -> Vec<&'a str> {
        let text = |at: usize| tokens.get(at).map_or("", |token| token.text);
        let mut children = Vec::new();
        // Ends of the modules within the file around the present place.
        let mut inline: Vec<usize> = Vec::new();
        let mut at = 0;
        while at < tokens.len() {
            inline.retain(|end| at < *end);
            match text(at) {
                "use" => {
                    let before = if at > 0 { text(at - 1) } else { "" };
                    let is_public = before == "pub" || before == ")";
                    at = import_tree(tokens, at + 1, &[], is_public, &mut self.imports);
                    continue;
                }
                "mod" if text(at + 2) == ";" => children.push(text(at + 1)),
                "mod" if text(at + 2) == "{" => inline.push(closing(tokens, at + 2)),
                // A visibility such as `pub(in crate::a)` does not use a module.
                "in" if at > 1 && text(at - 1) == "(" && text(at - 2) == "pub" => at = closing(tokens, at - 1),
                _ => {}
            }
            if KEYWORDS.contains(&text(at)) {
                let name = text(at + 1);
                self.items.insert(if name == "!" { text(at + 2) } else { name });
            } else if at == 0 || text(at - 1) != "::" {
                let is_name = |at: usize| text(at).starts_with(|c: char| c.is_alphabetic() || c == '_');
                let n_names = (0..tokens.len())
                    .take_while(|i| *i == 0 || text(at + 2 * i - 1) == "::" && is_name(at + 2 * i))
                    .count();
                let path: Vec<&str> = (0..n_names).map(|i| text(at + 2 * i)).collect();
                // In a module within the file, the first `super` is the file itself.
                let inner = inline.len().min(path.iter().take_while(|name| **name == "super").count());
                let path = [&["self"][..usize::from(inner > 0)], &path[inner..]].concat();
                if n_names > 1 && path.len() > 1 {
                    self.paths.push(path);
                }
            }
            if !KEYWORDS.contains(&if at > 0 { text(at - 1) } else { "" }) {
                self.words.insert(text(at));
            }
            at += 1;
        }
        children
    }
}

/// Reads the names of a `use` from `at` on, and returns their end.
///
/// `before` is the path before these names.
fn import_tree<'a>(
    tokens: &[Token<'a>],
    at: usize,
    before: &[&'a str],
    is_public: bool,
    imports: &mut Vec<Import<'a>>,
) -> usize {
    let text = |at: usize| tokens.get(at).map_or(";", |token| token.text);
    let mut at = at;
    let mut path = before.to_vec();
    loop {
        match text(at) {
            "{" => {
                at += 1;
                while !matches!(text(at), "}" | ";") {
                    at = import_tree(tokens, at, &path, is_public, imports);
                    at += usize::from(text(at) == ",");
                }
                return at + 1;
            }
            "::" => at += 1,
            "as" => {
                imports.push(Import { path, name: text(at + 1), is_public });
                return at + 2;
            }
            "," | "}" | ";" => {
                let name = path.iter().rfind(|name| **name != "self").copied().unwrap_or("self");
                imports.push(Import { path, name, is_public });
                return at;
            }
            name => {
                path.push(name);
                at += 1;
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn complaints(files: &[(&str, &str)]) -> Vec<Complaint> {
        check(&files.iter().map(|(path, text)| (format!("src/{path}"), (*text).to_owned())).collect())
    }

    #[test]
    fn two_files_that_use_each_other_are_found_with_their_imports() {
        let a = ("a.rs", "use crate::b::f;\npub struct S;");
        let found = complaints(&[("lib.rs", "mod a; mod b;"), a, ("b.rs", "pub fn f() { let s: super::a::S; }")]);
        assert_eq!(found.len(), 1, "{found:?}");
        let steps = ["src/a.rs uses src/b.rs (`crate::b::f`)", "src/b.rs uses src/a.rs (`super::a::S`)"];
        assert!(steps.iter().all(|step| found[0].contains(step)), "{found:?}");
        assert_eq!(complaints(&[("lib.rs", "mod a; mod b;"), a, ("b.rs", "pub fn f() {}")]), Vec::<String>::new());
    }

    #[test]
    fn a_circle_of_three_through_reexports_is_found_once() {
        let files = [
            ("lib.rs", "mod a; mod b; mod c; pub use b::{T as U, V};"),
            ("a.rs", "use crate::U; pub struct S;"),
            ("b/mod.rs", "mod d; pub use d::*; pub struct T(super::c::W);"),
            ("b/d.rs", "pub struct V;"),
            ("c.rs", "use super::a::S; pub struct W;"),
        ];
        let found = complaints(&files);
        assert_eq!(found.len(), 1, "{found:?}");
        assert!(found[0].contains("src/a.rs uses src/b/mod.rs (`crate::U`)"), "{found:?}");
        // V is the one of d.rs, which uses nothing.
        let found = complaints(&[files[0], ("a.rs", "use crate::V; pub struct S;"), files[2], files[3], files[4]]);
        assert_eq!(found, Vec::<String>::new());
    }

    #[test]
    fn a_parent_may_reexport_children_that_use_it_and_not_use_them() {
        let child = ("a/b.rs", "use super::S; pub struct T(S);");
        let of = |parent| complaints(&[("lib.rs", "mod a;"), ("a.rs", parent), child]);
        assert_eq!(of("mod b; pub use b::T; pub struct S;"), Vec::<String>::new());
        for uses in ["mod b; pub use b::T; pub struct S; fn f(t: T) {}", "mod b; pub struct S; fn f(t: b::T) {}"] {
            assert_eq!(of(uses).len(), 1, "{uses}");
        }
    }

    #[test]
    fn tests_comments_visibilities_and_modules_within_a_file_are_no_circle() {
        let b = "pub(in crate::a) fn f() {} mod inner { use super::f; } // crate::a\n#[cfg(test)] mod tests { use crate::a::S; }";
        let files = [("lib.rs", "mod a; mod b;"), ("a.rs", "use crate::b; pub struct S;"), ("b.rs", b)];
        assert_eq!(complaints(&files), Vec::<String>::new());
    }
}
