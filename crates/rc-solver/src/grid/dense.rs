//! The contact problem with a dense matrix and an active set.
//!
//! It is the slow reference for the solvers.

use rc_core::{Field, Kernel, Operator};

use crate::grid::direct_sum::DirectSum;
use crate::problem::bounds::Bounds;
use crate::problem::checked::Problem;
use crate::problem::control::Control;
use crate::problem::error::ProblemError;
use crate::problem::params::IterationParams;
use crate::problem::support::Support;

/// Pressures under a given penetration, by elimination on the elements in contact.
///
/// The pressures are in E*, on the grid of `heights`. The penetration is in λ. Each round solves `Σ_j L_ij p_j = h_i -
/// h_max + Δ` on the elements in contact. It then releases elements under tension and takes in elements that penetrate,
/// until the contact does not change. The result is exact to rounding. The work is O(n³), so this is for tests on small
/// grids.
///
/// `None` when the contact still changes after as many rounds as there are elements. This does not happen for the
/// positive definite operators of this workspace.
///
/// # Errors
/// [`ProblemError`] for heights or a penetration out of range.
pub fn solve_dense(heights: &Field, kernel: &dyn Kernel, penetration: f64) -> Result<Option<Field>, ProblemError> {
    solve_dense_with_hardness(heights, kernel, penetration, f64::INFINITY)
}

/// State of an element in the active set.
#[derive(Clone, Copy, PartialEq, Eq)]
enum State {
    Free,
    Elastic,
    /// Its pressure is the hardness.
    Plastic,
}

/// [`solve_dense`] with pressures of at most `hardness` (in E*).
///
/// Elements that would press more have the pressure `hardness`, until they no longer overlap.
///
/// # Errors
/// [`ProblemError`] for heights, a penetration or a hardness out of range.
pub fn solve_dense_with_hardness(
    heights: &Field,
    kernel: &dyn Kernel,
    penetration: f64,
    hardness: f64,
) -> Result<Option<Field>, ProblemError> {
    let load = Bounds { control: Control::Penetration(penetration), hardness };
    let (support, params) = (Support::of(kernel, heights.grid()), IterationParams::relative(1e-6));
    let problem = Problem::check_on(support, heights, load, &params)?;
    let grid = heights.grid();
    let operator = DirectSum::new(grid, kernel);
    let prescribed: Vec<f64> = heights.values().iter().map(|h| h - problem.offset()).collect();
    // Rounding of an elimination, relative to the heights.
    let rounding = 1e-13 * problem.unit();
    let mut states: Vec<State> =
        prescribed.iter().map(|&wanted| if wanted > 0.0 { State::Elastic } else { State::Free }).collect();
    for _ in 0..grid.len() {
        let mut pressure: Vec<f64> =
            states.iter().map(|state| if *state == State::Plastic { hardness } else { 0.0 }).collect();
        let mut displacement = vec![0.0; grid.len()];
        operator.apply(&pressure, &mut displacement, &mut []);
        let members: Vec<usize> = (0..grid.len()).filter(|&i| states[i] == State::Elastic).collect();
        let matrix = members.iter().map(|&i| members.iter().map(|&j| operator.coefficient(i, j)).collect()).collect();
        let solved = eliminate(matrix, members.iter().map(|&i| prescribed[i] - displacement[i]).collect());
        for (&i, p) in members.iter().zip(&solved) {
            pressure[i] = *p;
        }
        operator.apply(&pressure, &mut displacement, &mut []);
        let next = |i: usize| {
            let gap = displacement[i] - prescribed[i];
            match states[i] {
                State::Elastic if pressure[i] < 0.0 => State::Free,
                State::Elastic if pressure[i] > hardness => State::Plastic,
                State::Free if gap < -rounding => State::Elastic,
                State::Plastic if gap > rounding => State::Elastic,
                same => same,
            }
        };
        let changed: Vec<State> = (0..grid.len()).map(next).collect();
        if changed == states {
            return Ok(Field::new(grid, pressure).ok());
        }
        states = changed;
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
