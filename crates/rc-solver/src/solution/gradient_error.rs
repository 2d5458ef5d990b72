//! Reasons why a gradient is not computed.

use rc_core::Grid;
use thiserror::Error;

use crate::problem::capabilities::Refusal;

/// A gradient that cannot be computed.
#[derive(Clone, Debug, PartialEq, Error)]
#[non_exhaustive]
pub enum GradientError {
    /// A method or a feature of the problem excludes gradients.
    #[error(transparent)]
    Unsupported(#[from] Refusal),
    /// The contact is not the solution's.
    #[error("the contact did not converge, so it has no gradient; allow more iterations or time")]
    NotConverged,
    /// The quantity is held fixed.
    #[error("the {0} is held fixed, so its gradient is zero; hold the {1} fixed instead")]
    Held(&'static str, &'static str),
    /// Full contact on a half-space at a given penetration.
    #[error("in full contact the penetration does not determine the load; hold the mean pressure fixed instead")]
    FullContact,
    /// There is no contact, so the load cannot be held fixed.
    #[error("nothing is in contact, so no load can be held fixed; hold the penetration fixed instead")]
    NoContact,
    /// The kernel makes no copy of itself, and the solution has outlived it.
    #[error("the solution has no kernel any more; ask for the gradient before the solution is made without borrows")]
    NoKernel,
    /// The derivatives do not belong to the elements.
    #[error("the derivatives must be one number for each of {0} elements, finite in contact")]
    Derivatives(Grid),
    /// The linear solve does not reach an accuracy of use.
    #[error("the linear system of the gradient has a relative residual of {0:.1e}, because of rounding")]
    Inexact(f64),
}
