//! Every sentence of a library or the command line, as a snapshot to review.
//!
//! The sentences are read from the sources. A sentence is a string of four to eighty words outside tests and
//! documentation. So each error and each warning is here, beside titles and hints. A reviewer reads a new or changed
//! sentence in the snapshot before accepting it.

use std::fmt::Write as _;
use std::fs;
use std::path::{Path, PathBuf};

use proc_macro2::{Delimiter, TokenStream, TokenTree};

const FEWEST_WORDS: usize = 4;
/// Maximum number of words of a sentence. Longer texts are pages of help.
const MOST_WORDS: usize = 80;

/// Calls and macros whose message appears only if this program has an error.
const CERTAIN: [&str; 5] = ["expect", "assert", "assert_eq", "debug_assert", "unreachable"];

/// The snapshots of the crates whose sentences users read.
const SNAPSHOTS: [&str; 12] = [
    "sentences-rc-cli",
    "sentences-rc-cli-report",
    "sentences-rc-core",
    "sentences-rc-fractal",
    "sentences-rc-heights",
    "sentences-rc-kernel",
    "sentences-rc-leakage",
    "sentences-rc-plot",
    "sentences-rc-py",
    "sentences-rc-solver",
    "sentences-rc-sweep",
    "sentences-rc-theory",
];

/// The sources of a snapshot. Those of `rc report` have a snapshot of their own, for its size.
fn source_folder(name: &str) -> PathBuf {
    let crates = Path::new(env!("CARGO_MANIFEST_DIR")).join("../crates");
    match name.strip_suffix("-report") {
        Some(name) => crates.join(name).join("src/report"),
        None => crates.join(name).join("src"),
    }
}

/// The files of a crate that are not tests, ordered by path.
fn sources(folder: &Path) -> Vec<PathBuf> {
    let mut files = Vec::new();
    for entry in fs::read_dir(folder).expect("a folder of sources") {
        let path = entry.expect("an entry").path();
        let name = path.file_name().and_then(|name| name.to_str()).unwrap_or_default().to_owned();
        if path.is_dir() {
            files.extend(sources(&path));
        } else if Path::new(&name).extension().is_some_and(|e| e == "rs")
            && !["tests.rs", "testing.rs"].contains(&&*name)
        {
            files.push(path);
        }
    }
    files.sort();
    files
}

/// Adds the sentences of `tokens` to `found`.
///
/// Documentation, tests, and messages of impossible failures are left out.
fn collect(tokens: TokenStream, found: &mut Vec<String>) {
    let tokens: Vec<TokenTree> = tokens.into_iter().collect();
    let mut at = 0;
    while at < tokens.len() {
        match &tokens[at] {
            TokenTree::Punct(punct) if punct.as_char() == '#' => at = after_attribute(&tokens, at, found),
            TokenTree::Ident(name) if CERTAIN.iter().any(|word| name == word) => at += 2,
            TokenTree::Group(group) => collect(group.stream(), found),
            TokenTree::Literal(literal) => found.extend(sentence(&literal.to_string())),
            _ => {}
        }
        at += 1;
    }
}

/// Index of the last token of the attribute at `at`, `#[…]` or `#![…]`.
///
/// If the attribute begins a test, it is the last token of the test. Messages of errors and help texts are in
/// attributes too.
fn after_attribute(tokens: &[TokenTree], at: usize, found: &mut Vec<String>) -> usize {
    let group = |token: &TokenTree, delimiter| match token {
        TokenTree::Group(group) if group.delimiter() == delimiter => Some(group.stream()),
        _ => None,
    };
    let bracket = (at + 1..tokens.len().min(at + 3)).find(|&i| group(&tokens[i], Delimiter::Bracket).is_some());
    let Some(bracket) = bracket else { return at };
    let attribute = group(&tokens[bracket], Delimiter::Bracket).unwrap_or_default();
    let text = attribute.to_string();
    if text.replace(' ', "") == "cfg(test)" || text == "test" {
        let is_end = |token: &TokenTree| {
            group(token, Delimiter::Brace).is_some()
                || matches!(token, TokenTree::Punct(punct) if punct.as_char() == ';')
        };
        return (bracket..tokens.len()).find(|&i| is_end(&tokens[i])).unwrap_or(tokens.len());
    }
    if ["error", "command", "arg"].iter().any(|name| text.starts_with(name)) {
        collect(attribute, found);
    }
    bracket
}

/// The text of a literal, if it is a sentence.
fn sentence(literal: &str) -> Option<String> {
    let raw = literal.strip_prefix('r').map(|raw| raw.trim_matches('#'));
    let quoted = raw.unwrap_or(literal).strip_prefix('"')?.strip_suffix('"')?;
    // A backslash at the end of a line joins the line to the next word.
    let joined: Vec<&str> =
        quoted.split("\\\n").enumerate().map(|(i, line)| if i == 0 { line } else { line.trim_start() }).collect();
    let text = joined.concat();
    let words =
        text.split_whitespace().filter(|word| word.chars().filter(|c| c.is_alphabetic()).count() > 1 || *word == "a");
    (FEWEST_WORDS..=MOST_WORDS).contains(&words.count()).then_some(text)
}

fn sentences_of(name: &str) -> String {
    let folder = source_folder(name);
    let mut listing = String::new();
    for path in sources(&folder).into_iter().filter(|path| !path.starts_with(folder.join("report"))) {
        let text = fs::read_to_string(&path).expect("a source");
        let tokens: TokenStream = text.parse().expect("Rust");
        let mut found = Vec::new();
        collect(tokens, &mut found);
        if !found.is_empty() {
            let file =
                path.strip_prefix(&folder).expect("a file of the folder").display().to_string().replace('\\', "/");
            writeln!(listing, "{file}").expect("a text");
            for sentence in found {
                writeln!(listing, "  {sentence}").expect("a text");
            }
        }
    }
    listing
}

#[test]
fn every_sentence_is_as_reviewed() {
    for snapshot in SNAPSHOTS {
        insta::assert_snapshot!(snapshot, sentences_of(snapshot.trim_start_matches("sentences-")));
    }
}
