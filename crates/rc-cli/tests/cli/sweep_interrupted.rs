//! Sweeps that are killed, interrupted, cut short or out of disk, and then resumed.

use std::fs;
use std::io::Read as _;
use std::process::{Child, Command, Stdio};
use std::time::{Duration, Instant};

use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;

use crate::support::{Place, assert_refused, assert_solved, map, text};
use crate::sweep::{TINY, result, sweep, table};

const ROWS: usize = 12;

fn start(place: &Place, args: &[&str]) -> Child {
    let mut command = Command::new(env!("CARGO_BIN_EXE_rc"));
    command.args(args).current_dir(place.folder()).stderr(Stdio::piped()).spawn().expect("rc runs")
}

/// Number of whole lines of the journal, including the first.
fn journal_lines(place: &Place, out: &str) -> usize {
    // A killed process may not have made the file yet.
    let journal = fs::read_to_string(place.path(out).join("sweep.jsonl")).unwrap_or_default();
    journal.matches('\n').count()
}

/// Fails unless a resumed sweep has the results of the uninterrupted one in `whole`.
fn assert_same_as_whole(place: &Place, out: &str) {
    assert_eq!(result(&place.path(out)), result(&place.path("whole")));
    assert_eq!(journal_lines(place, out), 1 + ROWS, "not each row once");
    assert_eq!(place.names(out), ["rows", "sweep.csv", "sweep.jsonl"], "something was left behind");
    for row in place.names("whole/rows") {
        assert_eq!(place.names(&format!("{out}/rows/{row}")), place.names(&format!("whole/rows/{row}")));
        for name in ["pressure.npy", "gap.npy", "contact.png"] {
            let file = format!("rows/{row}/{name}");
            assert!(place.bytes(&format!("{out}/{file}")) == place.bytes(&format!("whole/{file}")), "{file} differs");
        }
    }
}

#[test]
fn a_sweep_killed_at_twenty_random_moments_loses_and_repeats_nothing() {
    const KILLS: usize = 20;
    let place = Place::new();
    let flags = ["--fields", "--threads", "2", "--resume"];
    let started = Instant::now();
    assert_solved(&place.run(&sweep("whole", &flags)));
    let longest = started.elapsed().mul_f64(0.2);
    let mut moments = ChaCha8Rng::seed_from_u64(20);
    let (mut kills, mut amid) = (0, 0);
    for number in 0.. {
        let out = format!("killed-{number}");
        while kills < KILLS {
            let mut child = start(&place, &sweep(&out, &flags));
            std::thread::sleep(longest.mul_f64(moments.random()));
            // This is SIGKILL, to which the process cannot react.
            child.kill().expect("a child");
            if child.wait().expect("the child has ended").success() {
                // The sweep was faster than the kill. The next kills are for a new sweep.
                break;
            }
            kills += 1;
            amid += usize::from((2..=ROWS).contains(&journal_lines(&place, &out)));
        }
        assert_solved(&place.run(&sweep(&out, &flags)));
        assert_same_as_whole(&place, &out);
        if kills == KILLS {
            break;
        }
    }
    assert!(amid > 0, "no kill hit a sweep that was partly done");
}

#[cfg(unix)]
#[test]
fn an_interrupt_leaves_the_table_of_the_rows_so_far() {
    let place = Place::new();
    let args = [&TINY[..], &["--pressures", "1e5:8e5:4", "--seeds", "1..2000", "--out", "s"]].concat();
    let mut child = start(&place, &args);
    let started = Instant::now();
    while journal_lines(&place, "s") < 4 && started.elapsed() < Duration::from_secs(60) {
        std::thread::sleep(Duration::from_millis(5));
    }
    let pid = child.id().to_string();
    assert!(Command::new("kill").args(["-INT", &pid]).status().expect("kill runs").success());
    let status = child.wait().expect("the child has ended");
    let mut message = String::new();
    child.stderr.take().expect("a pipe").read_to_string(&mut message).expect("text");
    assert_eq!(status.code(), Some(130), "{message}");
    let rows = table(&place.path("s")).len() - 1;
    assert!((3..8000).contains(&rows), "{rows} rows after an interrupt");
    assert_eq!(journal_lines(&place, "s"), 1 + rows, "table and journal differ");
    assert!(message.contains(&format!("interrupted with {rows} of 8000 rows in ")), "{message}");
    assert_eq!(place.names("s"), ["sweep.csv", "sweep.jsonl"]);
}

#[test]
fn a_torn_last_line_is_solved_again_and_the_others_are_not() {
    let place = Place::new();
    let flags = ["--fields", "--threads", "2"];
    assert_solved(&place.run(&sweep("whole", &flags)));
    assert_solved(&place.run(&sweep("torn", &flags)));
    let journal = place.bytes("torn/sweep.jsonl");
    place.write("torn/sweep.jsonl", &journal[..journal.len() - 40]);
    fs::remove_file(place.path("torn/sweep.csv")).expect("the table was there");
    let before = text(&place.bytes("torn/sweep.jsonl"));
    let kept = &before[..=before.rfind('\n').expect("whole lines")];
    assert_solved(&place.run(&sweep("torn", &[&flags[..], &["--resume"]].concat())));
    assert!(text(&place.bytes("torn/sweep.jsonl")).starts_with(kept), "finished rows were touched");
    assert_same_as_whole(&place, "torn");
}

#[test]
fn settings_that_differ_are_named() {
    let place = Place::new();
    place.write("map.csv", "1e-6,2e-6,1e-6\n3e-6,1e-6,2e-6\n");
    let map = map("sweep", "map.csv", &["--pressures", "1e5,2e5", "--quiet", "--out", "m"]);
    assert_solved(&place.run(&map));
    place.write("map.csv", "1e-6,2e-6,1e-6\n3e-6,2e-6,2e-6\n");
    assert_refused(&place.run(&[&map[..], &["--resume"]].concat()), "checksum of the file of surface 1 is ");

    let run = |pressures: &str, more: &[&str]| {
        place.run(&[&TINY[..], &["--pressures", pressures, "--out", "s"], more].concat())
    };
    assert_solved(&run("1e5,2e5", &[]));
    let before = place.contents("s");
    assert_refused(&run("1e5,2e5", &[]), "s: holds a sweep already; continue it with --resume");
    let cases: &[(&str, &[&str], &str)] = &[
        ("1e5,3e5", &[], "load 2 of surface 1 is 200000.0 in the folder and 300000.0 now"),
        ("1e5,2e5", &["--seeds", "2..3"], "the number of surfaces is 1 in the folder and 2 now"),
        ("1e5,2e5", &["--seed", "2"], "seed of surface 1 is 1 in the folder and 2 now"),
        (
            "1e5,2e5",
            &["--energy-tolerance", "0.02"],
            "energy_tolerance of surface 1 is 0.01 in the folder and 0.02 now",
        ),
        ("1e5,2e5", &["--fields"], "fields is false in the folder and true now"),
        ("1e5,2e5", &["--shard", "1/2"], "holds shard 1/1, not 1/2"),
    ];
    for (pressures, more, expected) in cases {
        assert_refused(&run(pressures, &[*more, &["--resume"]].concat()), expected);
    }
    // A default may be given or omitted.
    assert_solved(&run("1e5,2e5", &["--resume", "--kernel", "love", "--seeds", "1"]));
    assert!(place.contents("s") == before, "a refused or complete sweep was changed");
}

#[test]
fn a_folder_of_something_else_is_not_resumed() {
    let place = Place::new();
    assert_solved(&place.run(&[
        "solve",
        "--waves",
        "4",
        "--grid",
        "128",
        "--pressure",
        "1e5",
        "--quiet",
        "--out",
        "r",
    ]));
    let before = place.contents("r");
    assert_refused(&place.run(&sweep("r", &["--resume"])), "r: no sweep to resume");
    assert!(place.contents("r") == before, "the foreign folder was changed");
    fs::create_dir(place.path("s")).expect("a folder");
    place.write("s/sweep.jsonl", "{\"a\": 1}\n");
    assert_refused(&place.run(&sweep("s", &["--resume"])), "not a journal of rc sweep");
    fs::create_dir_all(place.path("t/rows/0001")).expect("a folder");
    assert_refused(&place.run(&sweep("t", &[])), "t: has rows already");
}

/// A full disk does not cost a finished row.
///
/// A limit of the size of files stands in for a full disk. It stops writing in the middle of a line with an error, and
/// does not need the administrator's rights.
#[cfg(unix)]
#[test]
fn a_full_disk_costs_no_finished_row() {
    let place = Place::new();
    assert_solved(&place.run(&sweep("whole", &["--threads", "2"])));
    // Blocks have 512 or 1024 bytes, depending on the shell. The whole journal has more than either.
    let size = place.bytes("whole/sweep.jsonl").len();
    let header = text(&place.bytes("whole/sweep.jsonl")).find('\n').expect("lines");
    let blocks = (header + 3000).div_ceil(512);
    assert!(blocks * 1024 < size, "a journal of {size} bytes fits into {blocks} blocks");
    let script = format!("trap '' XFSZ; ulimit -f {blocks}; exec \"$0\" \"$@\"");
    let output = Command::new("sh")
        .args(["-c", &script, env!("CARGO_BIN_EXE_rc")])
        .args(sweep("full", &["--threads", "2"]))
        .current_dir(place.folder())
        .output()
        .expect("a shell");
    let message = text(&output.stderr);
    assert_eq!(output.status.code(), Some(4), "{message}");
    let expected =
        message.starts_with("error: cannot write full/sweep.jsonl: ") && message.contains("rows before are kept");
    assert!(expected && message.lines().count() == 1, "{message}");
    let kept = place.bytes("full/sweep.jsonl");
    let rows = journal_lines(&place, "full") - 1;
    assert!(kept.ends_with(b"\n") && (1..ROWS).contains(&rows), "{rows} rows, {} bytes", kept.len());
    assert_solved(&place.run(&sweep("full", &["--threads", "2", "--resume"])));
    assert!(place.bytes("full/sweep.jsonl").starts_with(&kept), "finished rows were touched");
    assert_eq!(result(&place.path("full")), result(&place.path("whole")));
    assert_eq!(place.names("full"), ["sweep.csv", "sweep.jsonl"]);
}
