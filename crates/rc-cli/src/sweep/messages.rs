//! Errors of sweeps in the words of the command line.

use std::path::Path;

use rc_core::quantity::{count, digits};
use rc_sweep::{EnsembleMean, RunError, SweepError, SweepRows, TABLE_FILE};

use crate::error::CliError;
use crate::scene::time_limit::TimeLimit;

impl From<SweepError> for CliError {
    fn from(error: SweepError) -> Self {
        match error {
            SweepError::File(error) => error.into(),
            SweepError::Append { path, cause, kept } => Self::write(&path, not_kept(&cause, kept)),
            other => refused(&other),
        }
    }
}

/// Why a row could not be stored, and that the earlier rows are stored.
fn not_kept(cause: &str, kept: usize) -> String {
    match kept {
        0 => cause.to_owned(),
        1 => format!("{cause}; the row before is kept, and --resume continues after it"),
        _ => format!("{cause}; the {kept} rows before are kept, and --resume continues after them"),
    }
}

/// Bad input: the error itself, and what would be right.
fn refused(error: &SweepError) -> CliError {
    let remedy = match error {
        SweepError::AnotherProcess { .. } => "; wait for it, or give another --out",
        SweepError::HoldsSweep { .. } => "; continue it with --resume, or give another --out",
        SweepError::NothingToResume { .. } => "; give the folder of a sweep",
        SweepError::InTheWay { .. } | SweepError::OtherShard { .. } => "; give another --out",
        SweepError::OtherSettings { .. } => "; repeat its settings, or give another --out",
        SweepError::DamagedLine { .. } => "; remove the line, and --resume solves its row again",
        SweepError::DamagedShape { .. } => "; start the sweep again with another --out",
        SweepError::NoNumber { .. } => "; choose another --mean-of",
        SweepError::NoShards => "; give those of all shards",
        SweepError::MissingRows { .. } => "; finish it with --resume",
        SweepError::SameShard { .. } => "; give each shard once",
        SweepError::NotSameSweep { .. } => "; give the shards of one sweep",
        SweepError::OtherDivision { .. } => "; give shards i/n with the same n",
        SweepError::OtherDeal { .. } => "; solve all shards with one version of rc",
        SweepError::MissingShard { .. } => "; give the folders of all shards",
        SweepError::MissingFields { .. } => "; --resume in the folder of the shard makes them again",
        SweepError::EmptyShard { shard, rows } => {
            let (has, most) = (count(*rows, "row"), count(*rows, "shard"));
            return CliError::input(format_args!(
                "shard: {shard} is empty, because the sweep has only {has}; use at most {most}"
            ));
        }
        SweepError::Threads { cause, .. } => return CliError::input(format_args!("threads: {cause}")),
        _ => "",
    };
    CliError::input(format_args!("{error}{remedy}"))
}

/// The error of a sweep that ended before its last row.
pub(super) fn of_run(error: RunError<CliError>) -> CliError {
    match error {
        RunError::Refused { error: CliError::Input(message), missing, kept } if kept > 0 => {
            CliError::input(format_args!(
                "{message}; {} could not be solved, and {TABLE_FILE} has the other {kept}",
                count(missing, "row")
            ))
        }
        RunError::Refused { error, .. } | RunError::Failed(error) => error,
        RunError::Sweep(error) => error.into(),
        _ => CliError::input("the sweep ended for an unknown reason; --resume continues"),
    }
}

/// The error for a time limit that was too short for all rows.
pub(super) fn out_of_time(limit: TimeLimit, missing: usize, n_rows: usize) -> CliError {
    CliError::NotConverged(format!(
        "time_limit: {limit} was too short for {missing} of {}; --resume continues",
        count(n_rows, "row")
    ))
}

/// The error for a time limit that was too short for a mean.
pub(super) fn mean_out_of_time(limit: Option<TimeLimit>, kept: usize) -> CliError {
    let after = limit.map_or_else(String::new, |limit| format!(" after {limit}"));
    CliError::NotConverged(format!(
        "time_limit: the mean is not reached yet{after}, with {} so far; --resume continues",
        count(kept, "solve")
    ))
}

/// Fails when a mean does not have the wanted error.
pub(super) fn check_means(means: &[EnsembleMean]) -> Result<(), CliError> {
    let Some(mean) = means.iter().find(|mean| mean.status != "converged") else { return Ok(()) };
    let percent = |value: f64| format!("{} %", digits(100.0 * value, 2));
    let reached = format!("error_of_mean: {} at {} {:e}", mean.mean_of, mean.control, mean.control_value);
    Err(CliError::NotConverged(match (mean.not_converged, mean.levels.last()) {
        (0, Some(finest)) if mean.grid_error.is_some_and(|error| error > mean.standard_error) => format!(
            "{reached} has an error of {} on grid {}, but {} was wanted; give a finer --grid",
            percent(mean.relative_error),
            finest.grid,
            percent(mean.wanted_error)
        ),
        (0, _) => format!(
            "{reached} has an error of {} with the maximum number of realisations, but {} was wanted; give a larger --error-of-mean",
            percent(mean.relative_error),
            percent(mean.wanted_error)
        ),
        (n, _) => format!("{reached}: {} did not converge, marked not_converged in {TABLE_FILE}", count(n, "solve")),
    }))
}

/// Fails when a row did not converge.
pub(super) fn check_converged(rows: &SweepRows, table: &Path) -> Result<(), CliError> {
    match rc_sweep::n_not_converged(rows) {
        0 => Ok(()),
        n => Err(CliError::NotConverged(format!(
            "{n} of {} did not converge, marked not_converged in {}",
            count(rows.len(), "row"),
            table.display()
        ))),
    }
}
