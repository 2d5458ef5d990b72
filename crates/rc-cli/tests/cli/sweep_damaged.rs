//! `rc sweep` with impossible rows, damaged journals and missing fields.
//!
//! The tests check what is left behind.

use std::fs;

use crate::support::{Place, assert_refused, assert_solved, text};
use crate::sweep::{TINY, result, sweep, table};

#[test]
fn a_load_that_a_surface_cannot_carry_costs_its_row_only() {
    let place = Place::new();
    // Full contact is at another penetration for each seed, and 1e-3 is beyond all of them.
    let penetrations = ["--penetrations", "1e-6,1e-5,1e-3", "--seeds", "1..2", "--threads", "1", "--out", "s"];
    let refused = place.run(&[&TINY[..], &penetrations].concat());
    assert_refused(
        &refused,
        "row 3 (seed 1, penetration 1e-3): penetration: must be above 0 and below that of full contact",
    );
    assert!(
        text(&refused.stderr).contains("2 rows could not be solved, and sweep.csv has the other 4"),
        "{}",
        text(&refused.stderr)
    );
    let rows = table(&place.path("s"));
    assert_eq!(rows.len(), 5);
    let again = place.run(&[&TINY[..], &penetrations, &["--resume"]].concat());
    assert_refused(&again, "2 rows could not be solved");
    assert_eq!(table(&place.path("s")), rows, "finished rows were touched");
}

#[test]
fn memory_decides_whether_a_row_is_solved_but_not_how() {
    let place = Place::new();
    let loads = ["sweep", "--waves", "8", "--grid", "512", "--pressures", "2e5,1.5e6", "--quiet", "--out"];
    assert_solved(&place.run(&[&loads[..], &["whole"]].concat()));
    let method = |row: &Vec<String>| row.iter().find(|cell| ["adaptive", "uniform"].contains(&cell.as_str())).cloned();
    let methods: Vec<_> = table(&place.path("whole")).iter().skip(1).map(method).collect();
    assert_eq!(
        methods,
        [Some("adaptive".to_owned()), Some("uniform".to_owned())],
        "the scene is at the border of both"
    );
    // `rc solve` would switch to the adaptive method, which gives other digits.
    let tight = place.run(&[&loads[..], &["tight", "--memory-limit", "20.5MB"]].concat());
    assert_refused(&tight, "memory_limit: ");
    let (whole, tight) = (result(&place.path("whole")), result(&place.path("tight")));
    assert_eq!(tight[..], whole[..2], "the first row is that of the whole sweep");
}

#[test]
fn a_changed_digit_in_a_journal_is_found() {
    let place = Place::new();
    assert_solved(&place.run(&[&TINY[..], &["--pressures", "1e5,2e5", "--out", "s"]].concat()));
    let (journal, whole) = (text(&place.bytes("s/sweep.jsonl")), result(&place.path("s")));
    let (from, to) = ("\"area_fraction\":0.", "\"area_fraction\":9.");
    assert!(journal.contains(from), "{journal}");
    // A damaged last line counts as torn, and its row is solved again. An earlier damaged line is named.
    let damaged = journal.replacen(from, to, 1);
    place.write("s/sweep.jsonl", &damaged);
    let resume = [&TINY[..], &["--pressures", "1e5,2e5", "--out", "s", "--resume"]].concat();
    assert_refused(&place.run(&resume), "line 2 is damaged; remove the line, and --resume");
    assert!(text(&place.bytes("s/sweep.jsonl")) == damaged, "the damaged journal was changed");
    let without: Vec<&str> = damaged.lines().enumerate().filter(|(i, _)| *i != 1).map(|(_, line)| line).collect();
    place.write("s/sweep.jsonl", without.join("\n") + "\n");
    assert_solved(&place.run(&resume));
    assert_eq!(result(&place.path("s")), whole, "the row of the removed line is solved again");
    place.write("s/sweep.jsonl", journal.replace("\"loads\":2}", "\"loads\":9999999999999999}"));
    assert_refused(&place.run(&resume), "not a journal of rc sweep");
    assert_refused(&place.run(&["sweep", "merge", "s", "--out", "m"]), "not a journal of rc sweep");
}

#[test]
fn fields_that_are_gone_are_made_again_and_never_merged_in_part() {
    let place = Place::new();
    let fields = ["--fields", "--threads", "2"];
    assert_solved(&place.run(&sweep("whole", &fields)));
    let table = result(&place.path("whole"));
    fs::remove_dir_all(place.path("whole/rows/0002")).expect("a row");
    assert_refused(
        &place.run(&["sweep", "merge", "whole", "--out", "merged"]),
        "0002: the fields of this row are missing",
    );
    assert!(!place.path("merged").exists(), "{:?}", place.names("merged"));
    assert_solved(&place.run(&sweep("whole", &[&fields[..], &["--resume"]].concat())));
    assert_eq!(place.names("whole/rows").len(), 12);
    assert_eq!(result(&place.path("whole")), table);
    assert_solved(&place.run(&["sweep", "merge", "whole", "--out", "merged"]));
    assert_eq!(place.names("merged/rows").len(), 12);
}

#[test]
fn a_folder_that_was_there_stays() {
    let place = Place::new();
    fs::create_dir(place.path("mine")).expect("a folder");
    let refused = place.run(&[&TINY[..], &["--penetrations", "1e-3", "--out", "mine"]].concat());
    assert_refused(&refused, "row 1 ");
    assert_eq!(place.names("mine"), Vec::<String>::new());
}

#[test]
fn more_rows_than_anyone_means_are_refused_before_anything_is_made() {
    let place = Place::new();
    let many = ["--pressures", "1e4:1e6:100000", "--seeds", "0..9999", "--out", "s"];
    assert_refused(&place.run(&[&TINY[..], &many].concat()), "10000 seeds x 100000 loads are more than 1000000 rows");
    assert!(!place.path("s").exists(), "a folder was made for nothing");
}

/// If the first fields do not fit on the disk, nothing is left behind.
///
/// The command can then be repeated.
#[cfg(unix)]
#[test]
fn a_disk_that_is_full_at_once_leaves_nothing() {
    let place = Place::new();
    // Blocks have 512 or 1024 bytes, and pressure.npy alone has 131 thousand bytes.
    let output = std::process::Command::new("sh")
        .args(["-c", "trap '' XFSZ; ulimit -f 64; exec \"$0\" \"$@\"", env!("CARGO_BIN_EXE_rc")])
        .args(sweep("full", &["--fields", "--threads", "1"]))
        .current_dir(place.folder())
        .output()
        .expect("a shell");
    assert_eq!(output.status.code(), Some(4), "{}", text(&output.stderr));
    assert!(!place.path("full").exists(), "{:?}", place.names("full"));
    assert_solved(&place.run(&sweep("full", &["--fields", "--threads", "2"])));
}
