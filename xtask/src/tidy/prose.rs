//! The width of comments, and the documentation of items.

use rc_figures::repository::{Sources, has_extension};

use super::complaint::Complaint;

/// Longest line of a comment, in columns; rustfmt keeps code to as many.
const COLUMNS: usize = 120;

/// Checks the width of all comments in Rust.
pub(super) fn check(sources: &Sources) -> Vec<Complaint> {
    let code = sources.iter().filter(|(path, _)| has_extension(path, "rs"));
    code.flat_map(|(path, text)| check_columns(path, text)).collect()
}

fn check_columns(path: &str, text: &str) -> Vec<Complaint> {
    let is_wide = |line: &&str| {
        line.trim_start().starts_with("//")
            && line.chars().count() > COLUMNS
            && !line.contains("://")
            && !line.contains(" | ")
    };
    let wide = text.lines().enumerate().filter(|(_, line)| is_wide(line));
    wide.map(|(i, _)| format!("{path}:{}: the comment is wider than {COLUMNS} columns; wrap it", i + 1)).collect()
}

/// The documentation of one item.
#[derive(Debug)]
pub(super) struct Doc<'a> {
    /// Its first line, from 1.
    pub(super) line: usize,
    pub(super) lines: Vec<&'a str>,
}

/// The documentation of all items in a source, in their order.
pub(super) fn docs(text: &str) -> Vec<Doc<'_>> {
    let lines: Vec<&str> = text.lines().map(str::trim_start).collect();
    let mut found = Vec::new();
    let mut at = 0;
    while at < lines.len() {
        let marker = ["///", "//!"].into_iter().find(|marker| lines[at].starts_with(marker));
        let Some(marker) = marker.filter(|_| !lines[at].starts_with("////")) else {
            at += 1;
            continue;
        };
        let own: Vec<&str> = lines[at..].iter().map_while(|line| line.strip_prefix(marker)).map(str::trim).collect();
        let after = &lines[at + own.len()..];
        let line = at + 1;
        at += own.len();
        // Texts of flags are pages of help, whose lines a test counts.
        if !after.iter().take_while(|line| line.starts_with("#[")).any(|line| line.starts_with("#[arg(")) {
            found.push(Doc { line, lines: own });
        }
    }
    found
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn wide_comments_are_found() {
        let complaints =
            |code: &str| check(&Sources::from([("crates/rc-core/src/grid.rs".to_owned(), code.to_owned())]));
        assert_eq!(complaints(&format!("// {}\n", "x".repeat(117))), Vec::<String>::new());
        let wide = complaints(&format!("// {}\n", "x".repeat(118)));
        assert!(wide.len() == 1 && wide[0].contains("wider than 120"), "{wide:?}");
    }
}
