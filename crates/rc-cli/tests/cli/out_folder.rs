//! What `--out` does with the files that its folder has already.

use crate::support::{Place, assert_refused, assert_solved, bumps, f8, npy, small};

#[test]
fn a_solve_leaves_no_file_of_the_earlier_one() {
    let place = Place::new();
    let rich = small("1e5", &["--leakage", "--hardness", "3e6", "--elements", "--method", "adaptive", "--out", "r"]);
    assert_solved(&place.run(&rich));
    for made in [&["report", "r", "--quiet"][..], &["plot", "r", "--quiet"], &["export", "r", "--zarr", "--quiet"]] {
        assert_solved(&place.run(made));
    }
    place.write("r/notes.txt", "mine");
    let earlier = place.names("r");
    let has = |name: &str| place.names("r").iter().any(|other| other == name);
    assert!(["flow_x.npy", "plastic_gap.npy", "report.html", "gap.png", "fields.zarr"].iter().all(|name| has(name)));
    assert_refused(&place.run(&small("-1", &["--out", "r"])), "pressure");
    assert_eq!(place.names("r"), earlier, "a solve that failed removes nothing");
    // Another grid, so that a field of the earlier solve would not fit.
    let plain = ["solve", "--waves", "8", "--grid", "64", "--pressure", "1e5", "--quiet", "--out", "r"];
    assert_solved(&place.run(&plain));
    let expected = ["contact.png", "gap.npy", "notes.txt", "pressure.npy", "scene.toml", "summary.json"];
    assert_eq!(place.names("r"), expected);
    for made in [&["report", "r", "--quiet"][..], &["export", "r", "--vtk", "--quiet"], &["inspect", "r"]] {
        assert_solved(&place.run(made));
    }
}

#[test]
fn a_folder_of_another_kind_is_refused_and_keeps_its_files() {
    let place = Place::new();
    place.write("map.npy", npy("<f8", false, "(32, 32)", &f8(&bumps(32))));
    let solve: Vec<&str> = small("1e5", &["--out"]);
    let prepare = vec!["prepare", "map.npy", "--cell", "0.01", "--periodic", "mirror", "--quiet", "--out"];
    let surface = vec!["surface", "--waves", "8", "--grid", "64", "--quiet", "--out"];
    let sweep = vec!["sweep", "--waves", "8", "--grid", "64", "--pressures", "1e5", "--quiet", "--out"];
    let into = |command: &[&str], folder: &str| place.run(&[command, &[folder]].concat());
    assert_solved(&into(&solve, "result"));
    assert_solved(&into(&prepare, "ready"));
    assert_solved(&into(&sweep, "rows"));
    let refused = [
        (&prepare, "result", "result is the result of rc solve"),
        (&surface, "result", "result is the result of rc solve"),
        (&sweep, "result", "result is the result of rc solve"),
        (&solve, "ready", "ready is a surface of rc surface or rc prepare"),
        (&sweep, "ready", "ready is a surface of rc surface or rc prepare"),
        (&solve, "rows", "rows is a sweep"),
        (&prepare, "rows", "rows is a sweep"),
    ];
    for (command, folder, what) in refused {
        let files = place.contents(folder);
        assert_refused(
            &into(command, folder),
            &format!("out: {what}, whose files would be replaced; give another folder"),
        );
        assert_eq!(place.contents(folder), files);
    }
    // The same kind is replaced, and leaves nothing of the earlier one.
    assert_solved(&into(&surface, "ready"));
    assert_eq!(place.names("ready"), ["heights.npy", "scene.toml", "surface.json", "surface.png"]);
    assert_solved(&into(&solve, "result"));
}
