//! Arrays that are lists of points or profiles, not maps.

use super::cloud::on_grid;
use super::layout::Layout;
use super::{Format, limit};
use crate::{FormatError, HeightMap, Unit};

/// Number of rows above which two or three columns are not taken as a map.
///
/// Smaller arrays are tried by hand. No list of points that is worth a map is so short.
const FEW: u64 = 8;

/// Bytes for a point: its numbers, the list, an axis to sort, its height, and its mark.
const POINT: u64 = 24 + 24 + 8 + 9;

/// The numbers of a 2-D array.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Kind {
    /// Heights.
    Map,
    /// Points, each a row x y z.
    Rows,
    /// Points, each a column x y z.
    Columns,
}

impl Kind {
    /// What an array is by its numbers of rows and columns.
    ///
    /// # Errors
    /// [`FormatError::Profile`] for two columns or less. [`FormatError::Unsupported`] when the user says that an array
    /// of another shape has points.
    pub(super) fn of(format: Format, [rows, columns]: [u64; 2], layout: Option<Layout>) -> Result<Self, FormatError> {
        let (shorter, longer) = (rows.min(columns), rows.max(columns));
        match (shorter, layout) {
            (3, Some(Layout::Xyz)) => Ok(if columns == 3 { Self::Rows } else { Self::Columns }),
            (_, Some(Layout::Xyz)) => {
                let (what, cure) =
                    (format!("points in an array of {rows} x {columns}"), "a list of points x y z has three columns");
                Err(FormatError::Unsupported { format, what, cure })
            }
            (3, None) if longer > FEW => Ok(if columns == 3 { Self::Rows } else { Self::Columns }),
            (..3, None) if longer > FEW => Err(FormatError::profile_in_array(&format!("{rows} x {columns}"), "")),
            _ => Ok(Self::Map),
        }
    }
}

/// The map of the points in an array, whose values are row by row or, of the transpose, column by column.
///
/// `shape` is that of the array, for messages.
///
/// # Errors
/// [`FormatError::Points`] when they are not on a regular grid.
pub(super) fn map(values: &[f64], kind: Kind, shape: [u64; 2]) -> Result<HeightMap, FormatError> {
    let n = values.len() / 3;
    let point = |i: usize| match kind {
        Kind::Columns => [values[i], values[n + i], values[2 * n + i]],
        _ => [values[3 * i], values[3 * i + 1], values[3 * i + 2]],
    };
    map_of(&(0..n).map(point).collect::<Vec<_>>(), shape)
}

/// The map of points that were read from an array of `rows` x `columns` numbers.
///
/// # Errors
/// Those of [`map`].
pub(super) fn map_of(points: &[[f64; 3]], [rows, columns]: [u64; 2]) -> Result<HeightMap, FormatError> {
    let refused = |problem| FormatError::Points { rows, columns, problem: Box::new(problem) };
    let has_no_place = |[x, y, _]: &[f64; 3]| !(x.is_finite() && y.is_finite());
    if let Some(i) = points.iter().position(has_no_place) {
        let message = format!("x or y of point {i} (from 0) is not finite");
        return Err(refused(FormatError::Irregular(message)));
    }
    on_grid(points).map_err(refused)
}

/// The map of points x, y and height of a program, which may have any order. Points may be missing.
///
/// Coordinates and heights are numbers of an array, so they are in metres unless the user gives a unit.
///
/// # Errors
/// [`FormatError::Irregular`] when the points are not on a regular grid, [`FormatError::Profile`] when they are on a
/// line, and [`FormatError::Grid`] when the grid is too large.
pub fn of_points(points: &[[f64; 3]]) -> Result<HeightMap, FormatError> {
    let map = on_grid(points)?;
    Ok(HeightMap { height_unit: Unit::Array, side_unit: Unit::Array, ..map })
}

/// Refuses more points than fit into `max_bytes`.
pub(super) fn check(n: u64, max_bytes: u64) -> Result<(), FormatError> {
    limit::check(n.saturating_mul(POINT), max_bytes)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn kind(shape: [u64; 2], layout: Option<Layout>) -> Option<Kind> {
        Kind::of(Format::Npy, shape, layout).ok()
    }

    #[test]
    fn three_columns_are_points_and_fewer_are_a_profile() {
        for (shape, expected) in [
            ([600, 3], Some(Kind::Rows)),
            ([3, 600], Some(Kind::Columns)),
            ([3, 3], Some(Kind::Map)),
            ([8, 3], Some(Kind::Map)),
            ([600, 4], Some(Kind::Map)),
            ([600, 2], None),
            ([1, 600], None),
        ] {
            assert_eq!(kind(shape, None), expected, "{shape:?}");
            assert_eq!(kind(shape, Some(Layout::Matrix)), Some(Kind::Map), "{shape:?}");
        }
        assert_eq!(kind([4, 3], Some(Layout::Xyz)), Some(Kind::Rows));
        assert_eq!(kind([4, 4], Some(Layout::Xyz)), None);
    }

    #[test]
    fn points_become_a_map_only_on_a_grid() {
        let points: Vec<[f64; 3]> =
            (0..12).rev().map(|i| [f64::from(i % 4) * 0.5, f64::from(i / 4), f64::from(i * i)]).collect();
        let rows = map(points.as_flattened(), Kind::Rows, [12, 3]).expect("a map");
        assert_eq!((rows.heights.grid().nx(), rows.heights.grid().ny(), rows.sides), (4, 3, Some([2.0, 3.0])));
        assert!(rows.heights.values().iter().zip(0..12).all(|(z, i)| (z - f64::from(i * i)).abs() < 1e-12));
        let columns: Vec<f64> = (0..3).flat_map(|axis| points.iter().map(move |point| point[axis])).collect();
        assert_eq!(map(&columns, Kind::Columns, [3, 12]), Ok(rows));
        let scattered: Vec<f64> = (0..300).map(|i| f64::from(i * i % 271)).collect();
        let error = map(&scattered, Kind::Rows, [100, 3]).expect_err("no grid").to_string();
        assert!(error.contains("an array of 100 x 3 numbers is taken as a list of points"), "{error}");
        let error = map(&[0.0, f64::NAN, 1.0], Kind::Rows, [1, 3]).expect_err("no place").to_string();
        assert!(error.contains("point 0"), "{error}");
    }
}
