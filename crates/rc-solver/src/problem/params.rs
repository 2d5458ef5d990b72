//! Parameters of an iteration.

use crate::problem::tolerance::ErrorBound;

/// The accuracy and the limits of an iteration.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct IterationParams {
    /// The bound that the certificate must meet.
    pub bound: ErrorBound,
    /// Maximum number of iterations on any one level.
    pub max_iterations: usize,
}

impl IterationParams {
    /// Parameters for a `tolerance` relative to the height range.
    pub(crate) fn relative(tolerance: f64) -> Self {
        Self { bound: ErrorBound::Relative(tolerance), max_iterations: 2000 }
    }
}
