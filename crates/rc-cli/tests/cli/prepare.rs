//! `rc prepare`: from the file of an instrument to a folder that is solved.

use serde_json::{Value, json};

use crate::support::{Place, assert_refused, assert_solved, bumps, codes, f8, npy, text};

/// Points of the test map along x and y, and the spikes in it (column, row, height in m).
const POINTS: [usize; 2] = [80, 60];
const SPIKES: [(usize, usize, f64); 4] = [(20, 30, 2e-5), (40, 12, -6e-5), (61, 41, 3e-6), (10, 50, -4e-6)];

/// A tilted map with waves of 0.3 µm and less, as an .npy file.
///
/// The first row and the last two columns are missing, and a hole of six points. Spikes are added.
fn measured() -> Vec<u8> {
    let [nx, ny] = POINTS;
    let wave = |i: usize, j: usize, k: f64| (std::f64::consts::TAU * (k * i as f64 + 1.7 * j as f64) / 80.0).sin() / k;
    let height = |x: usize, y: usize| {
        let spike: f64 = SPIKES.iter().filter(|(sx, sy, _)| (x, y) == (*sx, *sy)).map(|spike| spike.2).sum();
        let is_hole = (30..33).contains(&x) && (40..42).contains(&y);
        if y == 0 || x + 2 >= nx || is_hole {
            return f64::NAN;
        }
        let waves = wave(x, y, 1.0) + wave(y, x, 3.0) + wave(x + 2 * y, x, 7.0);
        3e-7 * waves + 5e-8 * x as f64 - 2e-8 * y as f64 + spike
    };
    let bytes = (0..nx * ny).flat_map(|i| height(i % nx, i / nx).to_le_bytes()).collect::<Vec<u8>>();
    npy("<f8", false, &format!("({ny}, {nx})"), &bytes)
}

/// A place with `scan.npy`, and the arguments that prepare it into `ready`.
fn place() -> (Place, [&'static str; 7]) {
    let place = Place::new();
    place.write("scan.npy", measured());
    // 10 µm from point to point.
    (place, ["prepare", "scan.npy", "--cell", "8e-4", "--cell-y", "6e-4", "--out"])
}

/// The names of steps, and the numbers of points that they changed.
fn steps(record: &Value) -> Vec<(String, u64)> {
    let steps = record["steps"].as_array().expect("a list");
    let step = |step: &Value| (step["treatment"].as_str().unwrap_or_default().to_owned(), step["changed"].as_u64());
    steps.iter().map(step).map(|(name, changed)| (name, changed.expect("a number"))).collect()
}

#[test]
fn a_measured_map_is_prepared_and_solved() {
    let (place, prepare) = place();
    let output = place.run(&[&prepare[..], &["ready"]].concat());
    assert_solved(&output);
    let printed = text(&output.stdout);
    for words in ["crop measured", "despike 8", "fill laplace", "periodic mirror", "4 points, up to", "orientation"] {
        assert!(printed.contains(words), "no '{words}' in:\n{printed}");
    }
    assert_eq!(
        place.names("ready"),
        ["before.png", "despiked.png", "heights.npy", "prepare.json", "scene.toml", "surface.json", "surface.png"]
    );
    let record = place.json("ready/prepare.json");
    // Of 80 x 60 points, 78 x 59 are measured.
    let n = 78 * 59;
    let expected = [
        ("as read", 0),
        ("crop measured", 4800 - n),
        ("despike 8", 4),
        ("level plane", n),
        ("fill laplace", 6),
        ("periodic mirror", 0),
    ];
    assert_eq!(steps(&record), expected.map(|(name, changed)| (name.to_owned(), changed)));
    // Row by row, in the cropped map, whose first row is the second of the file.
    let at: Vec<&Value> = record["spikes"].as_array().expect("a list").iter().map(|spike| &spike["at"]).collect();
    assert_eq!(at, [&json!([40, 11]), &json!([20, 29]), &json!([61, 40]), &json!([10, 49])]);
    let surface = place.json("ready/surface.json");
    assert_eq!((&surface["grid"], codes(&surface)), (&json!([156, 118]), vec!["mirror".to_owned()]));
    assert!(surface["h_max"].as_f64() < Some(1e-6) && surface["h_min"].as_f64() > Some(-1e-6), "{surface}");

    let solve = ["solve", "ready", "--e-star", "1e9", "--pressure", "1e4", "--quiet", "--out", "result"];
    assert_solved(&place.run(&solve));
    let source = json!({
        "file": "scan.npy",
        "channel": null,
        "treatments": ["crop measured", "despike 8", "level plane", "fill laplace", "periodic mirror"],
    });
    let summary = place.json("result/summary.json");
    assert_eq!((&record["source"], &summary["source"]), (&source, &source));
    // A result that is repeated from its own folder, and further treatments, keep the origin.
    assert_solved(&place.run(&["solve", "result", "--quiet", "--out", "again"]));
    assert_eq!(place.json("again/summary.json")["source"], source);
    assert_solved(&place.run(&["surface", "ready", "--resample", "64", "--quiet", "--out", "coarse"]));
    let treatments = &place.json("coarse/surface.json")["source"]["treatments"];
    assert_eq!((treatments.as_array().map(Vec::len), &treatments[5]), (Some(6), &json!("resample 64 x 64")));
}

#[test]
fn a_sweep_keeps_the_origin_in_its_result_folders_only() {
    let place = Place::new();
    place.write("map.npy", npy("<f8", false, "(64, 64)", &f8(&bumps(64))));
    let sweep = ["sweep", "map.npy", "--cell", "0.01", "--e-star", "1e9", "--pressures", "1e4", "--fields", "--quiet"];
    assert_solved(&place.run(&[&sweep[..], &["--out", "s"]].concat()));
    let table = text(&place.bytes("s/sweep.csv"));
    assert!(!table.lines().next().unwrap_or_default().contains("source"), "{table}");
    let fields: Vec<String> = place.names("s").into_iter().filter(|name| place.path("s").join(name).is_dir()).collect();
    let folder = fields.first().expect("a folder of fields");
    let inside = place.names(&format!("s/{folder}"));
    let summary = if inside.contains(&"summary.json".to_owned()) {
        format!("s/{folder}/summary.json")
    } else {
        format!("s/{folder}/{}/summary.json", inside[0])
    };
    assert_eq!(place.json(&summary)["source"]["file"], "map.npy");
}

#[test]
fn each_step_is_replaced_or_left_out() {
    let (place, prepare) = place();
    let steps_of = |flags: &[&str]| {
        assert_solved(&place.run(&[&prepare[..], &["ready", "--quiet"], flags].concat()));
        let names: Vec<String> = steps(&place.json("ready/prepare.json")).into_iter().map(|(name, _)| name).collect();
        names[1..].to_vec()
    };
    assert_eq!(
        steps_of(&["--crop", "square", "--no-despike", "--level", "quadratic", "--periodic", "window", "--flip", "z"]),
        ["crop measured", "crop square", "flip z", "level quadratic", "fill laplace", "periodic window, taper 0.1"]
    );
    assert_eq!(
        steps_of(&["--crop", "48x40+8+8", "--despike", "20", "--no-level", "--high-pass", "2e-4", "--no-periodic"]),
        ["crop 48x40+8+8", "despike 20", "fill laplace", "high-pass 2e-4"]
    );
    let without = ["--no-crop", "--no-despike", "--no-level", "--no-periodic"];
    assert_eq!(steps_of(&without), ["fill laplace"]);
}

#[test]
fn wrong_preparations_are_refused_and_nothing_is_written() {
    let (place, prepare) = place();
    place.write("scene.toml", "waves = 8\ngrid = 64\n");
    for (flags, expected) in [
        (&["--despike", "1"][..], "despike: must be 3 or more"),
        (&["--no-fill"], "no_fill: 6 of 4602 points are missing, and a map with holes can be neither mirrored nor"),
        (&["--no-fill", "--no-periodic"], "omit --no-fill, give --fill nearest or --fill lowest"),
        (&["--despike", "--no-despike"], "cannot be used with"),
        (&["--high-pass", "1"], "high_pass: must be from"),
        (&["--waves", "8"], "are for height maps"),
        (&["--time-limit", "1s"], "rc prepare has none"),
    ] {
        assert_refused(&place.run(&[&prepare[..], &["ready"], flags].concat()), expected);
    }
    assert_refused(&place.run(&["prepare", "scene.toml", "--out", "ready"]), "are for height maps");
    assert_refused(&place.run(&["prepare", "scan.npy", "--cell", "1e-3"]), "required argument is missing: --out");
    assert!(!place.path("ready").exists());
}

#[test]
fn despiking_alone_leaves_the_other_points_as_they_are() {
    let place = Place::new();
    let clean = bumps(64);
    let mut spiky = clean.clone();
    spiky[64 * 20 + 33] += 1e-4;
    place.write("map.npy", npy("<f8", false, "(64, 64)", &f8(&spiky)));
    let surface = ["surface", "--heights", "map.npy", "--cell", "0.01", "--despike", "--out", "s"];
    let output = place.run(&surface);
    assert_solved(&output);
    assert_eq!(text(&output.stderr), "", "a spike that is gone is no doubt");
    let stored = place.bytes("s/heights.npy");
    let heights: Vec<f64> = stored[stored.len() - 8 * 4096..]
        .chunks_exact(8)
        .map(|bytes| f64::from_le_bytes(bytes.try_into().expect("eight bytes")))
        .collect();
    let changed: Vec<usize> = (0..4096).filter(|i| heights[*i].to_bits() != f64::from(spiky[*i]).to_bits()).collect();
    assert_eq!(changed, [64 * 20 + 33]);
    let off = heights[changed[0]] - f64::from(clean[changed[0]]);
    assert!(off.abs() < 1e-6, "off by {off:e}, the rms height is 6e-6 m");
}

#[test]
fn a_window_makes_no_contact_in_the_rim() {
    let place = Place::new();
    // A plateau with pits: the mean is far below most heights.
    let height = |i: usize| {
        let wave = |i: usize, k: f64| (std::f64::consts::TAU * k * (i as f64 + 0.5) / 128.0).sin();
        let sum = wave(i % 128, 3.3) * wave(i / 128, 4.1) + 0.5 * wave(i % 128 + i / 128, 7.7);
        -1e-6 * sum.abs().powf(1.5)
    };
    let heights = (0..128 * 128).flat_map(|i| height(i).to_le_bytes()).collect::<Vec<u8>>();
    place.write("plateau.npy", npy("<f8", false, "(128, 128)", &heights));
    let window = ["surface", "--heights", "plateau.npy", "--cell", "1e-3", "--periodic", "window", "--quiet"];
    assert_solved(&place.run(&[&window[..], &["--out", "w"]].concat()));
    for (pressure, most) in [("2e4", 0.1), ("2e5", 0.2)] {
        let solve = ["solve", "w", "--e-star", "1e8", "--pressure", pressure, "--quiet", "--out", "r"];
        assert_solved(&place.run(&solve));
        let stored = place.bytes("r/pressure.npy");
        let touches = |i: usize| {
            let at = stored.len() - 8 * 128 * 128 + 8 * i;
            f64::from_le_bytes(stored[at..at + 8].try_into().expect("eight bytes")) > 0.0
        };
        let is_rim = |i: &usize| [i % 128, i / 128].iter().any(|at| *at < 13 || *at >= 115);
        let contact: Vec<usize> = (0..128 * 128).filter(|i| touches(*i)).collect();
        let rim = contact.iter().filter(|i| is_rim(i)).count() as f64 / contact.len() as f64;
        // The rim is 36 % of the area.
        assert!(rim < most, "{pressure} Pa: {rim} of the contact is in the rim");
    }
}

/// The spectrum of a mirrored map has cosines alone, so that a fit to it would be wrong.
#[test]
fn a_mirrored_map_has_the_spectrum_of_its_measured_part() {
    let place = Place::new();
    let waves = ["surface", "--waves", "96", "--roll-off", "4", "--hurst", "0.8", "--grid", "512", "--quiet"];
    assert_solved(&place.run(&[&waves[..], &["--cell", "1e-3", "--out", "all"]].concat()));
    let treated = |from: &str, how: &[&str], out: &str| {
        assert_solved(&place.run(&[&["surface", from, "--quiet", "--out", out], how].concat()));
        let output = place.run(&["inspect", out, "--json"]);
        assert_solved(&output);
        serde_json::from_slice::<Value>(&output.stdout).expect("valid JSON")
    };
    assert_solved(&place.run(&["surface", "all", "--quiet", "--out", "all.npy"]));
    let part = ["--cell", "1e-3", "--heights", "all.npy", "--crop", "256"];
    assert_solved(&place.run(&[&["surface", "--quiet", "--out", "part"], &part[..]].concat()));
    let part = treated("part", &["--level", "plane"], "level");
    let mirrored = treated("part", &["--level", "plane", "--periodic", "mirror"], "mirrored");
    let number = |record: &Value, key: &str| record[key].as_f64().unwrap_or_else(|| panic!("no {key} in {record}"));
    let (hurst, error) = (number(&mirrored, "hurst"), number(&mirrored, "hurst_error"));
    assert!((hurst - 0.8).abs() <= 3.0 * error && error < 0.1, "H = {hurst} +- {error}");
    for key in ["hurst", "hurst_error", "cut_off_wavelength", "roll_off_wavelength", "resolution_wavelength"] {
        let [of_part, of_both] = [&part[key], &mirrored[key]].map(|value| value.as_f64().unwrap_or_default());
        assert!((of_part - of_both).abs() <= 1e-9 * of_part, "{key}: {of_part}, mirrored {of_both}");
    }
    let psd = |record: &Value| record["spectrum"][10]["psd"].as_f64().expect("a spectrum");
    assert!((psd(&mirrored) / psd(&part) - 1.0).abs() < 1e-9);
    assert!((number(&mirrored["spectrum"][10], "waves") / number(&part["spectrum"][10], "waves") - 2.0).abs() < 1e-12);
    assert!(mirrored["notes"].to_string().contains("measured part") && part.get("notes").is_none());
    assert!(text(&place.run(&["inspect", "mirrored"]).stdout).contains("measured part"));
    let copies = treated("mirrored", &["--repeat", "2x1"], "copies");
    assert!(copies.get("notes").is_none(), "copies are left as they are");
}

/// A bump of 4 x 4 points is no spike, but on a grid that is four times coarser it is one point.
#[test]
fn spikes_after_despiking_are_those_before_resampling() {
    let place = Place::new();
    let height = |x: usize, y: usize| {
        let wave = (x as f64 / 5.0).sin() * (y as f64 / 7.0).cos() + 0.3 * ((3 * x + 5 * y) as f64 / 11.0).sin();
        let is_bump = (64..68).contains(&x) && (40..44).contains(&y);
        1e-7 * wave + if is_bump { 5e-6 } else { 0.0 }
    };
    let bytes: Vec<u8> = (0..128 * 128).flat_map(|i| height(i % 128, i / 128).to_le_bytes()).collect();
    place.write("map.npy", npy("<f8", false, "(128, 128)", &bytes));
    let prepare =
        ["prepare", "map.npy", "--cell", "1e-3", "--no-periodic", "--resample", "32", "--quiet", "--out", "ready"];
    assert_solved(&place.run(&prepare));
    assert!(!codes(&place.json("ready/surface.json")).contains(&"spikes".to_owned()));
    let solve = ["--boundary", "free", "--e-star", "1e9", "--pressure", "1e5", "--quiet", "--out", "r"];
    assert_solved(&place.run(&[&["solve", "ready"], &solve[..]].concat()));
    assert!(!codes(&place.json("r/summary.json")).contains(&"spikes".to_owned()));
    // The map alone says nothing of its treatments. A folder is also taken with --heights.
    let alone = ["surface", "--heights", "ready", "--quiet", "--out", "alone.npy"];
    assert_solved(&place.run(&alone));
    let found = place.run(&["inspect", "alone.npy", "--cell", "1e-3"]);
    assert!(text(&found.stderr).contains("1 point stands far from all neighbours"), "{}", text(&found.stderr));
    assert!(text(&found.stderr).contains("(rc surface FILE --despike --out DIR)"));
    let remedy = ["surface", "alone.npy", "--cell", "1e-3", "--despike", "--quiet", "--out", "without"];
    assert_solved(&place.run(&remedy));
    // A map that is periodic is not mirrored again.
    assert_solved(&place.run(&["prepare", "map.npy", "--cell", "1e-3", "--quiet", "--out", "mirrored"]));
    let twice = place.run(&["prepare", "mirrored", "--quiet", "--out", "twice"]);
    assert_refused(&twice, "is periodic already (periodic mirror); give --no-periodic to rc prepare");
}
