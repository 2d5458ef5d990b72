//! Loading and unloading of a plastic contact.

use crate::support::{Place, assert_refused, assert_solved, text};

/// A steep metal surface of 8 waves on 128 x 128 elements.
const METAL: [&str; 7] = ["--cell", "1e-3", "--e-star", "1.2e11", "--hardness", "1e9", "--quiet"];

fn steep<'a>(more: &[&'a str]) -> Vec<&'a str> {
    [&["solve", "--waves", "8", "--grid", "128", "--rms-slope", ".1"], &METAL[..], more].concat()
}

/// The values of an npy file of doubles.
fn values(bytes: &[u8]) -> Vec<f64> {
    let data = 10 + usize::from(u16::from_le_bytes([bytes[8], bytes[9]]));
    bytes[data..].chunks_exact(8).map(|value| f64::from_le_bytes(value.try_into().expect("8 bytes"))).collect()
}

/// Fails unless the summary is that of this mean pressure (Pa), within the rounding of units.
fn assert_load(summary: &serde_json::Value, load: f64) {
    let found = summary["mean_pressure"].as_f64().expect("a number");
    assert!((found / load - 1.0).abs() < 1e-9, "{found} for {load}");
}

#[test]
fn the_unloaded_surface_bears_the_same_load_on_the_same_area() {
    let place = Place::new();
    for method in ["adaptive", "uniform"] {
        let loads = ["--history", "10MPa,0", "--method", method, "--out", "hist"];
        assert_solved(&place.run(&steep(&loads)));
        let first = place.json("hist/summary.json");
        let rms = first["residual_rms_height"].as_f64().expect("a number");
        assert!(rms > 0.0 && rms < first["rms_height"].as_f64().expect("a number"), "{method}: {rms}");
        assert_eq!(first["control"], "pressure", "{method}");
        assert_load(&first, 1e7);
        let residual = [&["solve", "hist/residual.npy"], &METAL[..], &["--pressure", "1e7", "--out", "again"]].concat();
        assert_solved(&place.run(&residual));
        let again = place.json("again/summary.json");
        let area = |summary: &serde_json::Value| summary["area_fraction_cells"].as_f64().expect("a number");
        assert!((area(&again) / area(&first) - 1.0).abs() < 7e-3, "{method}: {} after {}", area(&again), area(&first));
        let flow = |summary: &serde_json::Value| summary["mean_plastic_gap"].as_f64().expect("a number");
        assert!(flow(&again) < 1e-3 * flow(&first), "{method}: {} after {}", flow(&again), flow(&first));
        assert_solved(&place.run(&["solve", "hist/scene.toml", "--out", "twin", "--quiet"]));
        for name in ["residual.npy", "pressure.npy"] {
            assert!(place.bytes(&format!("hist/{name}")) == place.bytes(&format!("twin/{name}")), "{method}: {name}");
        }
        assert_solved(&place.run(&["report", "hist", "--quiet"]));
        assert!(text(&place.bytes("hist/report.html")).contains("unloaded surface"), "{method}");
    }
}

#[test]
fn only_the_plastic_part_of_a_map_is_changed() {
    let place = Place::new();
    let surface =
        ["surface", "--waves", "8", "--grid", "128", "--cell", "1e-3", "--rms-slope", ".1", "--out", "map.npy"];
    assert_solved(&place.run(&[&surface[..], &["--quiet"]].concat()));
    let map = [&["solve", "--heights", "map.npy"], &METAL[..], &["--history", "5e6,1e7,0", "--out", "hist"]].concat();
    assert_solved(&place.run(&map));
    let [before, after] = ["hist/heights.npy", "hist/residual.npy"].map(|name| values(&place.bytes(name)));
    assert!(after.iter().all(|height| height.is_finite()) && after.len() == 128 * 128);
    let changed = before.iter().zip(&after).filter(|(h, r)| (*h - *r).abs() > 1e-15).count() as f64 / (128.0 * 128.0);
    let summary = place.json("hist/summary.json");
    let plastic = summary["plastic_area_fraction"].as_f64().expect("a number");
    assert!(changed > 0.5 * plastic && changed < 2.0 * plastic, "{changed} of the heights, plastic area {plastic}");
    assert!(before.iter().zip(&after).all(|(h, r)| r - h <= 1e-18), "flow has raised a height");
}

#[test]
fn steps_of_a_history_say_what_the_path_changes() {
    let place = Place::new();
    let steps = ["--history", "10MPa,0", "--history-steps", "10"];
    assert_solved(&place.run(&steep(&[&steps[..], &["--out", "steps"]].concat())));
    assert_solved(&place.run(&steep(&["--history", "10MPa,0", "--out", "one"])));
    let tenths = "1MPa,2MPa,3MPa,4MPa,5MPa,6MPa,7MPa,8MPa,9MPa,10MPa,0";
    assert_solved(&place.run(&steep(&["--history", tenths, "--out", "list"])));
    let [steps, one, list] = ["steps", "one", "list"].map(|folder| place.json(&format!("{folder}/summary.json")));
    let difference = &steps["path_difference"];
    assert_eq!(difference["steps"], 10);
    for key in ["area_fraction", "residual_rms_height"] {
        let of = |summary: &serde_json::Value| summary[key].as_f64().expect("a number");
        // The list has the same loads, up to rounding of the units.
        assert!((of(&steps) / of(&list) - 1.0).abs() < 1e-4, "{key}: {} by a list", of(&list));
        let expected = of(&steps) / of(&one) - 1.0;
        let found = difference[key].as_f64().expect("a number");
        assert!((found - expected).abs() < 1e-9 && found.abs() < 0.1, "{key}: {found} for {expected}");
    }
    assert!(difference["removed_volume"].as_f64().is_some_and(|volume| volume != 0.0), "{difference}");
    assert!(one.get("path_difference").is_none());
    assert_refused(&place.run(&steep(&["--pressure", "1e7", "--history-steps", "10"])), "history_steps: a single load");
    assert_refused(&place.run(&steep(&["--history", "1e7", "--history-steps", "0"])), "history_steps: must be from 1");
}

#[test]
fn the_page_of_a_history_shows_the_surface_that_flow_has_left() {
    let place = Place::new();
    assert_solved(&place.run(&steep(&["--history", "10MPa,0", "--out", "hist"])));
    assert_solved(&place.run(&["report", "hist", "--quiet"]));
    let page = text(&place.bytes("hist/report.html"));
    let start = page.find("{\"title\"").expect("the data of the page");
    let data = serde_json::Deserializer::from_str(&page[start..]).into_iter::<serde_json::Value>().next();
    let surface = &data.expect("data").expect("JSON")["surface"];
    assert_eq!(surface["is_left"], true);
    let residual = values(&place.bytes("hist/residual.npy"));
    let lowest = residual.iter().copied().fold(f64::INFINITY, f64::min);
    assert!((surface["lowest"].as_f64().expect("a number") / lowest - 1.0).abs() < 1e-9, "{}", surface["lowest"]);
    // Where the section is in contact, both surfaces are in one place.
    let section = &surface["sections"][0];
    let points =
        section["points"].as_array().expect("points").iter().zip(section["contact"].as_array().expect("flags"));
    let touching: Vec<_> = points.filter(|(_, touches)| **touches == true).map(|(point, _)| point).collect();
    assert!(!touching.is_empty() && touching.iter().all(|point| point[1] == point[2]), "{touching:?}");
    // The elastic surface of a flat summit is flat: the highest points of the section are within the summit's curvature.
    let summary = place.json("hist/summary.json");
    let rms = summary["residual_rms_height"].as_f64().expect("a number");
    let told = surface["lines"].to_string();
    assert!(told.contains(&format!("{:.3}", rms * 1e6)[..4]), "{rms} is not in {told}");
}

#[test]
fn the_bar_of_the_plastic_area_at_a_reload_contains_zero() {
    let place = Place::new();
    for (loads, is_again) in [("10MPa,0,10MPa", true), ("5MPa,10MPa", false)] {
        assert_solved(&place.run(&steep(&["--history", loads, "--out", "hist"])));
        let summary = place.json("hist/summary.json");
        let [area, bar] = ["plastic_area_fraction", "plastic_area_fraction_error"]
            .map(|key| summary[key].as_f64().expect("a number"));
        assert!(area > 0.0 && (bar >= area) == is_again, "{loads}: {area} ± {bar}");
    }
}

#[test]
fn a_history_that_cannot_be_solved_is_refused_in_one_line() {
    let place = Place::new();
    let cases = [
        (&["--history", "1e7,-1"][..], "history: each load must be finite and at least 0 (Pa), not -1"),
        (&["--history", "1e7,nan"], "history: each load must be finite"),
        (&["--history", "0,0"], "history: one of the loads must be above 0"),
        (&["--history", "1e7,x"], "must be a pressure in Pa"),
        (&["--history", "2e9,1e7"], "hardness: 1000000000 Pa cannot bear"),
        (&["--history", "1e7,0", "--pressure", "1e7"], "both pressure and history are given"),
        (&["--history", "1e7,0", "--penetration", "1um"], "both penetration and history are given"),
        (
            &["--history", "1e7,0", "--border-level", "1"],
            "history: a history of loads cannot be combined with a border level",
        ),
        (&["--history", "1e7,0", "--method", "gauss-seidel"], "method: "),
    ];
    for (more, expected) in cases {
        assert_refused(&place.run(&steep(more)), expected);
    }
    let elastic = ["solve", "--waves", "8", "--grid", "64", "--history", "1e5,0"];
    assert_refused(
        &place.run(&elastic),
        "history: an elastic contact keeps nothing of earlier loads; give hardness too",
    );
    let sweep = ["sweep", "--waves", "8", "--grid", "64", "--hardness", "1e7", "--history", "1e5,0", "--out", "s"];
    assert_refused(&place.run(&sweep), "history: a history of loads cannot be combined with a sweep");
    let lists = [&sweep[..], &["--pressures", "1e4,1e5"]].concat();
    assert_refused(&place.run(&lists), "history: a history of loads cannot be combined with a sweep");
}

#[test]
fn a_pressure_of_the_command_line_replaces_the_history_of_a_scene() {
    let place = Place::new();
    place.write("a.toml", "waves = 8\ngrid = 64\nhardness = 1e7\nhistory = [\"0.2MPa\", 1e5, 0]\n");
    assert_solved(&place.run(&["solve", "a.toml", "--out", "both", "--quiet"]));
    assert_load(&place.json("both/summary.json"), 1e5);
    assert_solved(&place.run(&["solve", "a.toml", "--pressure", "2e5", "--out", "one", "--quiet"]));
    let one = place.json("one/summary.json");
    assert_load(&one, 2e5);
    assert!(one.get("residual_rms_height").is_none());
    assert!(!place.names("one").contains(&"residual.npy".to_owned()));
}
