//! The interface of the code that solves a row.
//!
//! The caller of a sweep provides this code, or the problems of the rows, which this crate solves.

use rc_core::quantity::count;
use thiserror::Error;

use crate::content::Cells;
use crate::error::SweepError;
use crate::plan::SweepRow;

/// Solves the rows of a sweep or of an ensemble. Workers call it in parallel.
pub trait RowSolver<Row = SweepRow>: Sync {
    /// Error of a row that could not be solved.
    type Error: Send;

    /// The cells of `row`, without scene, seed and load, which the sweep adds.
    ///
    /// A row that did not converge is not an error. Its cell `status` is `not_converged`. If fields are stored, the
    /// folder of the row is complete when this returns.
    ///
    /// # Errors
    /// [`RowError`] when the row cannot be solved.
    fn solve(&self, row: &Row) -> Result<Cells, RowError<Self::Error>>;

    /// Called after each row that was solved and stored.
    fn row_kept(&self) {}

    /// Whether to begin no more rows. Rows that have begun are finished.
    fn should_stop(&self) -> bool {
        false
    }
}

/// Reasons why a row could not be solved.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum RowError<E> {
    /// This row cannot be solved, for example because the surface cannot carry the load.
    ///
    /// Other rows may be solvable.
    Refused(E),
    /// The solver failed, and no more rows are begun.
    Failed(E),
}

/// Numbers of threads, and of rows that they solve in parallel.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Workers {
    /// Total number of threads.
    pub threads: usize,
    /// Maximum number of rows at once, as many as fit into memory.
    pub at_once: usize,
}

/// Reasons why a sweep ended before its last row.
#[derive(Clone, Debug, PartialEq, Eq, Error)]
#[non_exhaustive]
pub enum RunError<E> {
    /// Rows were refused. All other rows are solved.
    #[error("{error}; {} could not be solved, and the other {kept} are kept", count(*missing, "row"))]
    Refused {
        /// Error of the first refused row.
        error: E,
        /// Number of rows without a result.
        missing: usize,
        /// Number of rows in the table.
        kept: usize,
    },
    /// A row failed.
    #[error("{0}")]
    Failed(E),
    /// The sweep itself failed.
    #[error(transparent)]
    Sweep(#[from] SweepError),
}
