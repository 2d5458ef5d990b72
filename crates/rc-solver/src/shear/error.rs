//! Reasons why a sheared contact was not solved.

use rc_core::Grid;
use thiserror::Error;

use crate::problem::capabilities::Refusal;
use crate::shear::solution::ShearSolution;
use crate::solve::error::SolveError;

/// Smallest part of the shear or displacement of sliding that is solved.
///
/// The second normal contact is solved for the rest, of which this part must not be rounding.
pub(super) const SMALLEST_PART: f64 = 1e-9;

/// A sheared contact that was not solved.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum ShearError {
    /// The shear force is not below the friction of the whole contact.
    #[error(
        "the mean shear {shear} is not below the friction {limit} of the whole contact (in units of E*): it slides"
    )]
    Sliding {
        /// τ, in E*.
        shear: f64,
        /// μσ0, in E*.
        limit: f64,
    },
    /// The displacement is not below that at which all of the contact slips.
    #[error(
        "all of the contact slips from a displacement of {limit} on (in units of the cell side), not above {displacement}"
    )]
    SlipsAll {
        /// d, in λ.
        displacement: f64,
        /// The displacement at which sliding begins, in λ.
        limit: f64,
    },
    /// The shear is too small beside that of sliding to be told from none.
    #[error("the shear {value} must be at least {least}, which is {SMALLEST_PART:e} of that of sliding")]
    TooSmall {
        /// τ in E*, or d in λ.
        value: f64,
        /// The smallest that is solved, in the same unit.
        least: f64,
    },
    /// A parameter is out of range.
    #[error("{name} must be {wanted}, not {value}")]
    Parameter {
        /// Its name.
        name: &'static str,
        /// Its value.
        value: f64,
        /// What it must be.
        wanted: &'static str,
    },
    /// A combination of features that cannot be solved.
    #[error(transparent)]
    Unsupported(#[from] Refusal),
    /// The second normal contact was not solved.
    #[error("the contact under the smaller load: {0}")]
    Normal(#[from] SolveError),
    /// Fields on the whole grid exceed the memory limit.
    #[error("tangential tractions on {grid} elements need about {needed} bytes, more than the limit of {limit}")]
    Memory {
        /// The grid.
        grid: Grid,
        /// Estimate, in bytes.
        needed: u64,
        /// Limit, in bytes.
        limit: u64,
    },
    /// The certificate exceeds the tolerance.
    #[error("the tangential tractions have an error of {:.2e} after {} rounds, above the tolerance {tolerance:e}", solution.info.error, solution.info.rounds)]
    NotConverged {
        /// Bound on the error that was wanted.
        tolerance: f64,
        /// The best solution found.
        solution: Box<ShearSolution>,
    },
}
