//! Reasons why a contact problem was not solved.

use rc_core::{Grid, GridError};
use thiserror::Error;

use crate::descent::certificate::Certificate;
use crate::paper::error::GaussSeidelError;
use crate::problem::adaptive_error::AdaptiveError;
use crate::problem::capabilities::Refusal;
use crate::problem::error::ProblemError;
use crate::problem::method::Method;
use crate::solution::whole::Solution;

/// A contact problem that was not solved.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum SolveError {
    /// Heights, load or tolerance are out of range.
    #[error(transparent)]
    Problem(ProblemError),
    /// The adaptive method cannot solve this problem, and no other method is allowed.
    #[error(transparent)]
    Adaptive(AdaptiveError),
    /// The Gauss-Seidel method (the paper's procedure) cannot solve this problem.
    #[error(transparent)]
    GaussSeidel(GaussSeidelError),
    /// A combination of features and method that cannot be solved.
    #[error(transparent)]
    Unsupported(#[from] Refusal),
    /// A method that stores fields on the whole grid exceeds the memory limit.
    #[error("the {method} method on {grid} elements needs about {needed} bytes, more than the limit of {limit}")]
    Memory {
        /// The method.
        method: Method,
        /// The grid.
        grid: Grid,
        /// Estimate, in bytes.
        needed: u64,
        /// Limit, in bytes.
        limit: u64,
    },
    /// A grid cannot be made.
    #[error(transparent)]
    Grid(#[from] GridError),
    /// The grid does not resolve the waves of the surface.
    #[error("{grid} elements do not resolve {waves} waves; more than {} per side are needed", 2 * waves)]
    TooCoarse {
        /// The grid.
        grid: Grid,
        /// Largest wavenumber of the surface.
        waves: usize,
    },
    /// The finest grid that is tried is not accurate enough.
    #[error(
        "the relative error of the area cannot be reduced to {wanted}; with {side} elements per side it is {reached}"
    )]
    AreaError {
        /// Relative error that was wanted.
        wanted: f64,
        /// Relative error on the last grid.
        reached: f64,
        /// Elements per side of that grid.
        side: usize,
    },
    /// The solve ended without convergence.
    ///
    /// The iteration limit was reached, the error no longer fell, or the observer ended the solve.
    #[error("not converged on {grid} elements after {iterations} iterations: {certificate}")]
    NotConverged {
        /// Grid of the finest level.
        grid: Grid,
        /// Iterations on that grid.
        iterations: usize,
        /// Certificate of the best pressure found.
        certificate: Certificate,
        /// The best solution found.
        solution: Box<Solution<'static>>,
    },
}

impl From<ProblemError> for SolveError {
    fn from(error: ProblemError) -> Self {
        Self::Problem(error)
    }
}

impl From<AdaptiveError> for SolveError {
    fn from(error: AdaptiveError) -> Self {
        match error {
            AdaptiveError::Problem(error) => Self::Problem(error),
            AdaptiveError::Unsupported(refusal) => Self::Unsupported(refusal),
            other => Self::Adaptive(other),
        }
    }
}

impl From<GaussSeidelError> for SolveError {
    fn from(error: GaussSeidelError) -> Self {
        match error {
            GaussSeidelError::Problem(error) => Self::Problem(error),
            other => Self::GaussSeidel(other),
        }
    }
}
