//! The contact problem on uniform grids: nested grids, each solved by preconditioned projected conjugate gradients.

mod climb;
mod full_contact;
mod levels;
mod prolongation;

use rc_core::{Field, Kernel, Observer};

pub(crate) use self::climb::{Climb, Climbed, UniformDescent, coarse_tolerance};
pub(crate) use self::levels::coarsen;
pub(crate) use self::prolongation::{edge_function, edge_function_outside};
use crate::problem::Problem;
use crate::solution::{GridSolution, Status};
use crate::{Control, IterationError, IterationParams};

/// Bytes for each element that [`solve_uniform`] is assumed to need at its peak, heights included; 64 to 67 were measured at
/// 2048² and 4096².
pub const UNIFORM_BYTES_PER_ELEMENT: u64 = 80;

/// Solves the contact problem on the grid of `heights` (in λ, any mean).
///
/// Full contact is returned exactly and without iteration. Otherwise coarser grids, each with half the elements per side,
/// prepare the start on the next; on each the pressure is found by conjugate gradients preconditioned by the inverse
/// symbol masked to the contact (see `docs/uniform-solver.md` for the method and its measurements). The certificate is
/// computed from a fresh application of L, in double precision, on the pressure that is returned.
///
/// The result is bitwise the same for any number of threads.
///
/// # Errors
/// [`IterationError`]: heights that are not finite, a control or tolerance out of range, or no convergence.
pub fn solve_uniform(
    heights: &Field,
    kernel: &dyn Kernel,
    control: Control,
    params: &IterationParams,
    observer: &dyn Observer,
) -> Result<GridSolution, IterationError> {
    let problem = Problem::check(heights, control, params)?;
    if let Control::MeanPressure(mean_pressure) = control
        && let Some(solution) = full_contact::solve(heights, kernel, mean_pressure, &problem, params.tolerance)
    {
        return Ok(solution);
    }
    let climb = Climb { kernel, problem: &problem, params: *params, n_above: 0, observer };
    finish(climb.to(heights), &problem)
}

/// Wraps up what the finest level found.
fn finish(
    Climbed { descent, outcome, levels, coarser }: Climbed<'_>,
    problem: &Problem,
) -> Result<GridSolution, IterationError> {
    let grid = descent.grid();
    let (iterations, certificate) = (descent.info().iterations, outcome.certificate);
    let info = outcome.info(problem, levels, coarser);
    let (pressure, gap) = descent.into_vectors(outcome.approach + problem.offset());
    let field = |values| Field::new(grid, values).expect("a value for each element");
    let (pressure, gap) = (field(pressure), field(gap));
    let solution = GridSolution {
        pressure,
        gap,
        status: if outcome.converged { Status::Converged } else { Status::NotConverged },
        elements: None,
        info,
    };
    if outcome.converged {
        Ok(solution)
    } else {
        Err(IterationError::NotConverged { grid, iterations, certificate, solution: Box::new(solution) })
    }
}
