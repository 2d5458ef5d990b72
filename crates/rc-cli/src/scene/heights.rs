//! Height maps from files, in metres, and their checks.

use std::path::Path;

use rc_core::{Field, Grid, PeriodicCell};
use rc_heights::{Format, HeightMap, Layout, ReadNote, ReadParams, SAME_LENGTH, Scales};

use super::as_read::AsRead;
use super::file;
use crate::error::CliError;
use crate::files::names::{HEIGHTS_FILE, RECORD_FILE, RESIDUAL_FILE, SCENE_FILE, SUMMARY_FILE};
use rc_core::quantity::engineering;

/// Reads a height map of any format of `rc-heights`, in metres.
///
/// Unmeasured points are `NaN`. Row `iy` of the file is row `iy` of the field. The map in a folder of `rc surface` or
/// `rc solve` is in metres, and has the size of its cell.
///
/// # Errors
/// [`CliError::Input`] when the file cannot be read, is damaged or does not have the channel, or when `scales` does not
/// fit its units.
pub fn read(path: &Path, params: &ReadParams, scales: Scales) -> Result<HeightMap, CliError> {
    let of_folder = sides_in_folder(path);
    if of_folder.is_some() && scales != Scales::default() {
        let message =
            "the map in a folder of rc surface or rc solve is in metres; omit unit, height_unit and height_scale";
        return Err(CliError::in_file(path, message));
    }
    let map = rc_heights::read_with(path, params)?.in_metres(scales).map_err(|cause| CliError::in_file(path, cause))?;
    Ok(HeightMap { sides: map.sides.or(of_folder), ..map })
}

/// The sides (m) of the map in a folder of `rc surface` or `rc solve`, or `None` for any other file.
fn sides_in_folder(path: &Path) -> Option<[f64; 2]> {
    let is_map = path.file_name().is_some_and(|name| name == HEIGHTS_FILE || name == RESIDUAL_FILE);
    let folder = path.parent().filter(|_| is_map)?;
    if ![RECORD_FILE, SUMMARY_FILE].iter().any(|name| folder.join(name).is_file()) {
        return None;
    }
    let scene = file::read(&folder.join(SCENE_FILE)).ok()?.surface;
    scene.cell.map(|cell| [cell, scene.cell_y.unwrap_or(cell)])
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

/// Sides of the cell of a map, and what was assumed about it.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct CellOfMap {
    /// Side along x (m), if it is known.
    pub(crate) cell: Option<f64>,
    /// Side along y (m). It is `None` for a square with as many points along y as along x.
    pub(crate) cell_y: Option<f64>,
    /// What neither the file nor the user says, one clause each.
    pub(crate) assumed: Vec<String>,
}

impl CellOfMap {
    /// The cell of a map in metres, whose sides are `given` or in its file.
    ///
    /// If both give sides, they must be equal, unless the file does not name their unit. Without a side along y,
    /// spacings are equal along x and y.
    ///
    /// # Errors
    /// [`CliError::Input`] when the two differ.
    pub(crate) fn of(path: &Path, map: &HeightMap, given: [Option<f64>; 2]) -> Result<Self, CliError> {
        let without_unit = map.notes.contains(&ReadNote::SidesAssumedMetres);
        let wins = without_unit && given[0].is_some();
        let notes = map.notes.iter().filter(|note| note.is_assumption());
        let notes = notes.filter(|note| !(wins && **note == ReadNote::SidesAssumedMetres));
        let assumed = notes.map(ToString::to_string).collect();
        let grid = map.heights.grid();
        let ([given_x, given_y], points) = (given, [grid.nx(), grid.ny()]);
        let found = Self { assumed, ..Self::default() };
        match map.sides {
            Some(sides) if !wins => Ok(Self { assumed: found.assumed, ..Self::of_sides(path, sides, given, points)? }),
            // The ratio of sides has no unit.
            Some([x, y]) => Ok(found.with(given_x, given_y.or(given_x.map(|given| given * (y / x))), points)),
            None => Ok(found.of_points(given_x, given_y, points)),
        }
    }

    /// The cell of a map of nx and ny `points` with known sides (m), which those `given` must not contradict.
    ///
    /// # Errors
    /// [`CliError::Input`] when they differ.
    pub(crate) fn of_sides(
        path: &Path,
        sides: [f64; 2],
        given: [Option<f64>; 2],
        points: [usize; 2],
    ) -> Result<Self, CliError> {
        check_given(path, sides, given)?;
        Ok(Self::default().with(Some(given[0].unwrap_or(sides[0])), Some(given[1].unwrap_or(sides[1])), points))
    }

    /// The cell of a map of nx and ny `points` of which only the given sides are known.
    pub(crate) fn of_points(self, x: Option<f64>, y: Option<f64>, points: [usize; 2]) -> Self {
        let [nx, ny] = points.map(|n| n as f64);
        if let (Some(x), None, true) = (x, y, points[0] != points[1]) {
            let mut equal = self.with(Some(x), Some(x * (ny / nx)), points);
            equal.assumed.push(format!(
                "equal spacings along x and y, so that the cell is {} by {}; --cell-y says otherwise",
                engineering(x, "m"),
                engineering(x * (ny / nx), "m")
            ));
            return equal;
        }
        self.with(x, y, points)
    }

    /// The same assumptions with these sides. Spacings that are nearly equal are equal, because the adaptive method needs
    /// squares, and no instrument is calibrated better than [`SAME_LENGTH`].
    fn with(self, x: Option<f64>, y: Option<f64>, points: [usize; 2]) -> Self {
        let [nx, ny] = points.map(|n| n as f64);
        let has_squares = x.zip(y).is_none_or(|(x, y)| same(x / nx, y / ny));
        let cell_y = match (has_squares, points[0] == points[1]) {
            (true, true) => None,
            (true, false) => x.map(|x| x * (ny / nx)).or(y),
            (false, _) => y,
        };
        Self { cell: x, cell_y, ..self }
    }
}

/// Whether two lengths are the same.
pub(crate) fn same(a: f64, b: f64) -> bool {
    (a / b - 1.0).abs() <= SAME_LENGTH
}

/// Refuses sides that contradict those of the file.
fn check_given(path: &Path, of_file: [f64; 2], given: [Option<f64>; 2]) -> Result<(), CliError> {
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
    Ok(())
}

/// The heights of a map (m) on the grid of its points in `cell`.
///
/// # Errors
/// [`CliError::Input`] when the ratio of the cell's sides is too large.
pub(crate) fn in_cell(path: &Path, map: Field, cell: PeriodicCell) -> Result<Field, CliError> {
    let grid = Grid::in_cell(map.grid().nx(), map.grid().ny(), cell.ratio())
        .map_err(|cause| CliError::in_file(path, format_args!("cell_y: {cause}")))?;
    Field::new(grid, map.into_values()).map_err(|cause| CliError::in_file(path, cause))
}

/// Heights (m) in λ, which is `side` (m), with the data that restore them.
pub(crate) fn divided(mut heights: Field, side: f64) -> (Field, AsRead) {
    let as_read = AsRead::divide(heights.values_mut(), side);
    (heights, as_read)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn map(nx: usize, ny: usize, sides: Option<[f64; 2]>) -> HeightMap {
        HeightMap { sides, ..HeightMap::bare(Field::zeros(Grid::new(nx, ny).expect("a grid"))) }
    }

    #[test]
    fn the_sides_are_those_of_the_file_and_must_not_be_contradicted() {
        let path = Path::new("map.sdf");
        let cell = |map: &HeightMap, given| CellOfMap::of(path, map, given).map(|cell| [cell.cell, cell.cell_y]);
        let square = |sides| map(4, 4, sides);
        let none = [None, None];
        assert_eq!(cell(&square(None), [Some(2.0), None]), Ok([Some(2.0), None]));
        assert_eq!(cell(&square(Some([1e-3, 1e-3])), none), Ok([Some(1e-3), None]));
        assert_eq!(cell(&square(Some([1e-3, 1.0005e-3])), [Some(1e-3), None]), Ok([Some(1e-3), None]));
        assert_eq!(cell(&square(Some([1e-3, 2e-3])), none), Ok([Some(1e-3), Some(2e-3)]));
        assert_eq!(cell(&square(Some([1e-3, 2e-3])), [None, Some(2e-3)]), Ok([Some(1e-3), Some(2e-3)]));
        // Without the side along y, a later reading would assume equal spacings.
        assert_eq!(cell(&map(8, 4, Some([1e-3, 1e-3])), none), Ok([Some(1e-3), Some(1e-3)]));
        let nearly = cell(&map(8, 4, Some([1e-3, 0.50003e-3])), none);
        assert_eq!(nearly, Ok([Some(1e-3), Some(0.5e-3)]), "elements 0.006 % off square are squares");
        let contradictions = [([Some(2e-3), None], "cell says 2 mm"), ([None, Some(3e-3)], "cell_y says 3 mm")];
        for (given, expected) in contradictions {
            let error = cell(&square(Some([1e-3, 1e-3])), given).expect_err(expected).to_string();
            assert!(error.contains(expected) && error.contains("map.sdf"), "{error}");
        }
    }

    #[test]
    fn spacings_are_equal_where_nothing_says_otherwise() {
        let of = |map: &HeightMap, given| CellOfMap::of(Path::new("map.npy"), map, given).expect("a cell");
        let equal = of(&map(8, 4, None), [Some(2.0), None]);
        assert_eq!((equal.cell, equal.cell_y), (Some(2.0), Some(1.0)));
        assert!(equal.assumed[0].contains("equal spacings"), "{equal:?}");
        assert_eq!(of(&map(8, 4, None), [Some(2.0), Some(3.0)]).assumed, Vec::<String>::new());
        // Sides without a unit give only their ratio when the user gives the cell.
        let unnamed = map(8, 4, Some([2.0, 3.0])).with_note(ReadNote::SidesAssumedMetres);
        let given = of(&unnamed, [Some(4e-6), None]);
        assert_eq!((given.cell, given.cell_y, given.assumed), (Some(4e-6), Some(6e-6), Vec::new()));
        let assumed = of(&unnamed, [None, None]);
        assert_eq!((assumed.cell, assumed.cell_y, assumed.assumed.len()), (Some(2.0), Some(3.0), 1));
    }
}
