//! Rectangular cells in all commands.
//!
//! Both methods must agree with the square of copies of the cell.

use crate::support::{MATERIAL, Place, assert_refused, assert_solved, npy, text};

const TAU: f64 = std::f64::consts::TAU;

/// Smooth periodic bumps (m) on 128 x 64 points, in a cell of 2 mm by 1 mm.
fn map() -> Vec<u8> {
    let height = |i: usize| {
        let (x, y) = ((i % 128) as f64 / 128.0, (i / 128) as f64 / 64.0);
        1e-6 * ((TAU * (2.0 * x + y)).cos()
            + 0.7 * (TAU * (x - 2.0 * y + 0.3)).sin()
            + 0.4 * (TAU * (5.0 * x + 0.1)).cos())
    };
    let bytes: Vec<u8> = (0..128 * 64).flat_map(|i| height(i).to_le_bytes()).collect();
    npy("<f8", false, "(64, 128)", &bytes)
}

const CELL: [&str; 4] = ["--cell", "2e-3", "--cell-y", "1e-3"];
const CONTACT: [&str; 6] = ["--e-star", "1e9", "--pressure", "3e5", "--quiet", "--out"];

#[test]
fn a_rectangular_cell_has_the_contact_of_the_square_of_its_copies() {
    let place = Place::new();
    place.write("map.npy", map());
    let adaptive = ["solve", "--heights", "map.npy", "--method", "adaptive"];
    assert_solved(&place.run(&[&adaptive[..], &CELL, &CONTACT, &["part"]].concat()));
    let repeat = ["surface", "--heights", "map.npy", "--repeat", "square", "--quiet", "--out", "copies"];
    assert_solved(&place.run(&[&repeat[..], &CELL].concat()));
    for method in ["uniform", "adaptive"] {
        let solve = ["solve", "copies/scene.toml", "--method", method];
        assert_solved(&place.run(&[&solve[..], &CONTACT, &[method]].concat()));
    }
    let part = place.json("part/summary.json");
    assert_eq!(part["method"], "adaptive", "{part}");
    let number = |json: &serde_json::Value, key: &str| json[key].as_f64().unwrap_or_else(|| panic!("no {key}: {json}"));
    for copies in ["uniform", "adaptive"] {
        let whole = place.json(&format!("{copies}/summary.json"));
        assert_eq!(whole["grid"], serde_json::json!([128, 128]));
        let per_cell = ["elastic_energy", "contact_perimeter"];
        let means = ["area_fraction", "penetration", "rms_pressure", "mean_gap", "rms_height", "rms_slope", "h_max"];
        for (key, times) in means.map(|key| (key, 1.0)).into_iter().chain(per_cell.map(|key| (key, 2.0))) {
            let (a, b) = (times * number(&part, key), number(&whole, key));
            assert!((a / b - 1.0).abs() < 1e-4, "{key}: {a:e} of the rectangle, {b:e} of {copies} copies");
        }
    }
    // The scene of a result has the cell.
    assert_solved(&place.run(&["solve", "part/scene.toml", "--quiet", "--out", "again"]));
    assert!(place.bytes("again/pressure.npy") == place.bytes("part/pressure.npy"), "not the same result again");
}

#[test]
fn pictures_pages_and_exports_have_the_sides_of_the_cell() {
    let place = Place::new();
    place.write("map.npy", map());
    assert_solved(&place.run(&[&["solve", "--heights", "map.npy"], &CELL[..], &CONTACT[..], &["r"]].concat()));
    assert_solved(&place.run(&["plot", "r", "--out", "pictures"]));
    assert_solved(&place.run(&["report", "r", "--out", "r.html"]));
    assert_solved(&place.run(&["export", "r", "--vtk", "--zarr", "--out", "e"]));
    let png = place.bytes("pictures/gap.png");
    let pixels = |at: usize| f64::from(u32::from_be_bytes([png[at], png[at + 1], png[at + 2], png[at + 3]]));
    assert!(pixels(16) > 1.7 * pixels(20), "a picture of {} x {}", pixels(16), pixels(20));
    let page = text(&place.bytes("r.html"));
    assert!(page.contains("\"sides\":[0.002,0.001]") && page.contains("2 mm by 1 mm"), "no sides on the page");
    let image = text(&place.bytes("e/fields.vti"));
    assert!(image.contains("Spacing=\"1.5625e-5 1.5625e-5"), "{}", &image[..400]);
    assert_eq!(place.json("e/fields.zarr/.zattrs")["cell_y"], serde_json::json!(1e-3));
    let inspected = place.run(&[&["inspect", "map.npy"], &CELL[..]].concat());
    assert_solved(&inspected);
    assert!(text(&inspected.stdout).contains("2 mm by 1 mm with 128 x 64 elements"), "{}", text(&inspected.stdout));
}

#[test]
fn what_does_not_go_with_a_rectangle_is_refused() {
    let place = Place::new();
    place.write("map.npy", map());
    let solve = [&["solve", "--pressure", "1e5", "--out", "r"], &MATERIAL[..]].concat();
    let refused = |args: &[&str], expected: &str| assert_refused(&place.run(&[&solve[..], args].concat()), expected);
    refused(&["--waves", "8", "--cell-y", "1e-3"], "cell_y: applies to height maps");
    let gauss_seidel = ["--heights", "map.npy", "--method", "gauss-seidel"];
    refused(&[&gauss_seidel[..], &CELL].concat(), "square cell");
    // The cell is a square, and its elements are half as long along x as along y.
    let oblong = ["--heights", "map.npy", "--method", "adaptive", "--cell", "2e-3", "--cell-y", "2e-3"];
    refused(&oblong, "square elements");
    for (side, expected) in [("0", "cell_y"), ("nan", "cell_y"), ("-1", "cell_y"), ("1e9", "factor of 10000")] {
        refused(&["--heights", "map.npy", "--cell", "2e-3", "--cell-y", side], expected);
    }
    let repeat = ["surface", "--heights", "map.npy", "--repeat", "square", "--cell", "1.4142135", "--cell-y", "1"];
    assert_refused(&place.run(&repeat), "copies along a side of a map of 128 x 64 points");
    assert_eq!(place.names("."), ["map.npy"]);
}
