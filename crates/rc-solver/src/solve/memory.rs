//! Memory of the methods that store fields on the whole grid.

use rc_core::{Boundary, Grid};

use crate::levels::uniform::FREE_BYTES_PER_ELEMENT;
use crate::levels::uniform::UNIFORM_BYTES_PER_ELEMENT;
use crate::problem::contact_problem::ContactProblem;
use crate::problem::method::Method;
use crate::solve::error::SolveError;

/// Bytes for each element under a sliding surface: 110 for vectors, tables and transforms, the rest for GMRES.
const SLIDING_BYTES_PER_ELEMENT: u64 = 200;

/// Bytes per element of a method that stores fields on the whole grid.
pub(super) fn bytes_per_element(problem: &ContactProblem<'_>) -> u64 {
    match problem.boundary() {
        Boundary::Periodic if problem.kernel.get().sliding_velocity().is_some() => SLIDING_BYTES_PER_ELEMENT,
        Boundary::Periodic => UNIFORM_BYTES_PER_ELEMENT,
        Boundary::Free => FREE_BYTES_PER_ELEMENT,
    }
}

/// Refuses fields on the whole grid that do not fit into memory.
pub(super) fn check_uniform(
    grid: Grid,
    bytes_per_element: u64,
    limit: Option<u64>,
    method: Method,
) -> Result<(), SolveError> {
    let needed = grid.len() as f64 * bytes_per_element as f64;
    match limit {
        Some(limit) if needed > limit as f64 => Err(SolveError::Memory { method, grid, needed: needed as u64, limit }),
        _ => Ok(()),
    }
}
