//! Sweeps that are refused with one line and exit code 2, and write nothing.

use crate::support::{Place, assert_refused, assert_solved, bumps, f8, npy, text};
use crate::sweep::{TINY, table};

#[test]
fn bad_lists_are_refused() {
    let place = Place::new();
    let cases: &[(&[&str], &str)] = &[
        (&[], "give --pressures or --penetrations"),
        (&["--pressures", ""], "--pressures"),
        (&["--pressures", "1e5:1e6:0"], "from 2 to"),
        (&["--pressures", "1e5:1e6"], "first:last:count"),
        (&["--pressures", "1e5,1e6,2e5"], "must all rise or all fall"),
        (&["--pressures", "1e5:1e5:4"], "must all rise or all fall"),
        (&["--pressures", "-1e5:1e6:4"], "positive"),
        (&["--pressures", "nan"], "positive"),
        (&["--penetrations", "0,1e-6"], "positive"),
        (&["--pressures", "1e5", "--penetrations", "1e-6"], "--pressures and --penetrations are both given"),
        (&["--pressures", "1e5", "--penetration", "1e-6"], "--pressures and --penetration are both given"),
        (&["--pressures", "1e5", "--seeds", "7..1"], "empty"),
        (&["--pressures", "1e5", "--seeds", "1,1"], "given twice"),
        (&["--pressures", "1e5", "--seeds", "-1"], "seeds"),
        (&["--pressures", "1e5", "--seeds", "18446744073709551615"], "seed"),
        (&["--pressures", "1e5", "--seeds", "1", "--seed", "2"], "--seeds and --seed are both given"),
        (&["--pressures", "1e5,2e5", "--shard", "3/2"], "2/8"),
        (&["--pressures", "1e5,2e5", "--shard", "1/3"], "at most 2 shards"),
        (&["--pressures", "1e5", "--threads", "0"], "threads"),
        (&["--pressures", "1e5", "--tolerance", "3"], "tolerance"),
        (&["--pressures", "1e5", "merge"], "merge"),
    ];
    for (flags, expected) in cases {
        assert_refused(&place.run(&[&TINY[..], flags, &["--out", "s"]].concat()), expected);
    }
    assert_refused(&place.run(&[&TINY[..], &["--pressures", "1e5"]].concat()), "give --out DIR");
    assert!(place.names(".").is_empty(), "left behind: {:?}", place.names("."));
}

#[test]
fn scenes_that_do_not_go_together_are_refused() {
    let place = Place::new();
    std::fs::create_dir(place.path("b")).expect("a folder");
    for (name, scene) in [
        ("a.toml", "waves = 4\ngrid = 128\npressure = 1e5\n"),
        ("b/a.toml", "waves = 4\ngrid = 128\npressure = 1e5\n"),
        ("c.toml", "waves = 4\ngrid = 128\npenetration = 1e-6\n"),
        ("map.toml", "heights = \"map.npy\"\ncell = 0.01\ne_star = 5e8\n"),
        ("typo.toml", "presures = 1\n"),
    ] {
        place.write(name, scene);
    }
    place.write("map.npy", npy("<f8", false, "(64, 64)", &f8(&bumps(64))));
    let cases: &[(&[&str], &str)] = &[
        (&["a.toml", "b/a.toml"], "two are called 'a'"),
        (&["a.toml", "c.toml"], "a sweep has one control"),
        (&["a.toml", "typo.toml"], "typo.toml: line 1"),
        (&["a.toml", "none.toml"], "none.toml"),
        (&["map.toml", "--pressures", "1e5", "--seeds", "1..3"], "the height map of map has no seed"),
        (&["map.toml"], "give --pressures or --penetrations"),
    ];
    for (args, expected) in cases {
        assert_refused(&place.run(&[&["sweep", "--out", "s"], *args].concat()), expected);
    }
    assert!(!place.path("s").exists(), "a folder was made for nothing");
}

#[test]
fn a_refused_row_is_named_and_keeps_the_rows_before() {
    let place = Place::new();
    let run = |penetrations: &str| {
        place.run(&[&TINY[..], &["--penetrations", penetrations, "--threads", "1", "--out", "s"]].concat())
    };
    let refused = run("1e-3,2e-3");
    assert_refused(
        &refused,
        "row 1 (seed 1, penetration 1e-3): penetration: must be above 0 and below that of full contact",
    );
    assert!(!place.path("s").exists(), "an empty sweep was left behind");
    let refused = run("1e-6,1e-5,1e-3");
    assert_refused(&refused, "row 3 (seed 1, penetration 1e-3)");
    assert_eq!(table(&place.path("s")).len(), 3, "the rows before");
}

#[test]
fn a_sweep_that_needs_more_memory_than_there_may_be_is_refused() {
    let place = Place::new();
    let output = place.run(&[&TINY[..], &["--pressures", "1e5", "--memory-limit", "300kB", "--out", "s"]].concat());
    assert_refused(&output, "row 1 (seed 1, pressure 1e5): memory_limit: ");
    assert!(!place.path("s").exists(), "{}", text(&output.stderr));
    assert_solved(&place.run(&["sweep", "--help"]));
}
