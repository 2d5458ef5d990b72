//! A running sweep with its plan, its journal, and its remaining rows.

use std::path::{Path, PathBuf};
use std::sync::{Mutex, MutexGuard, PoisonError};

use crate::content::{Cells, Header};
use crate::error::SweepError;
use crate::folder::{fields_folder, has_fields};
use crate::journal::Journal;
use crate::kept::Kept;
use crate::plan::{SweepPlan, SweepRow};
use crate::row_solver::{RowSolver, RunError, Workers};
use crate::shard::Shard;
use crate::workers;

/// A sweep in its folder. No other process may write to the folder during its lifetime.
#[derive(Debug)]
pub struct Sweep {
    plan: SweepPlan,
    /// Indices of the rows of this shard.
    rows: Vec<usize>,
    folder: PathBuf,
    journal: Mutex<Journal>,
}

impl Sweep {
    /// Starts the shard of a new sweep in `folder`, or continues a sweep with `resume`.
    ///
    /// A sweep to continue must be the same, or a whole sweep without some of the surfaces and loads. Its finished rows
    /// are kept. The rows of a shard are those that were dealt to it when it was started.
    ///
    /// # Errors
    /// [`SweepError`] when the shard has no rows, when the folder contains something else, or when it cannot be
    /// written.
    pub fn start(plan: SweepPlan, shard: Shard, folder: &Path, resume: bool) -> Result<Self, SweepError> {
        let shape = plan.shape();
        plan.check_shard(shard)?;
        let header = Header::of_shard(shape, shard, plan.deal.clone(), plan.settings());
        let journal = Journal::start(folder, header, resume)?;
        let rows = journal.header.rows();
        Ok(Self { plan, rows, folder: folder.to_owned(), journal: Mutex::new(journal) })
    }

    /// The plan of the sweep.
    #[must_use]
    pub fn plan(&self) -> &SweepPlan {
        &self.plan
    }

    /// Number of rows of this shard, finished or not.
    #[must_use]
    pub fn n_rows(&self) -> usize {
        self.rows.len()
    }

    /// The unfinished rows of this shard, in the order of solution.
    #[must_use]
    pub fn todo(&self) -> Vec<usize> {
        let journal = self.locked();
        let is_done =
            |row: &usize| journal.rows.contains_key(row) && (!self.plan.keeps_fields || has_fields(&self.folder, *row));
        self.rows.iter().copied().filter(|row| !is_done(row)).collect()
    }

    /// The folder for the fields of row `index`, or `None` if fields are not stored.
    #[must_use]
    pub fn fields_folder(&self, index: usize) -> Option<PathBuf> {
        self.plan.keeps_fields.then(|| fields_folder(&self.folder, index))
    }

    /// Stores a row with these cells and its scene, seed and load.
    ///
    /// After success, the row is on disk. After an error, the rows before it are on disk, and no part of this row is.
    ///
    /// # Errors
    /// [`SweepError::Append`] when the row cannot be written.
    pub fn keep(&self, row: &SweepRow, cells: Cells) -> Result<(), SweepError> {
        let mut all = self.plan.leading_cells(row);
        all.extend(cells);
        self.locked().append(row.index, all)
    }

    /// The rows that are stored so far.
    #[must_use]
    pub fn kept(&self) -> Kept<'_> {
        Kept::new(&self.folder, self.locked())
    }

    /// Solves the remaining rows, writes the table, and returns its path.
    ///
    /// If no row could be solved, no files remain.
    ///
    /// # Errors
    /// [`RunError`]. The solved rows are stored, and in the table.
    pub fn run<S: RowSolver>(&self, solver: &S, workers: Workers) -> Result<PathBuf, RunError<S::Error>> {
        let todo = self.todo();
        if !todo.is_empty() {
            self.kept().write_table()?;
        }
        let todo: Vec<SweepRow> = todo.into_iter().map(|index| self.plan.row(index)).collect();
        let keep = |row: &SweepRow, cells| self.keep(row, cells);
        let solved = workers::run(&todo, solver, workers, &keep);
        let kept = self.kept();
        let written = kept.write_table();
        let Err(error) = solved else { return Ok(written?) };
        // The error of the run takes precedence. On a full disk, for example, the table fails as well.
        kept.discard_empty();
        Err(match error {
            RunError::Refused { error, .. } => {
                let n_kept = kept.rows().len();
                RunError::Refused { error, missing: self.n_rows() - n_kept, kept: n_kept }
            }
            other => other,
        })
    }

    /// Ends a sweep whose rows the caller has solved and stored.
    ///
    /// Writes the table and returns its path. If no row is stored, no files remain.
    ///
    /// # Errors
    /// [`SweepError::File`] when the table cannot be written. An earlier table is not changed.
    pub fn end(&self) -> Result<PathBuf, SweepError> {
        let kept = self.kept();
        let written = kept.write_table();
        kept.discard_empty();
        written
    }

    /// The journal, which workers share with a handler of interrupts.
    ///
    /// Every row in it is complete, so it is usable after a worker has panicked.
    fn locked(&self) -> MutexGuard<'_, Journal> {
        self.journal.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

#[cfg(test)]
mod tests {
    use serde_json::json;

    use super::*;
    use crate::plan::{ControlKind, PlannedSurface};
    use crate::row_solver::RowError;

    /// A solver that refuses one load, fails at another, and stops after some rows.
    struct Toy {
        refused: f64,
        failed: f64,
        stops: bool,
    }

    const SOUND: Toy = Toy { refused: f64::NAN, failed: f64::NAN, stops: false };

    impl RowSolver for Toy {
        type Error = String;

        fn solve(&self, row: &SweepRow) -> Result<Cells, RowError<String>> {
            let is = |load: f64| row.load.total_cmp(&load).is_eq();
            match row.load {
                load if is(self.refused) => Err(RowError::Refused(format!("no {load}"))),
                load if is(self.failed) => Err(RowError::Failed(format!("at {load}"))),
                load => Ok(Cells::from_iter([("twice".to_owned(), json!(2.0 * load))])),
            }
        }

        fn should_stop(&self) -> bool {
            self.stops
        }
    }

    const ALONE: Workers = Workers { threads: 1, at_once: 1 };

    fn sweep(folder: &Path, resume: bool) -> Sweep {
        let surface =
            |seed| PlannedSurface { seed: Some(seed), loads: vec![1.0, 2.0, 3.0], ..PlannedSurface::default() };
        let plan = SweepPlan::new(ControlKind::Pressure, vec![surface(7), surface(8)]);
        Sweep::start(plan, Shard::WHOLE, folder, resume).expect("a sweep")
    }

    #[test]
    fn a_refused_load_costs_its_rows_and_a_failure_those_after_it() {
        let dir = tempfile::tempdir().expect("a temporary folder");
        let folder = dir.path().join("refused");
        let refused = Toy { refused: 2.0, ..SOUND };
        let error = sweep(&folder, false).run(&refused, ALONE).expect_err("a load is refused");
        assert_eq!(error, RunError::Refused { error: "no 2".to_owned(), missing: 2, kept: 4 });
        // After it is resumed with a solver that succeeds, the rows are those of an uninterrupted sweep.
        let table = sweep(&folder, true).run(&SOUND, ALONE).expect("a table");
        let text = std::fs::read_to_string(table).expect("the table");
        assert_eq!(text.lines().nth(5), Some("8,2.0,4.0"), "{text}");

        let folder = dir.path().join("failed");
        let failed = Toy { failed: 3.0, ..SOUND };
        let stopped = sweep(&folder, false);
        assert_eq!(stopped.run(&failed, ALONE), Err(RunError::Failed("at 3".to_owned())));
        assert_eq!(stopped.todo(), [2, 3, 4, 5]);
    }

    #[test]
    fn no_row_is_begun_after_the_stop_and_nothing_is_left_of_no_row() {
        let dir = tempfile::tempdir().expect("a temporary folder");
        let folder = dir.path().join("s");
        let waiting = sweep(&folder, false);
        waiting.run(&Toy { stops: true, ..SOUND }, ALONE).expect("no error");
        assert_eq!((waiting.todo().len(), waiting.kept().rows().len()), (6, 0));
        drop(waiting);
        sweep(&folder, true).run(&Toy { failed: 1.0, ..SOUND }, ALONE).expect_err("it fails at once");
        assert!(!folder.join("sweep.jsonl").exists(), "an empty journal was left behind");
    }
}
