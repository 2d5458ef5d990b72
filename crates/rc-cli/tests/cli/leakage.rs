//! `--leakage`: the flow of a contact in files, tables and estimates.

use serde_json::Value;

use crate::support::{Place, assert_refused, assert_solved, npy, small, text};

fn pair(summary: &Value, key: &str) -> [f64; 2] {
    [0, 1].map(|axis| summary["leakage"][key][axis].as_f64().unwrap_or_else(|| panic!("no {key} of axis {axis}")))
}

#[test]
fn a_flow_is_certified_conserved_and_written() {
    let place = Place::new();
    assert_solved(&place.run(&small("1e5", &["--leakage", "--out", "r"])));
    let summary = place.json("r/summary.json");
    let [x, y] = pair(&summary, "permeance");
    assert!(x > 0.0 && y > 0.0, "{summary}");
    assert!(pair(&summary, "relative_error").iter().all(|error| *error <= 1e-9), "{summary}");
    assert!(pair(&summary, "conservation_error").iter().all(|error| *error <= 1e-10), "{summary}");
    assert!(place.bytes("r/leakage.png").starts_with(b"\x89PNG"));
    // Every section across the flow carries the whole flow: the flux times the width of an element, for a pressure drop
    // of 1.
    let name = if y > x { "r/flow_y.npy" } else { "r/flow_x.npy" };
    let flux = rc_heights::npy::read(&place.path(name)).expect("a field");
    let (side, n) = (0.01, flux.grid().nx());
    let index = |section: usize, i: usize| if y > x { (i, section) } else { (section, i) };
    for section in [0, n / 3] {
        let at = |i: usize| flux.at(index(section, i).0, index(section, i).1);
        let flow = (0..n).map(at).sum::<f64>() * side / n as f64;
        assert!((flow / x.max(y) - 1.0).abs() < 1e-8, "{flow} for {x}, {y}");
    }
    // Without the flow, the contact has the same numbers and files, except those of the flow.
    assert_solved(&place.run(&small("1e5", &["--out", "plain"])));
    assert_eq!(place.bytes("r/pressure.npy"), place.bytes("plain/pressure.npy"));
    assert!(place.json("plain/summary.json").get("leakage").is_none());
    assert!(!place.names("plain").iter().any(|name| name.contains("flow") || name.contains("leakage")));
    assert_solved(&place.run(&["solve", "r/scene.toml", "--quiet", "--out", "again"]));
    assert_eq!(place.json("again/summary.json")["leakage"]["permeance"], summary["leakage"]["permeance"]);
    assert_solved(&place.run(&["report", "r", "--quiet"]));
    assert!(text(&place.bytes("r/report.html")).contains("The flux of a film"));
}

#[test]
fn where_nothing_percolates_permeances_are_zero() {
    let place = Place::new();
    let line =
        ["sweep", "--waves", "8", "--grid", "64", "--pressures", "1e5,2e8", "--leakage", "--quiet", "--out", "s"];
    assert_solved(&place.run(&line));
    let table = text(&place.bytes("s/sweep.csv"));
    let mut rows = csv_rows(&table).into_iter();
    let (open, closed) = (rows.next().expect("a row"), rows.next().expect("a row"));
    assert!(open["permeance_x"].parse::<f64>().is_ok_and(|value| value > 0.0), "{open:?}");
    assert_eq!(closed["permeance_x"].parse::<f64>().ok(), Some(0.0), "{closed:?}");
    assert_eq!((&*open["percolates"], &*closed["percolates"]), ("true true", "false false"));
    assert_eq!(closed["permeance_error_x"].parse::<f64>().ok(), Some(0.0), "contact is complete");
}

/// Permeances and error bars along both axes of random surfaces under six loads, from 6 % contact to closed films.
fn random_flows(place: &Place, hurst: &str, grid: &str) -> Vec<[f64; 2]> {
    let surfaces = ["sweep", "--waves", "8", "--hurst", hurst, "--seeds", "11..18", "--rms-slope", "0.1"];
    let loads = ["--e-star", "1e9", "--pressures", "4e6:3.2e7:6", "--leakage", "--quiet", "--grid", grid];
    let out = format!("h{hurst}-{grid}");
    assert_solved(&place.run(&[&surfaces[..], &loads, &["--out", &out]].concat()));
    let rows = csv_rows(&text(&place.bytes(&format!("{out}/sweep.csv"))));
    let of = |row: &Row, key: &str| row[key].parse().unwrap_or_else(|_| panic!("no {key}: {row:?}"));
    let flow =
        |row: &Row, axis: &str| [of(row, &format!("permeance_{axis}")), of(row, &format!("permeance_error_{axis}"))];
    rows.iter().flat_map(|row| ["x", "y"].map(|axis| flow(row, axis))).collect()
}

#[test]
fn error_bars_hold_the_permeance_of_finer_grids() {
    let place = Place::new();
    let (mut held, mut closed, mut ratios) = (Vec::new(), 0, Vec::new());
    for hurst in ["0.3", "0.8"] {
        let exact = random_flows(&place, hurst, "128");
        for ([permeance, bar], [exact, _]) in random_flows(&place, hurst, "32").into_iter().zip(exact) {
            let error = (permeance - exact).abs();
            if permeance > 0.0 || exact > 0.0 {
                held.push(error <= bar);
                ratios.push(bar / error);
            } else {
                closed += 1;
            }
        }
    }
    let share = held.iter().filter(|held| **held).count() as f64 / held.len() as f64;
    ratios.sort_by(f64::total_cmp);
    let median = ratios[ratios.len() / 2];
    assert!(held.len() + closed == 192 && held.len() > 120, "{} leak", held.len());
    assert!(
        share >= 0.95 && median < 5.0,
        "a share of {share} of {} bars holds, with a median of {median}",
        held.len()
    );
}

/// A row of a table by the names of its columns.
type Row = std::collections::BTreeMap<String, String>;

fn csv_rows(table: &str) -> Vec<Row> {
    let mut lines = table.lines().map(|line| line.split(',').map(str::to_owned).collect::<Vec<_>>());
    let names = lines.next().unwrap_or_default();
    // The reason of the method may have commas in quotes. The columns of the flow are the last ones.
    let last = |cells: Vec<String>| names.iter().rev().cloned().zip(cells.into_iter().rev()).take(5).collect();
    lines.map(last).collect()
}

#[test]
fn memory_of_a_flow_is_estimated_and_refused() {
    let place = Place::new();
    let scene = ["--waves", "32", "--grid", "1024", "--pressure", "446395"];
    let bytes = |more: &[&str]| {
        let output = place.run(&[&["solve", "--dry-run", "--json"], &scene[..], more].concat());
        assert_solved(&output);
        let expected: Value = serde_json::from_slice(&output.stdout).expect("valid JSON");
        expected["memory_bytes"].as_f64().expect("bytes")
    };
    let (plain, flow) = (bytes(&[]), bytes(&["--leakage"]));
    assert!(flow - plain > 80.0 * 1024.0 * 1024.0, "{flow} with a flow, {plain} without");
    let limit = [&["solve", "--quiet", "--memory-limit", "100MB"], &scene[..]].concat();
    assert_solved(&place.run(&limit));
    assert_refused(&place.run(&[&limit[..], &["--leakage"]].concat()), "leakage on 1024 x 1024 elements");
}

/// The film closes between two loads of a sweep. Solves at the ends of the bracket confirm it.
#[test]
fn a_sweep_finds_the_pressure_at_which_the_film_closes() {
    let place = Place::new();
    let scene = ["--waves", "8", "--roll-off", "2", "--grid", "64"];
    let film = ["--viscosity", "2mPas", "--pressure-drop", "1bar"];
    let loads = ["--pressures", "1e5:1.2e7:4", "--out", "seal"];
    let output = place.run(&[&["sweep"][..], &scene, &film, &loads].concat());
    assert_solved(&output);
    let printed = text(&output.stdout);
    let line = printed.lines().find(|line| line.starts_with("sealing pressure: ")).expect("a line").to_owned();
    assert!(line.contains(" MPa, contact area ") && line.ends_with("along y"), "{line}");
    assert!(text(&place.run(&["inspect", "seal"]).stdout).contains(&line), "inspect says it too");
    assert_solved(&place.run(&["report", "seal", "--quiet"]));
    let page = text(&place.bytes("seal/report.html"));
    assert!(page.contains(&line[1..]) && page.contains("flow along y (m³/s)") && !page.contains("Percolation is lost"));
    let head = text(&place.bytes("seal/sweep.csv")).lines().next().expect("a head").to_owned();
    assert!(head.contains("flow_x,flow_y,flow_error_x,flow_error_y"), "{head}");
    let sealing = place.json("seal/sealing.json");
    let along_x = &sealing["problems"][0]["surfaces"][0];
    let [leaks, seals] = [0, 1].map(|i| along_x["bracket"][i].as_f64().expect("a pressure"));
    assert!(leaks < seals && seals < 1.011 * leaks, "{along_x}");
    let areas = [0, 1].map(|i| along_x["area_fraction"][i].as_f64().expect("an area"));
    assert!(0.1 < areas[0] && areas[0] < areas[1], "{along_x}");
    for (pressure, percolates) in [(leaks, true), (seals, false)] {
        let pressure = pressure.to_string();
        let folder = format!("at-{percolates}");
        let solve = ["--pressure", &pressure, "--quiet", "--out", &folder];
        assert_solved(&place.run(&[&["solve"][..], &scene, &film, &solve].concat()));
        let leakage = &place.json(&format!("{folder}/summary.json"))["leakage"];
        assert_eq!(leakage["percolates"][0], percolates, "{pressure} Pa");
        let [k, flow] = ["permeance", "flow"].map(|key| leakage[key][0].as_f64().expect("a number"));
        assert!((flow - k * 1e5 / 0.024).abs() <= 1e-12 * flow.abs(), "{flow}, {k}");
    }
}

/// A patch leaks between its borders, and not around a cell.
#[test]
fn a_patch_leaks_between_opposite_borders() {
    let place = Place::new();
    // Walls along x at y = 0 leave a channel along x, which the periodic cell and the patch have alike.
    let ridge = |i: usize| if (i / 32).is_multiple_of(31) { 1e-5_f64 } else { 0.0 };
    let heights: Vec<u8> = (0..32 * 32).flat_map(|i: usize| ridge(i).to_le_bytes()).collect();
    place.write("ridges.npy", npy("<f8", false, "(32, 32)", &heights));
    let solve =
        ["solve", "ridges.npy", "--cell", "1e-3", "--e-star", "1e9", "--pressure", "1e5", "--leakage", "--quiet"];
    assert_solved(&place.run(&[&solve[..], &["--boundary", "free", "--out", "patch"]].concat()));
    let patch = place.json("patch/summary.json");
    assert_eq!(patch["leakage"]["percolates"], serde_json::json!([true, false]), "{}", patch["leakage"]);
    let flux = rc_heights::npy::read(&place.path("patch/flow_x.npy")).expect("a field");
    let through: f64 = (0..32).map(|iy| flux.at(5, iy)).sum::<f64>() * 1e-3 / 32.0;
    let permeance = patch["leakage"]["permeance"][0].as_f64().expect("a number");
    assert!((through / permeance - 1.0).abs() < 1e-4, "{through:e} and {permeance:e}");
}
