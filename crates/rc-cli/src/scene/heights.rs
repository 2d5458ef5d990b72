//! Height maps from files, in metres, and their checks.

use std::path::Path;

use rc_core::{Field, Grid, PeriodicCell};
use rc_heights::{Format, HeightMap, Layout, ReadParams, SAME_LENGTH, Scales};

use super::as_read::AsRead;
use crate::error::CliError;
use rc_core::quantity::engineering;

/// Reads a height map of any format of `rc-heights`, in metres.
///
/// Unmeasured points are `NaN`. Row `iy` of the file is row `iy` of the field.
///
/// # Errors
/// [`CliError::Input`] when the file cannot be read, is damaged or does not have the channel, or when `scales` does not
/// fit its units.
pub fn read(path: &Path, params: &ReadParams, scales: Scales) -> Result<HeightMap, CliError> {
    rc_heights::read_with(path, params)?.in_metres(scales).map_err(|cause| CliError::in_file(path, cause))
}

/// Refuses a field with `NaN` or an infinite value.
///
/// # Errors
/// [`CliError::Input`] with row, column and value.
pub(crate) fn check_finite(path: &Path, field: &Field) -> Result<(), CliError> {
    check_heights(path, field, &ReadParams { layout: Some(Layout::Matrix), ..ReadParams::default() })
}

/// Refuses a height map with `NaN` or an infinite value. `params` are those that it was read with.
///
/// # Errors
/// [`CliError::Input`] with row, column and value.
pub(crate) fn check_heights(path: &Path, field: &Field, params: &ReadParams) -> Result<(), CliError> {
    let nx = field.grid().nx();
    match field.values().iter().position(|value| !value.is_finite()) {
        None => Ok(()),
        Some(i) => {
            let (row, column, value) = (i / nx, i % nx, field.values()[i]);
            let missing = field.values().iter().filter(|value| value.is_nan()).count();
            let place = format!("row {row}, column {column} (from 0) is {value}; heights must be finite");
            let filled =
                format!("rc surface --fill laplace fills the missing points ({missing} of {})", field.grid().len());
            let guessed = params.layout.is_none() && rc_heights::format_of(path) == Ok(Format::Xyz);
            Err(CliError::in_file(
                path,
                match missing {
                    0 => place,
                    _ if guessed => format!(
                        "{place}; the file was read as a list of points x, y, z, so give --layout matrix if each line is a row of \
                         the map; otherwise {filled}"
                    ),
                    _ => format!("{place}; {filled}"),
                },
            ))
        }
    }
}

/// Sides of the cell along x and y (m).
///
/// They are those of the map if its file has them, else those `given`. If both exist, they must be equal. The second is
/// `None` for a square.
///
/// # Errors
/// [`CliError::Input`].
pub(crate) fn sides(
    path: &Path,
    of_file: Option<[f64; 2]>,
    given: [Option<f64>; 2],
) -> Result<[Option<f64>; 2], CliError> {
    let Some(of_file) = of_file else { return Ok(given) };
    let same = |a: f64, b: f64| (a / b - 1.0).abs() <= SAME_LENGTH;
    let length = |side: f64| engineering(side, "m");
    for ((given, side), (key, extent)) in given.iter().zip(of_file).zip([("cell", "wide"), ("cell_y", "high")]) {
        if let Some(given) = given.filter(|given| !same(*given, side)) {
            let message = format_args!(
                "the map is {} {extent}, but {key} says {}; omit {key}, or convert the map to .npy, which has no size",
                length(side),
                length(given)
            );
            return Err(CliError::in_file(path, message));
        }
    }
    let [x, y] = of_file;
    Ok([Some(given[0].unwrap_or(x)), (!same(x, y)).then(|| given[1].unwrap_or(y))])
}

/// The heights of a map (m) in λ, on the grid of its points.
///
/// The grid has the sides of `cell`.
///
/// # Errors
/// [`CliError::Input`] when the ratio of the cell's sides is too large.
pub(crate) fn in_cell(path: &Path, map: Field, cell: PeriodicCell) -> Result<(Field, AsRead), CliError> {
    let grid = Grid::in_cell(map.grid().nx(), map.grid().ny(), cell.ratio())
        .map_err(|cause| CliError::in_file(path, format_args!("cell_y: {cause}")))?;
    let mut heights = map.into_values();
    let as_read = AsRead::divide(&mut heights, cell.side());
    let heights = Field::new(grid, heights).map_err(|cause| CliError::in_file(path, cause))?;
    Ok((heights, as_read))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_sides_are_those_of_the_file_and_must_not_be_contradicted() {
        let path = Path::new("map.sdf");
        let none = [None, None];
        assert_eq!(sides(path, None, [Some(2.0), None]), Ok([Some(2.0), None]));
        assert_eq!(sides(path, Some([1e-3, 1e-3]), none), Ok([Some(1e-3), None]));
        assert_eq!(sides(path, Some([1e-3, 1.0005e-3]), [Some(1e-3), None]), Ok([Some(1e-3), None]));
        assert_eq!(sides(path, Some([1e-3, 2e-3]), none), Ok([Some(1e-3), Some(2e-3)]));
        assert_eq!(sides(path, Some([1e-3, 2e-3]), [None, Some(2e-3)]), Ok([Some(1e-3), Some(2e-3)]));
        let contradictions = [([Some(2e-3), None], "cell says 2 mm"), ([None, Some(3e-3)], "cell_y says 3 mm")];
        for (given, expected) in contradictions {
            let error = sides(path, Some([1e-3, 1e-3]), given).expect_err(expected).to_string();
            assert!(error.contains(expected) && error.contains("map.sdf"), "{error}");
        }
    }
}
