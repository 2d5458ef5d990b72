//! The contact problem on nested uniform grids.
//!
//! Preconditioned projected conjugate gradients solve each grid.

use rc_core::{Boundary, Field, Kernel, Observer};

use crate::descent::info::GridSolution;
use crate::grid::full_contact;
use crate::levels::gap_levels;
use crate::levels::grids::{GridLevels, SMALLEST_SIDE, coarser_heights};
use crate::levels::nested::Nested;
use crate::problem::bounds::Bounds;
use crate::problem::checked::Problem;
use crate::problem::error::ProblemError;
use crate::problem::params::IterationParams;
use crate::problem::support::Support;

/// Bytes for each element that the uniform method is assumed to need, heights included.
///
/// The number is for its peak. 58 to 60 were measured at 2048² and 4096² with generated heights.
pub const UNIFORM_BYTES_PER_ELEMENT: u64 = 80;

/// Bytes for each element of heights with free borders.
///
/// Their transforms are padded to twice as many elements along both axes, or a few more.
pub(crate) const FREE_BYTES_PER_ELEMENT: u64 = 180;

/// Solves the contact problem on the grid of `heights` (in λ, any mean).
///
/// Full contact of a periodic cell is returned exactly and without iteration. Otherwise coarser grids, each with about
/// half the elements per side, prepare the start on the next. On each grid, preconditioned conjugate gradients find the
/// pressure. The preconditioner is the inverse symbol between two extensions of residuals (see
/// `docs/uniform-grid.md`, and `docs/constants.md` for measurements). The certificate comes from a fresh application of
/// L, in double precision, on the returned pressure.
///
/// The result is bitwise the same for any number of threads.
///
/// # Errors
/// [`ProblemError`].
pub(crate) fn solve_uniform(
    heights: &Field,
    kernel: &dyn Kernel,
    bounds: impl Into<Bounds>,
    params: &IterationParams,
    observer: &dyn Observer,
) -> Result<GridSolution, ProblemError> {
    solve(heights, kernel, bounds.into(), params, observer, Ways::Rounds).map(|(solution, _)| solution)
}

/// [`solve_uniform`], which may solve the finest grids for the gap of nearly full contact. The result says whether.
pub(crate) fn solve_uniform_or_gap(
    heights: &Field,
    kernel: &dyn Kernel,
    bounds: impl Into<Bounds>,
    params: &IterationParams,
    observer: &dyn Observer,
) -> Result<(GridSolution, bool), ProblemError> {
    solve(heights, kernel, bounds.into(), params, observer, Ways::RoundsOrGap)
}

/// How grids may be solved.
#[derive(Clone, Copy, PartialEq)]
enum Ways {
    Rounds,
    RoundsOrGap,
}

fn solve(
    heights: &Field,
    kernel: &dyn Kernel,
    bounds: Bounds,
    params: &IterationParams,
    observer: &dyn Observer,
    ways: Ways,
) -> Result<(GridSolution, bool), ProblemError> {
    let problem = Problem::check_on(Support::of(kernel, heights.grid()), heights, bounds, params)?;
    let boundary = problem.support.boundary;
    let coarser = coarser_heights(heights, boundary, SMALLEST_SIDE);
    if boundary == Boundary::Periodic
        && let Some(mean_pressure) = full_contact::mean_pressure(&problem)
        && let Some(solution) = full_contact::solve((heights, &coarser), kernel, mean_pressure, &problem, params.bound)
    {
        return Ok((solution, false));
    }
    let grids = GridLevels::new(kernel, &problem, (heights, &coarser), 0);
    let nested = Nested { problem: &problem, params: *params, n_levels: grids.n_levels(), observer };
    let (((descent, outcome), history), is_from_gap) = match ways {
        Ways::Rounds => (grids.solve_all(&nested), false),
        Ways::RoundsOrGap => gap_levels::solve(&grids, kernel, &nested),
    };
    Ok((descent.into_solution(&outcome, history.levels, history.coarser), is_from_gap))
}
