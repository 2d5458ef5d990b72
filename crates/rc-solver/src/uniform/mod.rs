//! The contact problem on uniform grids: nested grids, each solved by preconditioned projected conjugate gradients.

mod descent;
mod full_contact;
mod levels;
mod prolongation;
mod rows;

use rayon::prelude::*;
use rc_core::{Event, Field, Kernel, Observer};

use crate::solution::{LevelInfo, Solution, SolveInfo, Status};
use crate::{Control, SolveError, SolveParams};
use descent::{Descent, Outcome};
pub(crate) use levels::coarsen;

/// Grids with fewer elements per side cost nothing, so no coarser ones prepare them.
const SMALLEST_SIDE: usize = 64;

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
    let mut start: Option<Field> = None;
    for (level, level_heights) in coarse.iter().rev().chain(std::iter::once(heights)).enumerate() {
        let finest = level + 1 == n_levels;
        let grid = level_heights.grid();
        observer.notify(&Event::Level { grid, level, n_levels });
        let tolerance =
            if finest { params.tolerance } else { coarse_tolerance(n_levels - 2 - level).max(params.tolerance) };
        let mut descent = Descent::new(level_heights, kernel, &problem, start.take());
        let outcome = descent.run(tolerance, params.max_iterations, finest, observer);
        infos.push(descent.info());
        if finest {
            return finish(descent, &outcome, &problem, infos);
        }
        start = Some(prolongation::prolong(&descent));
    }
    unreachable!("the finest level returns")
}

/// Tolerance of the level that has `below` levels between it and the finest.
fn coarse_tolerance(below: usize) -> f64 {
    (COARSE_TOLERANCE * COARSENING.powi(below as i32)).min(COARSEST_TOLERANCE)
}

/// Wraps up what the finest level found.
fn finish(
    descent: Descent<'_>,
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
    let (pressure, gap) = descent.into_fields(outcome.approach + problem.offset());
    let solution = Solution { pressure, gap, status: Status::Converged, elements: None, info };
    if outcome.converged {
        Ok(solution)
    } else {
        Err(SolveError::NotConverged { grid, iterations, certificate, solution: Box::new(solution) })
    }
}

struct HeightStatistics {
    greatest: f64,
    least: f64,
    mean: f64,
}

impl HeightStatistics {
    /// In one pass, in parallel over rows.
    fn of(heights: &Field) -> Result<Self, SolveError> {
        let nx = heights.grid().nx();
        let rows: Vec<(f64, f64, f64)> = heights
            .values()
            .par_chunks(nx)
            .map(|row| {
                row.iter().fold((f64::NEG_INFINITY, f64::INFINITY, 0.0), |(max, min, sum), &h| {
                    (f64::max(max, h), f64::min(min, h), sum + h)
                })
            })
            .collect();
        // A sum that is not finite gives away NaN and infinities; so does an overflow, which finds none.
        for (iy, (_, _, sum)) in rows.iter().enumerate() {
            if let Some(ix) = (!sum.is_finite()).then(|| heights.row(iy).iter().position(|h| !h.is_finite())).flatten()
            {
                return Err(SolveError::Height { ix, iy, value: heights.at(ix, iy) });
            }
        }
        Ok(Self {
            greatest: rows.iter().map(|row| row.0).fold(f64::NEG_INFINITY, f64::max),
            least: rows.iter().map(|row| row.1).fold(f64::INFINITY, f64::min),
            mean: rows.iter().map(|row| row.2).sum::<f64>() / heights.grid().len() as f64,
        })
    }
}

/// A checked problem, in the quantities that every level shares.
pub(crate) struct Problem {
    pub(crate) control: Control,
    /// Greatest height, on the finest grid.
    pub(crate) h_max: f64,
    /// Mean height, on the finest grid.
    pub(crate) h_mean: f64,
    /// H = h_max - h_min, which tolerances multiply.
    pub(crate) h_range: f64,
}

impl Problem {
    pub(crate) fn check(heights: &Field, control: Control, params: &SolveParams) -> Result<Self, SolveError> {
        let HeightStatistics { greatest: h_max, least: h_min, mean: h_mean } = HeightStatistics::of(heights)?;
        let h_range = h_max - h_min;
        let full_contact = h_max - h_mean;
        match control {
            Control::MeanPressure(value) if !(value > 0.0 && value.is_finite()) => {
                return Err(SolveError::MeanPressure { value });
            }
            // Also refuses every penetration into a flat surface, whose full contact is at zero.
            Control::Penetration(value) if !(value > 0.0 && value < full_contact) => {
                return Err(SolveError::Penetration { value, full_contact });
            }
            Control::MeanPressure(_) | Control::Penetration(_) => {}
        }
        let (value, smallest) = (params.tolerance, SolveParams::SMALLEST_TOLERANCE);
        if !(value >= smallest && value < 1.0) {
            return Err(SolveError::Tolerance { value, smallest });
        }
        Ok(Self { control, h_max, h_mean, h_range })
    }

    /// The constant c in `g = L p - h + c`: h_max - Δ under penetration control; under pressure control Δ is a multiplier
    /// and c is left out.
    pub(crate) fn offset(&self) -> f64 {
        match self.control {
            Control::MeanPressure(_) => 0.0,
            Control::Penetration(penetration) => self.h_max - penetration,
        }
    }
}
