//! `--shard`: the part of a sweep that this process solves, and its folder.

use std::path::{Path, PathBuf};

use rc_sweep::memory::Budget;
use rc_sweep::{JobError, Shard, SweepPlan};

use super::problems::SceneProblems;
use super::specs::ShardSpec;
use super::surfaces::Surfaces;
use crate::error::CliError;

/// The folder of `shard` below `out`.
pub(super) fn folder_of(out: &Path, Shard { index, count }: Shard) -> PathBuf {
    out.join(format!("part-{index}-of-{count}"))
}

/// The part that `spec` selects, and its folder.
///
/// The folder is `out`, or a folder of its own in `out`.
///
/// # Errors
/// [`CliError::Input`] when no job system tells the part of this process.
pub(super) fn resolve(spec: Option<ShardSpec>, out: &Path) -> Result<(Shard, PathBuf), CliError> {
    match spec {
        None => Ok((Shard::WHOLE, out.to_owned())),
        Some(ShardSpec::Given(shard)) => Ok((shard, out.to_owned())),
        Some(ShardSpec::Auto(count)) => {
            let variable = |name: &str| std::env::var(name).ok();
            let shard = Shard::of_job(count, &variable).map_err(|error| refuse(&error))?;
            Ok((shard, folder_of(out, shard)))
        }
    }
}

fn refuse(error: &JobError) -> CliError {
    let remedy = match error {
        JobError::NoCount { .. } | JobError::Uneven { .. } => "give --shard auto/N, with tasks numbered from 1 to N",
        JobError::Outside { .. } => "number the tasks in this range, or give --shard i/n",
        JobError::NotStarted { .. } => "start it by srun, or give --shard i/n",
        _ => "give --shard i/n",
    };
    CliError::input(format_args!("shard: {error}; {remedy}"))
}

/// `plan` with its rows dealt to `shard` and all others.
///
/// The cost of rows is the estimate of `rc solve --dry-run`.
pub(super) fn deal(plan: SweepPlan, shard: Shard, surfaces: &Surfaces) -> SweepPlan {
    if shard.count == 1 {
        return plan;
    }
    // All machines must get the same estimate, whatever memory they have.
    plan.dealt_by_estimate(&SceneProblems::new(surfaces, Budget::UNLIMITED))
}
