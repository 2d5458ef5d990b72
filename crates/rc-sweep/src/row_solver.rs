//! How a row is solved: what the caller of a sweep hands in.

use thiserror::Error;

use crate::content::Cells;
use crate::error::SweepError;
use crate::plan::SweepRow;

/// What solves the rows of a sweep, or those of an ensemble. Workers call it side by side.
pub trait RowSolver<Row = SweepRow>: Sync {
    /// Why a row could not be solved.
    type Error: Send;

    /// The cells of `row`, but for scene, seed and load, which the sweep knows. A row that did not converge is no
    /// error: its cell `status` is `not_converged`. With fields, the folder of the row is complete when this returns.
    ///
    /// # Errors
    /// [`RowError`].
    fn solve(&self, row: &Row) -> Result<Cells, RowError<Self::Error>>;

    /// Called after each row that was solved and kept.
    fn row_kept(&self) {}

    /// Whether no further row is to be begun. Rows that have begun are finished.
    fn should_stop(&self) -> bool {
        false
    }
}

/// Why a row could not be solved.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum RowError<E> {
    /// This row cannot be solved, as with a load that its surface cannot carry; that says nothing about the others.
    Refused(E),
    /// No further row is begun.
    Failed(E),
}

/// Threads, and the rows that they solve side by side.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Workers {
    /// All threads together.
    pub threads: usize,
    /// Rows at once, at most: as many as fit into memory.
    pub at_once: usize,
}

/// Why a sweep ended before its last row.
#[derive(Clone, Debug, PartialEq, Eq, Error)]
#[non_exhaustive]
pub enum RunError<E> {
    /// Rows were refused; all others are solved.
    #[error("{error} ({missing} rows cannot be solved, {kept} are kept)")]
    Refused {
        /// The first one's error.
        error: E,
        /// Rows without a result.
        missing: usize,
        /// Rows in the table.
        kept: usize,
    },
    /// A row failed.
    #[error("{0}")]
    Failed(E),
    /// The sweep itself failed.
    #[error(transparent)]
    Sweep(#[from] SweepError),
}
