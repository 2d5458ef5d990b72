//! `rc study`: one contact under varied treatments.

use std::collections::BTreeSet;

use serde_json::Value;

use crate::support::{Place, assert_refused, assert_solved, npy, text};

/// A place with `scan.npy`: waves on a tilt, 40 x 32 points, with a hole of four points.
fn place() -> Place {
    let [nx, ny] = [40, 32];
    let wave = |i: usize, j: usize, k: f64| (std::f64::consts::TAU * (k * i as f64 + 1.7 * j as f64) / 40.0).sin() / k;
    let height = |x: usize, y: usize| {
        if (20..22).contains(&x) && (10..12).contains(&y) {
            return f64::NAN;
        }
        3e-7 * (wave(x, y, 1.0) + wave(y, x, 3.0) + wave(x + 2 * y, x, 5.0)) + 5e-8 * x as f64
    };
    let bytes = (0..nx * ny).flat_map(|i| height(i % nx, i / nx).to_le_bytes()).collect::<Vec<u8>>();
    let place = Place::new();
    place.write("scan.npy", npy("<f8", false, &format!("({ny}, {nx})"), &bytes));
    place
}

const STUDY: [&str; 8] = ["study", "scan.npy", "--cell", "4e-4", "--cell-y", "3.2e-4", "--e-star", "1e9"];

fn study<'a>(more: &[&'a str]) -> Vec<&'a str> {
    [&STUDY[..], more].concat()
}

fn number(value: &Value, key: &str) -> f64 {
    value[key].as_f64().unwrap_or_else(|| panic!("no number {key} in {value}"))
}

#[test]
fn each_result_has_the_range_of_all_treatments() {
    let place = place();
    let output = place.run(&study(&["--pressures", "1e4,1e5", "--out", "s"]));
    assert_solved(&output);
    let printed = text(&output.stdout);
    assert!(printed.contains("treatment_low") && printed.contains("every second point"), "{printed}");
    let record = place.json("s/study.json");
    let rows = record["rows"].as_array().expect("rows");
    let steps: BTreeSet<&str> = rows.iter().filter_map(|row| row["step"].as_str()).collect();
    let expected = ["border", "crop", "despike", "fill", "level", "low-pass", "none", "points"];
    assert_eq!(steps, BTreeSet::from(expected));
    for (i, load) in record["loads"].as_array().expect("loads").iter().enumerate() {
        assert_eq!((number(load, "pressure"), number(load, "n_treatments")), ([1e4, 1e5][i], 12.0));
        for range in load["results"].as_array().expect("results") {
            let key = range["result"].as_str().expect("a key");
            // A patch compares only where the half-space under it does not count.
            let is_of_half_space = ["penetration", "contact_stiffness", "contact_conductance"].contains(&key);
            let of_load = rows.iter().filter(|row| row["control_value"] == load["pressure"]);
            let of_load = of_load.filter(|row| !is_of_half_space || row["treatment"] != "free patch");
            let values: Vec<f64> = of_load.filter_map(|row| row[key].as_f64()).collect();
            let (low, high) = (number(range, "treatment_low"), number(range, "treatment_high"));
            assert!(values.iter().all(|value| (low..=high).contains(value)), "{range}: {values:?}");
            assert!(values.contains(&low) && values.contains(&high) && low < high, "{range}: {values:?}");
        }
        let area = &load["results"][0];
        assert_eq!(
            (area["result"].as_str(), &area["mesh_error"]),
            (Some("area_fraction"), &rows[i]["area_fraction_error"])
        );
    }
    assert_eq!(place.names("s"), ["contact", "report.html", "study.csv", "study.json", "sweep"]);
    let page = String::from_utf8(place.bytes("s/report.html")).expect("text");
    assert!(page.contains("\"kind\":\"study\"") && page.contains("every second point"), "no study in the page");
    let loads = ["<link", "src=\"", "@import"].into_iter().find(|word| page.contains(word));
    assert_eq!(loads, None, "the page loads something");
    let table = String::from_utf8(place.bytes("s/study.csv")).expect("text");
    assert!(table.starts_with("step,treatment,same_as,control_value,status,"), "{table}");
    assert_eq!(table.lines().count(), 25);
    let of = |name: &str| rows.iter().find(|row| row["treatment"] == name).expect(name);
    // 80 x 64 elements after mirroring, half as many along each side with every second point.
    assert_eq!(of("as prepared")["grid"], serde_json::json!([80, 64]));
    assert_eq!(of("every second point")["grid"], serde_json::json!([40, 32]));
    assert_eq!(of("free patch")["grid"], serde_json::json!([40, 32]));
}

/// The unchanged row is what `rc prepare` and `rc solve` give.
#[test]
fn the_first_row_is_that_of_the_prepared_map() {
    let place = place();
    assert_solved(&place.run(&study(&["--pressures", "1e5", "--quiet", "--out", "s"])));
    let prepare = [&["prepare"], &STUDY[1..6], &["--quiet", "--out", "ready"]].concat();
    assert_solved(&place.run(&prepare));
    let solve = ["solve", "ready", "--e-star", "1e9", "--pressure", "1e5", "--quiet", "--out", "r"];
    assert_solved(&place.run(&solve));
    let (row, summary) = (&place.json("s/study.json")["rows"][0], place.json("r/summary.json"));
    for key in ["area_fraction", "penetration", "mean_gap", "max_pressure", "rms_slope"] {
        let (found, expected) = (number(row, key), number(&summary, key));
        assert!((found / expected - 1.0).abs() < 1e-9, "{key}: {found} and {expected}");
    }
}

#[test]
fn a_study_is_resumed() {
    let place = place();
    let words = study(&["--pressures", "1e5", "--quiet", "--out", "s"]);
    assert_solved(&place.run(&words));
    assert_refused(&place.run(&words), "--resume");
    let (journal, table) = (place.bytes("s/sweep/sweep.jsonl"), place.bytes("s/study.csv"));
    let lines: Vec<&[u8]> = journal.split_inclusive(|byte| *byte == b'\n').collect();
    place.write("s/sweep/sweep.jsonl", lines[..5].concat());
    place.write("s/study.csv", "");
    let again = [&words[..], &["--resume"]].concat();
    assert_solved(&place.run(&again));
    let resumed = place.bytes("s/sweep/sweep.jsonl");
    assert!(resumed.starts_with(&lines[..5].concat()), "the finished rows were not kept");
    assert_eq!(
        place.bytes("s/study.csv").split(|byte| *byte == b'\n').count(),
        table.split(|byte| *byte == b'\n').count()
    );
    let other = study(&["--pressures", "1e5", "--level", "quadratic", "--quiet", "--out", "s", "--resume"]);
    assert_refused(&place.run(&other), "quadratic");
}

#[test]
fn what_does_not_go_together_is_left_out_or_refused() {
    let place = place();
    assert_solved(&place.run(&study(&["--pressures", "1e5", "--kernel", "spectral", "--quiet", "--out", "s"])));
    let skipped = &place.json("s/study.json")["skipped"];
    assert_eq!(skipped.as_array().map(Vec::len), Some(1), "{skipped}");
    assert_eq!(skipped[0]["treatment"], "free patch");
    assert_refused(&place.run(&study(&["--pressures", "1e5", "--pressure", "1e5", "--out", "t"])), "omit --pressure");
    assert_refused(&place.run(&["study", "scan.npy", "--cell", "1e-3", "--pressures", "1e5", "--out", "t"]), "e_star");
    place.write("waves.toml", "waves = 8\ngrid = 64\n");
    assert_refused(&place.run(&["study", "waves.toml", "--pressures", "1e5", "--out", "t"]), "has no height map");
    assert!(!place.path("t").exists());
}

/// Without spikes, all ways to remove them give one map.
#[test]
fn equal_maps_are_solved_once() {
    let place = place();
    let output = place.run(&study(&["--pressures", "1e5", "--out", "s"]));
    assert_solved(&output);
    assert!(text(&output.stdout).contains("'despike 12' gives the map of 'as prepared'"), "{}", text(&output.stdout));
    let record = place.json("s/study.json");
    let rows = record["rows"].as_array().expect("rows");
    let copies: Vec<&Value> = rows.iter().filter(|row| !row["same_as"].is_null()).collect();
    let names: Vec<_> = copies.iter().filter_map(|row| row["treatment"].as_str()).collect();
    assert_eq!(names, ["despike 6", "despike 12"]);
    for copy in copies {
        assert_eq!((&copy["same_as"], &copy["wall_seconds"]), (&rows[0]["treatment"], &rows[0]["wall_seconds"]));
    }
    let journal = text(&place.bytes("s/sweep/sweep.jsonl"));
    assert_eq!(journal.lines().count(), 1 + rows.len() - 2, "a line for each row that was solved, after the settings");
}

#[test]
fn the_page_is_drawn_again_and_repeats_the_study() {
    let place = place();
    let words = ["--pressures", "1e4,1e5", "--level", "quadratic", "--no-despike", "--quiet", "--out", "s"];
    assert_solved(&place.run(&study(&words)));
    let page = place.bytes("s/report.html");
    place.write("s/report.html", "");
    assert_solved(&place.run(&["report", "s"]));
    assert!(place.bytes("s/report.html") == page, "not the same page");
    let html = text(&page);
    assert_eq!(html.matches("\"png\":").count(), 3, "the base and both extremes");
    let command = place.json("s/study.json")["command"].as_str().expect("a command").to_owned();
    assert!(html.contains(&command), "{command}");
    assert_solved(&place.run(&command.split(' ').skip(1).collect::<Vec<_>>()));
    assert_eq!(place.json("again/study.json")["treatments"], place.json("s/study.json")["treatments"], "{command}");
    assert_eq!(place.json("again/study.json")["loads"], place.json("s/study.json")["loads"], "{command}");
}

#[test]
fn what_a_study_cannot_compare_is_refused_before_it_is_solved() {
    let place = place();
    // 40 x 32 points on 4e-4 m x 3.2e-4 m.
    let refused = place.run(&study(&["--force", "128mN", "--out", "t"]));
    assert_refused(&refused, "force: the maps of a study differ in size");
    assert_refused(&refused, "are --pressures 1e6");
    let profile = place.run(&study(&["--line", "--pressures", "1e5", "--out", "t"]));
    assert_refused(&profile, "line: a study is for maps; omit --line");
    // The lowest height in the hole is doubtful, but that treatment is one of the others.
    assert_solved(&place.run(&study(&[
        "--pressures",
        "1e7",
        "--no-periodic",
        "--boundary",
        "free",
        "--strict",
        "--quiet",
        "--out",
        "s",
    ])));
    let large = study(&["--pressures", "1e4,5e8", "--strict", "--out", "t"]);
    assert_refused(&place.run(&large), "nothing was solved or written");
    let prepare = [&["prepare"], &STUDY[1..6], &["--quiet", "--out", "ready"]].concat();
    assert_solved(&place.run(&prepare));
    let again = ["study", "ready", "--e-star", "1e9", "--pressures", "1e5", "--out", "t"];
    assert_refused(&place.run(&again), "give the file that was measured, scan.npy");
    assert!(!place.path("t").exists());
}

#[cfg(unix)]
#[test]
fn an_interrupted_study_has_the_table_of_the_rows_so_far() {
    let place = place();
    let words = study(&["--pressures", "1e4:1e5:200", "--threads", "1", "--quiet", "--out", "s"]);
    let child = std::process::Command::new(env!("CARGO_BIN_EXE_rc"))
        .args(&words)
        .current_dir(place.folder())
        .stderr(std::process::Stdio::piped())
        .spawn()
        .expect("rc runs");
    let rows_so_far = || {
        // The journal may not be there yet.
        std::fs::read_to_string(place.path("s/sweep/sweep.jsonl")).unwrap_or_default().matches('\n').count()
    };
    let started = std::time::Instant::now();
    while rows_so_far() < 4 && started.elapsed().as_secs() < 60 {
        std::thread::sleep(std::time::Duration::from_millis(5));
    }
    let signal = std::process::Command::new("kill").args(["-INT", &child.id().to_string()]).status().expect("kill");
    assert!(signal.success());
    let output = child.wait_with_output().expect("it ends");
    let message = text(&output.stderr);
    assert_eq!(output.status.code(), Some(130), "{message}");
    assert!(message.contains("interrupted with ") && message.contains("s/study.csv; --resume continues"), "{message}");
    let rows = place.json("s/study.json")["rows"].as_array().expect("rows").len();
    let table = text(&place.bytes("s/study.csv"));
    assert_eq!(table.lines().count(), 1 + rows, "{message}");
    // Equal maps are solved once and told for each treatment.
    assert!(rows >= rows_so_far() - 1 && rows < 2400, "{rows} rows: {message}");
    assert!(place.path("s/report.html").exists());
}
