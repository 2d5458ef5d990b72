//! Shards of a sweep in job arrays, as lists of commands, and from old journals.

use std::process::{Command, Output};

use crate::support::{Place, assert_refused, assert_solved, text};
use crate::sweep::{TINY, result, sweep, table};

/// Prefixes of variables that a job system around the tests may have set.
const OF_JOBS: [&str; 5] = ["SLURM_", "PBS_", "OMPI_", "PMI_", "PMIX_"];

/// Runs `rc` as a job system starts it, with the variables in `environment`.
fn run_as(place: &Place, environment: &[(&str, &str)], args: &[&str]) -> Output {
    let mut command = Command::new(env!("CARGO_BIN_EXE_rc"));
    for (name, _) in std::env::vars_os() {
        if OF_JOBS.iter().any(|begin| name.to_string_lossy().starts_with(begin)) {
            command.env_remove(name);
        }
    }
    command.args(args).envs(environment.iter().copied()).current_dir(place.folder()).output().expect("rc runs")
}

#[test]
fn tasks_of_a_job_array_solve_the_sweep_each_in_its_folder() {
    let place = Place::new();
    assert_solved(&place.run(&sweep("whole", &["--threads", "1"])));
    let auto = sweep("parts", &["--threads", "1", "--shard", "auto", "--resume"]);
    for id in ["0", "2", "4"] {
        let task = [
            ("SLURM_ARRAY_TASK_ID", id),
            ("SLURM_ARRAY_TASK_MIN", "0"),
            ("SLURM_ARRAY_TASK_MAX", "4"),
            ("SLURM_ARRAY_TASK_COUNT", "3"),
            ("SLURM_ARRAY_TASK_STEP", "2"),
        ];
        assert_solved(&run_as(&place, &task, &auto));
        // A repeated run continues, or has nothing left to do.
        assert_solved(&run_as(&place, &task, &auto));
    }
    assert_eq!(place.names("parts"), ["part-1-of-3", "part-2-of-3", "part-3-of-3"]);
    let parts = ["parts/part-1-of-3", "parts/part-2-of-3", "parts/part-3-of-3"];
    assert_solved(&place.run(&[&["sweep", "merge"], &parts[..], &["--out", "merged"]].concat()));
    assert_eq!(result(&place.path("merged")), result(&place.path("whole")));
}

#[test]
fn a_process_that_nobody_numbers_is_refused_with_what_was_found() {
    let place = Place::new();
    let auto = |count: &'static str| sweep("s", &["--shard", count]);
    assert_refused(
        &run_as(&place, &[], &auto("auto")),
        "shard: found neither a job array nor an MPI launcher: none of SLURM_ARRAY_TASK_ID",
    );
    let pbs = [("PBS_ARRAY_INDEX", "2")];
    let expected = "shard: PBS_ARRAY_INDEX=2 does not say how many tasks there are; give --shard auto/N, with tasks numbered from 1 to N";
    assert_refused(&run_as(&place, &pbs, &auto("auto")), expected);
    let both = [("PMI_RANK", "1"), ("PMI_SIZE", "4"), ("OMPI_COMM_WORLD_RANK", "2"), ("OMPI_COMM_WORLD_SIZE", "4")];
    assert_refused(&run_as(&place, &both, &auto("auto")), "contradicts PMI_RANK=1, PMI_SIZE=4; give --shard i/n");
    assert!(place.names(".").is_empty(), "left behind: {:?}", place.names("."));
    assert_solved(&run_as(&place, &pbs, &auto("auto/3")));
    assert_eq!(place.names("s"), ["part-2-of-3"]);
}

#[test]
fn the_listed_commands_solve_the_sweep() {
    let place = Place::new();
    assert_solved(&place.run(&sweep("whole", &[])));
    let listed = place.run(&sweep("parts", &["--list=5", "--resume"]));
    assert_solved(&listed);
    let listed = text(&listed.stdout);
    assert_eq!(listed.lines().count(), 5, "{listed}");
    for line in listed.lines() {
        let status = Command::new("sh").args(["-c", line]).current_dir(place.folder()).status().expect("a shell");
        assert!(status.success(), "{line}");
    }
    let parts: Vec<String> = place.names("parts").iter().map(|name| format!("parts/{name}")).collect();
    let parts: Vec<&str> = parts.iter().map(String::as_str).collect();
    assert_solved(&place.run(&[&["sweep", "merge"], &parts[..], &["--out", "merged"]].concat()));
    assert_eq!(result(&place.path("merged")), result(&place.path("whole")));
    let rows = text(&place.run(&sweep("parts", &["--list"])).stdout);
    assert_eq!(rows.lines().count(), 12, "not a command for each row: {rows}");
    assert_refused(&place.run(&sweep("parts", &["--list=13"])), "at most 12 shards");
    assert_refused(&place.run(&sweep("parts", &["--list=2", "--shard", "1/2"])), "--shard");
}

/// Shards from old journals are resumed and merged as their rows were dealt.
///
/// Old journals do not have costs, and their rows were dealt load by load.
#[test]
fn shards_of_before_are_resumed_and_merged_as_they_were_dealt() {
    let place = Place::new();
    let run = |out: &str, more: &[&str]| {
        place.run(&[&TINY[..], &["--pressures", "1e5,2e5,8e5", "--threads", "1", "--out", out], more].concat())
    };
    assert_solved(&run("whole", &[]));
    let journal = text(&place.bytes("whole/sweep.jsonl"));
    let lines: Vec<&str> = journal.lines().collect();
    for (shard, rows) in [("1/2", &[1, 3][..]), ("2/2", &[2])] {
        let folder = format!("old-{}", &shard[..1]);
        std::fs::create_dir(place.path(&folder)).expect("a folder");
        let header = lines[0].replace("\"1/1\"", &format!("\"{shard}\""));
        let lines = rows.iter().map(|&row| lines[row]);
        let old = std::iter::once(header.as_str()).chain(lines).collect::<Vec<_>>().join("\n") + "\n";
        place.write(&format!("{folder}/sweep.jsonl"), &old);
        assert_solved(&run(&folder, &["--shard", shard, "--resume"]));
        assert_eq!(text(&place.bytes(&format!("{folder}/sweep.jsonl"))), old, "a complete shard was changed");
        assert_eq!(table(&place.path(&folder)).len(), 1 + rows.len());
    }
    // The row of the largest load takes longer than the two others together.
    assert_solved(&run("new-2", &["--shard", "2/2"]));
    let merge = |folders: [&str; 2]| place.run(&[&["sweep", "merge"], &folders[..], &["--out", "merged"]].concat());
    let expected = "new-2: its rows were distributed to shards in another way than those of old-1; solve all shards with one version of rc";
    assert_refused(&merge(["old-1", "new-2"]), expected);
    assert_solved(&merge(["old-1", "old-2"]));
    assert_eq!(result(&place.path("merged")), result(&place.path("whole")));
}
