//! `rc sweep`: many loads on many surfaces, stored row by row.

pub(crate) mod args;
mod bar;
mod creep;
mod doubts;
pub(crate) mod interrupt;
mod list;
mod map_mark;
mod mean;
mod means;
mod merge;
mod messages;
mod part;
mod planned;
pub(crate) mod problems;
mod realisations;
mod results;
mod rows;
pub(crate) mod sealing;
pub(crate) mod solved;
mod specs;
mod surfaces;
mod varied;

pub use creep::{crept, times};
pub use map_mark::MapMark;
pub(crate) use mean::MEAN_FILE;
pub use planned::{PlannedRows, SweepLists, plan};
pub use varied::Variation;

use std::path::Path;
use std::sync::Arc;
use std::time::Instant;

use rc_core::quantity::{count, digits};
use rc_sweep::{Shard, Sweep, to_json};

use self::args::{SweepArgs, SweepCommand};
use self::solved::HowRows;
use self::surfaces::Surfaces;
use crate::error::CliError;
use crate::files::kind::Kind;
use crate::run::stop::Stop;
use crate::terminal;

/// Runs `rc sweep`.
///
/// # Errors
/// [`CliError`] of every kind.
pub(crate) fn run(args: SweepArgs) -> Result<(), CliError> {
    if let Some(SweepCommand::Merge(args)) = args.command {
        return merge::run(&args);
    }
    if let Some(wanted) = args.wanted_mean()? {
        return mean::run(&args, &wanted);
    }
    let surfaces = Surfaces::new(&args)?;
    let missing = || CliError::input("out: a sweep keeps its rows in a folder; give --out DIR");
    let folder = surfaces.run.out.clone().ok_or_else(missing)?;
    let plan = surfaces.plan()?;
    if let Some(list) = args.list {
        let shard = Shard { index: 1, count: list.count(plan.shape().rows()) };
        plan.check_shard(shard)?;
        return list::print(std::env::args_os(), shard.count, &folder);
    }
    let (shard, folder) = part::resolve(args.shard, &folder)?;
    plan.check_shard(shard)?;
    if !args.resume {
        Kind::Sweep.check_out(&folder)?;
    }
    doubts::refuse_early(&surfaces)?;
    let sweep = Sweep::start(part::deal(plan, shard, &surfaces), shard, &folder, args.resume)?;
    execute(&surfaces, &Arc::new(sweep), (shard, &folder))
}

/// Solves the missing rows and reports the result.
fn execute(surfaces: &Surfaces, sweep: &Arc<Sweep>, (shard, folder): (Shard, &Path)) -> Result<(), CliError> {
    let (started, threads) = (Instant::now(), surfaces.threads);
    let n_rows = sweep.n_rows();
    let n_before = n_rows - sweep.todo().len();
    let how =
        HowRows { run: &surfaces.run, threads, max_elements: surfaces.max_elements(), stop: None, at_interrupt: None };
    let solved = solved::rows(surfaces, sweep, how)?;
    let whole = shard == Shard::WHOLE && sweep.kept().rows().len() == n_rows;
    let sealing = if whole && surfaces.leak() {
        Some(sealing::find(surfaces, sweep, folder, &Stop::at(started, surfaces.run.time_limit))?)
    } else {
        None
    };
    let kept = sweep.kept();
    match (surfaces.run.json, surfaces.run.quiet) {
        (true, _) => terminal::print(&to_json(&kept.rows().values().collect::<Vec<_>>()))?,
        (false, true) => {}
        (false, false) => {
            let seconds = digits(started.elapsed().as_secs_f64(), 3);
            let before = if n_before > 0 { format!(" ({n_before} kept from before)") } else { String::new() };
            let table = solved.table.display();
            let finished = kept.rows().len();
            let rows = if finished < n_rows {
                format!("{finished} of {}", count(n_rows, "row"))
            } else {
                count(n_rows, "row")
            };
            let threads = count(threads, "thread");
            let sealing = sealing.map_or_else(String::new, |sealing| sealing.lines());
            let means = means::over_seeds(kept.rows());
            let head = format!("{means}{rows}{before} in {seconds} s, {threads}\n{sealing}");
            terminal::print(&format!("{head}\nwritten to {table}\n"))?;
        }
    }
    solved.verdict(kept.rows(), n_rows, &surfaces.run)
}

#[cfg(test)]
mod tests {
    use clap::{Args as _, FromArgMatches as _};
    use rc_sweep::memory::Budget;
    use rc_sweep::{RunError, SweepRow, TABLE_FILE, Workers};
    use serde_json::json;

    use super::bar::RowBar;
    use super::doubts::Doubts;
    use super::problems::{RowScenes, SceneProblems};
    use super::results::Results;
    use super::rows::SweepResults;
    use super::*;
    use crate::scene::loaded::LoadedSurface;
    use crate::scene::resolve::ContactSetup;

    /// The scenes of a sweep whose first row does not converge, and whose other rows are refused.
    struct FirstRowHasOneIteration<'a>(&'a Surfaces);

    impl RowScenes<SweepRow> for FirstRowHasOneIteration<'_> {
        fn load(&self, row: &SweepRow) -> Result<LoadedSurface, CliError> {
            self.0.load(row)
        }

        fn contact(&self, row: &SweepRow) -> Result<ContactSetup, CliError> {
            if row.index > 0 {
                return Err(CliError::input("not now"));
            }
            let mut contact = self.0.contact_of(row)?;
            contact.params.max_iterations = 1;
            Ok(contact)
        }
    }

    /// The arguments of `rc sweep` from these words.
    fn parsed(words: &[&std::ffi::OsStr]) -> SweepArgs {
        let command = SweepArgs::augment_args(clap::Command::new("sweep").no_binary_name(true));
        SweepArgs::from_arg_matches(&command.get_matches_from(words)).expect("a command line")
    }

    #[test]
    fn a_row_that_did_not_converge_is_marked_and_makes_exit_code_3() {
        let dir = tempfile::tempdir().expect("a temporary folder");
        let out = dir.path().join("s");
        let flags = ["--waves", "8", "--grid", "64", "--pressures", "1e4,1e5", "--quiet", "--out"];
        let words: Vec<_> = flags.iter().map(std::ffi::OsStr::new).chain([out.as_os_str()]).collect();
        let surfaces = Surfaces::new(&parsed(&words)).expect("surfaces");
        let plan = surfaces.plan().expect("a plan");
        let sweep = Sweep::start(plan, Shard::WHOLE, &out, false).expect("a sweep");
        let doubts = Doubts::default();
        let results = Results::new(1, &doubts, None, RowBar::new(0, 2, true));
        let scenes = FirstRowHasOneIteration(&surfaces);
        let results = SweepResults { sweep: &sweep, scenes: &scenes, results };
        let problems = SceneProblems::new(&scenes, Budget::UNLIMITED);
        let refused = sweep.solve(&problems, &results, Workers { threads: 1, at_once: 1 });
        assert!(matches!(refused, Err(RunError::Refused { kept: 1, .. })), "{refused:?}");
        assert_eq!(sweep.kept().rows()[&0]["status"], json!("not_converged"));
        let error = execute(&surfaces, &Arc::new(sweep), (Shard::WHOLE, &out)).expect_err("a row did not converge");
        assert_eq!(error.exit_code(), 3, "{error}");
        assert!(error.to_string().starts_with("1 of 2 rows did not converge"), "{error}");
        let table = std::fs::read_to_string(out.join(TABLE_FILE)).expect("a table");
        let lines: Vec<&str> = table.lines().collect();
        assert_eq!(lines.len(), 3, "{table}");
        assert!(lines[1].contains("not_converged") && lines[2].contains(",converged,"), "{table}");
    }
}
