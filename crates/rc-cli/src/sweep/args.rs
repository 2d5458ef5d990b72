//! Arguments of `rc sweep`.

use std::path::PathBuf;

use clap::{Args, Subcommand};
use rc_sweep::{Loads, Seeds, WantedMean};

use super::specs::{ListSpec, QUANTITIES, ShardSpec};
use super::varied::Variation;
use crate::error::CliError;
use crate::help::without_shear;
use crate::scene::keys::Scene;
use crate::scene::quantity::{penetrations, pressures, times};
use crate::scene::values::Fraction;

/// Arguments of `rc sweep`.
#[derive(Args, Clone, Debug)]
#[command(after_help = SWEEP_HELP, after_long_help = SWEEP_MANUAL, args_conflicts_with_subcommands = true)]
#[command(mut_arg("out", |out| out.help("Folder for the rows and the table; must be given")))]
#[command(mut_arg("area_error", |refused| refused.hide(true)))]
#[command(mut_arg("history", |refused| refused.hide(true)))]
#[command(mut_arg("history_steps", |refused| refused.hide(true)))]
#[command(mut_arg("fluid_pressure", |refused| refused.hide(true)))]
#[command(mut_args(without_shear))]
#[command(mut_arg("speed", |one| one.hide_short_help(true)))]
pub(crate) struct SweepArgs {
    /// What else there is to do with sweeps.
    #[command(subcommand)]
    pub(crate) command: Option<SweepCommand>,
    /// Scene files; each is solved for all seeds and loads
    #[arg(value_name = "SCENE.toml")]
    pub(crate) scene_files: Vec<PathBuf>,
    /// Mean pressures (Pa): 1e4:1e6:8 (geometric), 1e4:1e6:8:linear, 1e4,1e5
    ///
    /// first:last:count is geometric, first:last:count:linear is linear; or values with commas between them. Numbers
    /// may have units, such as 10kPa:1MPa:8.
    #[arg(long, value_name = "LIST", help_heading = "Sweep", value_parser = pressures, allow_hyphen_values = true)]
    pub(crate) pressures: Option<Loads>,
    /// Penetrations (m), in the same forms, instead of --pressures
    #[arg(long, value_name = "LIST", help_heading = "Sweep", value_parser = penetrations, allow_hyphen_values = true)]
    pub(crate) penetrations: Option<Loads>,
    /// Seeds: 1..7 (both included), or a list with commas
    #[arg(long, value_name = "LIST", help_heading = "Sweep", allow_hyphen_values = true)]
    pub(crate) seeds: Option<Seeds>,
    /// Values of another key, such as hardness=5MPa,10MPa; may be repeated
    ///
    /// Each row has a column with the name of the key. Several keys give all combinations. Numbers without units may be
    /// a range, such as layer-thickness=1e-5:1e-3:8.
    #[arg(long, value_name = "KEY=LIST", help_heading = "Sweep")]
    pub(crate) vary: Vec<Variation>,
    /// Speeds (m/s) of a surface that slides, in the same forms: 1e-6:1e1:20
    ///
    /// Short for --vary speed=LIST. A list with commas may begin with 0, the contact at rest.
    #[arg(long, value_name = "LIST", help_heading = "Sweep", value_parser = Variation::speeds, allow_hyphen_values = true)]
    pub(crate) speeds: Option<Variation>,
    /// Times (s) of creep under a constant load, in the same forms: 1e-3:1e3:7
    ///
    /// The solid is that of --prony, or --glassy-ratio and --relaxation-time, and nothing slides. Contact area, gap,
    /// penetration and leakage are those of the elastic contact under the load control_value.
    #[arg(long, value_name = "LIST", help_heading = "Sweep", value_parser = times, allow_hyphen_values = true)]
    pub(crate) times: Option<Loads>,
    /// Keep a result folder for each row: rows/0001 and so on
    #[arg(long, help_heading = "Sweep")]
    pub(crate) fields: bool,
    /// Continue the sweep in --out, or start it
    ///
    /// More loads, seeds and variations may be added: rows that exist are kept.
    #[arg(long, help_heading = "Sweep")]
    pub(crate) resume: bool,
    /// Solve part i of n; auto: the part of this task of a job array
    ///
    /// rc sweep merge puts the parts together. auto takes i and n from the job array (Slurm, PBS) or from MPI, and
    /// writes to a folder of its own in --out. auto/N is for environments that do not say how many tasks there are.
    #[arg(long, value_name = "I/N", help_heading = "Sweep", allow_hyphen_values = true)]
    pub(crate) shard: Option<ShardSpec>,
    /// Print the commands of N parts, one a line, and solve nothing
    ///
    /// The lines are for HyperQueue or GNU parallel. Without N there is a part for each row.
    #[arg(long, value_name = "N", help_heading = "Sweep", num_args = 0..=1, default_missing_value = ListSpec::ROWS, require_equals = true, conflicts_with = "shard")]
    pub(crate) list: Option<ListSpec>,
    /// Wanted relative rms error of the mean over surfaces, such as 0.5%
    ///
    /// Chooses how many realisations are solved on which grids. --seed is the first, --grid the finest.
    #[arg(long, value_name = "ERROR", help_heading = "Sweep", allow_hyphen_values = true)]
    pub(crate) error_of_mean: Option<Fraction>,
    /// Key of the summary for --error-of-mean [default: area_fraction]
    #[arg(long, value_name = "KEY", help_heading = "Sweep", value_parser = QUANTITIES, hide_possible_values = true)]
    pub(crate) mean_of: Option<String>,
    /// What is given here overrides the scene files.
    #[command(flatten)]
    pub(crate) scene: Scene,
}

impl SweepArgs {
    /// The mean of `--error-of-mean`, if it is given.
    ///
    /// # Errors
    /// [`CliError::Input`] for a quantity without an error.
    pub(super) fn wanted_mean(&self) -> Result<Option<WantedMean>, CliError> {
        match (self.error_of_mean, &self.mean_of) {
            (Some(Fraction(error)), quantity) => {
                let quantity = quantity.clone().unwrap_or_else(|| QUANTITIES[0].to_owned());
                Ok(Some(WantedMean { quantity, error }))
            }
            (None, None) => Ok(None),
            (None, Some(_)) => {
                Err(CliError::input("mean_of: the error is missing; give --error-of-mean, for example 0.5%"))
            }
        }
    }
}

/// Commands of `rc sweep`.
#[derive(Subcommand, Clone, Debug)]
pub(crate) enum SweepCommand {
    /// Put the parts of a sweep (--shard) together
    Merge(MergeArgs),
}

/// Arguments of `rc sweep merge`.
#[derive(Args, Clone, Debug)]
pub(crate) struct MergeArgs {
    /// Folders of all parts of one sweep
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
DIR receives sweep.csv, a line for each solve. Without lists, a scene has its own load and seed.
Manual pages with longer texts: rc man --out man";

const SWEEP_MANUAL: &str = "\
DIR (--out) receives sweep.csv: a line for each solve, by scene, seed, load. Its columns are scene (where there are several), seed, \
control_value (Pa or m), and the keys of the summary of rc solve. --leakage adds permeance_x, permeance_y and \
permeance_error_x, permeance_error_y (m³), and percolates (along x, along y), and makes sealing.json: the pressure at which the film closes. threads is the number of threads of the whole sweep, and peak_memory_bytes the peak memory of its process. Finished rows are kept \
in sweep.jsonl at once: whatever ends the sweep, --resume continues after them.

--threads is the number of all threads. As many rows as fit into memory (--memory-limit, or half of the machine's) are \
solved side by side. No result depends on it.

Parts of a sweep are of about equal work, by the estimate of rc solve --dry-run. In a job array, rc sweep ... --shard auto \
--resume --out DIR is the command of every task. A task that is run again continues after its finished rows. Each task has a \
folder DIR/part-i-of-n, and rc sweep merge DIR/part-* --out ALL makes the sweep of them.

--error-of-mean chooses realisations and grids by multilevel Monte Carlo: many realisations on a coarse grid, and \
only a few for the difference from each grid to the next finer one. DIR receives mean.json: mean, standard error and error of the grid for each load, and grids, \
realisations, variance and cost of each level. sweep.csv has the solves. Only results decide what is solved next, so the sweep \
can be interrupted, and resumed also with a smaller error.

Without lists, a scene is solved for its own load and seed. Rows that did not converge are marked, and the exit code is 3 at \
the end. A row whose load is refused is left out. The others are solved, and the exit code is 2 at the end.";
