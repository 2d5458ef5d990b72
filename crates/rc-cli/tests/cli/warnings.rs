//! Warnings: which command tells which, and `--strict`.

use crate::support::{Place, assert_refused, assert_solved, bumps, codes, f8, npy, text};

/// A map of 64 x 64 points with rms slope below 0.1 on 1 mm.
const GOOD: [&str; 8] = ["--heights", "map.npy", "--cell", "1e-3", "--e-star", "1e9", "--pressure", "1e5"];

fn heights(factor: f32) -> Vec<f32> {
    bumps(64).iter().map(|height| height * factor).collect()
}

fn place() -> Place {
    let place = Place::new();
    let put = |name: &str, heights: &[f32]| place.write(name, npy("<f8", false, "(64, 64)", &f8(heights)));
    put("map.npy", &heights(1.0));
    put("um.npy", &heights(1e6));
    put("steep.npy", &heights(30.0));
    let mut spiky = heights(1.0);
    for i in [300, 1500, 2222] {
        spiky[i] += 5e-5;
    }
    put("spiky.npy", &spiky);
    let mut marked = heights(1.0);
    marked[77] = -9999.0;
    put("marked.npy", &marked);
    put("tilted.npy", &heights(1.0).iter().enumerate().map(|(i, h)| h + (i % 64) as f32 * 1e-6).collect::<Vec<_>>());
    place
}

/// The codes of `rc solve`, sorted and without repetition.
fn solved(place: &Place, args: &[&str]) -> Vec<String> {
    let output = place.run(&[&["solve", "--json", "--quiet"], args].concat());
    assert_solved(&output);
    let mut found = codes(&serde_json::from_slice(&output.stdout).expect("JSON"));
    found.sort();
    found.dedup();
    found
}

#[test]
fn each_doubt_has_its_code_and_a_good_map_has_none() {
    let place = place();
    let map = |name| [&["--heights", name][..], &GOOD[2..]].concat();
    let one_kilopascal = |name| [&map(name)[..6], &["--pressure", "1e3"]].concat();
    let soft = [&GOOD[..4], &["--e-star", "4e5", "--pressure", "1e5"]].concat();
    let cases: Vec<(Vec<&str>, &[&str])> = vec![
        (GOOD.to_vec(), &[]),
        (map("um.npy"), &["slope", "units"]),
        // Three points bear the whole load.
        (map("spiky.npy"), &["coarse", "load", "spikes"]),
        // The step at the border is steep too.
        (map("tilted.npy"), &["border"]),
        ([&map("tilted.npy")[..], &["--boundary", "free"]].concat(), &[]),
        (soft, &["load"]),
        ([&GOOD[..6], &["--penetration", "1e-7"]].concat(), &[]),
        (vec!["--waves", "16", "--pressure", "4e5"], &[]),
        (vec!["--waves", "16", "--grid", "40", "--pressure", "4e5"], &["coarse"]),
        (vec!["--waves", "16", "--grid", "40", "--kernel", "spectral", "--pressure", "4e5"], &[]),
        (vec!["--waves", "16", "--grid", "35", "--kernel", "spectral", "--pressure", "4e5"], &["coarse"]),
        (vec!["--waves", "8", "--pressure", "1e5", "--area-error", "20%"], &[]),
        (vec!["--waves", "8", "--grid", "64", "--rms-slope", "0.5", "--pressure", "1e6"], &["load", "slope"]),
    ];
    for (args, expected) in cases {
        assert_eq!(solved(&place, &args), expected, "{args:?}");
    }
    assert!(solved(&place, &one_kilopascal("marked.npy")).contains(&"marks".to_owned()));
    assert!(solved(&place, &map("steep.npy")).contains(&"slope".to_owned()));
}

#[test]
fn a_warning_is_a_line_for_people_and_a_record_for_programs() {
    let place = place();
    let spiky = [&["solve", "--heights", "spiky.npy"], &GOOD[2..], &["--out", "r"]].concat();
    let output = place.run(&spiky);
    assert_solved(&output);
    let told = text(&output.stderr);
    assert!(told.starts_with("warning: 3 points stand far from all neighbours"), "{told}");
    assert!(told.lines().count() == 3 && told.lines().all(|line| line.starts_with("warning: ")), "{told}");
    assert_eq!(codes(&place.json("r/summary.json")), ["spikes", "load", "coarse"]);
    assert!(place.run(&[&spiky[..], &["--quiet"]].concat()).stderr.is_empty(), "--quiet");
    let inspected = place.run(&["inspect", "r", "--json"]);
    let inspected = serde_json::from_slice(&inspected.stdout).expect("JSON");
    assert_eq!(codes(&inspected), ["spikes", "load", "coarse"]);
    assert_solved(&place.run(&["report", "r"]));
    assert!(text(&place.bytes("r/report.html")).contains("3 points stand far"), "not in the report");
    let sweep = ["sweep", "--heights", "spiky.npy", "--cell", "1e-3", "--e-star", "1e9", "--pressures", "1e4,1e5"];
    let output = place.run(&[&sweep[..], &["--out", "s"]].concat());
    assert_solved(&output);
    assert!(text(&output.stderr).contains("(2 rows)"), "{}", text(&output.stderr));
    let table = text(&place.bytes("s/sweep.csv"));
    assert_eq!(
        table
            .lines()
            .skip(1)
            .filter(|line| line.contains(",spikes load coarse,") || line.contains(",spikes coarse,"))
            .count(),
        2,
        "{table}"
    );
    assert_solved(&place.run(&["report", "s"]));
    assert!(text(&place.bytes("s/report.html")).contains("spikes: single points"), "not in the report of the sweep");
}

#[test]
fn strict_makes_errors_of_warnings() {
    let place = place();
    let early: [&[&str]; 5] = [
        &["solve", "--heights", "um.npy", "--cell", "1e-3", "--e-star", "1e9", "--pressure", "1e5", "--out", "r"],
        &["sweep", "--heights", "um.npy", "--cell", "1e-3", "--e-star", "1e9", "--pressures", "1e5", "--out", "r"],
        &["surface", "--heights", "um.npy", "--cell", "1e-3", "--out", "r"],
        &["inspect", "um.npy", "--cell", "1e-3", "--out", "r"],
        &["solve", "--heights", "um.npy", "--cell", "1e-3", "--e-star", "1e9", "--pressure", "1e5", "--dry-run"],
    ];
    for args in early {
        assert_refused(&place.run(&[args, &["--strict"]].concat()), "(units)");
        assert!(!place.path("r").exists(), "{args:?} wrote something");
    }
    // Only the solution shows that the maximum pressure is large.
    let late = ["solve", "--waves", "8", "--grid", "64", "--rms-slope", "0.29", "--pressure", "5e6", "--e-star", "1e8"];
    let output = place.run(&[&late[..], &["--strict", "--quiet", "--out", "r"]].concat());
    assert_refused(&output, "the results are written");
    assert_eq!(codes(&place.json("r/summary.json")), ["load"]);
    assert_solved(&place.run(&[&["solve"], &GOOD[..], &["--strict", "--quiet"]].concat()));
}

#[test]
fn filled_points_are_doubted_also_when_the_folder_is_solved() {
    let place = Place::new();
    let mut holed = heights(1.0);
    holed[1000..1200].fill(f32::NAN);
    place.write("holes.npy", npy("<f8", false, "(64, 64)", &f8(&holed)));
    let treat = ["surface", "--heights", "holes.npy", "--cell", "1e-3", "--level", "plane", "--fill", "laplace"];
    assert_solved(&place.run(&[&treat[..], &["--periodic", "mirror", "--quiet", "--out", "ready"]].concat()));
    // The waves of the map are steeper along x, which is a lay.
    assert_eq!(codes(&place.json("ready/surface.json")), ["missing", "mirror"]);
    assert_eq!(solved(&place, &["ready", "--e-star", "1e9", "--pressure", "1e5"]), ["mirror", "missing"]);
    let holes = place.run(&["inspect", "holes.npy", "--cell", "1e-3", "--json"]);
    assert_solved(&holes);
    let record: serde_json::Value = serde_json::from_slice(&holes.stdout).expect("JSON");
    assert_eq!((record["missing"].as_u64(), codes(&record)), (Some(200), Vec::new()));
    let measured: Vec<f64> = holed.iter().filter(|h| !h.is_nan()).map(|h| f64::from(*h)).collect();
    let mean = measured.iter().sum::<f64>() / measured.len() as f64;
    let rms = (measured.iter().map(|h| (h - mean).powi(2)).sum::<f64>() / measured.len() as f64).sqrt();
    assert!((record["rms_height"].as_f64().expect("a number") / rms - 1.0).abs() < 1e-12, "{}", record["rms_height"]);
}

#[test]
fn a_mark_that_is_named_is_a_missing_point() {
    let place = place();
    let args = ["inspect", "marked.npy", "--cell", "1e-3", "--missing=-9999", "--json"];
    let output = place.run(&args);
    assert_solved(&output);
    let record: serde_json::Value = serde_json::from_slice(&output.stdout).expect("JSON");
    assert_eq!((record["missing"].as_u64(), codes(&record)), (Some(1), Vec::new()));
    place.write("scene.toml", "heights = \"marked.npy\"\ncell = 1e-3\nmissing = -9999\n");
    let output = place.run(&["surface", "scene.toml", "--fill", "laplace", "--quiet", "--out", "s"]);
    assert_solved(&output);
    assert_eq!(place.json("s/surface.json")["treatments"][0]["missing"], 1);
}

/// Codes of `rc inspect` for each file of data/formats that is a map, with the flags that it needs.
///
/// Small maps of 12 x 8 points have few warnings. What is assumed follows from what the file names.
#[test]
fn the_files_of_data_formats_have_these_codes() {
    let folder = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("../../data/formats");
    let mut names: Vec<String> = std::fs::read_dir(&folder)
        .expect("the folder")
        .map(|entry| entry.expect("an entry").file_name().to_string_lossy().into_owned())
        .filter(|name| name != "README.md")
        .collect();
    names.sort();
    let place = Place::new();
    let mut table = String::new();
    for name in names {
        let file = folder.join(&name).display().to_string();
        let inspected = |more: &[&str]| place.run(&[&["inspect", &file, "--json"], more].concat());
        let mut output = inspected(&[]);
        if text(&output.stderr).contains("height_scale") {
            output = inspected(&["--height-scale", "1e-9"]);
        }
        let line = match output.status.code() {
            Some(0) => codes(&serde_json::from_slice(&output.stdout).expect("JSON")).join(" "),
            Some(2) => "refused".to_owned(),
            code => panic!("{name}: {code:?}"),
        };
        let line = if line.is_empty() { "none".to_owned() } else { line };
        table = format!("{table}{name}: {line}\n");
    }
    assert_eq!(table, CODES_OF_FORMATS, "{table}");
}

const CODES_OF_FORMATS: &str = "\
columns.csv: none\n\
expected.asc.gz: assumed units slope\n\
expected.csv: assumed units slope\n\
gwyddion-utf16.txt: slope\n\
gwyddion.txt: slope\n\
gwyfile.gwy: none\n\
h5py-chunked.h5: none\n\
h5py-contiguous.h5: assumed units slope\n\
h5py-cycle.h5: refused\n\
h5py-groups.h5: slope\n\
h5py-huge.h5: refused\n\
h5py-matlab-mesh.mat: assumed slope\n\
h5py-matlab.mat: assumed slope\n\
h5py-vectors.h5: assumed slope\n\
h5py-waves-columns.h5: columns assumed units slope\n\
h5py-waves.h5: refused\n\
h5py-zeros.h5: refused\n\
igorwriter-stack.ibw: none\n\
igorwriter.ibw: slope\n\
interferometer.dat: slope\n\
netcdf4-64bit.nc: none\n\
netcdf4-classic.nc: none\n\
netcdf4-zeros.nc: refused\n\
netcdf4-zlib.nc: none\n\
pillow-lzw.tif: assumed\n\
pillow.png: assumed\n\
python-16bit.sur: none\n\
python-32bit.spm: slope\n\
python-float.opd: none\n\
python-int16.opd: none\n\
python-two-channels.spm: slope\n\
python-wide.spm: slope\n\
python-zlib.sur: none\n\
python.al3d: none\n\
python.dat: slope\n\
python.plu: none\n\
python.plux: none\n\
python.vk4: slope\n\
rosettasciio-zlib.sur: slope\n\
scipy-mesh.mat: assumed\n\
scipy-vectors.mat: assumed units slope\n\
surfalize-binary.sdf: slope\n\
surfalize-missing.sdf: none\n\
surfalize-text.sdf: slope\n\
surfalize-zlib.sur: none\n\
surfalize.al3d: none\n\
surfalize.sur: none\n\
surfalize.x3p: slope\n\
tifffile-be.tif: assumed\n\
tifffile-float.tif: assumed\n\
tifffile-geo.tif: none\n\
tifffile-imagej.tif: slope\n\
tifffile-ome.tif: slope\n\
tifffile-pages.tif: assumed\n\
tifffile-park.tif: refused\n\
tifffile-white-levels.tif: assumed\n\
tifffile-white.tif: assumed\n\
zipfile-folder.x3p: slope\n";

#[test]
fn the_map_of_a_folder_is_in_metres_and_has_the_size_of_its_cell() {
    let place = place();
    let ready =
        ["surface", "--heights", "map.npy", "--cell", "1e-3", "--periodic", "mirror", "--out", "ready", "--quiet"];
    assert_solved(&place.run(&ready));
    let load = ["--e-star", "1e9", "--pressure", "1e6", "--quiet"];
    assert_solved(&place.run(&[&["solve", "ready", "--out", "result"], &load[..]].concat()));
    for folder in ["ready", "result"] {
        for (flag, value, expected) in [
            ("--unit", "um", "is in metres"),
            ("--height-scale", "1e-6", "is in metres"),
            ("--cell", "1e-3", "2 mm wide"),
        ] {
            for command in ["solve", "surface", "inspect"] {
                if (folder, command) == ("result", "inspect") {
                    continue;
                }
                let material: &[&str] = if command == "solve" { &load[..4] } else { &[] };
                assert_refused(&place.run(&[&[command, folder, flag, value], material].concat()), expected);
            }
        }
        let map = format!("{folder}/heights.npy");
        let output = place.run(&["inspect", &map, "--json"]);
        assert_solved(&output);
        let record: serde_json::Value = serde_json::from_slice(&output.stdout).expect("JSON");
        assert_eq!((&record["cell"], codes(&record).len()), (&serde_json::json!(2e-3), 0), "{record}");
    }
}

/// A tilted map is steep across its border alone.
#[test]
fn the_border_of_a_map_that_is_not_periodic_is_no_slope() {
    let place = Place::new();
    let height = |i: usize| 0.1 * (i % 32) as f64 + 0.05 * ((i / 32) % 2) as f64;
    let bytes = (0..32 * 32).flat_map(|i| (1e-5 * height(i)).to_le_bytes()).collect::<Vec<u8>>();
    place.write("tilted.npy", npy("<f8", false, "(32, 32)", &bytes));
    let args = ["--cell", "3.2e-4", "--json"];
    let output = place.run(&[&["inspect", "tilted.npy"], &args[..]].concat());
    assert_solved(&output);
    let record: serde_json::Value = serde_json::from_slice(&output.stdout).expect("valid JSON");
    assert!(record["rms_slope"].as_f64() > Some(0.4), "{record}");
    assert!(codes(&record).is_empty(), "{:?}", codes(&record));
    let solve = ["solve", "tilted.npy", "--e-star", "1e9", "--pressure", "1e4"];
    let summary: serde_json::Value =
        serde_json::from_slice(&place.run(&[&solve[..], &args].concat()).stdout).expect("valid JSON");
    assert!(codes(&summary).contains(&"border".to_owned()), "{summary}");
    assert!(!codes(&summary).iter().any(|code| code == "slope" || code == "units"), "{summary}");
}
