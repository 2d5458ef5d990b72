//! House rules for all files.

use rc_figures::repository::{Sources, has_extension};

use super::complaint::Complaint;
use super::rust::{item_end, tokens, without_tests};
use crate::ci;

/// Maximum length of a Rust file, in lines. The maximum for a function outside tests follows.
const LONGEST_FILE: usize = 400;
const LONGEST_FUNCTION: usize = 60;

/// Attributes that hide a failing test.
///
/// A test that does not run, or that accepts any panic, claims nothing.
const HIDING: &[(&str, &str)] = &[
    (concat!("#[ig", "nore"), "assert the wrong behaviour and say why, or delete the test"),
    (concat!("should_", "panic"), "return an error and assert on it, or catch the panic and assert on its message"),
];

/// Folders in which people keep checkouts. In the repository they would be paths of one machine.
const MACHINE_FOLDERS: &[&str] = &[
    concat!("/", "work"),
    concat!("/", "root"),
    concat!("/", "home"),
    concat!("/", "Users"),
    concat!("C:", "\\Users"),
];

/// Checks the house rules in all sources.
///
/// Every Rust file is checked for its first line, its length, long functions and hidden tests. Every text is checked
/// for machine paths. `.ci/run` is compared with the steps.
pub(super) fn check(sources: &Sources) -> Vec<Complaint> {
    let per_file = sources.iter().flat_map(|(path, text)| {
        let rust = if has_extension(path, "rs") { check_rust(path, text) } else { Vec::new() };
        rust.into_iter().chain(check_machine_paths(path, text))
    });
    per_file.chain(check_ci(sources.get(".ci/run").map_or("", String::as_str))).collect()
}

fn check_rust(path: &str, text: &str) -> Vec<Complaint> {
    let mut complaints = Vec::new();
    if !text.starts_with("//! ") {
        complaints.push(format!("{path}:1: no `//!` first line; say in one sentence what the module is"));
    }
    let n_lines = text.lines().count();
    if n_lines > LONGEST_FILE {
        complaints.push(format!("{path}: {n_lines} lines, more than {LONGEST_FILE}; split it by purpose"));
    }
    complaints.extend(check_functions(path, text));
    for (number, line) in text.lines().enumerate() {
        for (attribute, cure) in HIDING {
            if line.contains(attribute) {
                complaints.push(format!("{path}:{}: `{attribute}`; {cure}", number + 1));
            }
        }
    }
    complaints
}

fn check_functions(path: &str, text: &str) -> Vec<Complaint> {
    let folders = ["tests/", "/tests/", "/tests.rs", "/benches/", "/examples/"];
    if folders.iter().any(|folder| path.contains(folder)) {
        return Vec::new();
    }
    let tokens = without_tests(&tokens(text));
    let is_name = |at: usize| tokens.get(at).is_some_and(|token| token.text != "(");
    let starts = (0..tokens.len()).filter(|&at| tokens[at].text == "fn" && is_name(at + 1));
    let complaint = |at: usize| {
        let (first, name) = (tokens[at].line, tokens[at + 1].text);
        let n_lines = tokens[item_end(&tokens, at) - 1].line + 1 - first;
        (n_lines > LONGEST_FUNCTION)
            .then(|| format!("{path}:{first}: `{name}` has {n_lines} lines, more than {LONGEST_FUNCTION}; divide it"))
    };
    starts.filter_map(complaint).collect()
}

fn check_machine_paths(path: &str, text: &str) -> Vec<Complaint> {
    let lines = text.lines().enumerate();
    let found = lines.filter_map(|(number, line)| Some((number + 1, machine_folder(line)?)));
    let complaint = |(number, folder)| {
        format!("{path}:{number}: `{folder}` is a folder of one machine; write a path relative to the repository")
    };
    found.map(complaint).collect()
}

/// The machine folder that `line` names.
///
/// It must be at the start of an absolute path, not inside a longer word or an address.
fn machine_folder(line: &str) -> Option<&'static str> {
    let joins_before = |c: char| c.is_alphanumeric() || "._-/}".contains(c);
    let joins_after = |c: char| c.is_alphanumeric() || "_-.".contains(c);
    MACHINE_FOLDERS.iter().copied().find(|folder| {
        line.match_indices(folder)
            .any(|(at, _)| !line[..at].ends_with(joins_before) && !line[at + folder.len()..].starts_with(joins_after))
    })
}

fn check_ci(script: &str) -> Vec<Complaint> {
    let missing =
        ci::STEPS.iter().map(crate::process::Step::shell_line).filter(|line| !script.lines().any(|l| l == line));
    missing
        .map(|line| format!(".ci/run: no line `{line}`, which `cargo xtask ci` runs; add it, or drop the step"))
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_module_without_a_first_line_is_found() {
        assert_eq!(check_rust("a.rs", "//! A module.\n"), Vec::<String>::new());
        assert_eq!(check_rust("a.rs", "use std::fs;\n").len(), 1);
    }

    #[test]
    fn a_long_file_is_found() {
        let text = format!("//! Long.\n{}", "\n".repeat(LONGEST_FILE));
        assert!(check_rust("a.rs", &text)[0].contains("401 lines"), "{:?}", check_rust("a.rs", &text));
    }

    #[test]
    fn a_long_function_is_found_and_a_long_test_is_not() {
        let text = format!("//! Long.\nfn short() {{}}\nfn long(_: [u8; 2]) {{{}}}\n", "\n".repeat(LONGEST_FUNCTION));
        let complaints = check_rust("src/a.rs", &text);
        assert_eq!(complaints.len(), 1, "{complaints:?}");
        assert!(complaints[0].starts_with("src/a.rs:3: `long` has 61 lines"), "{complaints:?}");
        assert_eq!(check_rust("src/a.rs", &text.replace("fn long", "#[cfg(test)]\nfn long")), Vec::<String>::new());
    }

    #[test]
    fn hidden_tests_are_found() {
        for (attribute, _) in HIDING {
            let complaints = check_rust("a.rs", &format!("//! A module.\n{attribute}]\nfn test() {{}}\n"));
            assert_eq!(complaints.len(), 1, "{complaints:?}");
            assert!(complaints[0].starts_with("a.rs:2:"), "{complaints:?}");
        }
    }

    #[test]
    fn machine_paths_are_found_and_words_are_not() {
        for folder in MACHINE_FOLDERS {
            let complaints = check_machine_paths("README.md", &format!("first\nsee {folder}/somebody/rc\n"));
            assert_eq!(complaints.len(), 1, "{folder}: {complaints:?}");
            assert_eq!(machine_folder(&format!("({folder})")), Some(*folder));
            assert_eq!(machine_folder(&format!("https://example.org{folder}")), None);
            assert_eq!(machine_folder(&format!("{folder}shop")), None);
        }
    }

    #[test]
    fn a_step_missing_from_the_script_is_found() {
        let script: Vec<String> = ci::STEPS.iter().map(crate::process::Step::shell_line).collect();
        assert_eq!(check_ci(&script.join("\n")), Vec::<String>::new());
        assert_eq!(check_ci(&script[1..].join("\n")).len(), 1);
    }
}
