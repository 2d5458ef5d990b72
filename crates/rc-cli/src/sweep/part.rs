//! `--shard`: the part of a sweep that this process solves, and its folder.

use std::path::{Path, PathBuf};

use rc_solver::Plan;
use rc_sweep::memory::Budget;
use rc_sweep::{JobError, Shard, SweepPlan, SweepRow};

use super::specs::ShardSpec;
use super::surfaces::Surfaces;
use crate::error::CliError;
use crate::scene::surface::LoadedSurface;
use crate::solve::solved::ProblemSetup;

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
    let mut latest: Option<Estimated> = None;
    plan.dealt_by(|row| {
        if latest.as_ref().is_none_or(|latest| latest.surface != row.surface) {
            latest = Estimated::load(surfaces, row);
        }
        latest.as_mut()?.seconds(surfaces, row)
    })
}

/// A surface whose loads are estimated.
struct Estimated {
    surface: usize,
    loaded: LoadedSurface,
    first: Option<Plan<'static>>,
}

impl Estimated {
    fn load(surfaces: &Surfaces, row: &SweepRow) -> Option<Self> {
        let loaded = surfaces.surface(row).load().ok()?;
        Some(Self { surface: row.surface, loaded, first: None })
    }

    /// Processor seconds of `row`.
    ///
    /// `None` if they are not known, or if the row will be refused.
    fn seconds(&mut self, surfaces: &Surfaces, row: &SweepRow) -> Option<f64> {
        let contact = surfaces.contact(row).ok()?;
        let kernel = contact.kernel().ok()?;
        // All machines must get the same estimate, whatever memory they have.
        let problem =
            ProblemSetup { surface: &self.loaded, contact: &contact, kernel: &*kernel, budget: Budget::UNLIMITED };
        let plan = match &self.first {
            Some(first) => problem.plan_like(first).ok()?,
            None => problem.first_plan().ok()?,
        };
        let seconds = problem.cost(&plan).cpu_seconds;
        self.first.get_or_insert(plan);
        seconds
    }
}
