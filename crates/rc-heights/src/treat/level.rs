//! Removal of a form: mean, plane or quadratic.
//!
//! The form is fitted by least squares to the measured points.

use std::str::FromStr;

use rc_core::DVec2;

use super::error::TreatError;
use super::moments::mean;
use super::treatment::Level;
use crate::HeightMap;

impl Level {
    /// Number of terms of the polynomial, on a map or on a profile, which is a map of one row.
    fn n_terms(self, is_profile: bool) -> usize {
        match (self, is_profile) {
            (Self::Mean, _) => 1,
            (Self::Plane, true) => 2,
            (Self::Plane, false) | (Self::Quadratic, true) => 3,
            (Self::Quadratic, false) => 6,
        }
    }
}

impl FromStr for Level {
    type Err = TreatError;

    fn from_str(text: &str) -> Result<Self, TreatError> {
        let form = [Self::Mean, Self::Plane, Self::Quadratic].into_iter().find(|form| form.to_string() == text);
        let expected = "a form to remove: mean, plane or quadratic";
        form.ok_or_else(|| TreatError::Unknown { found: text.to_owned(), expected })
    }
}

/// Maximum number of terms of a form.
const MOST: usize = 6;

/// The terms at a point of [-1, 1]².
///
/// They are Legendre polynomials, which are almost orthogonal on a grid.
fn terms(DVec2 { x, y }: DVec2) -> [f64; MOST] {
    [1.0, x, y, x * y, 1.5 * x * x - 0.5, 1.5 * y * y - 0.5]
}

/// The terms at a point of [-1, 1] along a profile.
fn terms_along(x: f64) -> [f64; MOST] {
    [1.0, x, 1.5 * x * x - 0.5, 0.0, 0.0, 0.0]
}

pub(super) fn level(mut map: HeightMap, form: Level) -> Result<HeightMap, TreatError> {
    let grid = map.heights.grid();
    let is_profile = grid.ny() == 1;
    let at = |i: usize| {
        let place = 2.0 * grid.centre(i % grid.nx(), i / grid.nx()) - 1.0;
        if is_profile { terms_along(place.x) } else { terms(place) }
    };
    // Heights are taken about their mean. Otherwise a fit of nanometres on metres would lose digits.
    let (mean, points) = mean(&map.heights);
    let n = form.n_terms(is_profile);
    let (mut matrix, mut right) = ([[0.0; MOST]; MOST], [0.0; MOST]);
    for (i, height) in map.heights.values().iter().enumerate().filter(|(_, height)| !height.is_nan()) {
        let t = at(i);
        for row in 0..n {
            right[row] += t[row] * (height - mean);
            for column in 0..=row {
                matrix[row][column] += t[row] * t[column];
            }
        }
    }
    let fit = solve(&mut matrix, right, n).ok_or(TreatError::Undetermined { form, points })?;
    for (i, height) in map.heights.values_mut().iter_mut().enumerate() {
        let value: f64 = fit[..n].iter().zip(at(i)).map(|(factor, term)| factor * term).sum();
        *height -= mean + value;
    }
    Ok(map)
}

/// Solves the symmetric positive system whose lower half is given, by its Cholesky factor.
///
/// `None` if the matrix is singular.
fn solve(matrix: &mut [[f64; MOST]; MOST], mut right: [f64; MOST], n: usize) -> Option<[f64; MOST]> {
    for j in 0..n {
        let diagonal = matrix[j][j];
        for k in 0..j {
            matrix[j][j] -= matrix[j][k] * matrix[j][k];
        }
        // For points on a line or on a few rows, only rounding remains here.
        if matrix[j][j].is_nan() || matrix[j][j] <= 1e-10 * diagonal {
            return None;
        }
        matrix[j][j] = matrix[j][j].sqrt();
        for i in j + 1..n {
            for k in 0..j {
                matrix[i][j] -= matrix[i][k] * matrix[j][k];
            }
            matrix[i][j] /= matrix[j][j];
        }
    }
    for i in 0..n {
        for k in 0..i {
            right[i] -= matrix[i][k] * right[k];
        }
        right[i] /= matrix[i][i];
    }
    for i in (0..n).rev() {
        for k in i + 1..n {
            right[i] -= matrix[k][i] * right[k];
        }
        right[i] /= matrix[i][i];
    }
    Some(right)
}
