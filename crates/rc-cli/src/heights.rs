//! Height maps from files, in metres and checked for what a solver needs.

use std::path::Path;

use rc_core::Field;
use rc_heights::{HeightMap, SAME_LENGTH, Scales};

use crate::error::CliError;
use crate::quantity::engineering;

/// Reads a height map of any format of `rc-heights`, in metres; `NaN` where nothing was measured. Row `iy` of the file is row
/// `iy` of the field.
///
/// # Errors
/// [`CliError::Input`] when the file cannot be read or is damaged, or when `scales` does not fit its units.
pub fn read(path: &Path, scales: Scales) -> Result<HeightMap, CliError> {
    rc_heights::read(path)?.in_metres(scales).map_err(|cause| CliError::in_file(path, cause))
}

/// Refuses a field with `NaN` or an infinite value.
///
/// # Errors
/// [`CliError::Input`] with row, column and value.
pub fn check_finite(path: &Path, field: &Field) -> Result<(), CliError> {
    let nx = field.grid().nx();
    match field.values().iter().position(|value| !value.is_finite()) {
        None => Ok(()),
        Some(i) => {
            let (row, column, value) = (i / nx, i % nx, field.values()[i]);
            let missing = field.values().iter().filter(|value| value.is_nan()).count();
            let cure = if missing > 0 {
                format!("; {missing} of {} are missing, which rc surface --fill laplace fills", field.grid().len())
            } else {
                String::new()
            };
            let place = format_args!("row {row}, column {column} (from 0) is {value}; heights must be finite{cure}");
            Err(CliError::in_file(path, place))
        }
    }
}

/// The side of the cell (m): that of the map, which must be a square, where the file says it, else `given`. If both are there
/// they must be the same.
///
/// # Errors
/// [`CliError::Input`].
pub fn side(path: &Path, sides: Option<[f64; 2]>, given: Option<f64>) -> Result<Option<f64>, CliError> {
    let Some([x, y]) = sides else { return Ok(given) };
    let same = |a: f64, b: f64| (a / b - 1.0).abs() <= SAME_LENGTH;
    let length = |side: f64| engineering(side, "m");
    if !same(x, y) {
        let message = format_args!(
            "the map is {} by {}, and a periodic cell is a square; rc surface --crop square cuts one out",
            length(x),
            length(y)
        );
        return Err(CliError::in_file(path, message));
    }
    match given {
        Some(cell) if !same(cell, x) => {
            let message = format_args!(
                "the map is {} wide, cell says {}; leave cell away, or convert the map to .npy, which has no size",
                length(x),
                length(cell)
            );
            Err(CliError::in_file(path, message))
        }
        Some(cell) => Ok(Some(cell)),
        None => Ok(Some(x)),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_side_is_that_of_the_file_and_must_not_be_contradicted() {
        let path = Path::new("map.sdf");
        assert_eq!(side(path, None, Some(2.0)), Ok(Some(2.0)));
        assert_eq!(side(path, Some([1e-3, 1e-3]), None), Ok(Some(1e-3)));
        assert_eq!(side(path, Some([1e-3, 1.0005e-3]), Some(1e-3)), Ok(Some(1e-3)));
        for (sides, given, expected) in [([1e-3, 2e-3], None, "--crop square"), ([1e-3, 1e-3], Some(2e-3), "2 mm")] {
            let error = side(path, Some(sides), given).expect_err(expected).to_string();
            assert!(error.contains(expected) && error.contains("map.sdf"), "{error}");
        }
    }
}
