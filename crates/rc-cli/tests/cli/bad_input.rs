//! Bad input gives exit code 2 and one line.
//!
//! The line says what, where, and what would be right.

use crate::support::{Place, SMALL, assert_refused, assert_solved, bumps, f8, map, npy, small, text};

/// Runs the small problem at 1e5 Pa with `flags`.
///
/// They replace its own flags of the same name.
fn run_small_with(place: &Place, flags: &[&str]) -> std::process::Output {
    let mut args = vec!["solve", "--quiet", "--pressure", "1e5"];
    for default in [["--waves", "8"], ["--grid", "128"]] {
        if !flags.contains(&default[0]) {
            args.extend(default);
        }
    }
    args.extend(flags);
    place.run(&args)
}

#[test]
fn bad_values_of_the_surface_are_refused_with_their_key() {
    let place = Place::new();
    let cases: &[(&[&str], &str)] = &[
        (&["--cell", "0"], "cell"),
        (&["--cell", "-1"], "cell"),
        (&["--cell", "-1e-3"], "cell"),
        (&["--cell", "nan"], "cell"),
        (&["--grid", "0"], "grid"),
        (&["--grid", "16"], "at least 17"),
        (&["--grid", "-3"], "grid"),
        (&["--grid", "1000000"], "grid"),
        (&["--grid", "99999999999"], "grid"),
        (&["--grid", "1048577"], "1 to 1048576"),
        (&["--grid", "1048576", "--method", "uniform"], "but this machine has"),
        (&["--waves", "0"], "waves"),
        (&["--rms", "-1e-6"], "rms"),
        (&["--hurst", "2"], "hurst"),
        (&["--roll-off", "9"], "roll_off"),
        (&["--seed", "-1"], "'-1' for '--seed <SEED>': must be a whole number, not negative"),
        (&["--rms", "x"], "'x' for '--rms <M>': must be a length in m, or with a unit such as 25um, not 'x'"),
        (&["--hurst", "x"], "'x' for '--hurst <H>': must be a number, such as 4.5e5"),
        (&["--seed", "18446744073709551615"], "seed"),
        (&["--rms", "1", "--c0", "1"], "alternatives"),
    ];
    for (flags, expected) in cases {
        assert_refused(&run_small_with(&place, flags), expected);
    }
    assert!(place.names(".").is_empty(), "left behind: {:?}", place.names("."));
}

#[test]
fn bad_values_of_the_contact_are_refused_with_their_key() {
    let place = Place::new();
    let cases: &[(&[&str], &str)] = &[
        (&["--young", "0"], "young"),
        (&["--e-star", "-5"], "e_star"),
        (&["--poisson", "0.6"], "poisson"),
        (&["--poisson", "-1"], "poisson"),
        (&["--e-star", "1", "--young", "1"], "e_star"),
        (&["--tolerance", "2"], "tolerance"),
        (&["--tolerance", "0"], "tolerance"),
        (&["--tolerance", "1e-30"], "tolerance"),
        (&["--tolerance", "small"], "tolerance"),
        (
            &["--method", "adaptive", "--kernel", "spectral"],
            "method: the method adaptive cannot be combined with the kernel spectral",
        ),
        (&["--method", "adaptive", "--grid", "128x64"], "square elements"),
        (
            &["--method", "adaptive", "--grid", "66"],
            "for 66 x 66; other numbers of elements may have one, and multiples of 16 do",
        ),
        (&["--method", "adaptive", "--waves", "24", "--grid", "96"], "at least 98 elements"),
        (
            &["--border-level", "1", "--grid", "130"],
            "a border level cannot be combined with a grid that cannot be halved several times",
        ),
        (&["--method", "adaptive", "--tolerance", "1e-13"], "tolerance"),
        (&["--memory-limit", "100kB"], "memory_limit"),
        (&["--memory-limit", "100kB", "--method", "uniform"], "memory_limit"),
        (&["--memory-limit", "0"], "memory-limit"),
        (&["--memory-limit", "many"], "500MB"),
        (&["--method", "gauss-seidel", "--kernel", "spectral"], "love"),
        (&["--kernel", "lave"], "love"),
        (&["--output-grid", "50"], "output_grid"),
        (&["--output-grid", "0"], "output_grid"),
        (&["--threads", "0"], "threads"),
        (&["--threads", "-1"], "threads"),
        (&["--presure", "1"], "--pressure"),
    ];
    for (flags, expected) in cases {
        assert_refused(&run_small_with(&place, flags), expected);
    }
    assert!(place.names(".").is_empty(), "left behind: {:?}", place.names("."));
}

#[test]
fn the_control_must_be_given_exactly_once() {
    let place = Place::new();
    assert_refused(&place.run(&SMALL), "exactly one");
    assert_refused(&place.run(&small("1e5", &["--penetration", "1e-6"])), "exactly one");
    for pressure in ["0", "-1e5", "inf", "nan"] {
        assert_refused(&place.run(&small(pressure, &[])), "pressure");
    }
    assert_refused(&place.run(&[&SMALL[..], &["--penetration", "-1e-6"]].concat()), "penetration");
}

#[test]
fn a_penetration_beyond_full_contact_names_it_and_points_to_pressure_control() {
    let place = Place::new();
    let output = place.run(&[&SMALL[..], &["--penetration", "4e-4", "--out", "result"]].concat());
    assert_refused(&output, "full contact");
    assert!(text(&output.stderr).contains("--pressure"), "{}", text(&output.stderr));
    assert!(!place.path("result").exists(), "a folder was made for nothing");
}

#[test]
fn bad_scene_files_are_refused_with_line_and_remedy() {
    let place = Place::new();
    let cases = [
        (
            "waves = 8\npresure = 1.0\n",
            "scene.toml: line 2: unknown key 'presure'; the nearest known key is 'pressure'",
        ),
        ("waves = 8\ncell = \"wide\"\n", "scene.toml: line 2"),
        ("waves = 8\nwaves = 9\n", "scene.toml: line 2"),
        ("waves == 8\n", "scene.toml: line 1"),
        (
            "pressure = 1.0\npenetration = 1e-6\n",
            "scene.toml: both pressure and penetration are given; give exactly one",
        ),
        ("heights = \"h.npy\"\nwaves = 8\n", "scene.toml: heights"),
        ("heights = \"missing.npy\"\npressure = 1.0\n", "missing.npy: cannot read"),
    ];
    for (scene, expected) in cases {
        place.write("scene.toml", scene);
        assert_refused(&place.run(&["solve", "scene.toml"]), expected);
    }
    assert_refused(&place.run(&["solve", "none.toml"]), "none.toml");
    place.write("binary.toml", [0xff, 0xfe, 0x00]);
    assert_refused(&place.run(&["solve", "binary.toml"]), "binary.toml");
}

/// Writes files that are not height maps.
///
/// Returns their names, each with a part of the expected message.
fn write_bad_maps(place: &Place) -> Vec<(&'static str, &'static str)> {
    let mut holed = bumps(8);
    holed[19] = f32::NAN;
    let mut spiked = bumps(8);
    spiked[0] = f32::INFINITY;
    let square = "(8, 8)";
    place.write("nan.npy", npy("<f8", false, square, &f8(&holed)));
    place.write("inf.npy", npy("<f8", false, square, &f8(&spiked)));
    place.write("flat.npy", npy("<f8", false, square, &f8(&[1.5; 64])));
    place.write("line.npy", npy("<f8", false, "(64,)", &f8(&bumps(8))));
    place.write("cube.npy", npy("<f8", false, "(4, 4, 4)", &f8(&bumps(8))));
    place.write("none.npy", npy("<f8", false, "(0, 8)", &[]));
    place.write("huge.npy", npy("<f8", false, "(1048576, 1048576)", &[0; 64]));
    place.write("short.npy", npy("<f8", false, square, &f8(&bumps(8)[1..])));
    place.write("complex.npy", npy("<c16", false, "(4, 8)", &f8(&bumps(8))));
    place.write("text.npy", npy("<U4", false, "(4, 8)", &f8(&bumps(8))));
    place.write("not.npy", "1,2\n3,4\n");
    place.write("ragged.csv", "1,2,3\n4,5\n");
    place.write("text.csv", "1,2\n3,four\n");
    place.write("nan.csv", "1,2,1\n3,nan,4\n");
    place.write("empty.csv", "");
    place.write("map.bin", "1,2\n3,4\n");
    vec![
        ("nan.npy", "row 2, column 3"),
        ("inf.npy", "row 0, column 0"),
        ("flat.npy", "flat"),
        ("line.npy", "a profile"),
        ("cube.npy", "2-D"),
        ("none.npy", "1 to"),
        ("huge.npy", "shorter"),
        ("short.npy", "shorter"),
        ("complex.npy", "real"),
        ("text.npy", "real"),
        ("not.npy", "not a valid npy file"),
        ("ragged.csv", "line 2"),
        ("text.csv", "line 2, value 2"),
        ("nan.csv", "row 1, column 1"),
        ("empty.csv", "it has no numbers; give a row of the map in each line"),
        ("map.bin", ".npy"),
        ("missing.npy", "cannot read"),
    ]
}

#[test]
fn bad_height_maps_are_refused_with_their_place() {
    let place = Place::new();
    for (file, expected) in write_bad_maps(&place) {
        let output = place.run(&map("solve", file, &["--pressure", "1e5", "--out", "result"]));
        assert_refused(&output, expected);
        assert!(text(&output.stderr).contains(file), "{}", text(&output.stderr));
        // Statistics of a map with missing points are those of the others.
        if !["nan.npy", "nan.csv"].contains(&file) {
            assert_refused(&place.run(&["inspect", file]), expected);
        }
    }
    assert_refused(&place.run(&map("solve", ".", &["--pressure", "1e5"])), ".csv");
    assert!(!place.path("result").exists(), "a folder was made for nothing");
}

#[test]
fn a_grid_that_is_not_that_of_the_height_map_is_refused() {
    let place = Place::new();
    place.write("map.npy", npy("<f8", false, "(64, 64)", &f8(&bumps(64))));
    let args = map("solve", "map.npy", &["--pressure", "1e5", "--grid", "128", "--quiet"]);
    assert_refused(&place.run(&args), "64 x 64");
}

#[test]
fn an_output_folder_that_cannot_be_is_refused_before_any_work() {
    let place = Place::new();
    place.write("file", "keep");
    for out in ["file", "file/sub", "file/sub/sub"] {
        assert_refused(&place.run(&small("1e5", &["--out", out])), "out:");
    }
    assert_eq!(place.bytes("file"), b"keep");
    assert_eq!(place.names("."), ["file"]);
}

#[test]
fn a_wrong_value_in_a_scene_file_is_named_with_its_line_and_key() {
    let place = Place::new();
    let cases = [
        ("waves = 8.5", "line 2: waves: must be a whole number of at least 0, not 8.5"),
        (
            "rms = \"1e-6x\"",
            "line 2: rms: must be a length in m, or with a unit such as 25um, not '1e-6x'; 'x' is not a known unit",
        ),
        ("hurst = \"0.8\"", "line 2: hurst: must be a number without quotes, not \"0.8\""),
        (
            "method = \"addaptive\"",
            "line 2: method: must be 'adaptive' or 'uniform' or 'gauss-seidel', not 'addaptive'",
        ),
        ("kernel = 3", "line 2: kernel: must be text in quotes"),
        ("heights = 3", "line 2: heights: must be text in quotes, not 3"),
        ("rms = [1e-6]", "line 2: rms: must be a length in m, or with a unit such as 25um, not a list"),
        ("area_error = \"x\"", "line 2: area_error: a fraction is a number above 0 and below 1"),
        ("threads = \"a, expected b\"", "line 2: threads: must be a whole number of at least 0, not \"a, expected b\""),
    ];
    for (line, expected) in cases {
        place.write("scene.toml", format!("# a scene\n{line}\n"));
        assert_refused(&place.run(&["solve", "scene.toml", "--pressure", "1e5"]), expected);
    }
    place.write("latin.toml", b"waves = 8 # \xb5m\n");
    assert_refused(&place.run(&["solve", "latin.toml"]), "latin.toml: not text in UTF-8; save it as UTF-8");
    place.write("map.npy", npy("<f8", false, "(4, 4)", &f8(&bumps(4))));
    // A height map may stand for its scene. Other files are not guessed.
    assert_refused(&place.run(&["solve", "map.npy"]), "a height map needs cell (m)");
    place.write("scene.bin", [0xff, 0, 2, 3]);
    let message = "scene.bin: not a scene file, which is text (TOML); for a height map give";
    assert_refused(&place.run(&["solve", "scene.bin"]), message);
    std::fs::create_dir(place.path("empty")).expect("a folder");
    assert_refused(&place.run(&["solve", "empty"]), "a folder without scene.toml");
}

#[test]
fn of_several_scenes_the_one_with_a_bad_value_is_named() {
    let place = Place::new();
    place.write("good.toml", "waves = 8\ngrid = 64\n");
    place.write("bad.toml", "waves = 8\ngrid = 64\nhurst = 3\n");
    let sweep = ["sweep", "good.toml", "bad.toml", "--pressures", "1e5,2e5", "--out", "s"];
    assert_refused(&place.run(&sweep), "scene bad: hurst: must be above 0 and at most 1, not 3");
}

#[test]
fn a_file_of_three_columns_that_was_read_as_points_says_so() {
    let place = Place::new();
    place.write("map.txt", "1 2 3\n4 5 6\n7 8 9\n");
    let guessed = "read as a list of points x, y, z, so give --layout matrix if each line is a row of the map";
    let press = ["--e-star", "1e9", "--pressure", "1e5"];
    assert_refused(&place.run(&[&["solve", "--heights", "map.txt"], &press[..]].concat()), guessed);
    place.write("hole.txt", "1 2 3\n4 nan 6\n7 8 9\n");
    let given = ["solve", "--heights", "hole.txt", "--layout", "matrix", "--cell", "1"];
    let given = place.run(&[&given[..], &press[..]].concat());
    assert_refused(&given, "row 1, column 1 (from 0) is NaN; heights must be finite; rc surface --fill laplace fills");
}

#[test]
fn remedies_are_possible() {
    let place = Place::new();
    let cases: &[(&[&str], &str)] = &[
        (&["man"], "required argument is missing: --out <DIR>"),
        (&["sweep", "merge"], "required arguments are missing: --out <DIR>, <DIR>..."),
        (&["squeeze"], "unrecognized subcommand 'squeeze'; rc --help lists the commands"),
        (&["surface", "--method", "uniform"], "unexpected argument '--method' found; --help lists the flags"),
        (&["solve", "--pressure", "1e5", "--grid", "64x"], "512x256, not '64x'"),
        (
            &["solve", "--pressure", "1e5", "--memory-limit", "12MB"],
            "more than the limit of 12 MB; give a coarser grid",
        ),
        (&["solve", "--pressure", "1e5", "--memory-limit", "1kB"], "more than the limit of 1 kB; allow more memory"),
    ];
    for (args, expected) in cases {
        assert_refused(&place.run(args), expected);
    }
    place.write("file", "text");
    for command in ["plot", "export", "report"] {
        let format: &[&str] = if command == "export" { &["--vtk"] } else { &[] };
        let output = place.run(&[&[command, "file"], format].concat());
        assert_refused(&output, "file: is a file; give the folder that it is in");
    }
}

#[test]
fn an_area_error_that_no_grid_reaches_is_refused_with_one_that_is_reached() {
    let place = Place::new();
    let scene = ["solve", "--waves", "2", "--pressure", "1e5", "--quiet", "--area-error"];
    let output = place.run(&[&scene[..], &["1e-7"]].concat());
    assert_refused(&output, "area_error: 1.0e-5 % cannot be reached; with 4096 elements per side");
    let message = text(&output.stderr);
    let (_, rest) = message.split_once("the error is ").expect("the error that is reached");
    let reached = rest.split(' ').next().expect("a number");
    assert_solved(&place.run(&[&scene[..], &[&format!("{reached}%")]].concat()));
}

#[test]
fn flags_of_files_that_are_never_written_are_refused() {
    let place = Place::new();
    let sweep = ["sweep", "--waves", "8", "--grid", "64", "--pressures", "1e4", "--quiet", "--out", "s"];
    for (args, expected) in [
        (small("1e5", &["--elements"]), "elements: applies to the files of the results; give --out DIR"),
        (small("1e5", &["--precision", "single"]), "precision: applies to the files of the results; give --out DIR"),
        (small("1e5", &["--elements", "--method", "uniform", "--out", "r"]), "elements: the method uniform has no"),
        ([&sweep[..], &["--elements"]].concat(), "elements: applies to the files of the rows; give --fields"),
    ] {
        assert_refused(&place.run(&args), expected);
    }
    assert!(!place.path("r").exists() && !place.path("s").exists());
}
