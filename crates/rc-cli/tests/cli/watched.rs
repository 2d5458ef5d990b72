//! `rc solve --watch`: a picture during the solve, and no other change.

use std::collections::BTreeSet;
use std::process::{Command, Stdio};
use std::time::Duration;

use crate::support::{Place, assert_refused, assert_solved, small, text};

#[test]
fn a_watched_solve_writes_the_same_bits_and_nothing_more() {
    let place = Place::new();
    for method in ["uniform", "adaptive", "gauss-seidel"] {
        let folders = [format!("{method}-watched"), format!("{method}-alone")];
        assert_solved(&place.run(&small("1e5", &["--method", method, "--watch", "--out", &folders[0]])));
        assert_solved(&place.run(&small("1e5", &["--method", method, "--out", &folders[1]])));
        let [watched, alone] = folders.map(|folder| place.contents(&folder));
        assert_eq!(watched.len(), alone.len(), "{method}: other files");
        for ((name, watched), (other, alone)) in watched.iter().zip(&alone) {
            assert_eq!(name, other, "{method}");
            // The summary differs, since it has times.
            assert!(name == "summary.json" || watched == alone, "{method}: {name} differs");
        }
    }
}

#[test]
fn the_picture_is_there_whole_while_the_solve_runs_and_gone_after_it() {
    let place = Place::new();
    for method in ["uniform", "adaptive"] {
        let mut long = Command::new(env!("CARGO_BIN_EXE_rc"))
            .args(["solve", "--waves", "64", "--grid", "2048", "--pressure", "446395", "--tolerance", "1e-9"])
            .args(["--time-limit", "3s", "--watch", "--quiet", "--method", method, "--out", method])
            .current_dir(place.folder())
            .stderr(Stdio::null())
            .spawn()
            .expect("rc runs");
        let mut pictures = BTreeSet::new();
        while long.try_wait().expect("a process").is_none() {
            if let Ok(bytes) = std::fs::read(place.path(&format!("{method}/watch.png"))) {
                let is_whole = bytes.starts_with(b"\x89PNG") && bytes.ends_with(b"IEND\xaeB`\x82");
                assert!(is_whole, "{method}: a picture of {} bytes is not whole", bytes.len());
                pictures.insert(bytes);
            }
            std::thread::sleep(Duration::from_millis(5));
        }
        assert!(!pictures.is_empty(), "{method}: nothing was seen");
        let names = place.names(method);
        assert!(names.contains(&"contact.png".to_owned()), "{method}: {names:?}");
        assert!(!names.iter().any(|name| name.contains("watch") || name.starts_with('.')), "{method}: {names:?}");
        // The picture has the size of contact.png. Width and height are in the first bytes.
        let result = place.bytes(&format!("{method}/contact.png"));
        assert!(pictures.iter().all(|picture| picture[16..24] == result[16..24]), "{method}: another size");
    }
}

#[test]
fn what_is_solved_at_once_or_grid_by_grid_can_be_watched_too() {
    let place = Place::new();
    let full = [
        "solve",
        "--waves",
        "2",
        "--grid",
        "16",
        "--pressure",
        "1e12",
        "--watch",
        "--out",
        "full",
        "--json",
        "--quiet",
    ];
    let output = place.run(&full);
    assert_solved(&output);
    assert!(output.stderr.is_empty(), "{}", text(&output.stderr));
    assert_eq!(output.stdout, place.bytes("full/summary.json"), "standard output is not the summary");
    assert!(!place.names("full").contains(&"watch.png".to_owned()));
    let chosen =
        ["solve", "--waves", "8", "--pressure", "1e5", "--area-error", "20%", "--quiet", "--watch", "--out", "c"];
    assert_solved(&place.run(&chosen));
    assert!(!place.names("c").contains(&"watch.png".to_owned()));
}

#[test]
fn a_picture_that_cannot_be_written_is_told_and_the_solve_goes_on() {
    let place = Place::new();
    std::fs::create_dir_all(place.path("r/watch.png")).expect("a folder in its way");
    let output = place.run(&small("1e5", &["--watch", "--out", "r"]));
    assert_solved(&output);
    let message = text(&output.stderr);
    assert!(message.lines().count() == 1 && message.contains("watch.png"), "{message}");
    assert!(place.path("r/summary.json").is_file() && place.path("r/watch.png").is_dir());
}

#[test]
fn watching_nothing_is_refused() {
    let place = Place::new();
    assert_refused(&place.run(&small("1e5", &["--watch"])), "--out");
    let dry = ["solve", "--waves", "8", "--pressure", "1e5", "--dry-run", "--watch", "--out", "r"];
    assert_refused(&place.run(&dry), "dry run");
    assert_refused(&place.run(&["sweep", "--waves", "8", "--pressures", "1e5", "--watch", "--out", "r"]), "--watch");
    assert_eq!(place.names("."), Vec::<String>::new(), "something was written");
}
