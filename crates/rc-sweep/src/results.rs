//! The interface of the code that takes solutions: the cells of each row.

use std::time::Duration;

use rc_solver::Solution;

use crate::content::Cells;
use crate::plan::SweepRow;
use crate::problems::RowProblems;
use crate::row::Row;
use crate::row_solver::RowError;

/// What becomes of the solutions of the problems `P`. Workers call it in parallel.
pub trait RowResults<P: RowProblems<R>, R: Row = SweepRow>: Sync {
    /// The cells of a solved row, without scene, seed and load, which the sweep adds.
    ///
    /// Every row must have the same columns. If fields are stored, the folder of the row is complete when this returns.
    ///
    /// # Errors
    /// When the result cannot be computed or written.
    fn cells(&self, row: &R, surface: &P::Surface, contact: &P::Contact, solved: SolvedRow) -> Result<Cells, P::Error>;

    /// Whether `error` concerns this row alone, or ends the sweep.
    fn failed(&self, row: &R, error: P::Error) -> RowError<P::Error>;

    /// Called after each row that was solved and stored.
    fn row_kept(&self) {}

    /// Whether to begin no more rows. Rows that have begun are finished.
    fn should_stop(&self) -> bool {
        false
    }
}

/// A solved row.
#[derive(Debug)]
pub struct SolvedRow {
    /// The solution. Its status says whether it converged.
    pub solution: Solution<'static>,
    /// Time to the certified solution. It includes the time to make the surface, for each of its loads.
    pub wall: Duration,
}
