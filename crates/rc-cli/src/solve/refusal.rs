//! What the solvers say, in the user's units.

use rc_core::Grid;
use rc_solver::{Certificate, IterationError};

use crate::error::CliError;
use crate::resolve::ContactProblem;

/// The solver's refusal of its input; `side` is λ in m.
pub(super) fn in_si(error: &IterationError, side: f64, contact: &ContactProblem) -> CliError {
    match error {
        IterationError::Penetration { value, full_contact } => CliError::input(format_args!(
            "penetration: must be above 0 and below that of full contact, {:.6e} m, not {:.6e} m; beyond it the penetration \
             no longer determines the pressure, so give --pressure",
            full_contact * side,
            value * side
        )),
        IterationError::HeightRange { value, smallest, greatest } => CliError::input(format_args!(
            "heights: their range must be 0 or from {:e} to {:e} m, not {:e} m",
            smallest * side,
            greatest * side,
            value * side
        )),
        IterationError::MeanPressure { value } => CliError::input(format_args!(
            "pressure: must be positive and finite (Pa), not {}",
            value * contact.elasticity.e_star()
        )),
        IterationError::Tolerance { value, smallest } => {
            CliError::input(format_args!("tolerance: must be between {smallest:e} and 1, not {value:e}"))
        }
        other => CliError::input(other),
    }
}

/// What is said of a solution that did not reach the tolerance.
pub(super) fn not_converged(grid: Grid, iterations: usize, certificate: &Certificate, tolerance: f64) -> String {
    format!("not converged to {tolerance:e} on {grid} elements after {iterations} iterations: {certificate}")
}
