//! Parameters of an iteration.

use crate::ErrorBound;

/// How accurately, and within which limits, an iteration solves.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct IterationParams {
    /// What the certificate has to meet.
    pub bound: ErrorBound,
    /// Largest number of iterations on any one level.
    pub max_iterations: usize,
}

impl IterationParams {
    /// To this part of the height range.
    pub(crate) fn relative(tolerance: f64) -> Self {
        Self { bound: ErrorBound::Relative(tolerance), max_iterations: 2000 }
    }
}
