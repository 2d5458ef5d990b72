//! `rc sweep`: rows and their order, agreement with `rc solve`, threads, shards, fields.

use std::path::Path;

use crate::solve::KEYS;
use crate::support::{Place, assert_refused, assert_solved, bumps, f8, npy, text};

/// Four waves on 128 x 128 elements, so that a row takes some hundredths of a second.
pub(crate) const TINY: [&str; 6] = ["sweep", "--waves", "4", "--grid", "128", "--quiet"];

/// Columns that depend on the run, not on the result.
const OF_THE_RUN: [&str; 2] = ["wall_seconds", "peak_memory_bytes"];

/// Arguments of a sweep of four loads and three seeds into `out`, followed by `more`.
pub(crate) fn sweep<'a>(out: &'a str, more: &[&'a str]) -> Vec<&'a str> {
    [&TINY[..], &["--pressures", "5e4:4e5:4", "--seeds", "1..3", "--out", out], more].concat()
}

/// The table in `folder`, with column names in the first row.
pub(crate) fn table(folder: &Path) -> Vec<Vec<String>> {
    let mut reader = csv::ReaderBuilder::new().has_headers(false).from_path(folder.join("sweep.csv")).expect("a table");
    let record =
        |record: Result<csv::StringRecord, csv::Error>| record.expect("a row").iter().map(Into::into).collect();
    reader.records().map(record).collect()
}

fn without(table: Vec<Vec<String>>, names: &[&str]) -> Vec<Vec<String>> {
    let kept: Vec<bool> = table[0].iter().map(|name| !names.contains(&name.as_str())).collect();
    let keep = |row: Vec<String>| row.into_iter().zip(&kept).filter(|(_, kept)| **kept).map(|(cell, _)| cell).collect();
    table.into_iter().map(keep).collect()
}

/// The table without time and memory.
///
/// Any way to compute it must give the same digits.
pub(crate) fn result(folder: &Path) -> Vec<Vec<String>> {
    without(table(folder), &OF_THE_RUN)
}

fn column<'a>(table: &'a [Vec<String>], name: &str) -> Vec<&'a str> {
    let at = table[0].iter().position(|other| other == name).unwrap_or_else(|| panic!("no column {name}"));
    table[1..].iter().map(|row| row[at].as_str()).collect()
}

#[test]
fn rows_are_ordered_by_scene_seed_and_load_and_have_all_keys() {
    let place = Place::new();
    place.write("rough.toml", "waves = 4\ngrid = 128\nrms = 2e-5\n");
    place.write("smooth.toml", "waves = 2\ngrid = 128\nrms = 1e-5\n");
    let args = ["sweep", "rough.toml", "smooth.toml", "--pressures", "1e5,2e5", "--seeds", "3,1", "--out", "s"];
    let output = place.run(&args);
    assert_solved(&output);
    assert!(text(&output.stdout).starts_with("8 rows in "), "{}", text(&output.stdout));
    assert_eq!(place.names("s"), ["sweep.csv", "sweep.jsonl"]);
    let table = table(&place.path("s"));
    let leading = ["scene", "seed", "control_value"];
    assert!(table[0].iter().eq(leading.iter().chain(&KEYS)), "{:?}", table[0]);
    let scenes = [["rough"; 4], ["smooth"; 4]].concat();
    assert_eq!(column(&table, "scene"), scenes);
    assert_eq!(column(&table, "seed"), ["3", "3", "1", "1"].repeat(2));
    assert_eq!(column(&table, "control_value"), ["100000.0", "200000.0"].repeat(4));
    assert_eq!(column(&table, "control"), ["pressure"; 8]);
    assert_eq!(column(&table, "grid"), ["128 128"; 8]);
}

#[test]
fn a_row_is_what_solve_prints() {
    let place = Place::new();
    let penetrations = ["sweep", "--waves", "4", "--grid", "128", "--penetrations", "4e-6:1.2e-5:3:linear", "--quiet"];
    assert_solved(&place.run(&[&penetrations[..], &["--seeds", "5", "--threads", "2", "--out", "s"]].concat()));
    let table = table(&place.path("s"));
    assert_eq!(column(&table, "control_value"), ["4e-6", "8e-6", "0.000012"]);
    for (i, penetration) in ["4e-6", "8e-6", "1.2e-5"].iter().enumerate() {
        let args = ["solve", "--waves", "4", "--grid", "128", "--penetration", penetration, "--seed", "5", "--json"];
        let output = place.run(&[&args[..], &["--threads", "2"]].concat());
        assert_solved(&output);
        let summary: serde_json::Value = serde_json::from_slice(&output.stdout).expect("valid JSON");
        for (key, value) in summary.as_object().expect("an object") {
            if OF_THE_RUN.contains(&key.as_str()) {
                continue;
            }
            let expected = match value {
                serde_json::Value::String(text) => text.clone(),
                serde_json::Value::Null => String::new(),
                serde_json::Value::Array(list) => list.iter().map(ToString::to_string).collect::<Vec<_>>().join(" "),
                other => other.to_string(),
            };
            assert_eq!(column(&table, key)[i], expected, "{key} at {penetration} m");
        }
    }
}

#[test]
fn a_scene_has_its_own_load_and_seed_where_no_list_is_given() {
    let place = Place::new();
    place.write("a.toml", "waves = 4\ngrid = 128\nseed = 9\npressure = 3e5\nquiet = true\nout = \"s\"\n");
    place.write("map.npy", npy("<f8", false, "(64, 64)", &f8(&bumps(64))));
    place.write("b.toml", "heights = \"map.npy\"\ncell = 0.01\ne_star = 5e8\npressure = 2e5\n");
    assert_solved(&place.run(&["sweep", "a.toml", "b.toml"]));
    let table = table(&place.path("s"));
    assert_eq!(column(&table, "control_value"), ["300000.0", "200000.0"]);
    assert_eq!(column(&table, "seed"), ["9", ""], "a height map has no seed");
    assert_eq!(column(&table, "status"), ["converged"; 2]);
}

#[test]
fn no_digit_depends_on_the_number_of_threads_or_on_memory() {
    let place = Place::new();
    let run = |out: &str, more: &[&str]| {
        assert_solved(&place.run(&sweep(out, more)));
        without(result(&place.path(out)), &["threads"])
    };
    let one = run("one", &["--threads", "1"]);
    assert_eq!(one.len(), 13);
    assert_eq!(run("five", &["--threads", "5"]), one, "five rows side by side");
    // Only one row of 128 x 128 elements runs at a time, on all threads.
    assert_eq!(run("tight", &["--threads", "3", "--memory-limit", "2.5MB"]), one, "three threads in each row");
}

#[test]
fn merged_shards_are_the_whole_sweep() {
    let place = Place::new();
    let fields = ["--fields", "--threads", "2"];
    assert_solved(&place.run(&sweep("whole", &fields)));
    for shard in ["3/3", "1/3", "2/3"] {
        let out = format!("part-{}", &shard[..1]);
        assert_solved(&place.run(&sweep(&out, &[&fields[..], &["--shard", shard]].concat())));
        assert_eq!(table(&place.path(&out)).len(), 5, "rows of shard {shard}");
    }
    let merge = ["sweep", "merge", "part-2", "part-1", "part-3", "--out", "merged"];
    let output = place.run(&merge);
    assert_solved(&output);
    assert!(text(&output.stdout).starts_with("12 rows of 3 shards"), "{}", text(&output.stdout));
    assert_eq!(result(&place.path("merged")), result(&place.path("whole")));
    assert_eq!(place.names("merged"), place.names("whole"));
    assert_eq!(place.names("merged/rows").len(), 12);
    for row in place.names("whole/rows") {
        for name in ["pressure.npy", "gap.npy", "scene.toml"] {
            let file = format!("rows/{row}/{name}");
            assert!(place.bytes(&format!("merged/{file}")) == place.bytes(&format!("whole/{file}")), "{file} differs");
        }
    }
    // A merged sweep is a sweep like any other.
    let before = place.bytes("merged/sweep.csv");
    assert_solved(&place.run(&sweep("merged", &[&fields[..], &["--resume"]].concat())));
    assert!(place.bytes("merged/sweep.csv") == before, "a complete sweep was changed by --resume");
    assert_refused(&place.run(&merge), "merged: has ");
}

#[test]
fn incomplete_and_unlike_shards_are_not_merged() {
    let place = Place::new();
    let shard = |out: &str, shard: &str, pressures: &str| {
        let args = ["--pressures", pressures, "--shard", shard, "--out", out];
        assert_solved(&place.run(&[&TINY[..], &args].concat()));
    };
    shard("one", "1/2", "1e5,2e5");
    shard("two", "2/2", "1e5,2e5");
    shard("other", "2/2", "1e5,3e5");
    shard("third", "2/3", "1e5,2e5,3e5");
    place.write("torn/sweep.jsonl", {
        let journal = text(&place.bytes("two/sweep.jsonl"));
        std::fs::create_dir(place.path("torn")).expect("a folder");
        journal[..journal.len() - 3].to_owned()
    });
    let cases: &[(&[&str], &str)] = &[
        (&["one"], "shard 2/2 is missing"),
        (&["one", "one"], "is shard 1/2, and so is one; give each shard once"),
        (&["one", "other"], "load 2 of surface 1 is 200000.0 in one and 300000.0 in other"),
        (&["one", "third"], "belongs to another sweep"),
        (&["one", "torn"], "torn: shard 2/2 lacks 1 row;"),
        (&["one", "nothing"], "nothing: not the folder of a sweep"),
    ];
    for (folders, expected) in cases {
        let args = [&["sweep", "merge"], *folders, &["--out", "merged"]].concat();
        assert_refused(&place.run(&args), expected);
    }
    assert!(!place.path("merged").exists(), "a folder was made for nothing");
    assert_refused(&place.run(&["sweep", "merge", "one", "two"]), "--out");
}

#[test]
fn the_rows_are_printed_as_json() {
    let place = Place::new();
    let args = ["sweep", "--waves", "4", "--grid", "128", "--pressures", "1e5,2e5", "--json", "--out", "s"];
    let output = place.run(&args);
    assert_solved(&output);
    let rows: serde_json::Value = serde_json::from_slice(&output.stdout).expect("valid JSON");
    assert_eq!(rows[1]["control_value"], 2e5);
    assert_eq!(rows.as_array().map(Vec::len), Some(2));
}
