//! Reasons why a contact problem was not solved.

use rc_core::{Grid, GridError};
use thiserror::Error;

use crate::descent::certificate::Certificate;
use crate::paper::error::GaussSeidelError;
use crate::problem::adaptive_error::AdaptiveError;
use crate::problem::error::ProblemError;
use crate::problem::method::{Method, MethodReason};
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
    /// The method is only for Love's squares.
    #[error("the {method} method needs the kernel love, not {kernel}")]
    Kernel {
        /// The method asked for.
        method: Method,
        /// Name of the kernel.
        kernel: &'static str,
    },
    /// The chosen method cannot run over several ranks (processes or threads).
    #[error("only the adaptive method runs on several ranks ({reason}); choose the adaptive method, or one rank")]
    OneRank {
        /// The method, and the reason to choose it.
        reason: MethodReason,
    },
    /// The method is only for the half-space.
    #[error("the {method} method solves on the half-space only, not on a layer")]
    Solid {
        /// The method asked for.
        method: Method,
    },
    /// The method is only for a periodic cell.
    #[error("the {method} method solves on a periodic cell only, not on a patch with free borders")]
    FreeBorders {
        /// The method asked for.
        method: Method,
    },
    /// Smaller elements at contact edges were requested from a method without them.
    ///
    /// [`crate::SolveParams::border_level`] requests them.
    #[error("the {method} method does not divide elements at contact edges; only the adaptive method does")]
    BorderLevel {
        /// The method asked for.
        method: Method,
    },
    /// A hardness was given to a method that does not support it.
    #[error("the {method} method does not support a hardness; the adaptive and uniform methods do")]
    Hardness {
        /// The method asked for.
        method: Method,
    },
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
    /// A grid can be chosen only for a band-limited surface in a square cell.
    #[error(
        "a wanted area error can choose the grid only for a band-limited surface in a square cell; a height map has its own grid"
    )]
    NoWaves,
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
