//! Points of a caller, as a map.

use super::xyz::on_grid;
use crate::{FormatError, HeightMap, Unit};

/// The map of points x, y and height, which may have any order. Points may be missing.
///
/// Coordinates and heights are numbers of an array, so they are in metres unless the user gives a unit.
///
/// # Errors
/// [`FormatError::Irregular`] when the points are not on a regular grid, and [`FormatError::Grid`] when it is too
/// large.
pub fn of_points(points: Vec<[f64; 3]>) -> Result<HeightMap, FormatError> {
    let map = on_grid(points)?;
    Ok(HeightMap { height_unit: Unit::Array, side_unit: Unit::Array, ..map })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn points_in_any_order_are_a_map_and_scattered_ones_are_not() {
        let mut points: Vec<[f64; 3]> =
            (0..12).map(|i| [f64::from(i % 4) * 0.5, f64::from(i / 4) * 0.25, f64::from(i)]).collect();
        points.reverse();
        let map = of_points(points.clone()).expect("a regular grid");
        assert_eq!(map.sides, Some([2.0, 0.75]));
        assert_eq!(map.heights.row(1), [4.0, 5.0, 6.0, 7.0]);
        assert_eq!((map.height_unit, map.side_unit), (Unit::Array, Unit::Array));
        for (i, point) in points.iter_mut().enumerate() {
            point[0] += (i as f64).sin();
        }
        assert!(of_points(points).is_err(), "scattered points");
    }
}
