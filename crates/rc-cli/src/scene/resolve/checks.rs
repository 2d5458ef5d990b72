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

/// Magnitudes that no quantity of a contact has. Beyond them, results would overflow.
const PLAUSIBLE: [f64; 2] = [1e-30, 1e30];

/// [`positive`], for a value whose reciprocal or product becomes a result.
pub(super) fn plausible(key: &str, unit: &str, value: f64) -> Result<f64, CliError> {
    let [least, most] = PLAUSIBLE;
    match positive(key, unit, Some(value))? {
        value if (least..=most).contains(&value) => Ok(value),
        value => {
            Err(CliError::input(format_args!("{key}: must be from {least:e} to {most:e} ({unit}), not {value:e}")))
        }
    }
}

/// The error for a key that neither the user nor the example gives.
///
/// It occurs only after an edit of the example.
pub(super) fn missing(key: &str) -> CliError {
    CliError::input(format_args!("{key}: is missing; give it"))
}
