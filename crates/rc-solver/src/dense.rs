//! The contact problem with a dense matrix and an active set: the slow truth of the solvers.

use rc_core::{Field, Kernel, Operator};

use crate::operator::DirectSum;
use crate::problem::Problem;
use crate::support::Support;
use crate::{Control, IterationParams, ProblemError};

/// Pressures (in E*) on the grid of `heights` under a given penetration (in λ), by elimination on the elements in contact:
/// solve `Σ_j L_ij p_j = h_i - h_max + Δ` there, release elements under tension, take in elements that penetrate, until
/// neither changes the contact. Exact to rounding; O(n³): for tests on small grids.
///
/// `None` when the contact still changes after as many rounds as there are elements, which does not happen for the positive
/// definite operators of this workspace.
///
/// # Errors
/// [`ProblemError`] for heights or a penetration out of range.
pub fn solve_dense(heights: &Field, kernel: &dyn Kernel, penetration: f64) -> Result<Option<Field>, ProblemError> {
    let grid = heights.grid();
    let (support, params) = (Support::of(kernel, grid), IterationParams::relative(1e-6));
    let problem = Problem::check_on(support, heights, Control::Penetration(penetration), &params)?;
    let operator = DirectSum::new(grid, kernel);
    let prescribed: Vec<f64> = heights.values().iter().map(|h| h - problem.offset()).collect();
    // Rounding of an elimination, relative to the heights.
    let rounding = 1e-13 * problem.h_range;
    let mut contact: Vec<bool> = prescribed.iter().map(|&wanted| wanted > 0.0).collect();
    for _ in 0..grid.len() {
        let members: Vec<usize> = (0..grid.len()).filter(|&i| contact[i]).collect();
        let matrix = members.iter().map(|&i| members.iter().map(|&j| operator.coefficient(i, j)).collect()).collect();
        let solved = eliminate(matrix, members.iter().map(|&i| prescribed[i]).collect());
        let mut pressure = vec![0.0; grid.len()];
        for (&i, p) in members.iter().zip(&solved) {
            pressure[i] = *p;
        }
        let mut displacement = vec![0.0; grid.len()];
        operator.apply(&pressure, &mut displacement, &mut []);
        let mut changed = false;
        for i in 0..grid.len() {
            let released = contact[i] && pressure[i] < 0.0;
            let taken_in = !contact[i] && displacement[i] - prescribed[i] < -rounding;
            contact[i] = (contact[i] && !released) || taken_in;
            changed |= released || taken_in;
        }
        if !changed {
            return Ok(Field::new(grid, pressure).ok());
        }
    }
    Ok(None)
}

/// Solves a dense system by Gaussian elimination with row pivoting.
pub(crate) fn eliminate(mut matrix: Vec<Vec<f64>>, mut right: Vec<f64>) -> Vec<f64> {
    let n = right.len();
    for column in 0..n {
        let pivot = (column..n).max_by(|&a, &b| matrix[a][column].abs().total_cmp(&matrix[b][column].abs()));
        let pivot = pivot.unwrap_or(column);
        matrix.swap(column, pivot);
        right.swap(column, pivot);
        let (above, below) = matrix.split_at_mut(column + 1);
        let pivot_row = &above[column];
        let pivot_right = right[column];
        for (row, value) in below.iter_mut().zip(&mut right[column + 1..]) {
            let factor = row[column] / pivot_row[column];
            for (entry, pivot_entry) in row[column..].iter_mut().zip(&pivot_row[column..]) {
                *entry -= factor * pivot_entry;
            }
            *value -= factor * pivot_right;
        }
    }
    for row in (0..n).rev() {
        let known: f64 = matrix[row][row + 1..].iter().zip(&right[row + 1..]).map(|(m, x)| m * x).sum();
        right[row] = (right[row] - known) / matrix[row][row];
    }
    right
}
