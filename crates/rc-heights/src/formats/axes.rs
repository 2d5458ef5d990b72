//! Axes of arrays, from coordinates in the same file.

use crate::{Format, FormatError};

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

/// Coordinates along x and y, and whether the first index of the matrices is x.
pub(super) type Meshes = ([Vec<f64>; 2], bool);

/// The coordinates in matrices of coordinates (`meshgrid`) with `columns` columns, row by row.
///
/// The last index is x (`indexing='xy'`), or the first is (`indexing='ij'`). `None` unless x and y each change along
/// one index only.
pub(super) fn of_meshes(x: &[f64], y: &[f64], columns: usize) -> Option<Meshes> {
    let same = |a: f64, b: f64| (a - b).abs() <= 1e-9 * (a.abs() + b.abs());
    let along_rows = |values: &[f64]| {
        let first = values.get(..columns)?;
        let same_rows = values.chunks(columns).all(|row| row.iter().zip(first).all(|(a, b)| same(*a, *b)));
        same_rows.then(|| first.to_vec())
    };
    let along_columns = |values: &[f64]| {
        let same_columns = values.chunks(columns).all(|row| row.iter().all(|value| same(*value, row[0])));
        same_columns.then(|| values.iter().step_by(columns).copied().collect::<Vec<f64>>())
    };
    let last = || Some(([along_rows(x)?, along_columns(y)?], false));
    let first = || Some(([along_columns(x)?, along_rows(y)?], true));
    last().or_else(first)
}

/// Refuses an array whose name is that of coordinates, and whose values are too: they change along one index at most.
pub(super) fn refuse_mesh(format: Format, name: &str, values: &[f64], columns: usize) -> Result<(), FormatError> {
    let rows = || values.chunks(columns);
    let same_rows = || rows().all(|row| row == &values[..columns.min(values.len())]);
    let same_columns = || rows().all(|row| row.iter().all(|value| value.total_cmp(&row[0]).is_eq()));
    let is_mesh = axis_of(name).is_some() && (same_rows() || same_columns());
    if is_mesh { Err(FormatError::Missing { format, field: "an array beside the coordinates" }) } else { Ok(()) }
}

/// Words beside the letter of an axis in the names of coordinates.
const BESIDE: [&str; 19] = [
    "grid",
    "mesh",
    "meshgrid",
    "coord",
    "coords",
    "coordinate",
    "coordinates",
    "axis",
    "pos",
    "position",
    "positions",
    "vec",
    "vector",
    "data",
    "array",
    "matrix",
    "values",
    "vals",
    "loc",
];

/// The axis whose coordinates an array of this name has: 0 for x, 1 for y.
///
/// The name is the letter, alone, twice, or beside words and a unit, as in `XX`, `y_grid` and `xcoords_um`.
pub(super) fn axis_of(name: &str) -> Option<usize> {
    let name = name.rsplit('/').next().unwrap_or_default().to_lowercase();
    let is_beside = |word: &str| word.is_empty() || BESIDE.contains(&word) || super::unit::length(word).is_some();
    let words = name.split(|c: char| !c.is_alphanumeric()).filter(|word| !is_beside(word));
    let [word] = <[&str; 1]>::try_from(words.collect::<Vec<_>>()).ok()?;
    let of = |letter: &str| {
        let double = letter.repeat(2);
        let is_letter = |rest: &str| {
            rest == letter
                || rest == double
                || rest.strip_prefix(letter).is_some_and(|end| ["s", "i", "q", "v", "g", "m"].contains(&end))
        };
        let before = BESIDE.iter().filter_map(|beside| word.strip_prefix(beside));
        let after = BESIDE.iter().filter_map(|beside| word.strip_suffix(beside));
        is_letter(word) || before.chain(after).any(is_letter)
    };
    ["x", "y"].into_iter().position(of)
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
        assert_eq!(of_meshes(&x, &y, 3), Some(([vec![1.0, 2.0, 3.0], vec![5.0, 7.0]], false)));
        assert_eq!(of_meshes(&y, &x, 3), Some(([vec![5.0, 7.0], vec![1.0, 2.0, 3.0]], true)));
        assert_eq!(of_meshes(&x, &x, 3), None);
    }

    #[test]
    fn coordinates_have_the_letter_of_their_axis_in_their_name() {
        for name in ["x", "X", "XX", "xx", "x_grid", "XGrid", "gridX", "x_um", "Xcoords (mm)", "xi", "scan/x", "pos_x"]
        {
            assert_eq!(axis_of(name), Some(0), "{name}");
            assert_eq!(axis_of(&name.replace('x', "y").replace('X', "Y")), Some(1), "{name}");
        }
        for name in ["z", "Z", "height", "max", "xyz", "flux", "x_slope", "dx", "data", "axis", "x_y", ""] {
            assert_eq!(axis_of(name), None, "{name}");
        }
    }
}
