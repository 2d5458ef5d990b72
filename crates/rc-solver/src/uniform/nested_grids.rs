//! From the coarsest of nested grids to the finest, each of which prepares the start on the next.

use rayon::prelude::*;
use rc_core::{Event, Field, Kernel, Observer};

use super::levels::nest_without_pits;
use super::prolongation::prolong;
use crate::IterationParams;
use crate::descent::{Descent, DescentObserver, Goal, Outcome, Start, uniform_operators};
use crate::problem::Problem;
use crate::solution::{LevelInfo, LevelValues};

/// Grids with fewer elements per side cost nothing, so no coarser ones prepare them.
pub(super) const SMALLEST_SIDE: usize = 64;

/// Nested grids: what their levels share.
pub(crate) struct NestedGrids<'a> {
    pub(crate) kernel: &'a dyn Kernel,
    pub(crate) problem: &'a Problem,
    pub(crate) params: IterationParams,
    /// Levels that others will add above the last grid; without any, it is solved to the tolerance and certified.
    pub(crate) n_above: usize,
    pub(crate) observer: &'a dyn Observer,
}

/// The solved finest of nested grids.
pub(crate) struct FinestGrid<'a> {
    pub(crate) descent: Descent<'a>,
    pub(crate) outcome: Outcome,
    /// The work on all grids, coarsest first.
    pub(crate) levels: Vec<LevelInfo>,
    /// What the level below the finest found, if that halves it; the last grid when there are others above it.
    pub(crate) coarser: Option<LevelValues>,
}

impl<'a> NestedGrids<'a> {
    /// Solves on coarser grids and then on that of `heights`.
    pub(crate) fn solve(&self, heights: &'a Field) -> FinestGrid<'a> {
        self.solve_from(&nest_without_pits(heights, SMALLEST_SIDE, self.problem.support.boundary), heights)
    }

    /// Solves on coarser grids with these heights, finest first, and then on that of `heights`.
    pub(super) fn solve_from(&self, coarser: &[Field], heights: &'a Field) -> FinestGrid<'a> {
        let n_levels = coarser.len() + 1 + self.n_above;
        let finer = coarser.iter().rev().skip(1).chain([heights]).map(Field::grid);
        let (mut levels, mut start, mut values) = (Vec::with_capacity(n_levels), Start::Nothing, None);
        for (heights, finer) in coarser.iter().rev().zip(finer) {
            let (descent, outcome) = self.solve_level(heights, start, n_levels, &mut levels);
            let is_half = [heights.grid().nx() * 2, heights.grid().ny() * 2] == [finer.nx(), finer.ny()];
            values = self.values(&descent, &outcome, n_levels - levels.len()).filter(|_| is_half);
            start = Start::Pressure(prolong(&descent, finer));
        }
        let (descent, outcome) = self.solve_level(heights, start, n_levels, &mut levels);
        let coarser = if self.n_above == 0 { values } else { self.values(&descent, &outcome, self.n_above) };
        FinestGrid { descent, outcome, levels, coarser }
    }

    /// What a grid with `above` levels above it found; nobody asks when there is more than one.
    fn values(&self, descent: &Descent<'_>, outcome: &Outcome, above: usize) -> Option<LevelValues> {
        (above == 1).then(|| LevelValues {
            rms_pressure: rms(descent.pressure()),
            penetration: self.problem.h_max + outcome.approach,
        })
    }

    /// Solves the next of `n_levels` levels.
    fn solve_level<'h>(
        &self,
        heights: &'h Field,
        start: Start,
        n_levels: usize,
        levels: &mut Vec<LevelInfo>,
    ) -> (Descent<'h>, Outcome)
    where
        'a: 'h,
    {
        let (level, grid) = (levels.len(), heights.grid());
        self.observer.notify(&Event::Level { grid, level, n_levels });
        let wanted = self.params.bound.aim();
        let above = n_levels - 1 - level;
        let tolerance = match above {
            0 => wanted,
            _ => self.problem.measure.coarse_tolerance(above - 1).max(wanted),
        };
        let operators = uniform_operators(grid, self.kernel);
        let mut descent = Descent::new(heights.values(), grid, operators, self.problem, start);
        let goal = Goal {
            tolerance,
            max_iterations: self.params.max_iterations,
            certify: (above == 0).then_some(self.params.bound),
        };
        let outcome = descent.run(goal, &DescentObserver { observer: self.observer, mesh: &grid });
        levels.push(descent.info());
        (descent, outcome)
    }
}

/// Root mean square, summed in pieces so that it is the same for any number of threads.
fn rms(values: &[f64]) -> f64 {
    let squares: Vec<f64> = values.par_chunks(4096).map(|chunk| chunk.iter().map(|v| v * v).sum()).collect();
    (squares.iter().sum::<f64>() / values.len() as f64).sqrt()
}
