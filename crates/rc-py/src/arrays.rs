//! Conversions between fields of the libraries and arrays of NumPy.

use numpy::{PyArray1, PyArray2, PyArrayMethods as _, PyReadonlyArray2, PyUntypedArrayMethods as _};
use pyo3::prelude::*;
use rc_core::{Field, Grid};
use rc_heights::{HeightMap, Unit};

use crate::errors::bad_input;

/// Heights (m) of shape (ny, nx), row by row in memory.
///
/// The Python package converts all arrays into this form.
pub(crate) type Heights<'py> = PyReadonlyArray2<'py, f64>;

/// Number of values of a large array between two looks for signals.
///
/// They take a few milliseconds.
const VALUES_BETWEEN_LOOKS: usize = 1 << 22;

/// The grid of an array.
pub(crate) fn grid_of(heights: &Heights<'_>) -> PyResult<Grid> {
    let [ny, nx] = [heights.shape()[0], heights.shape()[1]];
    Grid::new(nx, ny).map_err(|cause| bad_input(format_args!("heights: {cause}")))
}

/// The values of an array, without a copy.
pub(crate) fn values_of<'a>(heights: &'a Heights<'_>) -> PyResult<&'a [f64]> {
    heights.as_slice().map_err(|_| bad_input("heights: the array must be contiguous, row by row"))
}

/// The heights as a map in metres.
///
/// This is the only copy of the caller's heights. It becomes the heights in units of the cell.
pub(crate) fn map_of(heights: &Heights<'_>, sides: Option<[f64; 2]>) -> PyResult<HeightMap> {
    let field = Field::new(grid_of(heights)?, divided(heights, 1.0)?).map_err(bad_input)?;
    Ok(HeightMap::new(field, Unit::Metre, sides, Unit::Metre))
}

/// The values of an array, each divided by `unit`.
pub(crate) fn divided(array: &Heights<'_>, unit: f64) -> PyResult<Vec<f64>> {
    let values = values_of(array)?;
    let mut copy = Vec::with_capacity(values.len());
    for part in values.chunks(VALUES_BETWEEN_LOOKS) {
        copy.extend(part.iter().map(|value| value / unit));
        array.py().check_signals()?;
    }
    Ok(copy)
}

/// An array of shape (ny, nx) from values row by row, without a copy.
pub(crate) fn array_of(py: Python<'_>, grid: Grid, values: Vec<f64>) -> PyResult<Bound<'_, PyArray2<f64>>> {
    PyArray1::from_vec(py, values).reshape([grid.ny(), grid.nx()])
}

/// A number that distinguishes arrays. It depends on each value and on its place.
pub(crate) fn fingerprint(heights: &Heights<'_>) -> PyResult<u64> {
    let mut sum = 0_u64;
    for (part, values) in values_of(heights)?.chunks(VALUES_BETWEEN_LOOKS).enumerate() {
        let first = part * VALUES_BETWEEN_LOOKS;
        let of = |(i, value): (usize, &f64)| value.to_bits().wrapping_mul(2 * (first + i) as u64 + 1);
        sum = values.iter().enumerate().map(of).fold(sum, u64::wrapping_add);
        heights.py().check_signals()?;
    }
    Ok(sum)
}
