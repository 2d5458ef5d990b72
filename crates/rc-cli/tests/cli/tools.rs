//! `rc surface`, `rc inspect`, `rc plot` and help.

use crate::support::{Place, SURFACE_PICTURES, assert_refused, assert_solved, small, text};

#[test]
fn a_surface_is_converted_without_loss() {
    let place = Place::new();
    let surface = ["surface", "--waves", "8", "--grid", "64", "--quiet", "--out"];
    for target in ["s", "s.npy", "s.csv"] {
        assert_solved(&place.run(&[&surface[..], &[target]].concat()));
    }
    assert_eq!(place.names("s"), ["heights.npy", "scene.toml", "surface.json", "surface.png"]);
    assert_refused(&place.run(&["surface", "--time-limit", "1s"]), "time_limit: rc surface has none");
    assert_eq!(place.names("."), ["s", "s.csv", "s.npy"]);
    assert!(place.bytes("s/heights.npy") == place.bytes("s.npy"), "two ways to write heights differ");
    assert_solved(&place.run(&["surface", "--heights", "s.csv", "--cell", "0.01", "--quiet", "--out", "again.npy"]));
    assert!(place.bytes("again.npy") == place.bytes("s.npy"), "CSV has lost digits");
    let rms = place.json("s/surface.json")["rms_height"].as_f64().expect("a number");
    assert!((rms / 13e-6 - 1.0).abs() < 1e-12, "rms height {rms:e}, 13e-6 was asked for");
    assert_solved(&place.run(&["solve", "s/scene.toml", "--pressure", "1e5", "--quiet"]));
}

#[test]
fn inspect_knows_a_result_in_the_current_folder() {
    let place = Place::new();
    assert_solved(&place.run(&small("1e5", &["--out", "."])));
    let [folder, file] = [".", "summary.json"].map(|path| place.run(&["inspect", path]));
    assert_solved(&file);
    assert_eq!(file.stdout, folder.stdout);
}

#[test]
fn inspect_measures_what_surface_made() {
    let place = Place::new();
    let surface =
        ["surface", "--waves", "8", "--grid", "64", "--cell", "2e-3", "--rms", "1e-6", "--quiet", "--out", "s"];
    assert_solved(&place.run(&surface));
    let output = place.run(&["inspect", "s/heights.npy", "--cell", "2e-3", "--json"]);
    assert_solved(&output);
    let made = place.json("s/surface.json");
    let measured: serde_json::Value = serde_json::from_slice(&output.stdout).expect("valid JSON");
    for key in ["rms_height", "rms_slope", "rms_curvature", "nayak"] {
        let (a, b) = (made[key].as_f64().expect("a number"), measured[key].as_f64().expect("a number"));
        // Exact sums are compared with a transform of the grid. The difference is rounding, amplified by the fourth
        // power of the wavenumber.
        assert!((a / b - 1.0).abs() < 1e-9, "{key}: made {a}, measured {b}");
    }
    // The folder and its scene are the surface with its exact sums.
    for of_folder in ["s", "s/scene.toml"] {
        let output = place.run(&["inspect", of_folder, "--json"]);
        assert_solved(&output);
        assert_eq!(serde_json::from_slice::<serde_json::Value>(&output.stdout).expect("JSON"), made);
    }
    assert_solved(&place.run(&["plot", "s", "--out", "pictures"]));
    assert_eq!(place.names("pictures"), SURFACE_PICTURES);
    assert_solved(&place.run(&["report", "s"]));
    assert!(text(&place.bytes("s/report.html")).contains("\"kind\":\"surface\""), "not the page of a surface");
    assert_refused(&place.run(&["inspect", "s/heights.npy", "--cell", "-1"]), "cell");
}

#[test]
fn results_are_inspected_and_plotted() {
    let place = Place::new();
    assert_solved(&place.run(&small("1e5", &["--out", "r"])));
    for file in ["r", "r/summary.json", "r/pressure.npy"] {
        let output = place.run(&["inspect", file]);
        assert_solved(&output);
        assert!(text(&output.stdout).contains("contact area"), "{}", text(&output.stdout));
    }
    assert_solved(&place.run(&["plot", "r", "--out", "pictures"]));
    assert_eq!(
        place.names("pictures"),
        ["contact.png", "distribution.png", "distribution.svg", "gap.png", "sections.png", "sections.svg"]
    );
    assert!(place.bytes("pictures/contact.png") == place.bytes("r/contact.png"), "not the same picture again");
    assert_refused(&place.run(&["plot", "nothing"]), "nothing");
    assert_refused(&place.run(&["plot", "pictures"]), "summary.json");
    assert_refused(&place.run(&["inspect", "pictures"]), "summary.json");
}

#[test]
fn means_over_blocks_are_plotted_as_touched() {
    let place = Place::new();
    assert_solved(&place.run(&small("1e5", &["--output-grid", "32", "--out", "r"])));
    let of_elements = place.bytes("r/contact.png");
    assert_solved(&place.run(&["plot", "r", "--quiet"]));
    assert!(place.bytes("r/contact.png") == of_elements, "the picture of the elements is gone");
    assert!(place.names("r").contains(&"touched.png".to_owned()), "{:?}", place.names("r"));
    let distribution = text(&place.bytes("r/distribution.svg"));
    assert!(distribution.contains("touched blocks") && !distribution.contains("in contact"));
    assert!(text(&place.bytes("r/sections.svg")).contains("mean pressure of a block"));
}

#[test]
fn summaries_without_the_newer_keys_are_read() {
    let place = Place::new();
    assert_solved(&place.run(&small("1e5", &["--method", "adaptive", "--out", "r"])));
    let mut summary = place.json("r/summary.json");
    let keys = summary.as_object_mut().expect("an object");
    for key in ["method_reason", "tolerance", "cells_evaluated", "cells_proven", "level_iterations"] {
        assert!(keys.remove(key).is_some(), "no {key}");
    }
    place.write("r/summary.json", summary.to_string());
    let output = place.run(&["inspect", "r"]);
    assert_solved(&output);
    assert!(text(&output.stdout).contains("adaptive") && !text(&output.stdout).contains("evaluated"));
    assert_solved(&place.run(&["inspect", "r", "--json"]));
    assert_solved(&place.run(&["plot", "r", "--out", "pictures"]));
    summary.as_object_mut().expect("an object").remove("penetration");
    place.write("r/summary.json", summary.to_string());
    assert_refused(&place.run(&["inspect", "r"]), "penetration");
}

#[test]
fn shells_and_man_know_every_command() {
    let place = Place::new();
    for shell in ["bash", "zsh", "fish", "elvish", "powershell"] {
        let output = place.run(&["completions", shell]);
        assert_solved(&output);
        let script = text(&output.stdout);
        assert!(script.contains("--low-pass") || script.contains("low-pass"), "{shell}: no flag of rc surface");
        // Flags that a command refuses are hidden there.
        let [limits, errors] = ["time-limit", "area-error"].map(|flag| script.matches(flag).count());
        assert!(errors > 0 && limits > errors, "{shell}: --time-limit {limits}, --area-error {errors}");
    }
    assert_solved(&place.run(&["man", "--out", "man"]));
    let names = place.names("man");
    for page in ["rc.1", "rc-solve.1", "rc-sweep.1", "rc-sweep-merge.1", "rc-surface.1", "rc-inspect.1", "rc-plot.1"] {
        assert!(names.iter().any(|name| name == page), "no {page} in {names:?}");
    }
    let page = text(&place.bytes("man/rc-solve.1"));
    assert!(
        page.starts_with(".ie") && page.contains("A flag also replaces its alternatives"),
        "not the long text: {page}"
    );
    let page = text(&place.bytes("man/rc-sweep-merge.1"));
    assert!(page.contains("\nrc sweep merge [OPTIONS] \\-\\-out <DIR> <DIR>...\n"), "not the usage: {page}");
}

#[test]
fn a_dry_run_tells_elements_memory_and_time_and_does_nothing() {
    let place = Place::new();
    let scene = ["--waves", "32", "--pressure", "446395", "--out", "r"];
    let output = place.run(&[&["solve", "--dry-run", "--json"], &scene[..]].concat());
    assert_solved(&output);
    assert_eq!(place.names("."), Vec::<String>::new(), "something was written");
    let expected: serde_json::Value = serde_json::from_slice(&output.stdout).expect("valid JSON");
    assert_solved(&place.run(&[&["solve", "--quiet"], &scene[..]].concat()));
    let solved = place.json("r/summary.json");
    // Times depend on the machine, so only the other estimates are claims.
    for (estimate, fact) in
        [("elements", "cells_evaluated"), ("memory_bytes", "peak_memory_bytes"), ("area_fraction", "area_fraction")]
    {
        let value = |json: &serde_json::Value, key: &str| json[key].as_f64().unwrap_or_else(|| panic!("no {key}"));
        let ratio = value(&expected, estimate) / value(&solved, fact);
        assert!((0.5..2.0).contains(&ratio), "{estimate}: estimated {ratio} times what it was");
    }
    assert!(expected["wall_seconds"].as_f64().is_some_and(|seconds| seconds > 0.0));
    let printed = place.run(&["solve", "--dry-run", "--waves", "8", "--method", "gauss-seidel", "--pressure", "1e5"]);
    assert!(text(&printed.stdout).contains("not known before"), "{}", text(&printed.stdout));
    assert_refused(&place.run(&["solve", "--dry-run", "--waves", "8"]), "exactly one");
}

#[cfg(target_os = "linux")]
#[test]
fn the_memory_of_the_program_that_starts_it_does_not_count() {
    let place = Place::new();
    let large = vec![1.0_f64; 50 << 20];
    assert_solved(&place.run(&[
        "solve",
        "--waves",
        "8",
        "--grid",
        "64",
        "--pressure",
        "446395",
        "--quiet",
        "--out",
        "r",
    ]));
    let peak = place.json("r/summary.json")["peak_memory_bytes"].as_u64().expect("Linux says");
    let ours = 8 * large.iter().sum::<f64>() as u64;
    assert!(peak < ours / 2, "{peak} bytes, {ours} of the program that started it");
}

#[test]
fn json_is_printed_whatever_else_is_said() {
    let place = Place::new();
    let scene = ["--waves", "4", "--grid", "64", "--json", "--quiet"];
    let json = |args: &[&str]| -> serde_json::Value {
        let output = place.run(&[args, &scene[..]].concat());
        assert_solved(&output);
        assert!(output.stderr.is_empty(), "{}", text(&output.stderr));
        serde_json::from_slice(&output.stdout).expect("valid JSON")
    };
    assert_eq!(json(&["solve", "--pressure", "1e5"])["status"], "converged");
    assert_eq!(json(&["solve", "--pressure", "1e5", "--dry-run"])["status"], "dry_run");
    assert_eq!(json(&["sweep", "--pressures", "1e5", "--out", "s"])[0]["status"], "converged");
    assert_eq!(json(&["surface"])["grid"], serde_json::json!([64, 64]));
    let quiet = place.run(&["solve", "--waves", "4", "--grid", "64", "--pressure", "1e5", "--quiet"]);
    assert_solved(&quiet);
    assert!(quiet.stdout.is_empty() && quiet.stderr.is_empty(), "{}", text(&quiet.stdout));
}

#[test]
fn help_is_no_error() {
    let place = Place::new();
    for args in [&["--help"][..], &["--version"], &["solve", "--help"], &["surface", "--help"]] {
        assert_solved(&place.run(args));
    }
}

#[test]
fn stored_means_over_blocks_are_named_as_such() {
    let place = Place::new();
    assert_solved(&place.run(&small("1e5", &["--output-grid", "32", "--out", "coarse"])));
    let inspected = text(&place.run(&["inspect", "coarse"]).stdout);
    for expected in ["32 x 32 means over blocks of 4 x 4 elements", "touched blocks", "block pressure"] {
        assert!(inspected.contains(expected), "no '{expected}' in: {inspected}");
    }
    assert!(!inspected.contains("% of the elements"), "{inspected}");
}
