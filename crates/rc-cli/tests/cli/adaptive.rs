//! The adaptive method on the command line.
//!
//! The tests are about when it runs, what it writes, and agreement with the uniform grid.

use std::process::Output;

use rc_core::Field;
use serde_json::Value;

use crate::solve::assert_close;
use crate::support::{MATERIAL, Place, assert_refused, assert_solved, bumps, f8, map, npy, text};

/// Sixteen waves of 32 elements each. About a tenth of the cell is in contact.
const SCENE: [&str; 6] = ["solve", "--waves", "16", "--grid", "512", "--pressure"];
const PRESSURE: &str = "3e5";

fn scene<'a>(more: &[&'a str]) -> Vec<&'a str> {
    [&SCENE[..], &[PRESSURE], more].concat()
}

fn summary_of(output: &Output) -> Value {
    assert_solved(output);
    serde_json::from_slice(&output.stdout).expect("valid JSON")
}

fn number(summary: &Value, key: &str) -> f64 {
    summary[key].as_f64().unwrap_or_else(|| panic!("{key} is {}", summary[key]))
}

fn reason(summary: &Value) -> &str {
    summary["method_reason"].as_str().expect("text")
}

fn field(place: &Place, name: &str) -> Field {
    rc_heights::npy::read(&place.path(name)).expect("a field")
}

/// Fails unless counted area, rms pressure and penetration of two solutions agree.
fn assert_agree(adaptive: &Value, uniform: &Value) {
    // Both are solved to an energy error below 1e-2. Each error of an observable is below its square.
    for key in ["area_fraction_cells", "area_fraction", "rms_pressure", "penetration"] {
        let tolerance = 2e-4;
        assert_close(key, number(adaptive, key), number(uniform, key), tolerance);
    }
}

#[test]
fn the_default_is_adaptive_and_agrees_with_the_uniform_grid() {
    let place = Place::new();
    let adaptive = summary_of(&place.run(&scene(&["--json"])));
    let uniform = summary_of(&place.run(&scene(&["--json", "--method", "uniform", "--kernel", "love"])));
    assert_eq!((&adaptive["method"], &uniform["method"]), (&"adaptive".into(), &"uniform".into()));
    assert!(reason(&adaptive).starts_with("adaptive: the contact area was estimated as "), "{}", reason(&adaptive));
    assert_agree(&adaptive, &uniform);
    let cells = 512 * 512;
    let count = |summary: &Value, key: &str| summary[key].as_u64().expect("a count");
    assert_eq!(count(&adaptive, "cells_evaluated") + count(&adaptive, "cells_proven"), cells);
    assert!(count(&adaptive, "cells_proven") > cells / 2, "{} proven", adaptive["cells_proven"]);
    assert_eq!((count(&uniform, "cells_evaluated"), count(&uniform, "cells_proven")), (cells, 0));
    for summary in [&adaptive, &uniform] {
        let iterations = summary["level_iterations"].as_array().expect("a list");
        assert_eq!(iterations.len() as u64, count(summary, "levels"));
        assert_eq!(iterations.last(), Some(&summary["iterations"]));
    }
    let in_contact = number(&adaptive, "area_fraction_cells") * cells as f64;
    assert_eq!(count(&adaptive, "elements"), in_contact.round() as u64);
}

#[test]
fn the_method_is_chosen_by_what_can_and_what_is_cheaper() {
    let place = Place::new();
    let small = ["solve", "--waves", "8", "--json", "--pressure"];
    let cases: &[(&[&str], &str, &str)] = &[
        (&["1e5", "--grid", "1024"], "adaptive", "the contact area was estimated as"),
        (&["1e5", "--grid", "128"], "uniform", "cheaper on this grid for the contact area of"),
        (&["1e5", "--grid", "128", "--method", "adaptive"], "adaptive", "as requested"),
        (&["1e5", "--grid", "128", "--method", "uniform"], "uniform", "as requested"),
        (&["1e5", "--grid", "128", "--kernel", "spectral"], "uniform", "has no adaptive form (spectral)"),
        (&["4e6", "--grid", "128"], "uniform", "cheaper on this grid for the contact area of"),
        (&["1e9", "--grid", "128"], "uniform", "contact area of 100 %"),
        (&["1e5", "--grid", "128x64"], "uniform", "needs square elements"),
        (&["1e5", "--grid", "66"], "uniform", "the grid 66 x 66 is too coarse for the adaptive method"),
        (&["1e5", "--grid", "130", "--method", "adaptive"], "adaptive", "as requested"),
        (&["1e5", "--grid", "128", "--tolerance", "1e-12"], "uniform", "1e-12"),
    ];
    for (flags, method, expected) in cases {
        let summary = summary_of(&place.run(&[&small[..], flags].concat()));
        let reason = reason(&summary);
        assert_eq!(summary["method"], *method, "{flags:?}: {reason}");
        assert!(reason.starts_with(&format!("{method}: ")) && reason.contains(expected), "{flags:?}: {reason}");
    }
}

#[test]
fn where_one_method_does_not_fit_into_memory_the_other_is_taken() {
    let place = Place::new();
    // The uniform grid needs 21.0 MB. The adaptive method needs 16.6 MB at an estimated 40 % contact, and 21.5 MB at
    // 100 %.
    let cases = [("1.7e6", "19MB", "adaptive", "does not fit into memory"), ("1e9", "21MB", "uniform", "is cheaper")];
    for (pressure, limit, method, expected) in cases {
        let summary = summary_of(&place.run(&[&SCENE[..], &[pressure, "--memory-limit", limit, "--json"]].concat()));
        let reason = reason(&summary);
        assert_eq!(summary["method"], method, "{pressure} Pa: {reason}");
        assert!(reason.starts_with(&format!("{method}: ")) && reason.contains(expected), "{pressure} Pa: {reason}");
    }
}

#[test]
fn the_files_of_an_adaptive_solve_agree_with_its_summary() {
    let place = Place::new();
    let summary = summary_of(&place.run(&scene(&["--json", "--elements", "--out", "r"])));
    let (pressure, gap) = (field(&place, "r/pressure.npy"), field(&place, "r/gap.npy"));
    assert_close("mean pressure", pressure.mean(), 3e5, 1e-10);
    assert_close("max pressure", pressure.max(), number(&summary, "max_pressure"), 1e-14);
    // Gaps have single precision, and are zero in contact within the tolerance. The height range is about 8 rms heights
    // of 13 µm.
    let bound = 2e-6 * 8.0 * 13e-6;
    assert!(gap.min() >= -bound, "gap of {:e} m", gap.min());
    let in_contact = pressure.values().iter().zip(gap.values()).filter(|(p, _)| **p > 0.0);
    let weighted = in_contact.clone().map(|(p, g)| p * g.abs()).sum::<f64>() / pressure.values().iter().sum::<f64>();
    assert!(weighted <= bound, "mean gap in contact of {weighted:e} m");
    assert_close("mean gap", gap.mean(), number(&summary, "mean_gap"), 1e-6);

    let mut elements = csv::Reader::from_path(place.path("r/elements.csv")).expect("a table");
    let rows: Vec<[f64; 4]> = elements.deserialize().map(|row| row.expect("four numbers")).collect();
    assert_eq!(rows.len() as u64, summary["elements"].as_u64().expect("a count"));
    let load: f64 = rows.iter().map(|[_, _, size, pressure]| size * size * pressure).sum();
    assert_close("load of the elements", load, 3e5 * 1e-4, 1e-10);
    for [x, y, size, value] in rows {
        let (ix, iy) = ((x / size) as usize, (y / size) as usize);
        assert_close("pressure of an element", value, pressure.at(ix, iy), 1e-14);
    }
}

#[test]
fn an_output_grid_holds_the_means_of_an_adaptive_solution() {
    let place = Place::new();
    assert_solved(&place.run(&scene(&["--quiet", "--out", "full"])));
    assert_solved(&place.run(&scene(&["--quiet", "--out", "coarse", "--output-grid", "64x32"])));
    for name in ["pressure.npy", "gap.npy"] {
        let (full, coarse) = (field(&place, &format!("full/{name}")), field(&place, &format!("coarse/{name}")));
        assert_eq!((coarse.grid().nx(), coarse.grid().ny()), (64, 32));
        assert_close(name, coarse.mean(), full.mean(), 1e-12);
        let block: f64 = (0..16).map(|y| full.row(16 * 5 + y)[8 * 7..8 * 8].iter().sum::<f64>()).sum();
        assert!((coarse.at(7, 5) - block / 128.0).abs() <= 1e-12 * full.max(), "{name}: not the mean of its block");
    }
    assert!(place.bytes("full/contact.png") == place.bytes("coarse/contact.png"), "the picture is of the output grid");
}

#[test]
fn an_adaptive_full_contact_is_called_so() {
    let place = Place::new();
    let solve = |pressure: &str| {
        let args = ["solve", "--waves", "8", "--grid", "128", "--method", "adaptive", "--json", "--pressure", pressure];
        summary_of(&place.run(&args))
    };
    let (full, partial) = (solve("2e7"), solve("4e6"));
    assert_eq!((&full["status"], &partial["status"]), (&"full_contact".into(), &"converged".into()));
    assert_eq!(full["elements"], 128 * 128);
    assert!(full["contact_stiffness"].is_null() && partial["contact_stiffness"].is_number());
}

#[test]
fn a_penetration_and_a_height_map_are_solved_adaptively() {
    let place = Place::new();
    place.write("map.npy", npy("<f8", false, "(256, 256)", &f8(&bumps(256))));
    let random = ["--waves", "16", "--grid", "256"];
    let map = [&["--heights", "map.npy", "--cell", "3e-3"], &MATERIAL[..]].concat();
    let cases: [(&[&str], [&str; 2]); 3] =
        [(&random, ["--penetration", "1.5e-5"]), (&map, ["--penetration", "4e-6"]), (&map, ["--pressure", "5e5"])];
    for (surface, control) in cases {
        let solve = |method: &str| {
            let args = [&["solve", "--json", "--method", method], surface, &control].concat();
            summary_of(&place.run(&args))
        };
        let (adaptive, uniform) = (solve("adaptive"), solve("uniform"));
        assert_eq!(adaptive["method"], "adaptive");
        assert_agree(&adaptive, &uniform);
        assert_close("mean_pressure", number(&adaptive, "mean_pressure"), number(&uniform, "mean_pressure"), 1e-3);
        assert_close("h_max", number(&adaptive, "h_max"), number(&uniform, "h_max"), 1e-8);
        assert_close("rms_height", number(&adaptive, "rms_height"), number(&uniform, "rms_height"), 1e-14);
    }
    let beyond = [&["solve", "--method", "adaptive"], &random[..], &["--penetration", "1e-3"]].concat();
    assert_refused(&place.run(&beyond), "full contact");
}

#[test]
fn a_memory_limit_is_kept_before_any_work_and_otherwise_changes_nothing() {
    let place = Place::new();
    let refused = place.run(&scene(&["--memory-limit", "2MB", "--out", "r"]));
    assert_refused(&refused, "memory_limit: the adaptive method on 512 x 512 elements");
    assert!(text(&refused.stderr).contains("limit of 2 MB"), "{}", text(&refused.stderr));
    assert!(!place.path("r").exists(), "a folder was made for nothing");
    place.write("scene.toml", "waves = 8\ngrid = 128\npressure = 1e5\nmemory_limit = \"500kB\"\n");
    assert_refused(&place.run(&["solve", "scene.toml"]), "memory_limit");
    assert_solved(&place.run(&["solve", "scene.toml", "--memory-limit", "1GiB", "--quiet"]));
    assert_refused(&place.run(&scene(&["--memory-limit", "20MB", "--method", "uniform"])), "per side fit");
}

#[cfg(unix)]
#[test]
fn the_finest_grid_is_never_stored() {
    let place = Place::new();
    let args = ["solve", "--waves", "8", "--grid", "4096", "--pressure", "2e4", "--tolerance", "1e-4", "--json"];
    let summary = summary_of(&place.run(&args));
    assert_eq!(summary["method"], "adaptive");
    let heights = 8.0 * 4096.0 * 4096.0;
    let peak = number(&summary, "peak_memory_bytes");
    assert!(peak < heights, "a peak of {peak:e} bytes; the heights alone would be {heights:e}");
}

/// With `auto`, the error of the iteration is far below that of the grid.
///
/// Both errors are summed over three surfaces. The error of the grid is the change from halving the elements, and on a
/// single surface it may be small by chance.
#[test]
fn auto_stops_well_below_the_error_of_the_grid() {
    let place = Place::new();
    let solve = |method: &str, seed: &str, grid: usize, tolerance: &str| {
        let grid = grid.to_string();
        let args = ["solve", "--waves", "16", "--pressure", PRESSURE, "--json", "--method", method, "--seed", seed];
        summary_of(&place.run(&[&args[..], &["--grid", &grid, "--tolerance", tolerance]].concat()))
    };
    let keys = ["area_fraction", "rms_pressure"];
    for (grid, method) in [(64, "uniform"), (128, "uniform"), (256, "uniform"), (256, "adaptive")] {
        let (mut iteration, mut discretisation) = ([0.0; 2], [0.0; 2]);
        for seed in ["1", "2", "3"] {
            let [exact, finer] = [grid, 2 * grid].map(|grid| solve("uniform", seed, grid, "1e-9"));
            let auto = solve(method, seed, grid, "auto");
            for (i, key) in keys.iter().enumerate() {
                iteration[i] += (number(&auto, key) - number(&exact, key)).abs();
                discretisation[i] += (number(&finer, key) - number(&exact, key)).abs();
            }
        }
        for ((key, iteration), discretisation) in keys.iter().zip(iteration).zip(discretisation) {
            assert!(
                iteration < 0.2 * discretisation,
                "{key}, {method} on {grid}: the iteration leaves {iteration:e}, finer elements change {discretisation:e}"
            );
        }
    }
}

#[test]
fn a_scene_keeps_auto_and_the_method_that_ran() {
    let place = Place::new();
    let args =
        ["solve", "--waves", "8", "--grid", "128", "--pressure", "1e5", "--tolerance", "auto", "--quiet", "--out", "r"];
    assert_solved(&place.run(&args));
    let scene = text(&place.bytes("r/scene.toml"));
    assert!(scene.contains("tolerance = \"auto\"") && scene.contains("method = \"uniform\""), "{scene}");
    // The grid has sixteen elements per wave.
    let energy = number(&place.json("r/summary.json"), "energy_tolerance");
    assert_close("energy_tolerance", energy, 6e-2 * 2_f64.powf(-0.75), 1e-12);
}

#[test]
fn a_border_level_refines_edges_and_keeps_the_grid() {
    let place = Place::new();
    let scene = ["solve", "--waves", "8", "--grid", "128", "--pressure", PRESSURE, "--json"];
    let plain = summary_of(&place.run(&scene));
    let output = place.run(&[&scene[..], &["--border-level", "2", "--elements", "--out", "fine"]].concat());
    let fine = summary_of(&output);
    assert_eq!((&fine["grid"], &fine["border_level"]), (&plain["grid"], &2.into()));
    assert_eq!(reason(&fine), "adaptive: only the adaptive method halves elements at the edges of contacts");
    assert!(number(&fine, "area_fraction_cells") < number(&plain, "area_fraction_cells"));
    assert_close("area", number(&fine, "area_fraction"), number(&plain, "area_fraction"), 0.02);
    let pressure = field(&place, "fine/pressure.npy");
    assert_eq!((pressure.grid().nx(), pressure.grid().ny()), (128, 128));
    assert_close("load", pressure.mean(), number(&fine, "mean_pressure"), 1e-12);
    let elements = std::fs::read_to_string(place.path("fine/elements.csv")).expect("a table");
    assert_eq!(elements.lines().count() as u64 - 1, fine["elements"].as_u64().expect("a count"));
    let sizes: std::collections::BTreeSet<&str> =
        elements.lines().skip(1).map(|line| line.split(',').nth(2).expect("a side")).collect();
    assert!(sizes.len() >= 2, "sizes: {sizes:?}");
    // The folder gives the same result again.
    let again = summary_of(&place.run(&["solve", "fine/scene.toml", "--json"]));
    assert_eq!(again["area_fraction"], fine["area_fraction"]);
}

#[test]
fn border_levels_that_cannot_be_are_refused() {
    let place = Place::new();
    let scene = ["solve", "--waves", "8", "--grid", "128", "--pressure", PRESSURE];
    let refused = |more: &[&str], what: &str| {
        let output = place.run(&[&scene[..], more].concat());
        assert_refused(&output, what);
    };
    refused(
        &["--border-level", "2", "--method", "uniform"],
        "method: the method uniform cannot be combined with a border level",
    );
    refused(
        &["--border-level", "2", "--kernel", "spectral"],
        "border_level: a border level cannot be combined with the kernel spectral",
    );
    refused(&["--border-level", "11"], "10 is the deepest");
    refused(&["--border-level", "99999999999"], "10 is the deepest");
    place.write("map.npy", npy("<f8", false, "(128, 128)", &f8(&bumps(128))));
    let output =
        place.run(&map("solve", "map.npy", &["--pressure", PRESSURE, "--border-level", "1", "--cell-y", "0.02"]));
    assert_eq!(output.status.code(), Some(2));
    let refusal = "border_level: a border level cannot be combined with a height map: between the points of a map";
    assert!(text(&output.stderr).contains(refusal), "{}", text(&output.stderr));
}

#[test]
fn border_levels_of_a_map_have_bicubic_heights_between_its_points() {
    let place = Place::new();
    let surface = ["--waves", "8", "--grid", "128"];
    assert_solved(&place.run(&[&["surface"], &surface[..], &["--out", "s", "--quiet"]].concat()));
    let more = ["--pressure", PRESSURE, "--e-star", "5e8", "--border-level", "2", "--json"];
    let of_waves = summary_of(&place.run(&[&["solve"], &surface[..], &more].concat()));
    let output = place.run(&[&["solve", "s/heights.npy", "--cell", "0.01"], &more[..]].concat());
    assert!(text(&output.stderr).contains("assumed: bicubic heights between the points of the map"), "{output:?}");
    let of_map = summary_of(&output);
    assert_eq!((&of_map["method"], &of_map["border_level"]), (&"adaptive".into(), &2.into()));
    for key in ["area_fraction", "rms_pressure", "mean_gap"] {
        assert_close(key, number(&of_map, key), number(&of_waves, key), 2e-3);
    }
}
