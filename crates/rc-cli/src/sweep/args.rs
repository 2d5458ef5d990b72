//! Arguments of `rc sweep`.

use std::path::PathBuf;

use clap::{Args, Subcommand};
use rc_sweep::{Loads, Seeds, Shard};

use crate::scene::keys::Scene;

/// Arguments of `rc sweep`.
#[derive(Args, Clone, Debug)]
#[command(after_help = SWEEP_HELP, args_conflicts_with_subcommands = true)]
pub(crate) struct SweepArgs {
    /// What else there is to do with sweeps.
    #[command(subcommand)]
    pub(crate) command: Option<SweepCommand>,
    /// Scene files; every seed and load is solved for each
    #[arg(value_name = "SCENE.toml")]
    pub(crate) scene_files: Vec<PathBuf>,
    /// Mean pressures (Pa): first:last:count, geometric; first:last:count:linear; or values with commas between them
    #[arg(long, value_name = "LIST", help_heading = "Sweep", allow_hyphen_values = true)]
    pub(crate) pressures: Option<Loads>,
    /// Penetrations (m), in the same way, instead of --pressures
    #[arg(long, value_name = "LIST", help_heading = "Sweep", allow_hyphen_values = true)]
    pub(crate) penetrations: Option<Loads>,
    /// Seeds: 1..7 (both included), or a list with commas
    #[arg(long, value_name = "LIST", help_heading = "Sweep", allow_hyphen_values = true)]
    pub(crate) seeds: Option<Seeds>,
    /// Keep a result folder for each row, rows/0001 and so on
    #[arg(long, help_heading = "Sweep")]
    pub(crate) fields: bool,
    /// Go on with the sweep in --out; start it, if there is none yet
    #[arg(long, help_heading = "Sweep")]
    pub(crate) resume: bool,
    /// Solve part i of n, for job arrays; `rc sweep merge` puts the parts together
    #[arg(long, value_name = "I/N", help_heading = "Sweep", allow_hyphen_values = true)]
    pub(crate) shard: Option<Shard>,
    /// What is given here overrides the scene files.
    #[command(flatten)]
    pub(crate) scene: Scene,
}

/// Commands of `rc sweep`.
#[derive(Subcommand, Clone, Debug)]
pub(crate) enum SweepCommand {
    /// Put the shards of a sweep together
    Merge(MergeArgs),
}

/// Arguments of `rc sweep merge`.
#[derive(Args, Clone, Debug)]
pub(crate) struct MergeArgs {
    /// Folders of all shards of one sweep
    #[arg(value_name = "DIR", required = true)]
    pub(crate) folders: Vec<PathBuf>,
    /// Folder for the whole sweep
    #[arg(long, value_name = "DIR")]
    pub(crate) out: PathBuf,
    /// Print nothing but errors
    #[arg(long)]
    pub(crate) quiet: bool,
}

const SWEEP_HELP: &str = "\
DIR (--out) receives sweep.csv: a line for each solve, by scene, seed, load; its columns are scene (of more than one), seed, \
control_value (Pa or m), and the keys of the summary of rc solve. In it, threads are those of the whole sweep, and \
peak_memory_bytes that of its process. Finished rows are kept in sweep.jsonl at once: whatever ends the sweep, --resume \
goes on after them.

--threads is the number of all threads. As many rows as fit into memory (--memory-limit, or half of the machine's) are \
solved side by side; no result depends on it.

Without lists, a scene is solved for its own load and seed. Rows that did not converge are marked, and make exit code 3 at \
the end; a row whose input is refused ends the sweep.";
