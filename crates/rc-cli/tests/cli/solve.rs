//! `rc solve`: files, summaries, repeatability, and the state after a failure.

use std::fs;
use std::process::Command;
use std::time::Duration;

use crate::support::{MATERIAL, Place, assert_refused, assert_solved, bumps, f8, map, npy, small, text};

/// Keys of `summary.json`, in their order.
pub(crate) const KEYS: [&str; 47] = [
    "status",
    "control",
    "kernel",
    "method",
    "method_reason",
    "grid",
    "border_level",
    "elements",
    "levels",
    "mean_pressure",
    "mean_pressure_error_bar",
    "penetration",
    "penetration_error_bar",
    "penetration_full_contact",
    "area_fraction",
    "area_fraction_cells",
    "area_fraction_error",
    "contact_perimeter",
    "rms_pressure",
    "rms_pressure_corrected",
    "rms_pressure_error",
    "max_pressure",
    "mean_gap",
    "mean_gap_error",
    "contact_stiffness",
    "contact_conductance",
    "contact_conductance_error",
    "elastic_energy",
    "rms_height",
    "rms_slope",
    "h_max",
    "complementarity_error",
    "penetration_error",
    "energy_error",
    "load_error",
    "tolerance",
    "energy_tolerance",
    "cells_evaluated",
    "cells_proven",
    "level_iterations",
    "iterations",
    "operator_applications",
    "warnings",
    "wall_seconds",
    "peak_memory_bytes",
    "threads",
    "version",
];

pub(crate) fn assert_close(name: &str, value: f64, reference: f64, tolerance: f64) {
    let error = (value - reference).abs() / reference.abs();
    assert!(error <= tolerance, "{name}: {value:e}, reference {reference:e}, relative error {error:e}");
}

#[test]
fn a_solve_fills_its_folder_and_prints_the_keys_in_order() {
    let place = Place::new();
    let args = ["solve", "--waves", "8", "--grid", "128", "--pressure", "1e5", "--out", "a/result", "--json"];
    let output = place.run(&args);
    assert_solved(&output);
    assert_eq!(
        place.names("a/result"),
        ["contact.png", "gap.npy", "pressure.npy", "scene.toml", "summary.json"],
        "files of the result"
    );
    assert_eq!(place.names("a"), ["result"], "something beside the result");
    assert_eq!(output.stdout, place.bytes("a/result/summary.json"), "standard output is not the summary");
    let printed = text(&output.stdout);
    let keys: Vec<&str> = printed.lines().filter_map(|line| line.strip_prefix("  \"")?.split('"').next()).collect();
    assert_eq!(keys, KEYS);
    let summary = place.json("a/result/summary.json");
    assert_eq!(summary["status"], "converged");
    assert_eq!(summary["control"], "pressure");
    assert_eq!(summary["grid"], serde_json::json!([128, 128]));
    assert_eq!(summary["version"], env!("CARGO_PKG_VERSION"));
    assert!(place.bytes("a/result/contact.png").starts_with(b"\x89PNG"), "contact.png is no picture");
}

#[test]
fn fields_and_summary_of_a_solve_agree() {
    let place = Place::new();
    assert_solved(&place.run(&small("1e5", &["--out", "r"])));
    let summary = place.json("r/summary.json");
    let pressure = rc_heights::npy::read(&place.path("r/pressure.npy")).expect("a field");
    let gap = rc_heights::npy::read(&place.path("r/gap.npy")).expect("a field");
    let number = |key: &str| summary[key].as_f64().unwrap_or_else(|| panic!("{key} is {}", summary[key]));
    // The load of a certified solution is exact to 1e-10. The rest is rounding of sums over the grid.
    assert_close("mean of pressure.npy", pressure.mean(), 1e5, 1e-10);
    assert_close("mean_pressure", number("mean_pressure"), 1e5, 1e-10);
    assert_close("rms_pressure", number("rms_pressure"), pressure.rms(), 1e-12);
    assert_close("max_pressure", number("max_pressure"), pressure.max(), 1e-15);
    assert_close("rms_height", number("rms_height"), 13e-6, 1e-12);
    // The mean of v is zero, so the mean gap follows from the penetration.
    let by_penetration = number("penetration_full_contact") - number("penetration");
    assert_close("mean_gap", number("mean_gap"), by_penetration, 1e-9);
    // Overlaps that the tolerance of the solve leaves in the contact are zero in the file.
    let overlap = gap.mean() / by_penetration - 1.0;
    assert!((-1e-12..1e-8).contains(&overlap) && gap.min() == 0.0, "mean of gap.npy: {overlap:e}");
    let in_contact = pressure.values().iter().filter(|p| **p > 0.0).count() as f64 / pressure.values().len() as f64;
    assert_close("area_fraction_cells", number("area_fraction_cells"), in_contact, 1e-15);
    let energy = number("energy_error");
    assert!(energy <= number("energy_tolerance"), "energy_error is {energy}");
    assert!(summary["tolerance"].is_null(), "a tolerance that nobody asked for");
    assert!(number("load_error") <= 1e-10, "load_error is {}", number("load_error"));
}

#[test]
fn a_result_is_repeated_bit_for_bit_from_its_own_scene() {
    let place = Place::new();
    assert_solved(&place.run(&small("1e5", &["--rms", "7.3e-6", "--out", "first", "--threads", "1"])));
    assert_solved(&place.run(&["solve", "first/scene.toml", "--out", "second", "--quiet", "--threads", "2"]));
    for file in ["pressure.npy", "gap.npy", "scene.toml", "contact.png"] {
        assert!(place.bytes(&format!("first/{file}")) == place.bytes(&format!("second/{file}")), "{file} differs");
    }
}

#[test]
fn a_result_of_a_height_map_is_repeated_from_its_own_folder_alone() {
    let place = Place::new();
    place.write("map.npy", npy("<f8", false, "(64, 64)", &f8(&bumps(64))));
    let args = ["solve", "--heights", "map.npy", "--cell", "3e-3", "--pressure", "2e5", "--quiet", "--out", "first"];
    assert_solved(&place.run(&[&args[..], &MATERIAL].concat()));
    fs::remove_file(place.path("map.npy")).expect("the map was there");
    fs::rename(place.path("first"), place.path("moved")).expect("the folder can be moved");
    assert_solved(&place.run(&["solve", "moved/scene.toml", "--quiet", "--out", "second"]));
    for file in ["pressure.npy", "gap.npy", "heights.npy", "scene.toml"] {
        assert!(place.bytes(&format!("moved/{file}")) == place.bytes(&format!("second/{file}")), "{file} differs");
    }
}

#[test]
fn every_kind_of_height_file_gives_the_same_result() {
    let place = Place::new();
    let heights = bumps(32);
    let columns: Vec<f32> = (0..32 * 32).map(|i| heights[(i % 32) * 32 + i / 32]).collect();
    let csv_row = |row: &[f32]| row.iter().map(|v| f64::from(*v).to_string()).collect::<Vec<_>>().join(",");
    let rows: Vec<String> = heights.chunks(32).map(csv_row).collect();
    let single: Vec<u8> = heights.iter().flat_map(|v| v.to_le_bytes()).collect();
    let big: Vec<u8> = heights.iter().flat_map(|v| f64::from(*v).to_be_bytes()).collect();
    place.write("c.npy", npy("<f8", false, "(32, 32)", &f8(&heights)));
    place.write("fortran.npy", npy("<f8", true, "(32, 32)", &f8(&columns)));
    place.write("single.npy", npy("<f4", false, "(32, 32)", &single));
    place.write("big.npy", npy(">f8", false, "(32, 32)", &big));
    place.write("map.csv", rows.join("\n"));
    let pressure = |file: &str| {
        assert_solved(&place.run(&map("solve", file, &["--pressure", "1e5", "--quiet", "--out", "r"])));
        place.bytes("r/pressure.npy")
    };
    let reference = pressure("c.npy");
    for file in ["fortran.npy", "single.npy", "big.npy", "map.csv"] {
        assert!(pressure(file) == reference, "{file} gives another pressure");
    }
}

#[test]
fn a_control_on_the_command_line_replaces_that_of_the_scene() {
    let place = Place::new();
    place.write("scene.toml", "waves = 8\ngrid = 128\npressure = 1e5\nyoung = 1e9\npoisson = 0.3\n");
    let args = ["solve", "scene.toml", "--penetration", "1e-5", "--e-star", "2e8", "--quiet", "--out", "r"];
    assert_solved(&place.run(&args));
    let scene = text(&place.bytes("r/scene.toml"));
    assert!(scene.contains("penetration") && !scene.contains("pressure"), "{scene}");
    assert!(scene.contains("e_star") && !scene.contains("young"), "{scene}");
    let summary = place.json("r/summary.json");
    assert_eq!(summary["control"], "penetration");
    // A certified penetration is exact to 1e-10 of the peak-to-valley height, about 1e-4 m here.
    assert_close("penetration", summary["penetration"].as_f64().expect("a number"), 1e-5, 1e-8);
}

#[test]
fn an_output_grid_keeps_the_mean_pressure() {
    let place = Place::new();
    assert_solved(&place.run(&small("1e5", &["--output-grid", "32", "--out", "r"])));
    let pressure = rc_heights::npy::read(&place.path("r/pressure.npy")).expect("a field");
    assert_eq!((pressure.grid().nx(), pressure.grid().ny()), (32, 32));
    assert_close("mean pressure", pressure.mean(), 1e5, 1e-10);
}

#[test]
fn full_contact_has_an_infinite_stiffness() {
    let place = Place::new();
    let output = place.run(&["solve", "--waves", "2", "--grid", "16", "--pressure", "1e12", "--json"]);
    assert_solved(&output);
    let summary: serde_json::Value = serde_json::from_slice(&output.stdout).expect("valid JSON");
    assert_eq!(summary["status"], "full_contact");
    assert_eq!(summary["contact_stiffness"], serde_json::Value::Null);
    assert_eq!(summary["area_fraction"], 1.0);
}

#[test]
fn a_result_that_cannot_be_written_is_exit_code_4_and_leaves_no_trace() {
    let place = Place::new();
    fs::create_dir_all(place.path("r/pressure.npy")).expect("a folder in the way of a file");
    let output = place.run(&small("1e5", &["--out", "r"]));
    let message = text(&output.stderr);
    assert_eq!(output.status.code(), Some(4), "{message}");
    assert!(message.lines().count() == 1 && message.contains("pressure.npy"), "{message}");
    assert_eq!(place.names("r"), ["pressure.npy"]);
}

#[test]
fn a_refused_run_leaves_earlier_results_as_they_were() {
    let place = Place::new();
    assert_solved(&place.run(&small("1e5", &["--out", "r"])));
    let before = place.contents("r");
    assert_refused(&place.run(&small("-1", &["--out", "r"])), "pressure");
    assert!(place.contents("r") == before, "the earlier result has changed");
}

#[test]
fn an_interrupted_run_leaves_earlier_results_as_they_were() {
    let place = Place::new();
    assert_solved(&place.run(&small("1e5", &["--out", "r"])));
    let before = place.contents("r");
    // 2048 x 2048 elements to 1e-12 take seconds, so this run is killed long before it can write.
    let mut long = Command::new(env!("CARGO_BIN_EXE_rc"))
        .args(["solve", "--pressure", "1e5", "--tolerance", "1e-12", "--quiet", "--out", "r"])
        .current_dir(place.folder())
        .spawn()
        .expect("rc runs");
    std::thread::sleep(Duration::from_millis(200));
    long.kill().expect("the run is still there");
    assert!(!long.wait().expect("the run has ended").success(), "the run ended before it was interrupted");
    assert!(place.contents("r") == before, "the earlier result has changed");
}

#[test]
fn quiet_prints_nothing_and_a_summary_is_short() {
    let place = Place::new();
    let quiet = place.run(&small("1e5", &[]));
    assert_solved(&quiet);
    assert!(quiet.stdout.is_empty() && quiet.stderr.is_empty());
    let told = place.run(&["solve", "--waves", "8", "--grid", "128", "--pressure", "1e5"]);
    assert_solved(&told);
    let summary = text(&told.stdout);
    assert!(
        summary.lines().count() <= 15 && summary.contains("method") && summary.contains("contact area"),
        "{summary}"
    );
    assert!(told.stderr.is_empty(), "progress without a terminal: {}", text(&told.stderr));
    assert!(place.names(".").is_empty(), "written without --out: {:?}", place.names("."));
}

#[test]
fn single_precision_halves_the_fields_and_keeps_the_contact() {
    let place = Place::new();
    let solve = ["solve", "--waves", "8", "--grid", "128", "--pressure", "1e5", "--quiet"];
    assert_solved(&place.run(&[&solve[..], &["--out", "double"]].concat()));
    assert_solved(&place.run(&[&solve[..], &["--precision", "single", "--out", "single"]].concat()));
    for name in ["pressure.npy", "gap.npy"] {
        let read = |folder: &str| rc_heights::npy::read(&place.path(&format!("{folder}/{name}"))).expect("a field");
        let bytes = |folder: &str| place.bytes(&format!("{folder}/{name}")).len() - 128;
        assert_eq!(2 * bytes("single"), bytes("double"), "{name}");
        for (single, double) in read("single").values().iter().zip(read("double").values()) {
            assert!((single - double).abs() <= 6e-8 * double.abs(), "{name}: {single:e}, {double:e}");
            assert_eq!(*single > 0.0, *double > 0.0, "{name}: {double:e}");
        }
    }
    assert_solved(&place.run(&["report", "single", "--quiet"]));
}
