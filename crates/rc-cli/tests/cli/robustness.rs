//! Random scene files and journals of sweeps give an answer or one line.
//!
//! They do not cause a panic. `fuzz/` makes the same claims for a fuzzer.

use proptest::prelude::*;
use proptest::sample::Index;
use rc_cli::scene::keys::EXAMPLE;
use rc_cli::scene::{file, resolve};
use rc_core::PeriodicCell;
use rc_sweep::{SweepError, finished_rows};

use crate::support::{Place, assert_solved};

/// Replacements for a value or any other word of a file.
const TOKENS: [&str; 14] = [
    "0",
    "-1",
    "1e308",
    "1e-308",
    "nan",
    "inf",
    "\"auto\"",
    "[]",
    "18446744073709551615",
    "1e999",
    "=",
    "\n",
    "\"",
    "{}",
];

/// Text with some of its words replaced by tokens, and cut at `cut`.
fn mutated(text: &str, changes: &[(Index, Index)], cut: Index) -> String {
    let mut words: Vec<&str> = text.split_inclusive([' ', '\n']).collect();
    for (word, token) in changes {
        let place = word.index(words.len());
        words[place] = TOKENS[token.index(TOKENS.len())];
    }
    words.truncate(cut.index(2 * words.len()).max(1));
    words.concat()
}

fn assert_one_line(message: &str) {
    assert!(!message.is_empty() && message.len() < 1000 && !message.contains('\n'), "{message}");
}

/// Reads and resolves a scene, which may be refused.
fn read_scene(text: &str) {
    match file::parse(text) {
        Ok(mut scene) => {
            // Files of the machine must not take part.
            scene.surface.heights = None;
            let surface = resolve::surface(scene.surface);
            let contact = resolve::contact(scene.contact, PeriodicCell::new(1.0).expect("a cell"));
            for error in [surface.err(), contact.err()].into_iter().flatten() {
                assert_one_line(&error.to_string());
            }
        }
        Err(message) => assert_one_line(&message),
    }
}

/// The journal of a small sweep.
fn journal() -> Vec<u8> {
    let place = Place::new();
    let sweep = ["sweep", "--waves", "4", "--grid", "32", "--pressures", "1e5,1e6", "--seeds", "1..2", "--out", "s"];
    assert_solved(&place.run(&[&sweep[..], &["--quiet"]].concat()));
    place.bytes("s/sweep.jsonl")
}

fn read_journal(bytes: &[u8], most: usize) {
    match finished_rows(bytes) {
        Ok(rows) => assert!(rows <= most, "{rows} rows"),
        Err(error) => {
            assert!(matches!(error, SweepError::NotAJournal { .. } | SweepError::DamagedLine { .. }), "{error:?}");
            assert_one_line(&error.to_string());
        }
    }
}

#[test]
fn damaged_journals_are_read_or_refused() {
    let whole = journal();
    assert_eq!(finished_rows(&whole).expect("a journal"), 4);
    // Wherever the journal is cut, only whole lines count, and no row is invented.
    for length in 0..whole.len() {
        let lines = whole[..length].split(|&byte| byte == b'\n').count() - 1;
        read_journal(&whole[..length], lines.saturating_sub(1));
    }
    let config = ProptestConfig { cases: 2000, failure_persistence: None, ..ProptestConfig::default() };
    let changes = prop::collection::vec((any::<Index>(), any::<u8>()), 1..6);
    proptest!(config, |(changes in changes)| {
        let mut bytes = whole.clone();
        for (at, byte) in &changes {
            let at = at.index(bytes.len());
            bytes[at] = *byte;
        }
        read_journal(&bytes, 4);
    });
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 500, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn scenes_with_other_words_never_panic(
        changes in prop::collection::vec((any::<Index>(), any::<Index>()), 0..6),
        cut in any::<Index>(),
    ) {
        read_scene(&mutated(EXAMPLE, &changes, cut));
    }

    #[test]
    fn arbitrary_scenes_never_panic(text in "[a-z_]{1,12} ?= ?[-0-9eE.\"a-z]{0,12}\n{0,2}[ -~]{0,40}") {
        read_scene(&text);
    }
}
