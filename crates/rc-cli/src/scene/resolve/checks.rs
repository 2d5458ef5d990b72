//! Checks for several groups of keys.

use rc_core::Grid;

use crate::error::CliError;
use crate::scene::values::GridSpec;

/// A grid that the libraries can count.
///
/// Its memory is not checked here, since that depends on the method.
///
/// # Errors
/// [`CliError::Input`].
pub fn checked_grid(spec: GridSpec) -> Result<Grid, CliError> {
    Grid::new(spec.nx, spec.ny).map_err(|cause| CliError::input(format_args!("grid: {cause}")))
}

pub(super) fn positive(key: &str, unit: &str, value: Option<f64>) -> Result<f64, CliError> {
    match value {
        Some(value) if value > 0.0 && value.is_finite() => Ok(value),
        Some(value) => Err(CliError::input(format_args!("{key}: must be positive and finite ({unit}), not {value}"))),
        None => Err(missing(key)),
    }
}

/// The error for a key that neither the user nor the example gives.
///
/// It occurs only after an edit of the example.
pub(super) fn missing(key: &str) -> CliError {
    CliError::input(format_args!("{key}: is missing; give it"))
}
