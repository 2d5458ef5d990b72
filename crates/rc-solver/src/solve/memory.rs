//! Memory of the methods that store every element of the grid.

use rc_core::Grid;

use super::SolveError;
use crate::{Method, UNIFORM_BYTES_PER_ELEMENT};

/// Bytes of a method that stores every element.
pub(super) fn uniform_bytes(grid: Grid) -> f64 {
    grid.len() as f64 * UNIFORM_BYTES_PER_ELEMENT as f64
}

/// Refuses a method that stores every element if the grid does not fit into memory.
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
