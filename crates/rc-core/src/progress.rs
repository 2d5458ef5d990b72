//! Reports on running computations, without printing.

use crate::Grid;

/// An event in a solve.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub enum Event {
    /// A solve starts on one level of a hierarchy, coarsest first.
    Level {
        /// Grid of the level.
        grid: Grid,
        /// Number of the level, from 0.
        level: usize,
        /// Number of levels.
        n_levels: usize,
    },
    /// An iteration ended.
    Iteration {
        /// Number of iterations on this level so far.
        iteration: usize,
        /// Estimated error. It is relative to the same quantity as the tolerance.
        error: f64,
        /// Tolerance that the error has to reach on this level.
        tolerance: f64,
        /// Number of elements in contact.
        n_contact: usize,
    },
}

/// A function that passes the rows of a field, in order, to its argument.
///
/// Each call of the argument gets one or more whole rows.
pub type Rows<'a> = dyn Fn(&mut dyn FnMut(&[f64])) + 'a;

/// The pressure of a running solve, between two iterations.
///
/// Rows are computed when they are requested, so a snapshot costs nothing without an observer that reads it.
#[derive(Clone, Copy)]
pub struct Snapshot<'a> {
    grid: Grid,
    rows: &'a Rows<'a>,
}

impl<'a> Snapshot<'a> {
    /// A snapshot of a pressure (in E*) on `grid`.
    ///
    /// `rows` calls its argument with the rows of the pressure.
    #[must_use]
    pub fn new(grid: Grid, rows: &'a Rows<'a>) -> Self {
        Self { grid, rows }
    }

    /// The grid of the present level. On the last level it is the grid of the result, and before that a coarser one.
    #[must_use]
    pub fn grid(&self) -> Grid {
        self.grid
    }

    /// Passes the pressure (in E*) to `take` row by row from iy = 0.
    ///
    /// Each call gets one or more whole rows. The pressure is not a solution yet: with Gauss-Seidel it may contain
    /// tension.
    pub fn pressure_rows(&self, mut take: impl FnMut(&[f64])) {
        (self.rows)(&mut take);
    }
}

impl std::fmt::Debug for Snapshot<'_> {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Snapshot").field("grid", &self.grid).finish_non_exhaustive()
    }
}

/// Receives [`Event`]s.
///
/// The solver calls the methods between iterations and within them, one call at a time, from one of its threads. They
/// should return quickly. If several ranks (processes or threads) share a solve, each rank calls its observer. All ranks stop if the
/// observer of any rank wants to stop.
pub trait Observer: Sync {
    /// Receives an event.
    fn notify(&self, event: &Event);

    /// Gives access to the pressure so far, after each [`Event::Iteration`].
    ///
    /// The result of the solve does not depend on this method.
    fn look(&self, _pressure: &Snapshot<'_>) {}

    /// Returns whether to stop the solve now.
    ///
    /// The solver calls this between the applications of L, of which an iteration takes a few. Once it has returned
    /// true, it must not return false again. The solver then certifies the present state, with a fresh application of L
    /// on the finest grid, and returns it as not converged.
    fn should_stop(&self) -> bool {
        false
    }
}

/// The observer that ignores all events.
#[derive(Clone, Copy, Debug, Default)]
pub struct Silent;

impl Observer for Silent {
    fn notify(&self, _event: &Event) {}
}
