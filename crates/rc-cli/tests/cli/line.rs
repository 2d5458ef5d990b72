//! Profiles: line contact, parameters and spectra.

use std::f64::consts::{PI, TAU};

use serde_json::Value;

use crate::solve::assert_close;
use crate::support::{Place, assert_refused, assert_solved, f8, npy, text};

/// Points of the wave.
const N: u32 = 1024;

/// A wave of 1 µm on 1 mm: the height at a point.
fn height(i: u32) -> f64 {
    1e-6 * (TAU * (f64::from(i) + 0.5) / f64::from(N)).cos()
}

/// Lines x z of the wave, in m divided by these units.
fn lines(titles: &str, units: [f64; 2]) -> String {
    let line = |i: u32| format!("{:.9},{:.9}\n", 1e-3 * f64::from(i) / f64::from(N) / units[0], height(i) / units[1]);
    titles.to_owned() + &(0..N).map(line).collect::<Vec<_>>().concat()
}

/// Half of the load of full contact, π E* h/λ.
fn half() -> String {
    (0.5 * PI * 1e9 * 1e-3).to_string()
}

/// The summary of a solve of this file.
fn solved(place: &Place, file: &str, more: &[&str]) -> Value {
    let half = half();
    let args = ["solve", file, "--line", "--e-star", "1e9", "--pressure", &half, "--quiet", "--json"];
    let output = place.run(&[&args[..], more].concat());
    assert_solved(&output);
    serde_json::from_slice(&output.stdout).expect("valid JSON")
}

fn number(record: &Value, key: &str) -> f64 {
    record[key].as_f64().unwrap_or_else(|| panic!("{key}: {}", record[key]))
}

#[test]
fn half_of_a_wave_touches_in_every_file_of_the_profile() {
    let place = Place::new();
    place.write("wave.csv", lines("x (um),z (nm)\n", [1e-6, 1e-9]));
    place.write("bare.txt", (0..N).map(|i| format!("{:e}\n", height(i))).collect::<Vec<_>>().concat());
    let heights: Vec<u8> = (0..N).flat_map(|i| height(i).to_le_bytes()).collect();
    place.write("wave.npy", npy("<f8", false, "(1024,)", &heights));
    let cell = ["--cell", "1mm"];
    for (file, more) in [("wave.csv", &[][..]), ("bare.txt", &cell), ("wave.npy", &cell)] {
        for kernel in ["love", "spectral"] {
            let summary = solved(&place, file, &[more, &["--kernel", kernel]].concat());
            let (area, error) = (number(&summary, "area_fraction"), number(&summary, "area_fraction_error"));
            assert!((area - 0.5).abs() < error && error < 2e-3, "{file}, {kernel}: {area} ± {error}");
            assert_eq!(summary["grid"], serde_json::json!([N, 1]));
        }
    }
    solved(&place, "wave.csv", &["--out", "r"]);
    assert!(text(&place.bytes("r/pressure.npy")[..128]).contains("(1, 1024, )"), "one row");
    assert_solved(&place.run(&["report", "r", "--quiet"]));
    let page = text(&place.bytes("r/report.html"));
    for words in [
        "1024 elements, line contact",
        "width of a contact",
        " µm wide, 100 % of the contact",
        "\"Pa, Pq\"",
        "a profile: rms",
    ] {
        assert!(page.contains(words), "no '{words}'");
    }
    let again = place.run(&["solve", "r", "--quiet", "--out", "again"]);
    assert_solved(&again);
    assert_eq!(place.bytes("r/pressure.npy"), place.bytes("again/pressure.npy"));
}

#[test]
fn a_part_of_a_profile_is_a_profile() {
    let place = Place::new();
    place.write("wave.csv", lines("x (um),z (nm)\n", [1e-6, 1e-9]));
    let treated = |args: &[&str]| place.run(&[&["surface", "--heights", "wave.csv", "--line"], args].concat());
    for (args, side) in [(["--crop", "512x1"], 0.5e-3), (["--crop", "512"], 0.5e-3), (["--resample", "512"], 1e-3)] {
        assert_solved(&treated(&[&args[..], &["--quiet", "--out", "part"]].concat()));
        let record = place.json("part/surface.json");
        assert_eq!(record["grid"], serde_json::json!([512, 1]), "{args:?}");
        assert_close("side", number(&record, "cell"), side, 1e-9);
        // One row has no texture and no spectrum of an area.
        assert!(record["Sal"].is_null() && record["spectrum"] == serde_json::json!([]), "{record}");
        let args = ["solve", "part", "--e-star", "1e9", "--pressure", "1e5", "--quiet", "--out", "solved"];
        assert_solved(&place.run(&args));
    }
    assert_refused(&treated(&["--resample", "512x256"]), "resample: a profile has one row; give 512 or 512x1");
}

#[test]
fn what_a_line_contact_has_not_is_refused() {
    let place = Place::new();
    place.write("wave.csv", lines("x (um),z (nm)\n", [1e-6, 1e-9]));
    place.write("bare.txt", "1\n2\n3\n4\n");
    place.write("uneven.csv", "x (um),z (nm)\n0,1\n1,2\n4,1\n5,3\n");
    place.write("hole.csv", "x (um),z (nm)\n0,1\n1,nan\n2,1\n3,3\n");
    let map: Vec<f64> = (0..64).map(|i| f64::from(i * i % 7)).collect();
    place.write("map.npy", npy("<f8", false, "(8, 8)", &map.iter().flat_map(|h| h.to_le_bytes()).collect::<Vec<_>>()));
    let cases: [(&str, &[&str], &str); 10] = [
        ("wave.csv", &["--leakage"], "the line contact of a profile cannot be combined with the flow"),
        ("wave.csv", &["--boundary", "free"], "cannot be combined with free borders"),
        ("wave.csv", &["--method", "adaptive"], "a profile has none"),
        ("wave.csv", &["--cell-y", "1mm"], "no side along y"),
        ("wave.csv", &["--cell", "2mm"], "cell says 2 mm"),
        ("bare.txt", &[], "a profile without places; give cell (m)"),
        ("uneven.csv", &[], "from point 1 to 2 it is 1, and in the mean 1.66667"),
        ("hole.csv", &[], "column 1 (from 0) is NaN"),
        ("map.npy", &["--cell", "1mm"], "a map of 8 x 8 points, not a profile"),
        ("none.csv", &[], "none.csv"),
    ];
    for (file, more, expected) in cases {
        let args = ["solve", "--heights", file, "--line", "--e-star", "1e9", "--pressure", "1e5"];
        assert_refused(&place.run(&[&args[..], more].concat()), expected);
    }
    let force = ["solve", "wave.csv", "--line", "--e-star", "1e9", "--force", "10N"];
    assert_refused(&place.run(&force), "force per length");
    let waves = ["solve", "--line", "--waves", "8", "--pressure", "1e5"];
    assert_refused(&place.run(&waves), "line: applies to profiles");
    assert_refused(&place.run(&["solve", "wave.csv", "--e-star", "1e9", "--pressure", "1e5"]), "give --line");
    assert_refused(&place.run(&["inspect", "map.npy", "--lambda-c", "1um"]), "lambda_c: applies to profiles");
}

#[test]
fn a_profile_has_the_parameters_of_the_standard_with_and_without_filters() {
    let place = Place::new();
    // A wave of 1 µm on 0.8 mm, and one of 50 nm on 20 µm, over 8.2 mm. The
    // part between half of λc = 0.2 mm from both ends has whole waves. The other parts miss a quarter of the long wave.
    let wave = |x: f64| 1e-6 * (TAU * x / 0.8e-3).cos() + 50e-9 * (TAU * x / 20e-6).cos();
    let n = 8200;
    let line = |i: u32| format!("{:.3};{:.6}\n", f64::from(i), 1e9 * wave(1e-6 * f64::from(i)));
    place.write("waves.csv", "x [um];z [nm]\n".to_owned() + &(0..n).map(line).collect::<Vec<_>>().concat());
    let inspect = |more: &[&str]| {
        let output = place.run(&[&["inspect", "waves.csv", "--json"], more].concat());
        assert_solved(&output);
        serde_json::from_slice::<Value>(&output.stdout).expect("valid JSON")
    };
    let plain = inspect(&[]);
    assert_close("Rq", number(&plain, "Rq"), (0.5e-12_f64 + 0.5 * 2.5e-15).sqrt(), 1e-3);
    assert_eq!((&plain["Ra"], &plain["RSm"]), (&plain["Pa"], &plain["PSm"]));
    // The short wave is lower than a tenth of the profile.
    assert_close("PSm", number(&plain, "PSm"), 0.8e-3, 1e-2);
    // The short wave keeps 1 - 2^-(λc/λ)² of its amplitude, which is all, and the long one 1 - 2^-(1/16).
    let fine = inspect(&["--lambda-c", "0.2mm", "--psd-out", "psd.csv", "--out", "look"]);
    let kept = 1.0 - 0.5_f64.powf((0.2_f64 / 0.8).powi(2));
    let expected = (0.5 * (kept * 1e-6_f64).powi(2) + 0.5 * 50e-9_f64.powi(2)).sqrt();
    assert_close("Rq", number(&fine, "Rq"), expected, 2e-3);
    assert_eq!(fine["Pq"], plain["Pq"]);
    assert_close("evaluation length", number(&fine, "evaluation_length"), 8e-3, 1e-9);
    assert_eq!(fine["sections"], 40);
    // Sections have the length λc, and a rest is not evaluated: 8.2 mm less λc have four, and 0.7 mm are left.
    let long = inspect(&["--lambda-c", "1.5mm"]);
    assert_close("evaluation length", number(&long, "evaluation_length"), 6e-3, 1e-9);
    assert_eq!(long["sections"], 4);
    let told = place.run(&["inspect", "waves.csv", "--lambda-c", "1.5mm"]);
    let told = text(&told.stdout);
    assert!(told.contains("evaluated on 6 mm, 4 sections of λc and not on the 700 µm after them"), "{told}");
    // λs of 80 µm takes the short wave away.
    let smooth = inspect(&["--lambda-s", "80um"]);
    let left = 0.5_f64.powf((0.08_f64 / 0.8).powi(2));
    assert_close("Rq", number(&smooth, "Rq"), left * 1e-6 / 2.0_f64.sqrt(), 2e-3);
    assert_close("RSm", number(&smooth, "RSm"), 0.8e-3, 1e-2);
    for (key, value) in [("Ra", 2.0 / PI), ("Rz", 2.0)] {
        assert_close(key, number(&smooth, key), left * 1e-6 * value, 5e-3);
    }
    assert_eq!(place.bytes("psd.csv"), place.bytes("look/psd.csv"));
    let surface = place.run(&["surface", "--psd", "psd.csv", "--cell", "0.5mm", "--grid", "1024", "--out", "surface"]);
    assert_solved(&surface);
    assert_eq!(place.names("look"), ["profile.png", "profile.svg", "psd.csv", "spectrum.png", "spectrum.svg"]);
    for (args, expected) in [
        (["--lambda-c", "5mm"], "lambda_c: must be from two steps"),
        (["--lambda-s", "1um"], "lambda_s: must be from two steps"),
    ] {
        assert_refused(&place.run(&[&["inspect", "waves.csv"][..], &args].concat()), expected);
    }
}

#[test]
fn a_prepared_profile_has_the_filters_and_others_refuse_them() {
    let place = Place::new();
    let waves = |i: u32| 1e3 * height(8 * i % N) + 1e9 * height(i);
    let line = |i: u32| format!("{:.4},{:.6}\n", f64::from(i) * 1e3 / f64::from(N), waves(i));
    place.write("wave.csv", "x (um),z (nm)\n".to_owned() + &(0..N).map(line).collect::<Vec<_>>().concat());
    let make = ["surface", "--heights", "wave.csv", "--line", "--quiet"];
    assert_solved(&place.run(&[&make[..], &["--out", "plain"]].concat()));
    assert_solved(&place.run(&[&make[..], &["--periodic", "mirror", "--out", "mirrored"]].concat()));
    let inspect = |file: &str, more: &[&str]| {
        let output = place.run(&[&["inspect", file, "--json", "--lambda-c", "0.2mm"], more].concat());
        assert_solved(&output);
        serde_json::from_slice::<Value>(&output.stdout).expect("valid JSON")
    };
    let of_file = inspect("wave.csv", &[]);
    for folder in ["plain", "mirrored"] {
        let of_folder = inspect(folder, &[]);
        for key in ["Ra", "Rq", "Rz", "Rsk", "Pq", "evaluation_length"] {
            assert_close(key, number(&of_folder, key), number(&of_file, key), 1e-6);
        }
    }
    // The mean line is that of the filter: a short part of a long wave is not centred on its own mean.
    let cut = inspect("wave.csv", &["--lambda-s", "20um"]);
    assert!(number(&cut, "Rq") > 0.0 && number(&cut, "Pq") > number(&cut, "Rq"), "{cut}");
    assert_solved(&place.run(&["solve", "plain", "--e-star", "1e9", "--pressure", "1e5", "--quiet", "--out", "r"]));
    assert_refused(
        &place.run(&["inspect", "r", "--lambda-c", "0.2mm"]),
        "lambda_c: applies to height maps and profiles",
    );
    assert_refused(&place.run(&["inspect", "r", "--unit", "um"]), "unit: applies to height maps and profiles");
    assert_solved(&place.run(&["surface", "--waves", "8", "--grid", "64", "--quiet", "--out", "map"]));
    assert_refused(&place.run(&["inspect", "map", "--lambda-c", "0.2mm"]), "lambda_c: applies to profiles");
    assert_refused(
        &place.run(&["surface", "mirrored", "--periodic", "mirror"]),
        "is periodic already (periodic mirror)",
    );
}

#[test]
fn holes_and_units_of_a_profile_are_told() {
    let place = Place::new();
    let line = |i: u32| if i == 7 { format!("{i},\n") } else { format!("{i},{}\n", i * i % 11) };
    place.write("hole.csv", "x (um),z (nm)\n".to_owned() + &(0..40).rev().map(line).collect::<Vec<_>>().concat());
    let output = place.run(&["inspect", "hole.csv"]);
    assert_solved(&output);
    let told = text(&output.stdout);
    assert!(told.contains("40 points, 1 missing, step 1 µm") && told.contains("points are reversed"), "{told}");
    assert!(told.contains("straight lines over missing points"), "{told}");
    assert_solved(&place.run(&["surface", "--heights", "hole.csv", "--line", "--fill", "laplace", "--out", "filled"]));
    let solve = ["solve", "filled", "--e-star", "1e9", "--pressure", "1e5", "--quiet", "--json"];
    let output = place.run(&solve);
    assert_solved(&output);
    let summary: Value = serde_json::from_slice(&output.stdout).expect("valid JSON");
    assert_eq!(summary["grid"], serde_json::json!([40, 1]));
    let bare: Vec<f64> = (0..40).map(|i| f64::from(i * i % 11)).collect();
    place.write("bare.npy", npy("<f8", false, "(40, 1)", &f8(&bare.iter().map(|h| *h as f32).collect::<Vec<_>>())));
    assert_solved(&place.run(&["inspect", "bare.npy", "--cell", "40um", "--height-scale", "1nm"]));
}

/// Fewer points than a spectrum needs have the other parameters.
#[test]
fn a_short_profile_has_no_spectrum_and_says_so() {
    let place = Place::new();
    place.write("short.csv", "x (um),z (nm)\n0,1\n1,-1\n2,1\n3,-1\n4,1\n5,-1\n");
    let output = place.run(&["inspect", "short.csv", "--json", "--out", "look"]);
    assert_solved(&output);
    let record: Value = serde_json::from_slice(&output.stdout).expect("valid JSON");
    assert_close("Pq", number(&record, "Pq"), 1e-9, 1e-9);
    assert_close("PSm", number(&record, "PSm"), 2e-6, 1e-9);
    assert_eq!(record["spectrum"], serde_json::json!([]));
    assert!(record["notes"][0].as_str().is_some_and(|note| note.starts_with("6 points have no spectrum")), "{record}");
    assert_eq!(place.names("look"), ["profile.png", "profile.svg"]);
    assert_refused(&place.run(&["inspect", "short.csv", "--psd-out", "psd.csv"]), "has no spectrum; omit --psd-out");
    place.write("two.csv", "x (um),z (nm)\n0,1\n1,2\n");
    let told = place.run(&["inspect", "two.csv"]);
    assert_solved(&told);
    assert!(text(&told.stdout).contains("not defined: there is no whole element"), "{}", text(&told.stdout));
}

/// A surface of equal rows is the profile of one row, also with a hardness and on a layer.
#[test]
fn equal_rows_are_the_line_contact_of_one() {
    let place = Place::new();
    let row: Vec<f64> = (0..128).map(|i| 1e-7 * f64::from(i * i % 23)).collect();
    let file = |rows: usize| {
        let bytes: Vec<u8> = row.repeat(rows).iter().flat_map(|height| height.to_le_bytes()).collect();
        npy("<f8", false, &format!("({rows}, 128)"), &bytes)
    };
    place.write("row.npy", file(1));
    place.write("rows.npy", file(4));
    for more in [&[][..], &["--hardness", "1.2e8"], &["--layer-thickness", "3mm", "--layer-poisson", "0.4"]] {
        let solve = |file: &str, shape: &[&str], out: &str| {
            let args =
                ["solve", file, "--cell", "1mm", "--e-star", "1e9", "--pressure", "4e7", "--quiet", "--out", out];
            assert_solved(&place.run(&[&args[..], shape, more, &["--energy-tolerance", "1e-5"]].concat()));
            let summary = place.json(&format!("{out}/summary.json"));
            ["area_fraction", "mean_gap", "rms_pressure", "penetration"]
                .map(|key| summary[key].as_f64().expect("a number"))
        };
        let line = solve("row.npy", &["--line"], "line");
        let map = solve("rows.npy", &["--cell-y", "31.25um", "--method", "uniform"], "map");
        for (line, map) in line.into_iter().zip(map) {
            assert!((line / map - 1.0).abs() < 1e-4, "{more:?}: {line:e} and {map:e}");
        }
        for out in ["line", "map"] {
            std::fs::remove_dir_all(place.path(out)).expect("the folder of the result");
        }
    }
}
