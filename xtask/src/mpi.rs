//! `cargo xtask mpi`: solves over the ranks of MPI, compared with `rc solve` digit by digit.
//!
//! One of the solves loses a rank and continues.

use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

use anyhow::{Context, Result, bail, ensure};
use rc_figures::repository;
use serde_json::{Map, Value};

use crate::process::{cargo, path_of, run as run_step, wait};

/// Builds rc-mpi, compares its results with those of `rc solve`, and kills a rank.
///
/// It solves over 1, 2 and 4 ranks, and kills one of three. Without MPI and clang it says so and succeeds (Debian:
/// libopenmpi-dev openmpi-bin clang libclang-dev).
#[derive(clap::Args)]
pub(crate) struct Args {}

/// Programs that are needed.
const PROGRAMS: [&str; 3] = ["mpirun", "mpicc", "clang"];

/// The scenes, one for each control, of about a second each.
const SCENES: [&str; 2] = ["--grid=1024 --pressure=446395", "--grid=1024 --penetration=14e-6"];

/// The scene that loses a rank. Its last level takes some seconds.
const LONG: &str = "--grid=4096 --pressure=446395";

/// Flags of every scene.
const COMMON: &str = "--waves=64 --method=adaptive --tolerance=1e-6 --quiet --threads=1 --elements";

/// Files that are compared byte by byte.
const FILES: [&str; 5] = ["pressure.npy", "gap.npy", "elements.csv", "contact.png", "scene.toml"];

/// Keys of the summary that depend on the run, not on the result.
const OF_THE_RUN: [&str; 3] = ["wall_seconds", "peak_memory_bytes", "threads"];

/// Settings of Open MPI 4 and 5 for many ranks and for containers.
///
/// They allow more ranks than cores, and root as the user. Other libraries ignore them.
const ENVIRONMENT: [(&str, &str); 4] = [
    ("OMPI_MCA_rmaps_base_oversubscribe", "1"),
    ("PRTE_MCA_rmaps_default_mapping_policy", ":oversubscribe"),
    ("OMPI_ALLOW_RUN_AS_ROOT", "1"),
    ("OMPI_ALLOW_RUN_AS_ROOT_CONFIRM", "1"),
];

#[expect(clippy::print_stderr, reason = "a task runner says what it runs")]
pub(crate) fn run(_args: &Args) -> Result<()> {
    if let Some(missing) = PROGRAMS.iter().find(|program| path_of(program).is_none()) {
        eprintln!(
            "mpi: skipped, there is no {missing} here (Debian: apt-get install libopenmpi-dev openmpi-bin clang libclang-dev)"
        );
        return Ok(());
    }
    run_step(&mut cargo(&["build", "--release", "--package", "rc-cli"]))?;
    // A common folder lets both builds share their crates.
    let build = ["build", "--release", "--manifest-path", "mpi/Cargo.toml", "--target-dir"];
    run_step(cargo(&build).arg(repository::target()))?;
    let folder = tempfile::tempdir()?;
    let programs = Programs { target: repository::target().join("release"), folder: folder.path().to_owned() };
    for scene in SCENES {
        programs.solve(scene, "alone")?;
        for ranks in [1, 2, 4] {
            let out = format!("ranks-{ranks}");
            ensure!(programs.mpirun(ranks, scene, &["--out", &out]).status()?.success(), "{ranks} ranks failed");
            programs.compare("alone", &out)?;
        }
        eprintln!("mpi: {scene}: 1, 2 and 4 ranks give the files of one process, byte by byte");
    }
    lose_a_rank(&programs)?;
    eprintln!("mpi: 3 ranks of which one was killed, then 2 ranks from the last level, give the files of one process");
    Ok(())
}

/// Kills one of three ranks when the finest level has begun, and continues with two.
fn lose_a_rank(programs: &Programs) -> Result<()> {
    let words = ["--out", "resumed", "--checkpoint", "levels"];
    programs.solve(LONG, "alone")?;
    let mut run = programs.mpirun(3, LONG, &words).stderr(Stdio::null()).spawn()?;
    let checkpoint = programs.folder.join("levels");
    let (mut kept, mut last) = (0, None);
    wait("third checkpoint", || {
        ensure!(run.try_wait()?.is_none(), "the run has ended before its checkpoint");
        let written = checkpoint.metadata().and_then(|file| file.modified()).ok();
        if written.is_some() && written != last {
            (kept, last) = (kept + 1, written);
        }
        // The base grid has 256 elements per side, so four levels are kept before the finest.
        Ok(kept == 3)
    })?;
    let pid = std::fs::read_to_string(programs.folder.join("pid-1"))?;
    let killed = Command::new("kill").args(["-KILL", pid.trim()]).status()?;
    ensure!(killed.success(), "rank 1 was faster than the kill");
    ensure!(!run.wait()?.success(), "a run that has lost a rank does not end well");
    ensure!(!programs.folder.join("resumed/summary.json").exists(), "a run that has lost a rank has no result");
    ensure!(programs.mpirun(2, LONG, &words).status()?.success(), "the run does not go on");
    ensure!(!checkpoint.exists(), "the checkpoint is removed when the result is there");
    programs.compare("alone", "resumed")
}

/// The programs, and the folder in which they work.
struct Programs {
    target: PathBuf,
    folder: PathBuf,
}

impl Programs {
    fn solve(&self, scene: &str, out: &str) -> Result<()> {
        let mut command = Command::new(self.target.join("rc"));
        command.args(words_of(scene)).args(["--out", out]).current_dir(&self.folder);
        ensure!(command.status()?.success(), "rc solve {scene} failed");
        Ok(())
    }

    /// A command that solves the scene over `ranks` ranks.
    ///
    /// Each rank writes its process id.
    fn mpirun(&self, ranks: usize, scene: &str, more: &[&str]) -> Command {
        let mut command = Command::new("mpirun");
        let note = "echo $$ > pid-${OMPI_COMM_WORLD_RANK:-${PMI_RANK:-0}}; exec \"$0\" \"$@\"";
        command.args(["-n", &ranks.to_string(), "sh", "-c", note]).arg(self.target.join("rc-mpi"));
        command.args(words_of(scene)).args(more).envs(ENVIRONMENT).current_dir(&self.folder);
        command
    }

    /// Fails unless two result folders agree.
    fn compare(&self, one: &str, other: &str) -> Result<()> {
        for name in FILES {
            let [a, b] = [one, other].map(|folder| self.folder.join(folder).join(name));
            if read(&a)? != read(&b)? {
                bail!("{name} of {other} is not that of {one}");
            }
        }
        let [a, b] = [one, other].map(|folder| self.summary(folder));
        ensure!(a? == b?, "the summary of {other} is not that of {one}");
        Ok(())
    }

    /// The summary of a result without the keys that depend on the run.
    fn summary(&self, folder: &str) -> Result<Map<String, Value>> {
        let text = read(&self.folder.join(folder).join("summary.json"))?;
        let mut summary: Map<String, Value> = serde_json::from_slice(&text)?;
        summary.retain(|key, _| !OF_THE_RUN.contains(&key.as_str()));
        Ok(summary)
    }
}

/// Arguments of `rc` for a scene.
fn words_of(scene: &str) -> impl Iterator<Item = &str> {
    ["solve"].into_iter().chain(COMMON.split(' ')).chain(scene.split(' '))
}

fn read(path: &Path) -> Result<Vec<u8>> {
    std::fs::read(path).with_context(|| format!("cannot read {}", path.display()))
}
