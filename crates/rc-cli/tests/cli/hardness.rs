//! `--hardness` in several commands.

use crate::support::{Place, assert_refused, assert_solved, small, text};

const KEYS: [&str; 4] = ["hardness", "plastic_area_fraction", "plastic_area_fraction_error", "mean_plastic_gap"];

#[test]
fn a_hardness_bounds_the_pressure_and_is_in_every_file() {
    let place = Place::new();
    for method in ["uniform", "adaptive"] {
        let out = ["--hardness", "3e6", "--method", method, "--out", method];
        assert_solved(&place.run(&small("4e5", &out)));
        let summary = place.json(&format!("{method}/summary.json"));
        let number = |key: &str| summary[key].as_f64().expect(key);
        assert!(number("max_pressure") <= 3e6 && (number("hardness") / 3e6 - 1.0).abs() < 1e-15, "{method}");
        let (area, plastic) = (number("area_fraction"), number("plastic_area_fraction"));
        assert!(
            plastic > 0.0 && plastic < area && 3e6 * plastic < 4e5 && 3e6 * area > 4e5,
            "{method}: {plastic}, {area}"
        );
        assert!(number("plastic_area_fraction_error") > 0.0 && number("mean_plastic_gap") > 0.0, "{method}");
        let scene = text(&place.bytes(&format!("{method}/scene.toml")));
        assert!(scene.contains("hardness = 3000000.0"), "{scene}");
        let names = place.names(method);
        assert!(names.contains(&"plastic_gap.npy".to_owned()), "{names:?}");
        assert_solved(&place.run(&["solve", &format!("{method}/scene.toml"), "--out", "again", "--quiet"]));
        for name in ["pressure.npy", "gap.npy", "plastic_gap.npy"] {
            assert!(
                place.bytes(&format!("{method}/{name}")) == place.bytes(&format!("again/{name}")),
                "{method}: {name}"
            );
        }
        for command in [vec!["report", method], vec!["plot", method], vec!["export", method, "--zarr", "--vtk"]] {
            assert_solved(&place.run(&[&command[..], &["--quiet"]].concat()));
        }
        let page = text(&place.bytes(&format!("{method}/report.html")));
        assert!(page.contains("plastic area"), "{method}: the page does not say the plastic area");
        let image = place.bytes(&format!("{method}/fields.vti"));
        assert!(String::from_utf8_lossy(&image).contains("Name=\"plastic_gap\""), "{method}");
        assert!(place.names(&format!("{method}/fields.zarr")).contains(&"plastic_gap".to_owned()), "{method}");
    }
}

#[test]
fn without_a_hardness_nothing_is_said_of_it() {
    let place = Place::new();
    assert_solved(&place.run(&small("4e5", &["--out", "r"])));
    let summary = place.json("r/summary.json");
    assert!(KEYS.iter().all(|key| summary.get(key).is_none()), "{summary}");
    assert!(!place.names("r").contains(&"plastic_gap.npy".to_owned()));
    assert!(!text(&place.bytes("r/scene.toml")).contains("hardness"));
}

#[test]
fn a_sweep_has_the_plastic_area_of_each_load() {
    let place = Place::new();
    let sweep = ["sweep", "--waves", "8", "--grid", "64", "--hardness", "2e6", "--pressures", "1e5,1e6", "--quiet"];
    assert_solved(&place.run(&[&sweep[..], &["--out", "s"]].concat()));
    let table = text(&place.bytes("s/sweep.csv"));
    let mut lines = table.lines().map(|line| line.split(',').collect::<Vec<_>>());
    let header = lines.next().expect("a header");
    let column = header.iter().position(|name| *name == "plastic_area_fraction").expect("a column");
    let areas: Vec<f64> = lines.map(|line| line[column].parse().expect("a number")).collect();
    assert!(areas.len() == 2 && areas[0] < areas[1] && areas[1] <= 0.5, "{areas:?}");
}

#[test]
fn a_load_that_the_hardness_does_not_bear_is_refused_in_one_line() {
    let place = Place::new();
    for (hardness, words) in [("4e5", "cannot bear"), ("3e5", "cannot bear"), ("0", "positive"), ("-1", "positive")] {
        let output = place.run(&small("4e5", &["--hardness", hardness]));
        assert_refused(&output, words);
        assert!(text(&output.stderr).contains("hardness"), "{}", text(&output.stderr));
    }
    assert_refused(
        &place.run(&small("4e5", &["--hardness", "4e6", "--method", "gauss-seidel"])),
        "method: the method gauss-seidel cannot be combined with a hardness",
    );
}
