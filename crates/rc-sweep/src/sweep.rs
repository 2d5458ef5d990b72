//! A running sweep: its plan, its journal, and what is left to do.

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

/// A sweep in its folder, which no other process may write to as long as this lives.
#[derive(Debug)]
pub struct Sweep {
    plan: SweepPlan,
    /// Those of this shard.
    rows: Vec<usize>,
    folder: PathBuf,
    journal: Mutex<Journal>,
}

impl Sweep {
    /// Starts the shard of a new sweep in `folder`, or with `resume` goes on with what is there of the same sweep,
    /// whose rows are those that were dealt to it when it was started.
    ///
    /// # Errors
    /// [`SweepError`] when the shard has no rows, when the folder holds something else, or when it cannot be written
    /// to.
    pub fn start(plan: SweepPlan, shard: Shard, folder: &Path, resume: bool) -> Result<Self, SweepError> {
        let shape = plan.shape();
        plan.check_shard(shard)?;
        let header = Header::of_shard(shape, shard, plan.deal.clone(), plan.settings());
        let journal = Journal::start(folder, header, resume)?;
        let rows = journal.header.rows();
        Ok(Self { plan, rows, folder: folder.to_owned(), journal: Mutex::new(journal) })
    }

    /// What is to be solved.
    #[must_use]
    pub fn plan(&self) -> &SweepPlan {
        &self.plan
    }

    /// Number of rows of this shard, finished or not.
    #[must_use]
    pub fn n_rows(&self) -> usize {
        self.rows.len()
    }

    /// The rows of this shard that are not finished, in the order in which they are solved.
    #[must_use]
    pub fn todo(&self) -> Vec<usize> {
        let journal = self.locked();
        let is_done =
            |row: &usize| journal.rows.contains_key(row) && (!self.plan.keeps_fields || has_fields(&self.folder, *row));
        self.rows.iter().copied().filter(|row| !is_done(row)).collect()
    }

    /// The folder for the fields of row `index`, if they are kept.
    #[must_use]
    pub fn fields_folder(&self, index: usize) -> Option<PathBuf> {
        self.plan.keeps_fields.then(|| fields_folder(&self.folder, index))
    }

    /// Keeps a row with these cells beside its scene, seed and load. When it returns, the row is on disk; after an
    /// error the rows before still are, and no part of this one.
    ///
    /// # Errors
    /// [`SweepError::Append`].
    pub fn keep(&self, row: &SweepRow, cells: Cells) -> Result<(), SweepError> {
        let mut all = self.plan.leading_cells(row);
        all.extend(cells);
        self.locked().append(row.index, all)
    }

    /// The rows that are kept so far.
    #[must_use]
    pub fn kept(&self) -> Kept<'_> {
        Kept::new(&self.folder, self.locked())
    }

    /// Solves what is left to do and writes the table, whose path is returned. A sweep of which no row could be solved
    /// leaves nothing behind.
    ///
    /// # Errors
    /// [`RunError`]; the rows that were solved are kept, and in the table.
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
        // What it says comes first: on a full disk, for one, the table fails as well.
        kept.discard_empty();
        Err(match error {
            RunError::Refused { error, .. } => {
                let n_kept = kept.rows().len();
                RunError::Refused { error, missing: self.n_rows() - n_kept, kept: n_kept }
            }
            other => other,
        })
    }

    /// Ends a sweep whose rows a caller solved and kept: writes the table, whose path is returned. One of which no row
    /// is kept leaves nothing behind.
    ///
    /// # Errors
    /// [`SweepError::File`]; an earlier table is left as it was.
    pub fn end(&self) -> Result<PathBuf, SweepError> {
        let kept = self.kept();
        let written = kept.write_table();
        kept.discard_empty();
        written
    }

    /// The journal, which workers and a handler of interrupts share. Every row in it is whole, so a worker that
    /// panicked leaves it usable.
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

    /// Refuses one load, fails at another, and stops after some rows.
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
        // Resumed with a solver that can, the rows are those of an uninterrupted sweep.
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
