//! Commands that a time limit or Ctrl-C ends early.
//!
//! The results up to then are written and marked.

use crate::support::{Place, assert_refused, assert_solved, text};
use crate::sweep::{result, sweep};

/// A solve that takes some seconds.
const LONG: [&str; 10] =
    ["solve", "--waves", "64", "--grid", "2048", "--pressure", "446395", "--tolerance", "1e-9", "--quiet"];

#[test]
fn a_solve_that_takes_too_long_is_written_and_marked() {
    let place = Place::new();
    for method in ["uniform", "adaptive"] {
        let output = place.run(&[&LONG[..], &["--method", method, "--time-limit", "0.2s", "--out", method]].concat());
        let message = text(&output.stderr);
        assert_eq!(output.status.code(), Some(3), "{method}: {message}");
        assert!(message.starts_with("error: time_limit: 200ms was not enough: "), "{method}: {message}");
        assert!(message.contains("; give a longer time limit or a larger tolerance; the results are"), "{message}");
        assert_eq!(message.matches("give a").count(), 1, "one remedy: {message}");
        assert_eq!(message.lines().count(), 1, "{message}");
        let summary = place.json(&format!("{method}/summary.json"));
        assert_eq!(summary["status"], "not_converged");
        assert!(summary["penetration_error"].as_f64().is_some_and(|error| error > 1e-9), "{summary}");
        assert!(place.path(method).join("pressure.npy").exists());
    }
    let enough = ["solve", "--waves", "4", "--grid", "64", "--pressure", "1e5", "--quiet", "--time-limit", "1h"];
    assert_solved(&place.run(&enough));
    assert_refused(&place.run(&[&LONG[..], &["--time-limit", "soon"]].concat()), "not 'soon'");
}

#[test]
fn what_is_stopped_at_once_has_numbers_all_the_same() {
    let place = Place::new();
    for method in ["uniform", "adaptive", "gauss-seidel"] {
        let scene =
            ["solve", "--waves", "8", "--grid", "128", "--pressure", "446395", "--quiet", "--time-limit", "1us"];
        let output = place.run(&[&scene[..], &["--method", method, "--out", method]].concat());
        assert_eq!(output.status.code(), Some(3), "{method}: {}", text(&output.stderr));
        let summary = place.json(&format!("{method}/summary.json"));
        for key in ["mean_pressure", "penetration", "mean_gap", "area_fraction", "rms_pressure"] {
            assert!(summary[key].is_number(), "{method}: {key} is {}", summary[key]);
        }
        assert!(summary["mean_pressure"].as_f64().is_some_and(|pressure| pressure > 0.0), "{method}: {summary}");
        let largest = ["complementarity_error", "penetration_error", "load_error"].map(|key| summary[key].as_f64());
        assert!(largest.iter().flatten().any(|error| *error > 1e-6), "{method} claims to have converged: {summary}");
        assert_solved(&place.run(&["plot", method, "--quiet"]));
    }
}

#[cfg(unix)]
#[test]
fn an_interrupted_solve_is_written_and_marked() {
    let place = Place::new();
    let child = std::process::Command::new(env!("CARGO_BIN_EXE_rc"))
        .args([&LONG[..], &["--method", "uniform", "--threads", "1", "--out", "r"]].concat())
        .current_dir(place.folder())
        .stderr(std::process::Stdio::piped())
        .spawn()
        .expect("rc runs");
    std::thread::sleep(std::time::Duration::from_millis(700));
    let signal = std::process::Command::new("kill").args(["-INT", &child.id().to_string()]).status().expect("kill");
    assert!(signal.success());
    let output = child.wait_with_output().expect("it ends");
    let message = text(&output.stderr);
    assert_eq!(output.status.code(), Some(130), "{message}");
    assert!(message.contains("error: interrupted: ") && !message.contains("give a"), "{message}");
    assert_eq!(place.json("r/summary.json")["status"], "not_converged");
}

#[test]
fn a_sweep_begins_no_row_after_its_time_and_goes_on_later() {
    let place = Place::new();
    assert_solved(&place.run(&sweep("whole", &["--threads", "1"])));
    let output = place.run(&sweep("short", &["--threads", "1", "--time-limit", "0.01"]));
    let message = text(&output.stderr);
    assert_eq!(output.status.code(), Some(3), "{message}");
    assert!(
        message.contains("10ms was too short for ") && message.contains(" of 12 rows; --resume continues"),
        "{message}"
    );
    assert_solved(&place.run(&sweep("short", &["--threads", "1", "--resume"])));
    assert_eq!(result(&place.path("short")), result(&place.path("whole")));
}
