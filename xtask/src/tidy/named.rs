//! Rules for names in texts: files, commands of `cargo xtask` and flags must exist.
//!
//! The tests of rc-cli run and check the commands and flags of `rc` in README and guide.

use std::collections::BTreeSet;

use clap::CommandFactory as _;
use rc_figures::repository::{self, Sources, has_extension};

/// Folders whose files texts name by their paths from the root.
const FOLDERS: &[&str] = &["crates/", "data/", "docs/", "fuzz/", "python/", "tests/", "xtask/"];
/// The file that may name things which no longer exist.
const HISTORY: &str = "CHANGELOG.md";
/// Flags of other programs (cargo, rc-mpi) that the guide names without the program.
const FOREIGN: &[&str] = &["all-features", "checkpoint", "features", "help", "locked", "release"];

/// Checks guide, front pages and the comments in code.
///
/// `xtask` is the command line of `cargo xtask`.
pub(super) fn check(sources: &Sources, xtask: &clap::Command) -> Vec<String> {
    let mut flags: BTreeSet<String> = FOREIGN.iter().map(|flag| (*flag).to_owned()).collect();
    collect_flags(xtask, &mut flags);
    collect_flags(&rc_cli::args::Cli::command(), &mut flags);
    let texts = sources.iter().filter(|(path, _)| *path != HISTORY);
    let read = texts.filter_map(|(path, text)| Some((path, read_by_people(path, text)?)));
    let complaints = |(path, text): (&String, String)| {
        let mut complaints = check_files(path, &text, sources);
        complaints.extend(check_commands(path, &text, xtask));
        complaints.extend(check_flags(path, &text, &flags));
        complaints
    };
    read.flat_map(complaints).collect()
}

fn collect_flags(command: &clap::Command, flags: &mut BTreeSet<String>) {
    let own = command.get_arguments().filter_map(clap::Arg::get_long_and_visible_aliases).flatten();
    flags.extend(own.map(ToOwned::to_owned));
    for command in command.get_subcommands() {
        collect_flags(command, flags);
    }
}

/// The whole text of a document, or the comments of code.
fn read_by_people(path: &str, text: &str) -> Option<String> {
    if has_extension(path, "md") {
        return Some(text.to_owned());
    }
    let is_comment = |line: &&str| line.trim_start().starts_with("//");
    has_extension(path, "rs").then(|| text.lines().filter(is_comment).collect::<Vec<_>>().join("\n"))
}

/// Complaints about names of files that do not exist.
///
/// Names are relative to the root or to the text's crate.
fn check_files(path: &str, text: &str, sources: &Sources) -> Vec<String> {
    let crate_folder = path.match_indices('/').nth(1).map_or("", |(at, _)| &path[..=at]);
    let there = |name: &str| sources.contains_key(name) || repository::root().join(name).exists();
    let names =
        text.split(|c: char| !(c.is_alphanumeric() || "_-./".contains(c))).map(|name| name.trim_end_matches('.'));
    let files = names.filter(|name| {
        let file = name.rsplit('/').next().unwrap_or_default();
        FOLDERS.iter().any(|folder| name.starts_with(folder)) && file.contains('.')
    });
    let missing = files.filter(|name| !there(name) && !there(&format!("{crate_folder}{name}")));
    missing.map(|name| format!("{path}: there is no {name}; correct the name")).collect()
}

/// Complaints about `cargo xtask NAME --flag …` with an unknown command or flag.
///
/// The command ends at the end of the line or of the quotation.
fn check_commands(path: &str, text: &str, xtask: &clap::Command) -> Vec<String> {
    let mut complaints = Vec::new();
    for line in text.split("cargo xtask ").skip(1) {
        let mut words = line.split(['`', '\n', '#', ';', ')']).next().unwrap_or_default().split_whitespace();
        let name = words.next().unwrap_or_default().trim_end_matches([',', '.', ':']);
        if !name.starts_with(|c: char| c.is_ascii_lowercase()) {
            continue;
        }
        let Some(command) = xtask.find_subcommand(name) else {
            complaints.push(format!("{path}: there is no command `cargo xtask {name}`; correct the name"));
            continue;
        };
        let known = |flag: &str| flag == "help" || command.get_arguments().any(|a| a.get_long() == Some(flag));
        let unknown = words.filter_map(|word| word.strip_prefix("--")).filter(|flag| !known(flag));
        complaints
            .extend(unknown.map(|flag| format!("{path}: `cargo xtask {name}` has no --{flag}; correct the name")));
    }
    complaints
}

/// Complaints about unknown flags that a text names alone, as in `--threads 2`.
fn check_flags(path: &str, text: &str, flags: &BTreeSet<String>) -> Vec<String> {
    let named = text
        .split("`--")
        .skip(1)
        .map(|rest| rest.split(|c: char| !(c.is_ascii_lowercase() || c == '-' || c.is_ascii_digit())));
    let unknown = named
        .filter_map(|mut words| words.next())
        .filter(|flag| flag.starts_with(|c: char| c.is_ascii_lowercase()) && !flags.contains(*flag));
    unknown.map(|flag| format!("{path}: no command has the flag --{flag}; correct the name")).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn files_commands_and_flags_that_are_not_there_are_found() {
        let xtask = clap::Command::new("xtask").subcommand(clap::Command::new("fig5").arg(clap::arg!(--quick)));
        let good = "`crates/rc-core/src/lib.rs`, docs/faq.md; `cargo xtask fig5 --quick` and `--pressure 1`";
        let bad = "docs/gone.md; `cargo xtask fig9`, `cargo xtask fig5 --slow`, `--presure 1`";
        let complaints = |text: &str| check(&[("docs/a.md".to_owned(), text.to_owned())].into(), &xtask);
        assert_eq!(complaints(good), Vec::<String>::new());
        let found = complaints(bad);
        let expected = ["no docs/gone.md", "`cargo xtask fig9`", "no --slow", "flag --presure"];
        assert_eq!(found.len(), expected.len(), "{found:?}");
        for (complaint, expected) in found.iter().zip(expected) {
            assert!(complaint.contains(expected), "{complaint}: {expected}");
        }
    }
}
