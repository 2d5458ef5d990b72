//! Our own solves, each in a process of its own.
//!
//! The peers start in new processes too, and only a new process gives the peak memory of one solve.

use std::env;
use std::path::{Path, PathBuf};
use std::process::Command;

use anyhow::{Context, Result, bail};
use rc_core::Grid;
use rc_heights::npy;
use serde::{Deserialize, Serialize};

use super::measure::{Outcome, measure};
use super::scenes::Scene;
use super::setting::Setting;

/// The job of a child process, which is the argument of `--job`.
#[derive(Debug, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
enum Job {
    /// Solves once and prints the outcome.
    Solve { scene: String, setting: Setting },
    /// Saves the heights on a grid, so that this process stays small.
    Heights { scene: String, side: usize, path: PathBuf },
}

/// Solves in a child process with `threads` threads.
///
/// # Errors
/// When the process fails. The text has what the process wrote.
pub(super) fn solve(scene: &Scene, setting: Setting, threads: usize) -> Result<Outcome> {
    let job = Job::Solve { scene: scene.name.to_owned(), setting };
    let answer = start(&job, threads)?;
    serde_json::from_str(&answer).with_context(|| format!("the process for {job:?} answered '{answer}'"))
}

/// Saves the heights of `scene` on a grid, as `.npy` with cell side 1.
///
/// A child process does it.
///
/// # Errors
/// When the process fails. The text has what the process wrote.
pub(super) fn save_heights(scene: &Scene, side: usize, path: &Path) -> Result<()> {
    start(&Job::Heights { scene: scene.name.to_owned(), side, path: path.to_path_buf() }, 1).map(drop)
}

fn start(job: &Job, threads: usize) -> Result<String> {
    let this = env::current_exe().context("the path of this program is unknown")?;
    let output = Command::new(this)
        .args(["bench", "--job", &serde_json::to_string(job)?])
        .env("RAYON_NUM_THREADS", threads.to_string())
        .output()
        .with_context(|| format!("could not start a process for {job:?}"))?;
    if !output.status.success() {
        bail!("{job:?}: {}", String::from_utf8_lossy(&output.stderr).trim());
    }
    String::from_utf8(output.stdout).with_context(|| format!("the answer to {job:?} is not text"))
}

/// Does `job` in the child process.
///
/// # Errors
/// When the job cannot be read, or fails.
#[expect(clippy::print_stdout, reason = "the answer")]
pub fn work(job: &str) -> Result<()> {
    match serde_json::from_str(job).context("--job is for processes that the benchmark starts itself")? {
        Job::Solve { scene, setting } => {
            println!("{}", serde_json::to_string(&measure(&Scene::named(&scene)?, &setting)?)?);
        }
        Job::Heights { scene, side, path } => {
            let heights = Scene::named(&scene)?.surface()?.sample_on(Grid::square(side)?)?;
            npy::write(&path, &heights, 1.0).with_context(|| format!("could not write {}", path.display()))?;
        }
    }
    Ok(())
}
