//! `rc-mpi solve` without MPI, with threads as ranks.

use std::ffi::OsString;

use rc_cli::solve::main_over_ranks;
use rc_comm::run_threads;

use crate::support::{Place, array, assert_solved};

/// The scene: contacts on a grid that is divided among three ranks.
const SCENE: [&str; 7] = ["solve", "--waves=16", "--grid=512", "--method=adaptive", "--quiet", "--pressure", "446395"];

/// Exit codes of a command line over `size` ranks.
fn run(size: usize, place: &Place, words: &[&str], out: Option<&str>) -> Vec<u8> {
    let out = out.map(|out| [OsString::from("--out"), place.path(out).into_os_string()]);
    let words = ["rc-mpi"].iter().chain(words).map(OsString::from).chain(out.into_iter().flatten());
    let words: Vec<OsString> = words.collect();
    run_threads(size, |ranks| main_over_ranks(words.clone(), &ranks)).expect("all ranks end")
}

/// The summary without the keys that depend on the run.
fn summary(place: &Place, folder: &str) -> serde_json::Value {
    let mut summary = place.json(&format!("{folder}/summary.json"));
    for key in ["wall_seconds", "peak_memory_bytes", "threads"] {
        summary.as_object_mut().expect("an object").remove(key);
    }
    summary
}

#[test]
fn the_files_of_three_ranks_are_those_of_one_process() {
    let place = Place::new();
    assert_solved(&place.run(&[&SCENE[..], &["--out", "alone"]].concat()));
    assert_eq!(run(3, &place, &SCENE, Some("ranks")), [0; 3]);
    let names = place.names("alone");
    assert_eq!(place.names("ranks"), names);
    for name in names.iter().filter(|name| *name != "summary.json") {
        assert!(place.bytes(&format!("alone/{name}")) == place.bytes(&format!("ranks/{name}")), "{name} differs");
    }
    assert_eq!(summary(&place, "ranks"), summary(&place, "alone"));
    let elements = summary(&place, "alone")["elements"].as_u64().expect("a number");
    assert!(elements > 10_000, "{elements} elements");
}

#[test]
fn ranks_write_the_chunks_of_their_rows() {
    let place = Place::new();
    assert_solved(&place.run(&[&SCENE[..], &["--out", "alone"]].concat()));
    assert_eq!(run(3, &place, &[&SCENE[..], &["--zarr"]].concat(), Some("ranks")), [0; 3]);
    assert_eq!(place.names("ranks"), ["fields.zarr", "scene.toml", "summary.json"]);
    for field in ["pressure", "gap"] {
        let (_, _, bytes) = array(&place, &format!("ranks/fields.zarr/{field}"));
        let npy = place.bytes(&format!("alone/{field}.npy"));
        assert_eq!(bytes.len(), 512 * 512 * 8);
        assert!(npy.ends_with(&bytes), "{field} differs");
    }
    assert_eq!(summary(&place, "ranks"), summary(&place, "alone"));
}

#[test]
fn a_checkpoint_is_of_one_scene_and_gone_with_the_result() {
    let place = Place::new();
    let file = place.path("levels");
    let file = file.to_str().expect("a path of letters");
    let kept = [&SCENE[..], &["--checkpoint", file]].concat();
    place.write("levels", "something else");
    assert_eq!(run(2, &place, &kept, Some("ranks")), [2; 2]);
    assert_eq!(place.bytes("levels"), b"something else");
    std::fs::remove_file(file).expect("a file");
    assert_eq!(run(2, &place, &kept, Some("ranks")), [0; 2]);
    assert_eq!(place.names("."), ["ranks"], "the result does not need it any more");
}

#[test]
fn what_ranks_cannot_do_is_refused_on_all_of_them() {
    let place = Place::new();
    let with = |words: &[&'static str]| [&SCENE[..], words].concat();
    let without_method = ["solve", "--waves=16", "--grid=512", "--quiet", "--method=uniform", "--pressure=446395"];
    for words in [&with(&["--watch"])[..], &with(&["--border-level=1"]), &without_method, &["sweep"]] {
        assert_eq!(run(2, &place, words, Some("ranks")), [2; 2], "{words:?}");
    }
    // A mean pressure of 0.11 E* is doubted before the solve.
    assert_eq!(run(2, &place, &with(&["--e-star=4e6", "--strict"]), Some("ranks")), [2; 2]);
    assert_eq!(run(2, &place, &with(&["--zarr"]), None), [2; 2], "a group has a folder");
    assert_eq!(run(2, &place, &with(&["--zarr", "--output-grid=64"]), Some("ranks")), [2; 2]);
    assert_eq!(place.names("."), [""; 0], "nothing is written");
}
