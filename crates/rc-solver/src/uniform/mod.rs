//! The contact problem on uniform grids: nested grids, each solved by preconditioned projected conjugate gradients.

mod full_contact;
mod levels;
mod prolongation;

use rc_core::{Event, Field, Kernel, Observer};

use crate::descent::{Descent, Machinery, Outcome, Start};
use crate::fft::{Convolution, SymbolTable};
use crate::problem::Problem;
use crate::solution::{LevelInfo, Solution, SolveInfo, Status};
use crate::{Control, SolveError, SolveParams};
pub(crate) use levels::coarsen;
pub(crate) use prolongation::{level_function, outside_level, prolong};

/// Grids with fewer elements per side cost nothing, so no coarser ones prepare them.
pub(crate) const SMALLEST_SIDE: usize = 64;

/// Tolerance of the level below the finest: its discretisation error is far above this.
const COARSE_TOLERANCE: f64 = 1e-4;

/// Levels further down may be solved less accurately by this factor each, up to a limit: they only prepare the next.
const COARSENING: f64 = 3.0;
const COARSEST_TOLERANCE: f64 = 1e-3;

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
/// [`SolveError`]: heights that are not finite, a control or tolerance out of range, or no convergence.
pub fn solve_uniform(
    heights: &Field,
    kernel: &dyn Kernel,
    control: Control,
    params: &SolveParams,
    observer: &dyn Observer,
) -> Result<Solution, SolveError> {
    let problem = Problem::check(heights, control, params)?;
    if let Control::MeanPressure(mean_pressure) = control
        && let Some(solution) = full_contact::solve(heights, kernel, mean_pressure, &problem)
    {
        return Ok(solution);
    }
    let coarse = coarsen(heights, SMALLEST_SIDE);
    let n_levels = coarse.len() + 1;
    let mut infos: Vec<LevelInfo> = Vec::with_capacity(n_levels);
    let mut start: Option<Vec<f64>> = None;
    for (level, level_heights) in coarse.iter().rev().chain(std::iter::once(heights)).enumerate() {
        let finest = level + 1 == n_levels;
        let grid = level_heights.grid();
        observer.notify(&Event::Level { grid, level, n_levels });
        let tolerance =
            if finest { params.tolerance } else { coarse_tolerance(n_levels - 2 - level).max(params.tolerance) };
        let mut descent = descent(level_heights, kernel, &problem, start.take());
        let outcome = descent.run(tolerance, params.max_iterations, finest, observer);
        infos.push(descent.info());
        if finest {
            return finish(descent, &outcome, &problem, infos);
        }
        start = Some(prolong(&descent));
    }
    unreachable!("the finest level returns")
}

/// A descent on a uniform grid.
pub(crate) type UniformDescent<'a> = Descent<'a, Convolution<f32>, Convolution<f64>>;

/// A descent on the grid of `heights` from `start`, if there is one.
pub(crate) fn descent<'a>(
    heights: &'a Field,
    kernel: &dyn Kernel,
    problem: &'a Problem,
    start: Option<Vec<f64>>,
) -> UniformDescent<'a> {
    let grid = heights.grid();
    let fresh_response = SymbolTable::new(grid, kernel.symbol(grid));
    let machinery = Machinery {
        corrections: Convolution::new(grid),
        response: fresh_response.map(|value| value as f32),
        preconditioner: fresh_response.inverse(grid).map(|value| value as f32),
        fresh: Convolution::new(grid),
        fresh_response,
    };
    Descent::new(heights.values(), grid, machinery, problem, start.map_or(Start::Nothing, Start::Pressure))
}

/// Tolerance of the level that has `below` levels between it and the finest.
pub(crate) fn coarse_tolerance(below: usize) -> f64 {
    (COARSE_TOLERANCE * COARSENING.powi(below as i32)).min(COARSEST_TOLERANCE)
}

/// Wraps up what the finest level found.
fn finish(
    descent: UniformDescent<'_>,
    outcome: &Outcome,
    problem: &Problem,
    levels: Vec<LevelInfo>,
) -> Result<Solution, SolveError> {
    let grid = descent.grid();
    let (iterations, certificate) = (descent.info().iterations, outcome.certificate);
    let info = SolveInfo {
        certificate,
        mean_pressure: outcome.mean_pressure,
        penetration: problem.h_max + outcome.approach,
        penetration_full_contact: problem.h_max - problem.h_mean,
        elastic_energy: outcome.elastic_energy,
        levels,
    };
    let (pressure, gap) = descent.into_vectors(outcome.approach + problem.offset());
    let field = |values| Field::new(grid, values).expect("a value for each element");
    let (pressure, gap) = (field(pressure), field(gap));
    let solution = Solution { pressure, gap, status: Status::Converged, elements: None, info };
    if outcome.converged {
        Ok(solution)
    } else {
        Err(SolveError::NotConverged { grid, iterations, certificate, solution: Box::new(solution) })
    }
}
