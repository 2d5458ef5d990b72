//! `rc sweep --error-of-mean`: the mean and its error.
//!
//! Interruptions must not change the digits.

use std::process::{Command, Stdio};
use std::time::Duration;

use serde_json::Value;

use crate::solve::assert_close;
use crate::support::{Place, assert_refused, assert_solved, bumps, f8, npy, text};
use crate::sweep::table;

/// Arguments for the mean of a small surface under one load, into `out`.
fn mean<'a>(out: &'a str, more: &[&'a str]) -> Vec<&'a str> {
    let small = ["sweep", "--waves", "8", "--grid", "128", "--pressure", "2e5", "--quiet", "--out", out];
    [&small[..], more].concat()
}

#[test]
fn the_mean_is_that_of_many_realisations_within_its_error() {
    let place = Place::new();
    assert_solved(&place.run(&mean("m", &["--error-of-mean", "3%"])));
    let found = &place.json("m/mean.json")[0];
    let number = |key: &str| found[key].as_f64().unwrap_or(f64::NAN);
    assert_eq!((&found["status"], &found["mean_of"]), (&Value::from("converged"), &Value::from("area_fraction")));
    assert!(number("relative_error") <= 0.03 && number("wanted_error").to_bits() == 0.03_f64.to_bits(), "{found}");
    let levels = found["levels"].as_array().expect("levels");
    let grids: Vec<&Value> = levels.iter().map(|level| &level["grid"]).collect();
    assert_eq!(grids, [64, 128], "no coarser grid has 64 elements per side");
    let first = levels[0]["realisations"].as_u64().expect("a number");
    assert!(first > 20 && levels[1]["realisations"].as_u64() < Some(first / 3), "{found}");
    let sum: f64 = levels.iter().map(|level| level["mean"].as_f64().expect("a number")).sum();
    assert!((sum - number("mean")).abs() < 1e-15, "{found}");
    // These seeds differ from those of the mean, and the grid is the finest.
    let plain = ["sweep", "--waves", "8", "--grid", "128", "--pressures", "2e5", "--seeds", "5001..5200", "--quiet"];
    assert_solved(&place.run(&[&plain[..], &["--out", "plain"]].concat()));
    let rows = table(&place.path("plain"));
    let at = rows[0].iter().position(|name| name == "area_fraction").expect("a column");
    let areas: Vec<f64> = rows[1..].iter().map(|row| row[at].parse().expect("a number")).collect();
    let other = areas.iter().sum::<f64>() / 200.0;
    let spread = (areas.iter().map(|area| (area - other).powi(2)).sum::<f64>() / 199.0 / 200.0).sqrt();
    let most = 3.0 * number("standard_error").hypot(spread);
    assert!((number("mean") - other).abs() < most, "{} beside {other}, at most {most} apart", number("mean"));
}

#[test]
fn a_killed_mean_goes_on_to_the_same_digits_with_any_number_of_threads() {
    let place = Place::new();
    let flags = ["--error-of-mean", "4%", "--resume", "--threads"];
    assert_solved(&place.run(&mean("whole", &[&flags[..], &["2"]].concat())));
    let mut child = Command::new(env!("CARGO_BIN_EXE_rc"))
        .args(mean("killed", &[&flags[..], &["1"]].concat()))
        .current_dir(place.folder())
        .stderr(Stdio::null())
        .spawn()
        .expect("rc runs");
    let journal = || std::fs::read_to_string(place.path("killed/sweep.jsonl")).unwrap_or_default();
    while journal().lines().count() < 12 && child.try_wait().expect("a child").is_none() {
        std::thread::sleep(Duration::from_millis(1));
    }
    child.kill().expect("a child");
    assert!(!child.wait().expect("the child has ended").success(), "it was faster than the kill");
    let before = journal();
    let kept = &before[..=before.rfind('\n').expect("whole lines")];
    assert_solved(&place.run(&mean("killed", &[&flags[..], &["3"]].concat())));
    assert!(journal().starts_with(kept), "finished solves were touched");
    assert!(place.bytes("killed/mean.json") == place.bytes("whole/mean.json"), "other digits after a kill");
    // A smaller error continues from the stored rows, and a larger error does not need a solve.
    assert_solved(&place.run(&mean("killed", &["--error-of-mean", "3%", "--resume"])));
    let rows = table(&place.path("killed")).len();
    assert!(rows > table(&place.path("whole")).len(), "nothing was added");
    assert_solved(&place.run(&mean("killed", &["--error-of-mean", "4%", "--resume"])));
    assert_eq!(table(&place.path("killed")).len(), rows);
    assert!(place.bytes("killed/mean.json") == place.bytes("whole/mean.json"), "other digits with more rows");
}

#[test]
fn each_load_has_a_mean_and_the_text_has_every_level() {
    let place = Place::new();
    let loads = ["sweep", "--waves", "8", "--grid", "128", "--pressures", "2e5,4e5", "--error-of-mean", "10%"];
    let output = place.run(&[&loads[..], &["--mean-of", "penetration", "--out", "m"]].concat());
    assert_solved(&output);
    let (printed, found) = (text(&output.stdout), place.json("m/mean.json"));
    assert_eq!(found.as_array().map(Vec::len), Some(2), "{found}");
    for (load, value) in [("2.00000e5", 2e5), ("4.00000e5", 4e5)] {
        let mean = found.as_array().and_then(|all| all.iter().find(|mean| mean["control_value"] == value));
        assert!(mean.is_some_and(|mean| mean["mean_of"] == "penetration"), "{load}: {found}");
    }
    assert_eq!(printed.matches("mean penetration at pressure ").count(), 2, "{printed}");
    assert_eq!(printed.matches("128 minus 64").count(), 2, "{printed}");
    assert!(printed.contains("written to m/mean.json"), "{printed}");
    assert_solved(&place.run(&["report", "m"]));
}

#[test]
fn what_does_not_go_with_a_mean_is_refused() {
    let place = Place::new();
    place.write("map.npy", npy("<f8", false, "(64, 64)", &f8(&bumps(64))));
    let error = ["--error-of-mean", "1%"];
    let cases: &[(&[&str], &str)] = &[
        (&["--seeds", "1..3"], "seeds: cannot be combined with --error-of-mean"),
        (&["--shard", "1/2"], "shard: cannot be combined with --error-of-mean"),
        (&["--list"], "list: cannot be combined with --error-of-mean"),
        (&["--fields"], "fields: cannot be combined with --error-of-mean"),
        (&["--grid", "96"], "grid: the mean needs an even number of at least 128 elements per side, not 96"),
        (&["--seed", "9223372036854775807"], "leaves no room"),
        (&["--mean-of", "seed"], "--mean-of"),
    ];
    for (more, expected) in cases {
        let args = [&["sweep", "--waves", "8", "--pressure", "2e5", "--out", "m"], &error[..], more].concat();
        assert_refused(&place.run(&args), expected);
    }
    let map = ["sweep", "--heights", "map.npy", "--cell", "0.01", "--e-star", "5e8", "--pressure", "2e5", "--out", "m"];
    assert_refused(&place.run(&[&map[..], &error].concat()), "a height map has no other realisations");
    assert_refused(&place.run(&mean("m", &["--mean-of", "penetration"])), "give --error-of-mean");
    assert_refused(&place.run(&mean("m", &["--error-of-mean", "2"])), "0.5%");
    assert!(!place.path("m").exists(), "a folder was made for nothing");
}

#[test]
fn an_error_that_no_grid_gives_is_said_and_marked() {
    let place = Place::new();
    let rough =
        ["sweep", "--waves", "16", "--grid", "128", "--pressure", "1e6", "--error-of-mean", "1.5%", "--out", "m"];
    let output = place.run(&[&rough[..], &["--mean-of", "contact_perimeter", "--quiet"]].concat());
    let message = text(&output.stderr);
    assert_eq!(output.status.code(), Some(3), "{message}");
    assert!(message.contains("on grid 128") && message.contains("give a finer --grid"), "{message}");
    assert_eq!(place.json("m/mean.json")[0]["status"], "not_converged");
}

/// Each seed of a measured surface is a realisation. Twins have one grid, which may be a rectangle.
#[test]
fn spectra_and_twins_have_means() {
    let place = Place::new();
    place.write("psd.csv", "628,1e-19\n5030,1e-22\n");
    place.write("map.npy", npy("<f8", false, "(48, 64)", &f8(&bumps(64)[..48 * 64])));
    let load = ["--cell", "0.01", "--e-star", "5e8", "--pressure", "2e5", "--seed", "7", "--quiet", "--out"];
    let run = |folder: &str, surface: &[&str], error: &str| {
        let mean = ["--error-of-mean", error];
        assert_solved(&place.run(&[&["sweep"], surface, &load, &[folder], &mean].concat()));
        place.json(&format!("{folder}/mean.json"))[0].clone()
    };
    let of_table = run("table", &["--psd", "psd.csv", "--grid", "128"], "20%");
    assert_eq!(of_table["levels"][1]["grid"], 128, "{of_table}");
    assert!(of_table["grid_error"].is_number(), "{of_table}");
    for (folder, surface, grid) in [
        ("coarse", &["--psd", "psd.csv", "--grid", "32"][..], 32),
        ("twin", &["--like", "map.npy", "--cell-y", "0.0075"], 64),
    ] {
        let found = run(folder, surface, "20%");
        assert_eq!((&found["levels"][0]["grid"], &found["grid_error"]), (&grid.into(), &serde_json::Value::Null));
        // The mean is that of a sweep over the same seeds.
        let n = found["levels"][0]["realisations"].as_u64().expect("a number");
        let seeds = format!("7..{}", 6 + n);
        let plain: Vec<&str> = load.iter().copied().filter(|word| !["--seed", "7"].contains(word)).collect();
        let args = [&["sweep"], surface, &plain, &["plain", "--seeds", &seeds, "--json"]].concat();
        let output = place.run(&args);
        assert_solved(&output);
        let rows: serde_json::Value = serde_json::from_slice(&output.stdout).expect("JSON");
        let areas: Vec<f64> =
            rows.as_array().expect("rows").iter().map(|row| row["area_fraction"].as_f64().expect("an area")).collect();
        let mean = areas.iter().sum::<f64>() / areas.len() as f64;
        assert_close("mean area", found["mean"].as_f64().expect("a mean"), mean, 1e-12);
        assert_solved(&place.run(&["report", folder]));
        std::fs::remove_dir_all(place.path("plain")).expect("a folder");
    }
    let text = String::from_utf8(place.bytes("twin/report.html")).expect("text");
    assert!(text.contains("one grid"), "the page has no grid error to show");
}
