//! Nested grids under a sliding surface.

use rc_core::{Field, Grid, Kernel, Observer};

use crate::descent::info::{GridSolution, LevelInfo, LevelValues};
use crate::descent::outcome::Outcome;
use crate::descent::run::{DescentObserver, Goal};
use crate::descent::state::{Descent, Start};
use crate::grid::full_contact;
use crate::grid::operators::{certifying_operators, corrections_of, operators_of};
use crate::grid::response::GridResponse;
use crate::levels::grids::{GridLevels, coarser_heights};
use crate::levels::nested::{Begun, History, Levels, Nested};
use crate::problem::bounds::Bounds;
use crate::problem::checked::Problem;
use crate::problem::error::ProblemError;
use crate::problem::params::IterationParams;
use crate::problem::support::Support;
use crate::sliding::friction::{coefficient, friction};
use crate::sliding::newton::{SlidingDescent, Work};

/// Minimum number of elements per side of the coarsest grid. Small grids too are compared with a coarser one.
const SMALLEST_SIDE: usize = 32;

/// Solves the contact of `heights` (in λ, any mean) that slide over the solid of `kernel`.
///
/// As [`crate::levels::uniform::solve_uniform`], with friction in the result.
///
/// # Errors
/// [`ProblemError`].
pub(crate) fn solve_sliding(
    heights: &Field,
    kernel: &dyn Kernel,
    bounds: Bounds,
    params: &IterationParams,
    observer: &dyn Observer,
) -> Result<GridSolution, ProblemError> {
    let problem = Problem::check_on(Support::of(kernel, heights.grid()), heights, bounds, params)?;
    let coarser = coarser_heights(heights, problem.support.boundary, SMALLEST_SIDE);
    let full = full_contact::mean_pressure(&problem).and_then(|mean_pressure| {
        full_contact::solve((heights, &coarser), kernel, mean_pressure, &problem, params.bound)
    });
    let (mut solution, work) = if let Some(solution) = full {
        (solution, Work::default())
    } else {
        let levels = SlidingLevels { grids: GridLevels::new(kernel, &problem, (heights, &coarser), 0), kernel };
        let nested = Nested { problem: &problem, params: *params, n_levels: levels.grids.n_levels(), observer };
        let ((sliding, outcome), history) = levels.solve_all(&nested, 0);
        let work = sliding.work;
        (sliding.descent.into_solution(&outcome, history.levels, history.coarser), work)
    };
    solution.info.friction = friction(&solution, heights, kernel, work);
    Ok(solution)
}

/// Nested grids, each of which is solved by [`SlidingDescent`].
pub(crate) struct SlidingLevels<'a> {
    pub(crate) grids: GridLevels<'a>,
    pub(crate) kernel: &'a dyn Kernel,
}

impl<'a> SlidingLevels<'a> {
    /// Solves all grids, coarsest first. The last one has `above` levels above it.
    pub(crate) fn solve_all(&self, nested: &Nested<'_>, above: usize) -> ((SlidingDescent<'a>, Outcome), History) {
        let begun = Begun { above: self.grids.n_levels() - 1, start: Start::Nothing, history: History::default() };
        nested.solve(self, nested.climb(self, begun, above))
    }

    /// The pressure on the coarsest grid of an elastic solid with the storage modulus of each wave.
    fn elastic_start(&self, above: usize, storage: GridResponse, goal: Goal, observer: &dyn Observer) -> Start {
        let grid = self.grids.grid(above);
        let operators = operators_of(grid, self.kernel, storage);
        let heights = self.grids.heights(above).values();
        let mut descent = Descent::new(heights, grid, operators, self.grids.problem(), Start::Nothing);
        descent.run(Goal { certify: None, ..goal }, &DescentObserver { observer, mesh: &grid });
        Start::Pressure(descent.into_pressure().into_all())
    }
}

impl<'a> Levels for SlidingLevels<'a> {
    type Start = Start;
    type Solved = (SlidingDescent<'a>, Outcome);

    const SKIPS: bool = true;

    fn grid(&self, above: usize) -> Grid {
        self.grids.grid(above)
    }

    fn solve_level(&self, above: usize, start: Start, goal: Goal, observer: &dyn Observer) -> Self::Solved {
        let (grid, heights) = (self.grid(above), self.grids.heights(above).values());
        let watch = DescentObserver { observer, mesh: &grid };
        let response = GridResponse::of(grid, self.kernel);
        let elastic = response.clone().storage();
        let storage = corrections_of(grid, self.kernel, &elastic);
        let is_begun = !matches!(start, Start::Nothing);
        let start = if is_begun { start } else { self.elastic_start(above, elastic, goal, observer) };
        if above == 0 && is_begun && observer.should_stop() {
            let operators = certifying_operators(grid, self.kernel);
            let mut descent = Descent::without_steps(heights, grid, operators, self.grids.problem(), start);
            let outcome = descent.certify_start(goal, &watch);
            return (SlidingDescent::new(descent, storage), outcome);
        }
        let operators = operators_of(grid, self.kernel, response);
        let descent = Descent::new(heights, grid, operators, self.grids.problem(), start);
        let mut sliding = SlidingDescent::new(descent, storage);
        let outcome = sliding.run(goal, &watch);
        (sliding, outcome)
    }

    fn info(&self, (sliding, _): &Self::Solved) -> LevelInfo {
        sliding.descent.info()
    }

    fn values(&self, (sliding, outcome): &Self::Solved, above: usize) -> Option<LevelValues> {
        let values = self.grids.values_of(&sliding.descent, outcome, above)?;
        let pressure = Field::new(self.grid(above), sliding.descent.pressure().to_vec()).ok()?;
        Some(LevelValues { friction: coefficient(&pressure, self.grids.heights(above), self.kernel), ..values })
    }

    fn start(&self, (sliding, _): Self::Solved, above: usize) -> Start {
        self.grids.start_from(&sliding.descent, above)
    }
}
