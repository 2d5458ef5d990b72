//! The solution of all missing rows of a sweep, with its bar, its interrupts and its warnings.

use std::path::PathBuf;
use std::sync::Arc;

use rc_core::Observer;
use rc_sweep::memory::Budget;
use rc_sweep::{Sweep, SweepRow, SweepRows, Warning, Workers};

use super::bar::RowBar;
use super::doubts::Doubts;
use super::interrupt::{self, WriteRows};
use super::messages;
use super::problems::{RowScenes, SceneProblems};
use super::results::Results;
use super::rows::SweepResults;
use crate::error::CliError;
use crate::scene::keys::RunKeys;

/// How rows are solved.
#[derive(Clone, Copy)]
pub(crate) struct HowRows<'a> {
    pub(crate) run: &'a RunKeys,
    /// Number of all threads.
    pub(crate) threads: usize,
    /// Number of elements of the largest row.
    pub(crate) max_elements: f64,
    /// Says when no further row is begun, in a program that sees to interrupts itself.
    pub(crate) stop: Option<&'a dyn Observer>,
    /// Writes more than the table when the process is interrupted.
    pub(crate) at_interrupt: Option<&'a Arc<WriteRows>>,
}

/// What solving the rows left, besides the rows.
pub(crate) struct SolvedRows {
    /// The table of the rows.
    pub(crate) table: PathBuf,
    doubts: Doubts,
}

/// Solves the missing rows of `sweep`.
///
/// # Errors
/// [`CliError`]. The rows that were solved are kept.
pub(crate) fn rows<S: RowScenes<SweepRow>>(
    scenes: &S,
    sweep: &Arc<Sweep>,
    HowRows { run, threads, max_elements, stop, at_interrupt }: HowRows<'_>,
) -> Result<SolvedRows, CliError> {
    let n_rows = sweep.n_rows();
    let bar = RowBar::new(n_rows - sweep.todo().len(), n_rows, run.quiet);
    if stop.is_none() {
        let (sweep, bar, write) = (Arc::clone(sweep), bar.clone(), at_interrupt.cloned());
        interrupt::install(move || interrupt::end(&sweep.kept(), Some(n_rows), &bar, write.as_deref()));
    }
    let doubts = Doubts::default();
    let budget = Budget::new(run.memory_limit);
    let results = Results::new(threads, &doubts, run.time_limit, bar.clone()).until(stop);
    let results = SweepResults { sweep, scenes, results };
    let workers = Workers { threads, at_once: budget.solves_at_once(max_elements) };
    let finished = sweep.solve(&SceneProblems::new(scenes, budget), &results, workers);
    bar.clear();
    let table = finished.map_err(messages::of_run)?;
    Ok(SolvedRows { table, doubts })
}

impl SolvedRows {
    /// The warnings of the solved rows, one for each code.
    pub(crate) fn warnings(&self) -> Vec<Warning> {
        self.doubts.warnings()
    }

    /// Tells the warnings of the `rows`, and fails where some of `n_rows` are missing or did not converge.
    ///
    /// # Errors
    /// [`CliError`].
    pub(crate) fn verdict(&self, rows: &SweepRows, n_rows: usize, run: &RunKeys) -> Result<(), CliError> {
        let doubted = self.doubts.tell(run);
        if let (missing @ 1.., Some(limit)) = (n_rows - rows.len(), run.time_limit) {
            return Err(messages::out_of_time(limit, missing, n_rows));
        }
        messages::check_converged(rows, &self.table).and(doubted)
    }
}
