//! Every command line of README and guide runs, and every flag in them exists.

use std::fs;
use std::path::{Path, PathBuf};

use clap::CommandFactory as _;

use crate::support::{Place, npy, text};

/// Beginning of a block whose lines that begin with `rc` are run. `sh,ignore` marks blocks that take too long.
const RUN: &str = "```sh";
const IGNORED: &str = "```sh,ignore";

/// Maximum number of ignored blocks in all documents together.
const MOST_IGNORED: usize = 2;

fn repository() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../..")
}

/// Names and texts of README and guide.
fn documents() -> Vec<(String, String)> {
    let mut paths = vec![repository().join("README.md")];
    let entries = fs::read_dir(repository().join("docs")).expect("the guide");
    paths.extend(
        entries.map(|entry| entry.expect("an entry").path()).filter(|path| path.extension().is_some_and(|e| e == "md")),
    );
    paths.sort();
    paths.into_iter().map(|path| (path.display().to_string(), fs::read_to_string(&path).expect("a text"))).collect()
}

/// The lines of blocks that are run, each with its number.
fn commands(document: &str) -> Vec<(usize, String)> {
    let mut inside = false;
    let mut commands = Vec::new();
    for (number, line) in document.lines().enumerate() {
        if line.starts_with("```") {
            inside = line == RUN;
        } else if inside && line.starts_with("rc ") {
            let command = line.split(" #").next().unwrap_or_default();
            commands.push((number + 1, command.trim().to_owned()));
        }
    }
    commands
}

/// Makes the files that the documents assume.
///
/// They are measured maps, a sphere, waves, a spectrum, a profile, scenes, and the file of an instrument.
fn prepare(place: &Place) {
    // It has no lay, and its summits are wide enough for the lightest loads.
    let map = ["surface", "--waves", "4", "--grid", "64", "--cell", "1e-3", "--rms", "7e-6", "--out"];
    for name in ["map.npy", "first.npy", "second.npy"] {
        assert_eq!(place.run(&[&map[..], &[name, "--quiet"]].concat()).status.code(), Some(0));
    }
    let wide = |i: usize| (0.3 * (i % 128) as f64).sin() * 1e-6 + (0.2 * (i / 128) as f64).cos() * 1e-6;
    let wide = (0..128 * 64).flat_map(|i| wide(i).to_le_bytes()).collect::<Vec<u8>>();
    place.write("wide.npy", npy("<f8", false, "(64, 128)", &wide));
    let n = 256;
    let x = |i: usize| (i as f64 - n as f64 / 2.0) * 4e-3 / n as f64;
    let sphere = (0..n * n).flat_map(|i| (-(x(i % n).powi(2) + x(i / n).powi(2)) / 2e-2).to_le_bytes());
    place.write("sphere.npy", npy("<f8", false, "(256, 256)", &sphere.collect::<Vec<u8>>()));
    place.write("waves.txt", "1 0 2e-7 1e-7\n0 3 -1e-7 5e-8\n4 4 3e-8 0\n");
    place.write("psd.csv", "q,C\n6.2e3,2e-22\n2e4,2e-22\n1e5,6e-25\n");
    let height = |i: u32| (f64::from(i) * 0.31).sin() + 0.1 * f64::from(i * i % 17);
    place.write("profile.txt", (0..256).map(|i| format!("{i} {}\n", 0.1 * height(i))).collect::<Vec<_>>().concat());
    fs::copy(repository().join("data/prony.csv"), place.path("rubber.csv")).expect("a Prony series");
    place.write("a.toml", "waves = 8\ngrid = 64\n");
    place.write("b.toml", "waves = 8\ngrid = 64\nhurst = 0.5\n");
    // It stands for the file of an instrument. The format follows from the first bytes.
    let scan = ["surface", "--waves", "8", "--grid", "64", "--cell", "1e-3", "--rms", "1e-6", "--out", "scan.gsf"];
    assert_eq!(place.run(&scan).status.code(), Some(0));
    fs::rename(place.path("scan.gsf"), place.path("scan.x3p")).expect("a map with its size");
}

/// Warnings of documented commands: a part of the command, and the beginning of what it tells.
const EXPECTED: [(&str, &str); 0] = [];

/// Fails unless a command tells the warnings that are expected of it, and no others.
fn assert_expected(command: &str, told: &str) {
    let warnings: Vec<&str> = told.lines().filter_map(|line| line.strip_prefix("warning: ")).collect();
    let expected: Vec<&str> =
        EXPECTED.iter().filter(|(part, _)| command.contains(part)).map(|(_, beginning)| *beginning).collect();
    let is_expected = warnings.len() == expected.len()
        && warnings.iter().zip(&expected).all(|(warning, beginning)| warning.starts_with(beginning));
    assert!(is_expected, "{command}: expected {expected:?}, told {warnings:?}");
}

#[test]
fn every_command_line_of_the_documents_ends_well() {
    let mut n_commands = 0;
    for (name, document) in documents() {
        let place = Place::new();
        prepare(&place);
        for (number, command) in commands(&document) {
            let words: Vec<&str> = command.split_whitespace().skip(1).collect();
            let output = place.run(&words);
            assert_eq!(output.status.code(), Some(0), "{name}:{number}: {command}\n{}", text(&output.stderr));
            assert_expected(&command, &text(&output.stderr));
            n_commands += 1;
        }
    }
    assert!(n_commands > 40, "only {n_commands} command lines were found");
    let ignored: usize = documents().iter().map(|(_, document)| document.matches(IGNORED).count()).sum();
    assert!(ignored <= MOST_IGNORED, "{ignored} blocks are not run");
}

/// Each `rc solve --flag` in the text has an existing command and existing flags.
#[test]
fn commands_and_flags_in_the_text_exist() {
    let rc = rc_cli::args::Cli::command();
    let mut n_flags = 0;
    for (name, document) in documents() {
        for span in
            document.split('`').skip(1).step_by(2).filter(|span| span.starts_with("rc ") && !span.contains("rc-"))
        {
            let mut words = span.split_whitespace().skip(1).peekable();
            let mut command = &rc;
            while let Some(next) = words.peek().and_then(|word| command.find_subcommand(word)) {
                command = next;
                words.next();
            }
            let known = |flag: &str| {
                flag == "help" || flag == "version" || command.get_arguments().any(|a| a.get_long() == Some(flag))
            };
            for flag in words.filter_map(|word| word.strip_prefix("--")) {
                assert!(known(flag), "{name}: `{span}`: {} has no --{flag}", command.get_name());
                n_flags += 1;
            }
        }
    }
    assert!(n_flags > 10, "only {n_flags} flags were found");
}
