//! Surfaces from measurements: tabulated spectra, twins of maps, profiles.

use std::f64::consts::TAU;

use crate::solve::assert_close;
use crate::support::{CELL, MATERIAL, Place, assert_refused, assert_solved, bumps, codes, f8, npy, text};

/// A flat spectrum from one to four waves per cell of 0.01 m, and a power law up to sixteen.
fn psd(scale: f64) -> String {
    let q = |waves: f64| TAU * waves / 0.01;
    let rows = [(1.0, 1e-18), (4.0, 1e-18), (16.0, 1e-20)];
    rows.iter().fold("q,C\n".to_owned(), |text, &(waves, c)| text + &format!("{:e},{:e}\n", q(waves), scale * c))
}

/// A text of n lines.
fn lines(n: u32, line: impl Fn(u32) -> String) -> String {
    (0..n).map(line).collect::<Vec<_>>().concat()
}

/// A map with a heavy upper tail, on 48 x 40 points.
fn map() -> Vec<u8> {
    let heights: Vec<f32> = bumps(48).iter().take(48 * 40).map(|height| 1e-6 * (height / 1e-5).exp()).collect();
    npy("<f8", false, "(40, 48)", &f8(&heights))
}

/// The values of a .npy file of version 1.0.
fn values(bytes: &[u8]) -> Vec<f64> {
    let start = 10 + usize::from(u16::from_le_bytes([bytes[8], bytes[9]]));
    bytes[start..].chunks_exact(8).map(|b| f64::from_le_bytes(b.try_into().expect("eight bytes"))).collect()
}

fn sorted(bytes: &[u8]) -> Vec<f64> {
    let mut values = values(bytes);
    values.sort_by(f64::total_cmp);
    values
}

#[test]
fn a_tabulated_spectrum_is_that_of_the_surface_in_either_convention() {
    let place = Place::new();
    place.write("plain.csv", psd(1.0));
    place.write("fourier.csv", psd(TAU * TAU));
    let mut moments = Vec::new();
    for (file, more) in [("plain.csv", &[][..]), ("fourier.csv", &["--psd-convention", "fourier"])] {
        let args = ["surface", "--psd", file, "--grid", "64", "--seed", "5", "--quiet", "--out", "s"];
        assert_solved(&place.run(&[&args[..], &CELL, more].concat()));
        let record = place.json("s/surface.json");
        for row in record["spectrum"].as_array().expect("rings") {
            let [waves, c] = ["waves", "psd"].map(|key| row[key].as_f64().expect(key));
            if waves < 3.6 {
                assert_close("C on the plateau", c, 1e-18, 1e-9);
            } else if (6.0..15.0).contains(&waves) {
                let slope = 100_f64.ln() / 4_f64.ln();
                assert_close("C", c, 1e-18 * (waves / 4.0).powf(-slope), 0.03);
            }
        }
        moments.push(["rms_height", "rms_slope"].map(|key| record[key].as_f64().expect(key)));
    }
    assert_close("rms height", moments[1][0], moments[0][0], 1e-12);
    assert_close("rms slope", moments[1][1], moments[0][1], 1e-12);
}

#[test]
fn a_result_is_repeated_from_its_own_folder_alone() {
    let place = Place::new();
    place.write("psd.txt", psd(1.0));
    place.write("map.npy", map());
    let point = |i: u32| format!("{i} {}\n", 1e-3 * (f64::from(i * i) * 0.37).sin());
    place.write("profile.txt", lines(200, point));
    let cases: [(&str, &[&str]); 3] = [
        ("psd", &["--psd", "psd.txt", "--amplitudes", "random", "--cell", "0.01", "--grid", "64"]),
        ("twin", &["--like", "map.npy", "--cell", "0.01", "--seed", "2"]),
        ("line", &["--like", "profile.txt", "--unit", "um", "--grid", "64"]),
    ];
    for (name, surface) in cases {
        let load = ["--pressure", "1e5", "--quiet", "--out", name];
        assert_solved(&place.run(&[&["solve"], surface, &MATERIAL, &load].concat()));
        let scene = text(&place.bytes(&format!("{name}/scene.toml")));
        assert!(!scene.contains("like"), "{scene}");
        std::fs::create_dir(place.path("moved")).expect("a folder");
        for (file, content) in place.contents(name) {
            place.write(&format!("moved/{file}"), content);
        }
        assert_solved(&place.run(&["solve", "moved", "--quiet", "--out", "again"]));
        assert!(place.bytes("again/pressure.npy") == place.bytes(&format!("{name}/pressure.npy")), "{name}");
        assert_eq!(text(&place.bytes("again/scene.toml")), scene);
        for folder in ["moved", "again"] {
            std::fs::remove_dir_all(place.path(folder)).expect("a folder");
        }
    }
    assert_solved(&place.run(&["solve", "psd", "--seed", "9", "--quiet", "--out", "other"]));
    assert!(place.bytes("other/pressure.npy") != place.bytes("psd/pressure.npy"), "the seed changes nothing");
}

#[test]
fn a_twin_has_the_heights_of_the_map_and_another_order() {
    let place = Place::new();
    place.write("map.npy", map());
    let twin = |more: &[&str]| {
        let args = ["surface", "--like", "map.npy", "--quiet", "--out", "twin"];
        assert_solved(&place.run(&[&args[..], &CELL, more].concat()));
        (place.bytes("twin/heights.npy"), place.json("twin/surface.json"))
    };
    let map = place.bytes("map.npy");
    let (first, record) = twin(&[]);
    assert!(sorted(&first) == sorted(&map) && values(&first) != values(&map));
    assert_eq!(record["grid"], serde_json::json!([48, 40]));
    assert!(record["notes"][0].as_str().expect("a note").contains("map.npy, seed 1"), "{}", record["notes"]);
    let (second, _) = twin(&["--seed", "2"]);
    assert!(values(&first) != values(&second) && sorted(&first) == sorted(&second));
    let (gaussian, of_gaussian) = twin(&["--heights-like", "gaussian"]);
    assert!(sorted(&gaussian) != sorted(&map));
    let skewness = |record: &serde_json::Value| record["skewness"].as_f64().expect("a number");
    assert!(skewness(&record) > 2.0 * skewness(&of_gaussian).abs());
    // The folder of a map is a map too, whose size may be changed.
    let larger = ["surface", "--like", "twin", "--cell", "0.02", "--quiet", "--out", "larger"];
    assert_solved(&place.run(&larger));
    assert_eq!(place.json("larger/surface.json")["grid"], serde_json::json!([96, 80]));
}

/// A shape and another body are added to measured surfaces as to any other, and the folder repeats the sum.
#[test]
fn shapes_and_other_bodies_are_added_to_measured_surfaces() {
    let place = Place::new();
    place.write("psd.txt", psd(1.0));
    place.write("map.npy", map());
    place.write(
        "profile.txt",
        lines(200, |i| format!("{:e} {:e}\n", 1e-6 * f64::from(i), 1e-6 * f64::from(i * i).sin())),
    );
    let run = |words: String| assert_solved(&place.run(&words.split(' ').collect::<Vec<_>>()));
    run("surface --waves 4 --grid 64 --rms 1um --cell 10mm --quiet --out waves.npy".into());
    let cases = [
        ("--psd psd.txt --cell 10mm --grid 64", "waves.npy", [64, 64], 0.01),
        ("--like profile.txt --unit m --grid 64", "waves.npy", [64, 64], 2e-4),
        ("--like map.npy --cell 10mm --seed 3", "map.npy", [48, 40], 0.01),
    ];
    for (surface, other, [nx, ny], side) in cases {
        let heights = |added: &str| {
            run(format!("surface {surface}{added} --quiet --out heights.npy"));
            values(&place.bytes("heights.npy"))
        };
        let (bare, on_sphere) = (heights(""), heights(" --shape sphere --radius 2m"));
        let (of_two, other_body) = (heights(&format!(" --add {other}")), values(&place.bytes(other)));
        for i in 0..nx * ny {
            let (ix, iy) = (i % nx, i / nx);
            let at = |index: usize, n: usize| (index as f64 + 0.5 - 0.5 * n as f64) * side / nx as f64;
            let sphere = -(at(ix, nx).powi(2) + at(iy, ny).powi(2)) / 4.0;
            assert!((on_sphere[i] - bare[i] - sphere).abs() < 1e-15, "{surface}: {ix}, {iy}");
            let mirrored = other_body[iy * nx + nx - 1 - ix];
            assert!((of_two[i] - bare[i] - mirrored).abs() < 1e-15, "{surface}: {ix}, {iy}");
        }
        for added in ["--shape sphere --radius 2m".to_owned(), format!("--add {other} --shape flat")] {
            run(format!("solve {surface} {added} --boundary free --e-star 1GPa --force 1mN --quiet --out sum"));
            run("solve sum --quiet --out again".into());
            assert!(place.bytes("sum/pressure.npy") == place.bytes("again/pressure.npy"), "{surface} {added}");
        }
    }
}

#[test]
fn the_source_of_a_twin_is_its_map() {
    let place = Place::new();
    place.write("map.npy", map());
    let twin = ["solve", "--like", "map.npy", "--pressure", "1e5", "--seed", "4", "--quiet", "--out", "twin"];
    assert_solved(&place.run(&[&twin[..], &CELL, &MATERIAL].concat()));
    let source = serde_json::json!({ "file": "map.npy", "channel": null, "treatments": ["twin, seed 4"] });
    assert_eq!(place.json("twin/summary.json")["source"], source);
    assert_solved(&place.run(&["solve", "twin", "--quiet", "--out", "again"]));
    assert_eq!(place.json("again/summary.json")["source"], source);
    // A twin of a twin.
    assert_solved(&place.run(&["surface", "--like", "twin", "--quiet", "--out", "second"]));
    let treatments = &place.json("second/surface.json")["source"]["treatments"];
    assert_eq!(treatments, &serde_json::json!(["twin, seed 4", "twin, seed 1"]));
}

#[test]
fn sweeps_take_seeds_of_twins_and_of_spectra() {
    let place = Place::new();
    place.write("psd.txt", psd(1.0));
    place.write("map.npy", map());
    for (name, surface) in [("psd", ["--psd", "psd.txt"]), ("like", ["--like", "map.npy"])] {
        let sweep = ["sweep", "--pressures", "1e5", "--seeds", "1..3", "--quiet", "--out", name];
        let grid: &[&str] = if name == "psd" { &["--grid", "64"] } else { &[] };
        assert_solved(&place.run(&[&sweep[..], &surface, &CELL, &MATERIAL, grid].concat()));
        let table = text(&place.bytes(&format!("{name}/sweep.csv")));
        let seeds: Vec<&str> = table.lines().skip(1).map(|line| line.split(',').next().expect("a seed")).collect();
        assert_eq!(seeds, ["1", "2", "3"]);
    }
}

#[test]
fn what_cannot_be_a_surface_is_refused_in_one_line() {
    let place = Place::new();
    place.write("psd.txt", psd(1.0));
    place.write("falling.txt", "2000 1e-18\n1000 1e-18\n");
    place.write("map.npy", map());
    place.write("short.txt", "0 1\n1 2\n");
    place.write("uneven.txt", lines(20, |i| format!("{} 1e-6\n", i * i)));
    let cases: [(&[&str], &str); 11] = [
        (&["--psd", "psd.txt"], "psd: a table of a spectrum needs cell (m) too"),
        (&["--psd", "psd.txt", "--cell", "0.01", "--waves", "8"], "psd defines the surface"),
        (&["--psd", "psd.txt", "--cell", "0.01", "--grid", "16"], "at least 33 per side"),
        (&["--psd", "psd.txt", "--cell", "1e-4"], "take another cell"),
        (&["--psd", "psd.txt", "--like", "map.npy"], "psd and like both define the surface"),
        (&["--psd", "falling.txt", "--cell", "0.01"], "falling.txt: row 2: the wavenumber"),
        (&["--psd-convention", "fourier"], "give --psd FILE"),
        (&["--heights-like", "map"], "give --like FILE"),
        (&["--like", "map.npy"], "needs cell (m) too"),
        (&["--like", "short.txt"], "give at least 16"),
        (&["--like", "uneven.txt"], "not equally spaced"),
    ];
    for (args, expected) in cases {
        assert_refused(&place.run(&[&["surface"], args].concat()), expected);
    }
}

#[test]
fn the_metres_of_a_profile_without_a_unit_are_told() {
    let place = Place::new();
    let wave = |i: u32| 1e-6 * (TAU * f64::from(i) / 25.0).sin() + 1e-8 * f64::from(i * i % 7);
    place.write("profile.txt", lines(200, |i| format!("{:e} {:e}\n", 1e-6 * f64::from(i), wave(i))));
    assert_solved(&place.run(&["surface", "--like", "profile.txt", "--grid", "64", "--quiet", "--out", "s"]));
    let record = place.json("s/surface.json");
    assert!(codes(&record).contains(&"assumed".to_owned()), "{}", record["warnings"]);
    assert_close("cell", record["cell"].as_f64().expect("a length"), 2e-4, 1e-12);
}
