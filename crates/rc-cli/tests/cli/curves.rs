//! Sweeps in `rc report`, `rc plot` and `rc inspect`, and `rc compare`.

use serde_json::Value;

use crate::support::{Place, assert_refused, assert_solved, text};

/// A sweep of three loads and two seeds with fields, in the folder `sw`.
fn sweep(more: &[&str]) -> Place {
    let place = Place::new();
    let words = ["sweep", "--waves", "8", "--grid", "64", "--pressures", "1e5:4e5:3", "--quiet", "--out", "sw"];
    assert_solved(&place.run(&[&words[..], more].concat()));
    place
}

/// The data of the page of the sweep.
fn page(place: &Place) -> Value {
    assert_solved(&place.run(&["report", "sw", "--quiet"]));
    let page = text(&place.bytes("sw/report.html"));
    for word in ["type=\"range\"", "@media print"] {
        assert!(page.contains(word), "no {word}");
    }
    let (_, data) = page.split_once("id=\"data\">").expect("data");
    serde_json::from_str(data.split_once("</script>").expect("an end").0).expect("JSON")
}

#[test]
fn the_page_has_maps_of_every_row_under_one_scale_and_the_theory() {
    let place = sweep(&["--seeds", "1..2", "--fields"]);
    let page = page(&place);
    assert_eq!(page["geometric"], true);
    let surfaces = page["frames"]["surfaces"].as_array().expect("surfaces");
    assert_eq!((surfaces.len(), &surfaces[1]["name"]), (2, &"seed 2".into()));
    let greatest = page["frames"]["greatest"].as_f64().expect("a pressure");
    for frame in surfaces.iter().flat_map(|surface| surface["frames"].as_array().expect("frames")) {
        assert_eq!(frame["pressure"]["max"].as_f64(), Some(greatest), "one scale");
    }
    assert!(surfaces.iter().all(|surface| surface["frames"].as_array().map(Vec::len) == Some(3)));
    // At low load A/A0 = √(8/π) σ0/(E* h') with E* = 0.4e9/(1 - 0.45²).
    let first = &page["persson"][0]["points"][1];
    let (pressure, area) = (first[0].as_f64().expect("a number"), first[1].as_f64().expect("a number"));
    let slope = place.json("sw/rows/0001/summary.json")["rms_slope"].as_f64().expect("a slope");
    let expected = (8.0 / std::f64::consts::PI).sqrt() * pressure * (1.0 - 0.45 * 0.45) / (0.4e9 * slope);
    assert!((area / expected - 1.0).abs() < 0.05, "{area} instead of {expected}");
    let note = page["note"].as_str().expect("a note");
    let mean = &page["scenes"][0]["mean"][0];
    let n_seeds = page["scenes"][0]["seeds"].as_array().map(Vec::len);
    assert_eq!(n_seeds == Some(2), note.contains("within it in 50 % of all cases"), "{n_seeds:?}: {note}");
    assert!(mean["area_error"].as_f64().expect("an error") > 0.0, "{mean}");
}

#[test]
fn without_fields_the_page_says_what_to_do() {
    let page = page(&sweep(&[]));
    assert_eq!(page["frames"], Value::Null);
    assert!(page["frames_note"].as_str().expect("a note").contains("--fields"));
}

#[test]
fn a_sweep_is_drawn_and_its_means_are_written() {
    let place = sweep(&["--seeds", "1..2", "--fields"]);
    assert_solved(&place.run(&["plot", "sw", "--out", "p"]));
    let names = place.names("p");
    for name in ["area.png", "area.svg", "gap.svg", "penetration.png", "stiffness.svg", "contact-0006.png"] {
        assert!(names.contains(&name.to_owned()), "no {name}: {names:?}");
    }
    assert!(text(&place.bytes("p/area.svg")).contains("Persson"));
    let output = place.run(&["inspect", "sw", "--json", "--out", "m"]);
    assert_solved(&output);
    let means: Value = serde_json::from_slice(&output.stdout).expect("JSON");
    let first = &means["means"][0];
    let areas = ["0001", "0004"]
        .map(|row| place.json(&format!("sw/rows/{row}/summary.json"))["area_fraction"].as_f64().expect("an area"));
    let [mean, error] =
        ["area_fraction", "area_fraction_standard_error"].map(|key| first[key].as_f64().expect("a number"));
    assert!((mean - 0.5 * (areas[0] + areas[1])).abs() < 1e-15);
    assert!((error - 0.5 * (areas[0] - areas[1]).abs()).abs() < 1e-12);
    let csv = text(&place.bytes("m/means.csv"));
    assert!(csv.starts_with("load,seeds,mean_pressure,mean_pressure_standard_error,"), "{csv}");
    assert_eq!(csv.lines().count(), 4);
    assert!(text(&place.run(&["inspect", "sw"]).stdout).contains('±'));
    assert_refused(&place.run(&["compare", "sw", "sw"]), "rows/0001");
}

#[test]
fn two_results_are_compared() {
    let place = Place::new();
    let solve = |grid: &str, cell: &str, out: &str| {
        let words =
            ["solve", "--waves", "8", "--pressure", "1e5", "--quiet", "--grid", grid, "--cell", cell, "--out", out];
        assert_solved(&place.run(&words));
    };
    solve("128", "0.01", "a");
    solve("64", "0.01", "b");
    solve("96", "0.02", "c");
    let compare = |with: &str| -> Value {
        let output = place.run(&["compare", "a", with, "--json", "--out", with]);
        assert_solved(&output);
        serde_json::from_slice(&output.stdout).expect("JSON")
    };
    let same = compare("a");
    for number in same["numbers"].as_array().expect("numbers") {
        assert_eq!(number["difference"].as_f64(), Some(0.0), "{number}");
    }
    assert_eq!((&same["scenes"], same["pressure"]["max"].as_f64()), (&Value::Array(Vec::new()), Some(0.0)));
    let coarse = compare("b");
    assert_eq!(coarse["pressure"]["grid"], serde_json::json!([64, 64]));
    assert!(coarse["pressure"]["mean"].as_f64().expect("a mean").abs() < 1e-3, "the load is the same");
    assert!(place.names("b").contains(&"difference.png".to_owned()));
    let other = compare("c");
    assert!(other["no_picture"].as_str().expect("a reason").contains("cells differ"), "{other}");
    let line = text(&place.run(&["compare", "a", "b"]).stdout);
    assert!(line.contains("the scenes differ in grid (128; 64)"), "{line}");
}
