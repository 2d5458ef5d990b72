//! A solve from the coarsest of nested grids to the finest.
//!
//! Each grid prepares the start on the next.

use rayon::prelude::*;
use rc_core::{Boundary, Event, Field, Kernel, Observer};

use crate::descent::info::{LevelInfo, LevelValues};
use crate::descent::outcome::Outcome;
use crate::descent::run::{DescentObserver, Goal};
use crate::descent::state::{Descent, Start};
use crate::grid::coarser::{Pits, about_halved, coarsen};
use crate::grid::operators::{certifying_operators, uniform_operators};
use crate::grid::prolongation::prolong;
use crate::problem::checked::Problem;
use crate::problem::params::IterationParams;

/// Minimum number of elements per side of the coarsest grid.
///
/// A smaller grid costs nothing, so coarser ones do not prepare it.
const SMALLEST_SIDE: usize = 64;

/// The heights on the coarser of nested grids, finest first.
pub(super) fn coarser_heights(heights: &Field, boundary: Boundary) -> Vec<Field> {
    coarsen(heights, boundary, Pits::Filled, about_halved(heights.grid(), SMALLEST_SIDE))
}

/// The data that the levels of nested grids share.
pub(crate) struct NestedGrids<'a> {
    pub(crate) kernel: &'a dyn Kernel,
    pub(crate) problem: &'a Problem,
    pub(crate) params: IterationParams,
    /// Number of levels that others will add above the last grid.
    ///
    /// If it is 0, the last grid is solved to the tolerance and certified.
    pub(crate) n_above: usize,
    pub(crate) observer: &'a dyn Observer,
}

/// The solved finest of nested grids.
pub(crate) struct FinestGrid<'a> {
    pub(crate) descent: Descent<'a>,
    pub(crate) outcome: Outcome,
    /// The work on all grids, coarsest first.
    pub(crate) levels: Vec<LevelInfo>,
    /// Results of the level below the finest, if that level halves it.
    ///
    /// When there are levels above the last grid, these are the results of the last grid.
    pub(crate) coarser: Option<LevelValues>,
}

impl<'a> NestedGrids<'a> {
    /// Solves on coarser grids, and then on the grid of `heights`.
    pub(crate) fn solve(&self, heights: &'a Field) -> FinestGrid<'a> {
        self.solve_from(&coarser_heights(heights, self.problem.support.boundary), heights)
    }

    /// Solves on the coarser grids, and then on the grid of `heights`.
    ///
    /// `coarser` are the heights on the coarser grids, finest first.
    pub(super) fn solve_from(&self, coarser: &[Field], heights: &'a Field) -> FinestGrid<'a> {
        let n_levels = coarser.len() + 1 + self.n_above;
        let finer = coarser.iter().rev().skip(1).chain([heights]).map(Field::grid);
        let (mut levels, mut start, mut values) = (Vec::with_capacity(n_levels), Start::Nothing, None);
        for (level, (coarse, finer)) in coarser.iter().rev().zip(finer).enumerate() {
            let (descent, outcome) = self.solve_level(coarse, start, [level, n_levels], &mut levels);
            if self.observer.should_stop() {
                // Levels between would only improve the start.
                start = Start::Pressure(prolong(&descent, heights.grid()));
                values = None;
                break;
            }
            let is_half = [coarse.grid().nx() * 2, coarse.grid().ny() * 2] == [finer.nx(), finer.ny()];
            values = self.values(&descent, &outcome, n_levels - levels.len()).filter(|_| is_half);
            start = Start::Pressure(prolong(&descent, finer));
        }
        let (descent, outcome) = self.solve_level(heights, start, [coarser.len(), n_levels], &mut levels);
        let coarser = if self.n_above == 0 { values } else { self.values(&descent, &outcome, self.n_above) };
        FinestGrid { descent, outcome, levels, coarser }
    }

    /// The results of a grid with `above` levels above it.
    ///
    /// Only the level before the last has results, because only the last one compares with them.
    fn values(&self, descent: &Descent<'_>, outcome: &Outcome, above: usize) -> Option<LevelValues> {
        (above == 1).then(|| LevelValues {
            rms_pressure: rms(descent.pressure()),
            penetration: self.problem.h_max + outcome.approach,
        })
    }

    /// Solves a level, whose number is below `n_levels`.
    fn solve_level<'h>(
        &self,
        heights: &'h Field,
        start: Start,
        [level, n_levels]: [usize; 2],
        levels: &mut Vec<LevelInfo>,
    ) -> (Descent<'h>, Outcome)
    where
        'a: 'h,
    {
        let grid = heights.grid();
        self.observer.notify(&Event::Level { grid, level, n_levels });
        let wanted = self.params.bound.aim();
        let above = n_levels - 1 - level;
        let tolerance = match above {
            0 => wanted,
            _ => self.problem.measure.coarse_tolerance(above - 1).max(wanted),
        };
        let goal = Goal {
            tolerance,
            max_iterations: self.params.max_iterations,
            certify: (above == 0).then_some(self.params.bound),
        };
        let (values, watch) = (heights.values(), DescentObserver { observer: self.observer, mesh: &grid });
        let (descent, outcome) = if above == 0 && !levels.is_empty() && self.observer.should_stop() {
            let operators = certifying_operators(grid, self.kernel);
            let mut descent = Descent::without_steps(values, grid, operators, self.problem, start);
            let outcome = descent.certify_start(goal, &watch);
            (descent, outcome)
        } else {
            let operators = uniform_operators(grid, self.kernel);
            let mut descent = Descent::new(values, grid, operators, self.problem, start);
            let outcome = descent.run(goal, &watch);
            (descent, outcome)
        };
        levels.push(descent.info());
        (descent, outcome)
    }
}

/// Root mean square, summed in pieces. It is the same for any number of threads.
fn rms(values: &[f64]) -> f64 {
    let squares: Vec<f64> = values.par_chunks(4096).map(|chunk| chunk.iter().map(|v| v * v).sum()).collect();
    (squares.iter().sum::<f64>() / values.len() as f64).sqrt()
}
