//! Conversions between fields of the libraries and arrays of NumPy.

use numpy::{PyArray1, PyArray2, PyArrayMethods as _, PyReadonlyArray2, PyUntypedArrayMethods as _};
use pyo3::prelude::*;
use rc_core::{Field, Grid};
use rc_heights::{HeightMap, LengthUnit, Unit};

use crate::errors::{bad_input, raised_by_points};
use crate::running::on_threads;

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

/// The map of points x, y and height (m), one in each row: its heights, and its sides along x and y (m).
#[pyfunction]
pub(crate) fn points<'py>(py: Python<'py>, array: Heights<'py>) -> PyResult<(Bound<'py, PyArray2<f64>>, [f64; 2])> {
    let (rows, rest) = values_of(&array)?.as_chunks::<3>();
    if array.shape()[1] != 3 || !rest.is_empty() {
        return Err(bad_input("points: must be an array of shape (n, 3)"));
    }
    let rows = rows.to_vec();
    let map = on_threads(py, 0, move || rc_heights::of_points(&rows))?.map_err(|cause| raised_by_points(&cause))?;
    let sides = map.sides.ok_or_else(|| bad_input("points: the points have no sides"))?;
    Ok((array_of(py, map.heights.grid(), map.heights.into_values())?, sides))
}

/// The metres of a unit of length by any name that files have; `None` if the name is of no length.
#[pyfunction]
pub(crate) fn metres(name: &str) -> Option<f64> {
    // In files, `A` is an ampere.
    let unit: Option<LengthUnit> = name.parse().ok().filter(|_| name.trim() != "A");
    unit.map(LengthUnit::metres)
}

/// The heights as a map in metres.
///
/// This is the only copy of the caller's heights. It becomes the heights in units of the cell.
pub(crate) fn map_of(heights: &Heights<'_>, sides: Option<[f64; 2]>) -> PyResult<HeightMap> {
    Ok(HeightMap::new(field_of(heights)?, Unit::Metre, sides, Unit::Metre))
}

/// An array as a field, which is a copy.
pub(crate) fn field_of(array: &Heights<'_>) -> PyResult<Field> {
    Field::new(grid_of(array)?, divided(array, 1.0)?).map_err(bad_input)
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
