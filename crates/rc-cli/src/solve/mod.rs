//! `rc solve`: one contact problem, from scene to files.

pub(crate) mod args;
pub(crate) mod solved;

mod checked;
mod dry_run;
mod failure;
mod flow_files;
mod fluid;
mod job;
pub(crate) mod leakage;
mod map_file;
mod messages;
mod over_ranks;
mod path;
mod result_files;
mod shared_fields;
pub(crate) mod shear;
mod sliding_note;

pub use checked::CheckedScene;
pub use failure::Failure;
pub use fluid::SolvedFluid;
pub use leakage::SolvedFlow;
pub(crate) use leakage::memory_factor;
pub use over_ranks::main_over_ranks;
pub use result_files::{MapHeights, ResultFiles};
pub use shear::SolvedShear;
pub use solved::{ProblemSetup, Solved, SolvedParts};

use std::path::PathBuf;

use rc_solver::Feature;

use self::args::SolveArgs;
use self::job::Job;
use crate::error::CliError;
use crate::run::stop;
use crate::scene::keys::{RunKeys, Scene};
use crate::scene::{features, file, resolve, written};
use crate::terminal;

/// Folder of the results of a run without arguments.
const EXAMPLE_FOLDER: &str = "rc-result";

/// Runs `rc solve`.
///
/// # Errors
/// [`CliError`] of every kind.
pub(crate) fn run(args: SolveArgs) -> Result<(), CliError> {
    let (dry_run, watch) = (args.dry_run, args.watch);
    let scene = scene_of(args)?;
    let shown = [watch.then_some(Feature::Watch), dry_run.then_some(Feature::DryRun)];
    features::check(&scene.contact, shown.into_iter().flatten())?;
    if watch && scene.run.out.is_none() {
        return Err(CliError::input("watch: the picture is written to the folder of the results; give --out DIR"));
    }
    let job = Job::new(scene, watch)?;
    stop::listen();
    if dry_run {
        return job.dry_run();
    }
    job.execute()
}

/// The scene of the command line.
///
/// Without arguments it is the embedded example, with its own folder.
fn scene_of(args: SolveArgs) -> Result<Scene, CliError> {
    if args.scene_file.is_some() || !args.scene.is_empty() {
        let flags = args.scene.contact.clone();
        let scene = resolve::layers(args.scene_file.as_deref(), args.scene)?;
        let is_lost = scene.run.out.is_none() && !args.dry_run;
        let without = "applies to the files of the results; give --out DIR";
        written::check(&flags, &scene, is_lost.then_some(without))?;
        return Ok(scene);
    }
    if args.dry_run {
        return Ok(file::example());
    }
    terminal::tell(&format!(
        "No scene given: solving the embedded example (the paper's surface, N = 64, σ0/E* = 8.9e-4), writing to \
         {EXAMPLE_FOLDER}/"
    ));
    let run = RunKeys { out: Some(PathBuf::from(EXAMPLE_FOLDER)), ..RunKeys::default() };
    Ok(Scene { run, ..file::example() })
}
