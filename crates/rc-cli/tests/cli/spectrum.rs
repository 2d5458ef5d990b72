//! Surfaces from files of waves, and generated surfaces without their longest waves.

use std::f64::consts::TAU;

use crate::solve::assert_close;
use crate::support::{CELL, MATERIAL, Place, assert_refused, assert_solved, text};

/// Lines of kx, ky, Re and Im in m.
///
/// Half of the waves are given by k, the others by -k, and one by both. There is also a mean height, which does not
/// count.
const WAVES: &str = "# a comment\n0 0 1 0\n1, 0, 2e-6, 1e-6\n0 -2 1e-6 -1e-6\n\n3 -2 4e-7 0\n-3 2 4e-7 -0\n-5;7;0;2e-7\n8 8 -1e-7 1e-7\n";

/// |c|² and |k|² of the waves.
const POWERS: [(f64, f64); 5] = [(5e-12, 1.0), (2e-12, 4.0), (1.6e-13, 13.0), (4e-14, 74.0), (2e-14, 128.0)];

fn solve<'a>(more: &[&'a str]) -> Vec<&'a str> {
    [&["solve", "--spectrum", "waves.txt", "--pressure", "3e5", "--quiet"], &CELL[..], &MATERIAL, more].concat()
}

fn place() -> Place {
    let place = Place::new();
    place.write("waves.txt", WAVES);
    place
}

#[test]
fn a_file_of_waves_is_a_surface_on_any_grid_by_any_method() {
    let place = place();
    let mut areas = Vec::new();
    for (out, more) in [
        ("a", vec!["--grid", "128", "--method", "uniform"]),
        ("b", vec!["--method", "adaptive"]),
        ("c", vec!["--grid", "128", "--method", "uniform", "--kernel", "spectral"]),
        ("d", vec!["--area-error", "2%"]),
        ("e", vec!["--grid", "128", "--border-level", "1", "--method", "adaptive"]),
    ] {
        assert_solved(&place.run(&[solve(&more), vec!["--out", out]].concat()));
        let summary = place.json(&format!("{out}/summary.json"));
        let number = |key: &str| summary[key].as_f64().expect(key);
        let sum = |of: &dyn Fn(f64, f64) -> f64| 2.0 * POWERS.iter().map(|&(power, k)| of(power, k)).sum::<f64>();
        assert_close("rms height", number("rms_height"), sum(&|power, _| power).sqrt(), 1e-12);
        let slope = sum(&|power, k_squared| (TAU / 0.01).powi(2) * k_squared * power).sqrt();
        assert_close("rms slope", number("rms_slope"), slope, 1e-12);
        areas.push(number("area_fraction"));
    }
    assert_eq!(place.json("b/summary.json")["grid"], serde_json::json!([256, 256]), "32 elements per shortest wave");
    for area in &areas {
        assert_close("area fraction", *area, areas[1], 2e-2);
    }
}

#[test]
fn waves_are_read_with_any_number_of_threads() {
    let place = place();
    for threads in ["1", "3"] {
        assert_solved(&place.run(&solve(&["--grid", "64", "--threads", threads, "--out", threads])));
        let folder = format!("sweep-{threads}");
        let args = ["sweep", "--spectrum", "waves.txt", "--pressures", "1e5,3e5", "--grid", "64", "--quiet"];
        let more = ["--threads", threads, "--out", &folder];
        assert_solved(&place.run(&[&args[..], &CELL, &MATERIAL, &more].concat()));
    }
    assert!(place.bytes("1/pressure.npy") == place.bytes("3/pressure.npy"), "the digits depend on the threads");
}

#[test]
fn a_result_of_waves_is_repeated_from_its_own_folder_alone() {
    let place = place();
    for method in ["uniform", "adaptive"] {
        let (first, again) = (format!("{method}-a"), format!("{method}-b"));
        let more = ["--unit", "nm", "--height-scale", "-1.5", "--grid", "96", "--method", method, "--out", &first];
        assert_solved(&place.run(&solve(&more)));
        let scene = text(&place.bytes(&format!("{first}/scene.toml")));
        assert!(scene.contains("spectrum = \"spectrum.txt\"") && scene.contains("height_scale = -1.5"), "{scene}");
        assert_solved(&place.run(&["solve", &format!("{first}/scene.toml"), "--out", &again, "--quiet"]));
        for name in ["pressure.npy", "gap.npy", "spectrum.txt", "scene.toml"] {
            let [a, b] = [&first, &again].map(|folder| place.bytes(&format!("{folder}/{name}")));
            assert!(a == b, "{method}: {name} is another one");
        }
    }
}

/// The file in nm, with the opposite sign, gives the same surface.
#[test]
fn coefficients_have_the_unit_that_is_said() {
    let place = place();
    let scaled = |line: &str| {
        let words: Vec<&str> = line.split([' ', ',', ';']).filter(|word| !word.is_empty()).collect();
        let turned = |word: &str| -1e9 * word.parse::<f64>().expect("a number");
        format!("{} {} {:e} {:e}\n", words[0], words[1], turned(words[2]), turned(words[3]))
    };
    let lines = WAVES.lines().filter(|line| !line.is_empty() && !line.starts_with('#'));
    place.write("nm.txt", lines.map(scaled).collect::<String>());
    let rows = |file: &str, more: &[&str]| {
        let heights = ["surface", "--spectrum", file, "--grid", "40", "--quiet", "--out", "h.csv"];
        assert_solved(&place.run(&[&heights, &CELL[..], more].concat()));
        let text = text(&place.bytes("h.csv"));
        text.split([',', '\n']).filter(|word| !word.is_empty()).map(|word| word.parse().expect("a number")).collect()
    };
    let metres: Vec<f64> = rows("waves.txt", &[]);
    let turned: Vec<f64> = rows("nm.txt", &["--height-scale", "-1e-9"]);
    let down: Vec<f64> = rows("nm.txt", &["--unit", "nm"]);
    assert_eq!(metres.len(), 1600);
    for ((height, turned), down) in metres.iter().zip(turned).zip(down) {
        assert!((height - turned).abs() < 1e-18 && (height + down).abs() < 1e-18, "{height:e}, {turned:e}, {down:e}");
    }
    // The height at the first centre is computed by hand.
    let at = |kx: f64, ky: f64, re: f64, im: f64| {
        let phase = TAU * (kx + ky) / 80.0;
        2.0 * (re * phase.cos() - im * phase.sin())
    };
    let first = at(1.0, 0.0, 2e-6, 1e-6)
        + at(0.0, -2.0, 1e-6, -1e-6)
        + at(3.0, -2.0, 4e-7, 0.0)
        + at(-5.0, 7.0, 0.0, 2e-7)
        + at(8.0, 8.0, -1e-7, 1e-7);
    assert_close("first height", metres[0], first, 1e-12);
}

#[test]
fn a_sweep_knows_its_file_of_waves_by_content() {
    let place = place();
    let sweep = |waves: &str, more: &[&str]| {
        let sweep = ["sweep", "--spectrum", waves, "--grid", "64", "--pressures", "1e5,3e5", "--quiet", "--out", "s"];
        place.run(&[&sweep, &CELL[..], &MATERIAL, more].concat())
    };
    assert_refused(&sweep("waves.txt", &["--seeds", "1..3"]), "the file of waves has no seed; omit --seeds");
    assert_solved(&sweep("waves.txt", &["--fields"]));
    assert_eq!(text(&place.bytes("s/sweep.csv")).lines().count(), 3);
    assert_solved(&place.run(&["solve", "s/rows/0002/scene.toml", "--out", "again", "--quiet"]));
    assert!(place.bytes("s/rows/0002/pressure.npy") == place.bytes("again/pressure.npy"));
    std::fs::create_dir(place.path("moved")).expect("a folder");
    std::fs::rename(place.path("waves.txt"), place.path("moved/waves.txt")).expect("a moved file");
    assert_solved(&sweep("moved/waves.txt", &["--fields", "--resume"]));
    place.write("waves.txt", WAVES.replace("2e-7", "3e-7"));
    assert_eq!(sweep("waves.txt", &["--fields", "--resume"]).status.code(), Some(2), "another surface");
}

#[test]
fn files_that_are_no_surface_are_refused_with_one_line() {
    let place = place();
    for (name, content, expected) in [
        ("twice.txt", "1 2 3 4\n1 2 3 4\n", "twice.txt: wave (1, 2) is given twice"),
        ("real.txt", "1 2 3 4\n-1 -2 3 4\n", "real.txt: wave (1, 2) is 3 + 4i, and its opposite, -k, is 3 + 4i"),
        ("half.txt", "0.5 2 3 4\n", "half.txt: line 1: wave number 0.5 is not an integer"),
        ("three.txt", "1 2 3\n", "three.txt: line 1 has 3 values, but a wave has four: kx, ky, Re and Im"),
        ("flat.txt", "0 0 3 0\n", "flat.txt: all waves are zero"),
        ("far.txt", "5000 0 3 0\n", "far.txt: wave (5000, 0): kx and ky must be from -4096 to 4096"),
        ("nan.txt", "1 0 nan 0\n", "nan.txt: wave (1, 0): its amplitude is NaN"),
        ("huge.txt", "1 0 1e308 1e308\n", "huge.txt: an rms height of inf cell sides"),
        ("h.h5", "\u{89}HDF", "h.h5: line 1"),
    ] {
        place.write(name, content);
        let args = [&["surface", "--spectrum", name, "--out", "s"], &CELL[..]].concat();
        assert_refused(&place.run(&args), expected);
    }
    let cases: [(&[&str], &str); 8] = [
        (&["--heights", "waves.txt"], "heights and spectrum both define the surface"),
        (&["--waves", "8"], "spectrum defines the surface"),
        (&["--low-cut", "8"], "spectrum defines the surface"),
        (&["--cell-y", "0.02"], "cell_y: applies to height maps; a surface of waves has a square cell"),
        (&["--grid", "16"], "grid: 16 x 16 elements are too coarse for waves = 8; at least 17"),
        (&["--height-scale", "0"], "height_scale: must be finite (m) and different from 0, not 0"),
        (&["--level", "plane"], "are for height maps"),
        (&["--unit", "V"], "'V'"),
    ];
    for (more, expected) in cases {
        let args = [&["surface", "--spectrum", "waves.txt", "--out", "s"], &CELL[..], more].concat();
        let output = place.run(&args);
        assert_eq!(output.status.code(), Some(2));
        assert!(text(&output.stderr).contains(expected), "{more:?}: {}", text(&output.stderr));
    }
    let bare = ["solve", "--spectrum", "waves.txt", "--pressure", "1e5"];
    assert_refused(&place.run(&bare), "spectrum: a file of waves needs cell (m), and e_star (Pa)");
    assert_refused(&place.run(&[&bare[..], &CELL, &["--young", "1e9"]].concat()), "needs poisson too");
    assert!(!place.path("s").exists());
}

#[test]
fn inspect_has_the_moments_of_the_waves() {
    let place = place();
    let inspect = |more: &[&str]| {
        let output = place.run(&[&["inspect", "waves.txt", "--spectrum", "--cell", "0.01", "--json"], more].concat());
        assert_solved(&output);
        serde_json::from_slice::<serde_json::Value>(&output.stdout).expect("JSON")
    };
    let sum: f64 = POWERS.iter().map(|(power, _)| 2.0 * power).sum();
    for (more, side) in [(&[][..], 32), (&["--grid", "70", "--out", "pictures"], 70)] {
        let record = inspect(more);
        assert_close("rms height", record["rms_height"].as_f64().expect("a number"), sum.sqrt(), 1e-12);
        assert_eq!(record["grid"], serde_json::json!([side, side]), "{record}");
    }
    assert!(place.names("pictures").iter().any(|name| name.contains("spectrum")), "{:?}", place.names("pictures"));
    assert_eq!(place.run(&["inspect", "waves.txt", "--grid", "70"]).status.code(), Some(2));
}

#[test]
fn the_low_cut_is_a_key_a_flag_and_part_of_a_result() {
    let place = Place::new();
    let waves = ["--waves", "8", "--grid", "128", "--quiet"];
    let solve = |more: &[&str]| place.run(&[&["solve"], &waves[..], &["--pressure", "1e5"], more].concat());
    assert_solved(&solve(&["--low-cut", "4", "--out", "cut"]));
    assert_solved(&solve(&["--out", "all"]));
    assert!(!text(&place.bytes("all/scene.toml")).contains("low_cut"));
    let scene = text(&place.bytes("cut/scene.toml"));
    assert!(scene.contains("low_cut = 4.0"), "{scene}");
    let number = |out: &str, key: &str| place.json(&format!("{out}/summary.json"))[key].as_f64().expect("a number");
    assert_close("rms height", number("cut", "rms_height"), number("all", "rms_height"), 1e-12);
    let slopes = number("cut", "rms_slope") / number("all", "rms_slope");
    assert!(slopes > 2.0, "the same height in shorter waves is steeper: {slopes}");
    assert_solved(&place.run(&["solve", "cut/scene.toml", "--out", "again", "--quiet"]));
    assert!(place.bytes("cut/pressure.npy") == place.bytes("again/pressure.npy"));
    assert_refused(&solve(&["--low-cut", "9"]), "low_cut: must be from 1 (none) to waves = 8, not 9");
    assert_refused(&solve(&["--low-cut", "nan"]), "low_cut:");
}
