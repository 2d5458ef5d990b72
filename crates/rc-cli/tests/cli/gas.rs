//! A gas in the gap.

use crate::support::{Place, assert_refused, assert_solved, small, text};

/// The values of an npy file of doubles.
fn values(bytes: &[u8]) -> Vec<f64> {
    let data = 10 + usize::from(u16::from_le_bytes([bytes[8], bytes[9]]));
    bytes[data..].chunks_exact(8).map(|value| f64::from_le_bytes(value.try_into().expect("8 bytes"))).collect()
}

#[test]
fn the_inverse_gap_is_that_of_the_files_and_of_both_methods() {
    let place = Place::new();
    for hardness in [None, Some("3e6")] {
        let found = ["uniform", "adaptive"].map(|method| {
            let flags = ["--jump-distance", "0.1um", "--method", method, "--out", method];
            let hard = hardness.map_or(Vec::new(), |hardness| vec!["--hardness", hardness]);
            assert_solved(&place.run(&small("1e5", &[&flags[..], &hard].concat())));
            let value = place.json(&format!("{method}/summary.json"))["mean_inverse_gap"].as_f64().expect("a number");
            let [gap, pressure] = ["gap", "pressure"].map(|name| values(&place.bytes(&format!("{method}/{name}.npy"))));
            let inverse = gap.iter().zip(&pressure).map(|(g, p)| 1.0 / (1e-7 + if *p > 0.0 { 0.0 } else { *g }));
            let direct = inverse.sum::<f64>() / gap.len() as f64;
            assert!((value / direct - 1.0).abs() < 1e-12, "{method}: {value} for {direct}");
            value
        });
        assert!((found[0] / found[1] - 1.0).abs() < 1e-3, "{found:?}");
    }
}

#[test]
fn a_sweep_has_it_in_a_column() {
    let place = Place::new();
    let sweep =
        ["sweep", "--waves", "8", "--grid", "64", "--pressures", "1e5,1e6", "--jump-distance", "1e-7", "--quiet"];
    assert_solved(&place.run(&[&sweep[..], &["--out", "s"]].concat()));
    let table = text(&place.bytes("s/sweep.csv"));
    let mut lines = table.lines().map(|line| line.split(',').collect::<Vec<_>>());
    let header = lines.next().expect("a header");
    let column = header.iter().position(|name| *name == "mean_inverse_gap").expect("a column");
    let found: Vec<f64> = lines.map(|line| line[column].parse().expect("a number")).collect();
    assert!(found.len() == 2 && 0.0 < found[0] && found[0] < found[1], "{found:?}");
    assert_solved(&place.run(&["report", "s", "--quiet"]));
}

#[test]
fn a_jump_distance_is_positive() {
    let place = Place::new();
    for jump in ["0", "-1e-7", "nan"] {
        assert_refused(&place.run(&small("1e5", &["--jump-distance", jump])), "jump_distance: must be positive");
    }
    let tiny = place.run(&small("1e5", &["--jump-distance", "1e-320"]));
    assert_refused(&tiny, "jump_distance: must be from 1e-30 to 1e30 (m)");
    let vary =
        ["sweep", "--waves", "8", "--grid", "64", "--pressure", "1e5", "--vary", "jump_distance=nan", "--out", "s"];
    assert_refused(&place.run(&vary), "vary: jump_distance: must be finite, not NaN");
    assert_solved(&place.run(&small("1e5", &["--out", "r"])));
    assert!(place.json("r/summary.json").get("mean_inverse_gap").is_none());
}
