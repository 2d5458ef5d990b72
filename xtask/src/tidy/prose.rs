//! The lengths of sentences in documentation, and of comment lines.

use rc_figures::repository::{Sources, has_extension};

use super::complaint::Complaint;

/// Longest first sentence of the documentation of an item, in words.
const FIRST_SENTENCE: usize = 15;
/// Longest sentence of documentation, in words.
const SENTENCE: usize = 30;
/// Longest line of a comment, in columns; rustfmt keeps code to as many.
const COLUMNS: usize = 120;

/// Dots after these do not end a sentence.
const ABBREVIATIONS: [&str; 15] =
    ["Eq", "Eqs", "Fig", "Figs", "Sec", "No", "e.g", "i.e", "cf", "vs", "al", "Phys", "Rev", "Lett", "Tribol"];

/// Checks the sentences of all documentation in Rust, and the width of all comments.
pub(super) fn check(sources: &Sources) -> Vec<Complaint> {
    let code = sources.iter().filter(|(path, _)| has_extension(path, "rs"));
    code.flat_map(|(path, text)| {
        let mut complaints = check_columns(path, text);
        complaints.extend(docs(text).iter().flat_map(|doc| check_doc(path, doc)));
        complaints
    })
    .collect()
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
    /// Whether readers outside the module see it: the item is public, part of a trait, or a module itself.
    is_public: bool,
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
        let item = after.iter().find(|line| !line.starts_with("#["));
        let is_public = marker == "//!" || item.is_some_and(|item| is_public(item));
        let line = at + 1;
        at += own.len();
        // Texts of flags are pages of help, whose lines a test counts.
        if !after.iter().take_while(|line| line.starts_with("#[")).any(|line| line.starts_with("#[arg(")) {
            found.push(Doc { line, is_public, lines: own });
        }
    }
    found
}

fn is_public(item: &str) -> bool {
    item.starts_with(|c: char| c.is_ascii_uppercase())
        || ["pub ", "pub(", "fn ", "const ", "type "].iter().any(|start| item.starts_with(start))
}

fn check_doc(path: &str, doc: &Doc<'_>) -> Vec<Complaint> {
    let mut complaints = Vec::new();
    let all = paragraphs(&doc.lines);
    for (i, sentence) in all.iter().flat_map(|paragraph| sentences(paragraph)).enumerate() {
        let n = n_words(&sentence);
        let (most, what) =
            if i == 0 && doc.is_public { (FIRST_SENTENCE, "first sentence") } else { (SENTENCE, "sentence") };
        if n > most {
            let start: String = sentence.chars().take(40).collect();
            complaints.push(format!(
                "{path}:{}: the {what} \"{start}…\" has {n} words; at most {most} are read once",
                doc.line
            ));
        }
    }
    complaints
}

/// The paragraphs and list items of documentation, each on one line.
///
/// Code, tables and headings are left out.
fn paragraphs(lines: &[&str]) -> Vec<String> {
    let mut all: Vec<String> = vec![String::new()];
    let mut is_code = false;
    for line in lines {
        let fence = line.starts_with("```");
        is_code ^= fence;
        if fence || is_code || line.is_empty() || line.starts_with(['#', '|', '<']) {
            all.push(String::new());
            continue;
        }
        let item = ["- ", "* "].into_iter().find_map(|bullet| line.strip_prefix(bullet));
        if item.is_some() {
            all.push(String::new());
        }
        let last = all.last_mut().expect("a paragraph was pushed");
        last.push(' ');
        last.push_str(item.unwrap_or(line));
    }
    all.retain(|paragraph| !paragraph.is_empty());
    all
}

/// The sentences of a paragraph. Code between backticks is one word.
fn sentences(paragraph: &str) -> Vec<String> {
    let plain: String =
        paragraph.split('`').enumerate().map(|(i, part)| if i % 2 == 0 { part } else { "Code" }).collect();
    let mut found = vec![String::new()];
    let words: Vec<&str> = plain.split_whitespace().collect();
    for (i, word) in words.iter().enumerate() {
        let last = found.last_mut().expect("a sentence was pushed");
        last.push_str(word);
        last.push(' ');
        let ends = word.trim_end_matches([')', '"', '*']).ends_with(['.', '!', '?'])
            && !ABBREVIATIONS.iter().any(|short| word.trim_start_matches('(').strip_suffix('.') == Some(short));
        let next_starts = words
            .get(i + 1)
            .is_some_and(|next| next.starts_with(|c: char| c.is_uppercase() || c.is_ascii_digit() || c == '['));
        if ends && next_starts {
            found.push(String::new());
        }
    }
    found
}

/// Number of words. Symbols of one letter and numbers are not words.
fn n_words(sentence: &str) -> usize {
    let is_word = |word: &&str| *word == "a" || word.chars().filter(|c| c.is_alphabetic()).count() > 1;
    sentence.split_whitespace().filter(is_word).count()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn complaints(code: &str) -> Vec<Complaint> {
        check(&Sources::from([("crates/rc-core/src/grid.rs".to_owned(), code.to_owned())]))
    }

    fn words(n: usize) -> String {
        vec!["as"; n].join(" ")
    }

    #[test]
    fn short_sentences_pass() {
        let (first, other) = (words(15), words(30).replacen('a', "A", 1));
        for code in [
            format!("//! {first}.\n//!\n//! {other}.\n//! {other}.\n"),
            format!("/// {first}.\n///\n/// - {other}\n/// - {other}\npub fn f() {{}}\n"),
            format!("/// {first}.\n/// ```\n/// {other}\n/// {other}\n/// ```\npub fn f() {{}}\n"),
            format!("/// {other}.\nlet a = 1;\n// {other}\n// {other}\n"),
        ] {
            assert_eq!(complaints(&code), Vec::<String>::new(), "{code}");
        }
    }

    #[test]
    fn long_sentences_and_lines_are_found() {
        for (code, what) in [
            (format!("//! {}.\n", words(16)), "first sentence"),
            (format!("/// {}.\n#[must_use]\npub fn f() {{}}\n", words(16)), "first sentence"),
            (format!("    /// {}.\n    Variant,\n", words(16)), "first sentence"),
            (format!("/// {}.\nlet a = 1;\n", words(31)), "has 31 words"),
            (
                format!("/// Short. {}\n/// {}.\npub fn f() {{}}\n", words(16).replacen('a', "A", 1), words(15)),
                "has 31 words",
            ),
            (format!("/// Short:\n/// - {}\n/// {}.\npub fn f() {{}}\n", words(16), words(15)), "has 31 words"),
            (format!("// {}\n", "x".repeat(118)), "wider than 120"),
        ] {
            let complaints = complaints(&code);
            assert!(complaints.len() == 1 && complaints[0].contains(what), "{code}: {complaints:?}");
        }
    }

    #[test]
    fn code_is_a_word_and_an_abbreviation_is_no_end() {
        assert_eq!(sentences("As in Eq. 5, `a b. C d` is. So it ends."), ["As in Eq. 5, Code is. ", "So it ends. "]);
        assert_eq!(n_words("Of 3 elements at [`Grid`](https://example.org/a) "), 4);
    }
}
