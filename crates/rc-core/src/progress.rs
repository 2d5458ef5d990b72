//! How long computations report what they do, without printing.

use crate::Grid;

/// Something that happened in a solve.
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
        /// Iterations on this level so far.
        iteration: usize,
        /// Estimated error, relative as the tolerance is.
        error: f64,
        /// The tolerance that the error is to reach on this level.
        tolerance: f64,
        /// Elements in contact.
        n_contact: usize,
    },
}

/// Hands out the rows of a field in order, any number of whole ones at a time.
pub type Rows<'a> = dyn Fn(&mut dyn FnMut(&[f64])) + 'a;

/// The pressure of a running solve, between two iterations. Rows are made when they are asked for, so that it costs
/// nothing where nobody looks.
#[derive(Clone, Copy)]
pub struct Snapshot<'a> {
    grid: Grid,
    rows: &'a Rows<'a>,
}

impl<'a> Snapshot<'a> {
    /// Of a pressure (in E*) on `grid`, whose rows `rows` hands out.
    #[must_use]
    pub fn new(grid: Grid, rows: &'a Rows<'a>) -> Self {
        Self { grid, rows }
    }

    /// The grid of the present level, coarser than that of the result before the last one.
    #[must_use]
    pub fn grid(&self) -> Grid {
        self.grid
    }

    /// Hands out the pressure (in E*) row by row from iy = 0, one row or some of them at a time. It is not a solution
    /// yet: Gauss-Seidel may have tension in it.
    pub fn pressure_rows(&self, mut take: impl FnMut(&[f64])) {
        (self.rows)(&mut take);
    }
}

impl std::fmt::Debug for Snapshot<'_> {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Snapshot").field("grid", &self.grid).finish_non_exhaustive()
    }
}

/// Receives [`Event`]s. Called from the solving thread, between iterations; should return quickly.
pub trait Observer: Sync {
    /// Takes note of an event.
    fn notify(&self, event: &Event);

    /// May look at the pressure so far; called after each [`Event::Iteration`]. The result does not depend on it.
    fn look(&self, _pressure: &Snapshot<'_>) {}

    /// Whether to end now, with what there is: it is returned as not converged. Asked between iterations.
    fn should_stop(&self) -> bool {
        false
    }
}

/// The observer that ignores everything.
#[derive(Clone, Copy, Debug, Default)]
pub struct Silent;

impl Observer for Silent {
    fn notify(&self, _event: &Event) {}
}
