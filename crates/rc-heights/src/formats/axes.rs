//! Axes of arrays, from coordinates in the same file.

use crate::FormatError;

/// Maximum deviation of a coordinate from an even spacing, in spacings.
const EVEN: f64 = 0.1;

/// Spacing of evenly spaced coordinates, negative where they decrease.
///
/// # Errors
/// [`FormatError::Irregular`] when the spacing is not even.
pub(super) fn step(name: &str, coordinates: &[f64]) -> Result<f64, FormatError> {
    let (Some(first), Some(last), true) = (coordinates.first(), coordinates.last(), coordinates.len() > 1) else {
        return Err(FormatError::Irregular(format!(
            "{name} has {} values; a grid needs at least two",
            coordinates.len()
        )));
    };
    let step = (last - first) / (coordinates.len() - 1) as f64;
    let off = |(i, at): (usize, &f64)| {
        let distance = (at - first - i as f64 * step).abs();
        distance.is_nan() || distance > EVEN * step.abs()
    };
    if step == 0.0 || !step.is_finite() {
        return Err(FormatError::Irregular(format!(
            "{name} goes from {first:e} to {last:e}; a grid needs two different finite ends"
        )));
    }
    match coordinates.iter().enumerate().position(off) {
        None => Ok(step),
        Some(i) => {
            let message = format!(
                "{name} is not evenly spaced: value {i} (from 0) is {:e}, and even spacing makes it {:e}",
                coordinates[i],
                first + i as f64 * step
            );
            Err(FormatError::Irregular(message))
        }
    }
}

/// The coordinates along x and y, from matrices of coordinates (`meshgrid`) with `nx` columns.
///
/// `None` unless x is the same in every row and y is the same in every column.
pub(super) fn of_meshes(x: &[f64], y: &[f64], nx: usize) -> Option<[Vec<f64>; 2]> {
    let same = |a: f64, b: f64| (a - b).abs() <= 1e-9 * (a.abs() + b.abs());
    let first = x.get(..nx)?;
    let rows_are_equal = x.chunks(nx).all(|row| row.iter().zip(first).all(|(a, b)| same(*a, *b)));
    let columns_are_equal = y.chunks(nx).all(|row| row.iter().all(|value| same(*value, row[0])));
    (rows_are_equal && columns_are_equal).then(|| [first.to_vec(), y.iter().step_by(nx).copied().collect()])
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_step_is_that_of_even_coordinates() {
        assert_eq!(step("x", &[1.0, 3.0, 5.0]), Ok(2.0));
        assert_eq!(step("x", &[5.0, 3.0, 1.0]), Ok(-2.0));
        for bad in [&[1.0, 3.0, 6.0][..], &[1.0], &[2.0, 2.0], &[1.0, f64::NAN, 3.0], &[0.0, f64::INFINITY]] {
            assert!(step("x", bad).is_err(), "{bad:?}");
        }
    }

    #[test]
    fn meshes_have_coordinates_of_both_sides() {
        let (x, y) = ([1.0, 2.0, 3.0, 1.0, 2.0, 3.0], [5.0, 5.0, 5.0, 7.0, 7.0, 7.0]);
        assert_eq!(of_meshes(&x, &y, 3), Some([vec![1.0, 2.0, 3.0], vec![5.0, 7.0]]));
        assert_eq!(of_meshes(&y, &x, 3), None);
    }
}
