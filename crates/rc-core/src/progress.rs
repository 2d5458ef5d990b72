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

/// Receives [`Event`]s. Called from the solving thread, between iterations; should return quickly.
pub trait Observer: Sync {
    /// Takes note of an event.
    fn notify(&self, event: &Event);

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
