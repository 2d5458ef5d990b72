//! Reasons why the paper's procedure cannot solve a problem.

use rc_quadtree::paper::MeshError;
use thiserror::Error;

use crate::problem::error::ProblemError;

/// A contact problem that the paper's procedure cannot solve.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum GaussSeidelError {
    /// Heights, load or tolerance are out of range.
    ///
    /// [`crate::solve()`] returns it as [`crate::SolveError::Problem`].
    #[error(transparent)]
    Problem(#[from] ProblemError),
    /// The mesh cannot be made.
    #[error(transparent)]
    Mesh(#[from] MeshError),
    /// The scene needs more work than the budget allows.
    ///
    /// The estimate comes from a solution on a coarse grid, before any other work.
    #[error(
        "about {elements} elements in contact need {coefficients:.1e} coefficients for each sweep of the iteration, about {seconds_per_sweep:.0} s. \
         At most {budget:.1e} are allowed; give a coarser grid, or another method"
    )]
    Budget {
        /// Estimated number of elements in contact.
        elements: usize,
        /// Square of the number of elements.
        coefficients: f64,
        /// Rough time of one sweep on one core.
        seconds_per_sweep: f64,
        /// [`crate::GaussSeidelParams::sweep_budget`].
        budget: f64,
    },
    /// A parameter is out of range.
    #[error("{what} must be {wanted}, not {value}")]
    Parameter {
        /// Name of the parameter.
        what: &'static str,
        /// The condition that the value must meet.
        wanted: &'static str,
        /// The value.
        value: f64,
    },
}
