//! Measured surfaces on the command line: units, cells, treatments and refusals.

use std::path::Path;

use crate::support::{
    MATERIAL, Place, SURFACE_PICTURES, assert_refused, assert_solved, bumps, codes, f8, map, npy, text,
};

/// Path of a file of data/formats/.
fn sample(name: &str) -> String {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../../data/formats").join(name).display().to_string()
}

#[test]
fn a_measured_map_becomes_a_surface_that_is_solved() {
    let place = Place::new();
    let scan = sample("surfalize-missing.sdf");
    // The map has 12 x 8 points on 24 µm x 24 µm. It is a square, has a hole, and is not periodic. The form is fitted
    // to the measured points before the hole is filled, whatever the order of the flags.
    assert_refused(
        &place.run(&[&["solve", "--heights", &scan, "--pressure", "1e5"], &MATERIAL[..]].concat()),
        "--fill laplace",
    );
    let treat = [
        "surface",
        "--heights",
        &scan,
        "--fill",
        "laplace",
        "--level",
        "plane",
        "--periodic",
        "mirror",
        "--resample",
        "32",
    ];
    let output = place.run(&[&treat[..], &["--out", "ready"]].concat());
    assert_solved(&output);
    let printed = text(&output.stdout);
    for words in ["as read", "fill laplace", "level plane", "periodic mirror", "resample 32 x 32", "Sdr", "border step"]
    {
        assert!(printed.contains(words), "no '{words}' in:\n{printed}");
    }
    let json = place.json("ready/surface.json");
    assert_eq!(json["cell"].as_f64().map(|cell| (cell * 1e9).round()), Some(48_000.0), "twice 24 µm");
    let treatments = json["treatments"].as_array().expect("a list");
    assert_eq!(treatments.len(), 5);
    let states: Vec<_> = treatments.iter().map(|row| (row["treatment"].as_str(), row["missing"].as_u64())).collect();
    let expected = [("as read", 1), ("level plane", 1), ("fill laplace", 0)];
    assert_eq!(states[..3], expected.map(|(name, missing)| (Some(name), Some(missing))));
    let solve = ["solve", "ready", "--e-star", "1e9", "--pressure", "1e6", "--quiet", "--out", "result"];
    assert_solved(&place.run(&solve));
    // The result is repeated from its own folder, in which the map no longer has units.
    let again = ["solve", "result/scene.toml", "--quiet", "--out", "again"];
    assert_solved(&place.run(&again));
    assert!(place.bytes("again/pressure.npy") == place.bytes("result/pressure.npy"), "not the same result again");
}

#[test]
fn the_cell_is_that_of_the_file_and_units_are_applied_once() {
    let place = Place::new();
    let json = |args: &[&str]| -> serde_json::Value {
        let output = place.run(&[&["inspect", "--json"], args].concat());
        assert_solved(&output);
        serde_json::from_slice(&output.stdout).expect("valid JSON")
    };
    let from_x3p = json(&[&sample("surfalize.x3p")]);
    // These are the same heights as bare numbers, in nm.
    let csv = sample("expected.csv");
    let sides = ["--cell", "24e-6", "--cell-y", "24e-6"];
    let from_csv = json(&[&[&*csv, "--unit", "nm"], &sides[..]].concat());
    let scaled = json(&[&[&*csv, "--height-scale", "1e-9"], &sides[..]].concat());
    let in_two_units = json(&[&[&*csv, "--unit", "um", "--height-unit", "nm"], &sides[..]].concat());
    for key in ["cell", "rms_height", "rms_slope", "h_max"] {
        let of = |json: &serde_json::Value| json[key].as_f64().expect("a number");
        for other in [&from_csv, &scaled, &in_two_units] {
            assert!((of(other) / of(&from_x3p) - 1.0).abs() < 1e-9, "{key}: {} and {}", of(other), of(&from_x3p));
        }
    }
    let sq = from_x3p["parameters"]["sq"].as_f64().expect("a number");
    assert!((sq / 0.70065932e-6 - 1.0).abs() < 1e-6, "Sq = {sq}, surfalize says 0.70066 µm");
}

#[test]
fn contradictions_and_what_is_missing_are_refused() {
    let place = Place::new();
    let (x3p, png) = (sample("surfalize.x3p"), sample("pillow.png"));
    place.write("map.xyz", "0 0 1\n1 0 2\n2 0 3\n0 1 4\n1 1 5\n2 1 7\n");
    place.write("map.npy", npy("<f8", false, "(8, 8)", &f8(&bumps(8))));
    let cases: [(&[&str], &str); 13] = [
        (&["surface", "--heights", &x3p, "--cell", "1e-3"], "24 µm wide, but cell says 1 mm"),
        (&["surface", "--heights", &x3p, "--unit", "um"], "names its units"),
        (&["surface", "--heights", &x3p, "--height-scale", "1e-9"], "names the unit of its heights"),
        (&["surface", "--heights", &png, "--cell", "1"], "height_scale"),
        (&["surface", "--heights", &png, "--cell", "1", "--unit", "um", "--height-scale", "1e-9"], "omit unit"),
        (&["surface", "--heights", "map.xyz", "--cell-y", "1"], "2 m high, but cell_y says 1 m"),
        (&["surface", "--heights", "map.npy", "--cell", "1", "--unit", "V"], "'V' is not a unit of length"),
        (&["surface", "--heights", "map.npy", "--cell", "1", "--crop", "9"], "not inside the map of 8 x 8"),
        (&["surface", "--heights", "map.npy", "--cell", "1", "--crop", "half"], "512x256+100+50"),
        (&["surface", "--heights", "map.npy", "--cell", "0.01", "--low-pass", "1"], "low_pass"),
        (&["surface", "--heights", "map.npy", "--cell", "1", "--resample", "0"], "resample"),
        (&["surface", "--waves", "8", "--level", "plane"], "--heights"),
        (&["surface", "--waves", "8", "--unit", "um"], "height_scale"),
    ];
    for (args, expected) in cases {
        assert_refused(&place.run(&[args, &["--out", "s"]].concat()), expected);
    }
    assert_eq!(place.names("."), ["map.npy", "map.xyz"], "something was written");
    assert_refused(&place.run(&["solve", "--waves", "8", "--crop", "4"]), "--crop");
}

#[test]
fn a_height_map_never_gets_the_size_or_the_material_of_the_example() {
    let place = Place::new();
    place.write("map.npy", npy("<f8", false, "(16, 16)", &f8(&bumps(16))));
    let x3p = sample("surfalize.x3p");
    let all = "needs cell (m), and e_star (Pa) or young (Pa) with poisson too";
    let material = "needs e_star (Pa) or young (Pa) with poisson too";
    let cases: [(&[&str], &str); 9] = [
        (&["solve", "--heights", "map.npy", "--pressure", "1e5"], all),
        (&["solve", "--heights", "map.npy", "--pressure", "1e5", "--dry-run"], all),
        (&["solve", "--heights", "map.npy", "--pressure", "1e5", "--cell", "1"], material),
        (&["solve", "--heights", "map.npy", "--pressure", "1e5", "--cell", "1", "--young", "1e9"], "needs poisson too"),
        (&["solve", "--heights", "map.npy", "--pressure", "1e5", "--e-star", "1e9"], "needs cell (m) too"),
        (&["solve", "--heights", &x3p, "--pressure", "1e5"], material),
        (&["sweep", "--heights", "map.npy", "--pressures", "1e5,2e5"], all),
        (&["surface", "--heights", "map.npy"], "needs cell (m) too"),
        (&["surface", "--heights", "map.npy", "--level", "plane"], "needs cell (m) too"),
    ];
    for (args, expected) in cases {
        assert_refused(&place.run(&[args, &["--out", "r"]].concat()), expected);
    }
    place.write("map.toml", "heights = \"map.npy\"\npressure = 1e5\n");
    assert_refused(&place.run(&["solve", "map.toml", "--out", "r"]), all);
    assert_eq!(place.names("."), ["map.npy", "map.toml"], "something was written");
    // A flag, a scene file or the map itself may give the size. Commands that only inspect have a default.
    assert_solved(&place.run(&["solve", "map.toml", "--cell", "1e-3", "--e-star", "1e9", "--quiet"]));
    assert_solved(&place.run(&["surface", "--heights", &x3p, "--quiet"]));
    assert_solved(&place.run(&["inspect", "map.npy"]));
}

#[test]
fn points_of_a_map_without_a_size_are_squares() {
    let place = Place::new();
    let heights: Vec<f32> =
        (0..48 * 32).map(|i| ((i % 48) as f32 * 0.3).sin() * 1e-6 + (i / 48) as f32 * 1e-8).collect();
    place.write("map.npy", npy("<f8", false, "(32, 48)", &f8(&heights)));
    let treat = ["surface", "--heights", "map.npy", "--cell", "3e-3"];
    assert_solved(&place.run(&[&treat[..], &["--crop", "square", "--out", "square", "--quiet"]].concat()));
    let json = place.json("square/surface.json");
    assert_eq!(json["cell"].as_f64().map(|cell| (cell * 1e9).round()), Some(2e6), "32 of 48 points on 3 mm");
    assert_eq!(json["treatments"][1]["grid"], serde_json::json!([32, 32]));
    assert_solved(&place.run(&[&treat[..], &["--level", "plane", "--out", "whole", "--quiet"]].concat()));
    let sides =
        ["cell", "cell_y"].map(|key| place.json("whole/surface.json")[key].as_f64().map(|side| (side * 1e9).round()));
    assert_eq!(sides, [Some(3e6), Some(2e6)]);
    // Other commands assume the same and say so, unless the other side is given.
    let press = ["--e-star", "1e9", "--pressure", "1e4", "--boundary", "free", "--json", "--quiet", "--out"];
    let summary = |flags: &[&str], out: &str| {
        let solve = ["solve", "--heights", "map.npy", "--cell", "3e-3"];
        assert_solved(&place.run(&[&solve[..], flags, &press[..], &[out]].concat()));
        place.json(&format!("{out}/summary.json"))
    };
    let (assumed, given) = (summary(&[], "assumed"), summary(&["--cell-y", "2e-3"], "given"));
    assert_eq!(assumed["area_fraction"], given["area_fraction"]);
    assert_eq!((codes(&assumed), codes(&given)), (vec!["assumed".to_owned()], Vec::new()));
    let square = summary(&["--cell-y", "3e-3"], "square-cell");
    assert_ne!(square["area_fraction"], given["area_fraction"]);
    // The scene of a result keeps the sides.
    assert_solved(&place.run(&["solve", "square-cell", "--quiet", "--out", "again"]));
    assert!(place.bytes("again/pressure.npy") == place.bytes("square-cell/pressure.npy"), "another cell");
    let output = place.run(&["inspect", "map.npy", "--cell", "3e-3"]);
    assert_solved(&output);
    let told = text(&output.stderr);
    assert!(told.starts_with("warning: assumed: equal spacings") && told.contains("3 mm by 2 mm"), "{told}");
}

#[test]
fn a_treated_map_that_does_not_fit_is_refused_before_it_is_made() {
    let place = Place::new();
    place.write("map.npy", npy("<f8", false, "(64, 64)", &f8(&bumps(64))));
    let treat = ["surface", "--heights", "map.npy", "--cell", "0.01", "--out", "s"];
    for (flags, expected) in [
        (&["--resample", "1048576"][..], "the map after resample 1048576 x 1048576 on"),
        (&["--periodic", "mirror", "--memory-limit", "1MB"], "the map after periodic mirror on 128 x 128"),
        (&["--resample", "1048576x2", "--memory-limit", "1MB"], "memory_limit"),
    ] {
        assert_refused(&place.run(&[&treat[..], flags].concat()), expected);
    }
    assert_eq!(place.names("."), ["map.npy"]);
}

#[test]
fn cut_off_and_damaged_files_are_refused_with_one_line() {
    let place = Place::new();
    for name in ["surfalize.x3p", "surfalize-binary.sdf", "surfalize-text.sdf", "pillow.png", "pillow-lzw.tif"] {
        let bytes = std::fs::read(sample(name)).expect("a sample");
        place.write(name, &bytes[..bytes.len() / 2]);
        let refused = |args: &[&str]| assert_refused(&place.run(args), name);
        refused(&["inspect", name, "--height-scale", "1e-9"]);
        refused(&map("solve", name, &["--pressure", "1e5", "--out", "r"]));
    }
}

#[test]
fn inspect_draws_a_map_of_any_shape() {
    let place = Place::new();
    let points: Vec<String> = (0..48).map(|i| format!("{} {} {}", i % 8, i / 8, (i * 7) % 5)).collect();
    place.write("map.xyz", points.join("\n"));
    let output = place.run(&["inspect", "map.xyz", "--unit", "um", "--out", "look"]);
    assert_solved(&output);
    assert!(text(&output.stdout).contains("8 µm by 6 µm with 8 x 6 elements"), "{}", text(&output.stdout));
    assert_eq!(place.names("look"), SURFACE_PICTURES);
}

#[test]
fn channels_are_listed_and_one_of_them_is_read() {
    let place = Place::new();
    let stack = sample("igorwriter-stack.ibw");
    // A point of the heights is missing.
    let output = place.run(&["inspect", &stack, "--out", "look"]);
    assert_solved(&output);
    let printed = text(&output.stdout);
    assert!(printed.contains("heights      Height, read") && printed.contains("missing            1 of "), "{printed}");
    assert_eq!(
        place.names("look"),
        ["distribution.png", "distribution.svg", "material_ratio.png", "material_ratio.svg", "surface.png"],
        "no spectrum"
    );
    let output = place.run(&["inspect", &stack, "--channel", "phase", "--height-scale", "1e-9"]);
    assert_solved(&output);
    let printed = text(&output.stdout);
    assert!(printed.contains("not heights  Phase\n") && printed.contains("Height, read unless --channel"), "{printed}");
    let output = place.run(&["inspect", &stack, "--channel", "Phase", "--height-scale", "1e-9", "--json"]);
    assert_solved(&output);
    let record: serde_json::Value = serde_json::from_slice(&output.stdout).expect("JSON");
    assert!((record["h_max"].as_f64().expect("a height") / 90e-9 - 1.0).abs() < 1e-6, "{}", record["h_max"]);
    assert_eq!(record["channels"][1]["name"], "Height");
    let refused: [(&[&str], &str); 4] = [
        (
            &["surface", "--heights", &stack, "--channel", "Slope"],
            "no channel is called 'Slope'; the file has Phase, Height",
        ),
        (&["surface", "--heights", &stack, "--channel", "Phase"], "not lengths"),
        (&["surface", "--waves", "8", "--channel", "Phase"], "channel, layout, missing"),
        (&["inspect", &stack, "--layout", "columns"], "'columns' is not a layout"),
    ];
    for (args, expected) in refused {
        assert_refused(&place.run(args), expected);
    }
    // The written folder has one channel, and its scene does not name a channel.
    let key = format!("heights = {stack:?}\nchannel = \"Phase\"\nheight_scale = 1e-9\n");
    place.write("scene.toml", key);
    assert_solved(&place.run(&["surface", "scene.toml", "--fill", "nearest", "--out", "made"]));
    let scene = text(&place.bytes("made/scene.toml"));
    assert!(!scene.contains("channel"), "{scene}");
}

#[test]
fn the_layout_of_a_text_is_a_flag_and_a_key() {
    let place = Place::new();
    place.write("map.txt", "0 0 1\n0 1 2\n1 0 3\n1 1 5\n");
    let grid = |args: &[&str]| {
        let output = place.run(&[&["inspect", "map.txt", "--json"], args].concat());
        assert_solved(&output);
        serde_json::from_slice::<serde_json::Value>(&output.stdout).expect("JSON")["grid"].clone()
    };
    assert_eq!(grid(&[]), serde_json::json!([2, 2]));
    assert_eq!(grid(&["--layout", "matrix", "--cell", "1"]), serde_json::json!([3, 4]));
    place.write("scene.toml", "heights = \"map.txt\"\nlayout = \"matrix\"\n");
    assert_refused(&place.run(&["surface", "scene.toml"]), "needs cell (m)");
}
