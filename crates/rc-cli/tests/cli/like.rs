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
            let (of_sum, of_again) = (place.json("sum/summary.json"), place.json("again/summary.json"));
            assert_eq!((&of_sum["control"], &of_sum["force"]), (&"force".into(), &1e-3.into()), "{surface} {added}");
            assert_eq!((&of_again["control"], &of_again["force"]), (&of_sum["control"], &of_sum["force"]));
            let treatments = of_sum["source"]["treatments"].to_string();
            let told =
                if added.contains("--add") { format!("{other} added, mirrored along x") } else { "shape added".into() };
            assert!(treatments.contains(&told), "{surface} {added}: {treatments}");
            if of_sum["source"]["file"] == "map.npy" {
                assert_eq!(of_again["source"], of_sum["source"], "{surface} {added}");
            }
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

/// A Digital Surf profile in micrometres, with this spacing.
fn sur(heights: &[f64], spacing: f32) -> Vec<u8> {
    let mut bytes = vec![0; 512];
    let n = i32::try_from(heights.len()).expect("a length");
    let mut put = |at: usize, field: &[u8]| bytes[at..at + field.len()].copy_from_slice(field);
    put(0, b"DIGITAL SURF");
    put(18, &1_u16.to_le_bytes());
    put(98, &32_u16.to_le_bytes());
    for (at, count) in [(108, n), (112, 1), (116, n)] {
        put(at, &count.to_le_bytes());
    }
    put(120, &spacing.to_le_bytes());
    put(128, &1e-6_f32.to_le_bytes());
    put(180, b"um");
    put(212, b"um");
    bytes.extend(heights.iter().flat_map(|height| ((height * 1e6).round() as i32).to_le_bytes()));
    bytes
}

/// A NetCDF file with vectors x and heights (µm), as SurfaceTopography writes line scans.
fn netcdf(heights: &[f64], spacing: f64) -> Vec<u8> {
    let word = |n: usize| u32::try_from(n).expect("a length").to_be_bytes().to_vec();
    let name =
        |text: &str| [word(text.len()), text.bytes().chain([0; 4]).take(text.len().div_ceil(4) * 4).collect()].concat();
    let unit = || [word(12), word(1), name("unit"), word(2), name("um")].concat();
    let n = heights.len();
    let header = |start: usize| {
        let variable =
            |text: &str, at: usize| [name(text), word(1), word(0), unit(), word(6), word(8 * n), word(at)].concat();
        let dimension = [word(10), word(1), name("x"), word(n), word(0), word(0)].concat();
        let both = [variable("x", start), variable("heights", start + 8 * n)].concat();
        [b"CDF\x01".to_vec(), word(0), dimension, word(11), word(2), both].concat()
    };
    let places = (0..n).map(|i| spacing * i as f64);
    let values = places.chain(heights.iter().copied()).flat_map(f64::to_be_bytes).collect();
    [header(header(0).len()), values].concat()
}

/// A profile of an instrument gives the surface of its text, whose source is the profile.
#[test]
fn profiles_of_instruments_are_like_texts_and_are_the_source() {
    let place = Place::new();
    let heights: Vec<f64> = (0..200).map(|i| (0.37 * f64::from(i * i)).sin() + 0.1 * f64::from(i % 7)).collect();
    place.write(
        "profile.txt",
        heights.iter().enumerate().map(|(i, z)| format!("{} {z}\n", 0.5 * i as f64)).collect::<Vec<_>>().concat(),
    );
    place.write("profile.sur", sur(&heights, 0.5));
    place.write("profile.nc", netcdf(&heights, 0.5));
    let mut rms = Vec::new();
    for (file, unit) in [("profile.txt", &["--unit", "um"][..]), ("profile.sur", &[]), ("profile.nc", &[])] {
        let args = ["surface", "--like", file, "--grid", "64", "--seed", "3", "--quiet", "--out", "s"];
        assert_solved(&place.run(&[&args[..], unit].concat()));
        let record = place.json("s/surface.json");
        let treatments = ["surface with the spectrum of this profile, seed 3"];
        assert_eq!(record["source"], serde_json::json!({ "file": file, "channel": null, "treatments": treatments }));
        assert_close("cell", record["cell"].as_f64().expect("a length"), 1e-4, 1e-9);
        rms.push(record["rms_height"].as_f64().expect("a length"));
    }
    assert_close("rms height of .sur", rms[1], rms[0], 1e-5);
    assert_close("rms height of .nc", rms[2], rms[0], 1e-9);
    // The folder has the table only, and knows where it is from.
    assert_solved(
        &place.run(
            &[&["solve", "s", "--seed", "4", "--pressure", "1e5", "--quiet", "--out", "r"][..], &MATERIAL].concat(),
        ),
    );
    let source = &place.json("r/summary.json")["source"];
    assert_eq!(source["file"], "profile.nc");
    assert_eq!(source["treatments"], serde_json::json!(["surface with the spectrum of this profile, seed 4"]));
    assert_refused(&place.run(&["surface", "--heights", "profile.sur"]), "a profile, not a map");
    // Heights of falling x are those of rising x in the reverse order.
    place.write("falling.nc", netcdf(&heights.iter().rev().copied().collect::<Vec<_>>(), -0.5));
    for file in ["profile.nc", "falling.nc"] {
        assert_solved(&place.run(&[
            "surface",
            "--heights",
            file,
            "--line",
            "--quiet",
            "--out",
            file.trim_end_matches(".nc"),
        ]));
    }
    assert_eq!(place.bytes("profile/heights.npy"), place.bytes("falling/heights.npy"));
    place.write("short.sur", sur(&heights[..9], 0.5));
    assert_refused(&place.run(&["surface", "--like", "short.sur"]), "a profile of 9 points");
}

#[test]
fn a_twin_larger_than_the_memory_is_refused_before_it_is_made() {
    let place = Place::new();
    assert_solved(&place.run(&["surface", "--waves", "8", "--grid", "64", "--cell", "64um", "--quiet", "--out", "s"]));
    let twin = ["--like", "s", "--cell", "1"];
    assert_refused(&place.run(&[&["surface"][..], &twin].concat()), "the twin on 1000000 x 1000000 elements");
    let solve = [&["solve", "--pressure", "1e5"][..], &MATERIAL, &twin].concat();
    assert_refused(&place.run(&solve), "the twin on 1000000 x 1000000 elements");
}

#[test]
fn the_tilt_of_a_map_is_told_with_its_twin() {
    let place = Place::new();
    let tilted = |tilt: f64| {
        let heights = values(&map()).into_iter().zip(0..).map(move |(height, i)| height + tilt * f64::from(i % 48));
        npy("<f8", false, "(40, 48)", &f8(&heights.map(|height| height as f32).collect::<Vec<f32>>()))
    };
    for (tilt, expected) in [(0.0, false), (1e-6, true)] {
        place.write("tilted.npy", tilted(tilt));
        assert_solved(
            &place.run(&[&["surface", "--like", "tilted.npy", "--quiet", "--out", "twin"][..], &CELL].concat()),
        );
        let record = place.json("twin/surface.json");
        assert_eq!(codes(&record).contains(&"tilt".to_owned()), expected, "{}", record["warnings"]);
    }
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
    place.write("negative.txt", "2000 1e-18\n3000 -1e-18\n");
    place.write("empty.txt", "2000 0\n3000 0\n");
    place.write("map.npy", map());
    place.write("short.txt", "0 1\n1 2\n");
    place.write("uneven.txt", lines(20, |i| format!("{} 1e-6\n", i * i)));
    let cases: [(&[&str], &str); 13] = [
        (&["--psd", "psd.txt"], "psd: a table of a spectrum needs cell (m) too"),
        (&["--psd", "psd.txt", "--cell", "0.01", "--waves", "8"], "psd defines the surface"),
        (&["--psd", "psd.txt", "--cell", "0.01", "--grid", "16"], "at least 33 per side"),
        (&["--psd", "psd.txt", "--cell", "1e-4"], "take another cell"),
        (&["--psd", "psd.txt", "--like", "map.npy"], "psd and like both define the surface"),
        (&["--psd", "falling.txt", "--cell", "0.01"], "falling.txt: row 2: the wavenumber 1e3 must"),
        (&["--psd", "negative.txt", "--cell", "0.01"], "row 2: the spectrum is -1e-18;"),
        (&["--psd", "empty.txt", "--cell", "0.01"], "the spectrum is 0 in all rows"),
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
