//! `rc-mpi solve`: one contact problem over ranks.
//!
//! All ranks run this together.

use std::ffi::OsString;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use clap::{Args, Parser, Subcommand};
use rc_comm::Ranks;
use rc_solver::Feature;

use super::args::SolveArgs;
use super::job::Job;
use super::scene_of;
use crate::error::CliError;
use crate::files::checkpoint::CheckpointFile;
use crate::help;
use crate::run::stop;
use crate::run::together::together;
use crate::scene::keys::Scene;
use crate::scene::resolve::Place;
use crate::scene::{features, file};
use crate::terminal;

/// One contact problem over the ranks of MPI: mpirun -n 4 rc-mpi solve ...
///
/// Flags and files are those of rc solve, and the digits do not depend on the number of ranks. Each rank has a part of
/// the mesh; all of them have the base grid. Exit codes: 0 solved, 2 bad input, 3 not converged, 4 could not write.
#[derive(Parser, Clone, Debug)]
#[command(name = "rc-mpi", version, max_term_width = 120, disable_help_subcommand = true)]
#[command(disable_help_flag = true, arg = help::help_flag())]
struct Cli {
    #[command(subcommand)]
    command: Command,
}

#[derive(Subcommand, Clone, Debug)]
enum Command {
    /// Solve one contact problem
    Solve(Box<RanksArgs>),
}

#[derive(Args, Clone, Debug)]
struct RanksArgs {
    #[command(flatten)]
    solve: SolveArgs,
    /// File from which a run that was ended continues, on any number of ranks
    ///
    /// It keeps what the last level has left for the next one. The digits are the same. It is removed when the result
    /// is there.
    #[arg(long, value_name = "FILE", help_heading = help::MACHINE)]
    checkpoint: Option<PathBuf>,
    /// All ranks write pressure and gap as the Zarr group DIR/fields.zarr
    ///
    /// It replaces pressure.npy, gap.npy, elements.csv and contact.png, which one rank writes.
    #[arg(long, help_heading = help::RESULTS)]
    zarr: bool,
}

/// Runs a command line of `rc-mpi` and returns the exit code.
///
/// The first argument is the name of the program. All ranks call this together. The first rank prints and writes.
#[must_use]
pub fn main_over_ranks(words: impl IntoIterator<Item = OsString>, ranks: &Ranks) -> u8 {
    let is_first = ranks.rank() == 0;
    let result = match Cli::try_parse_from(words) {
        Ok(Cli { command: Command::Solve(args) }) => run(*args, ranks),
        Err(error) if !error.use_stderr() => {
            if is_first {
                // If the output is closed, there is no place to report it.
                let _ = error.print();
            }
            return 0;
        }
        Err(error) => Err(CliError::from(&error)),
    };
    let Err(error) = result else { return 0 };
    if is_first {
        terminal::tell(&format!("error: {error}"));
    }
    error.exit_code()
}

fn run(args: RanksArgs, ranks: &Ranks) -> Result<(), CliError> {
    let RanksArgs { solve, checkpoint, zarr } = args;
    let dry_run = solve.dry_run;
    let job = together(ranks, prepare(solve, (checkpoint.as_deref(), zarr), ranks))?;
    stop::listen();
    if dry_run {
        return if ranks.rank() == 0 { job.dry_run() } else { Ok(()) };
    }
    job.execute()?;
    if let (Some(file), 0) = (&job.scene.contact.place.checkpoint, ranks.rank()) {
        if let Some(failure) = file.failure() {
            terminal::tell(&format!("checkpoint: {failure}; the result does not need it"));
        }
        file.remove();
    }
    Ok(())
}

/// The job of the checked scene, with its ranks and its checkpoint file.
fn prepare(args: SolveArgs, (checkpoint, zarr): (Option<&Path>, bool), ranks: &Ranks) -> Result<Job, CliError> {
    let (dry_run, watch) = (args.dry_run, args.watch);
    let scene = scene_of(args)?;
    let text = scene_text(&scene);
    let features = [
        (Feature::Ranks, ranks.size() > 1),
        (Feature::Checkpoint, checkpoint.is_some()),
        (Feature::Watch, watch),
        (Feature::DryRun, dry_run),
    ];
    features::check(
        &scene.contact,
        features.into_iter().filter_map(|(feature, is_there)| is_there.then_some(feature)),
    )?;
    let mut job = Job::new(scene, watch)?;
    if zarr {
        job = job.with_zarr()?;
    }
    if dry_run {
        return Ok(job);
    }
    let checkpoint = match checkpoint {
        Some(path) => Some(Arc::new(CheckpointFile::new(path, &text)?)),
        None => None,
    };
    job.scene.contact.place = Place { ranks: ranks.clone(), checkpoint };
    Ok(job)
}

/// The keys that determine the solution, with size and time of the files they name.
fn scene_text(scene: &Scene) -> String {
    let Scene { surface, contact, .. } = scene;
    let files = surface.files().map(|(_, path)| path).chain(surface.add.as_deref());
    let files = files.map(|path| format!("{:?}", path.metadata().ok().map(|data| (data.len(), data.modified().ok()))));
    [file::to_toml(surface), file::to_toml(contact)].into_iter().chain(files).collect::<Vec<_>>().join("\n")
}
