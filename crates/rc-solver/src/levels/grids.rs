//! Levels that are whole grids.

use rc_core::{Boundary, Field, Grid, Kernel, Observer};

use crate::descent::info::{LevelInfo, LevelValues};
use crate::descent::outcome::Outcome;
use crate::descent::run::{DescentObserver, Goal};
use crate::descent::state::{Descent, Start};
use crate::grid::coarser::{Pits, about_halved, coarsen};
use crate::grid::operators::{certifying_operators, uniform_operators};
use crate::grid::prolongation::prolong;
use crate::levels::nested::{Begun, History, Levels, Nested};
use crate::parallel::rms;
use crate::problem::checked::Problem;
use crate::problem::steps::Step;

/// Minimum number of elements per side of the coarsest grid.
///
/// A smaller grid costs nothing, so coarser ones do not prepare it.
pub(crate) const SMALLEST_SIDE: usize = 64;

/// Number of pressures that are summed at once.
const PIECE: usize = 4096;

/// The heights on the coarser of nested grids, finest first. The coarsest has at least this number of elements a side.
pub(crate) fn coarser_heights(heights: &Field, boundary: Boundary, smallest: usize) -> Vec<Field> {
    let _running = Step::Heights.begin();
    coarsen(heights, boundary, Pits::Filled, about_halved(heights.grid(), smallest))
}

/// Nested grids.
pub(crate) struct GridLevels<'a> {
    kernel: &'a dyn Kernel,
    problem: &'a Problem,
    /// Heights on the grids, finest first.
    heights: Vec<&'a Field>,
    /// Number of levels above the last grid.
    n_above: usize,
}

impl<'a> GridLevels<'a> {
    /// The grid of `heights` with `n_above` levels above it, and the `coarser` grids, finest first.
    pub(crate) fn new(
        kernel: &'a dyn Kernel,
        problem: &'a Problem,
        (heights, coarser): (&'a Field, &'a [Field]),
        n_above: usize,
    ) -> Self {
        Self { kernel, problem, heights: std::iter::once(heights).chain(coarser).collect(), n_above }
    }

    /// Number of levels, including those above the last grid.
    pub(crate) fn n_levels(&self) -> usize {
        self.n_above + self.heights.len()
    }

    /// The problem that all grids solve.
    pub(crate) fn problem(&self) -> &'a Problem {
        self.problem
    }

    /// The heights of a grid.
    pub(crate) fn heights(&self, above: usize) -> &'a Field {
        self.heights[above - self.n_above]
    }

    /// The values of a solved grid that a grid with half its elements is compared with.
    pub(crate) fn values_of(&self, descent: &Descent<'_>, outcome: &Outcome, above: usize) -> Option<LevelValues> {
        let is_half = || {
            let (grid, finer) = (self.grid(above), self.grid(above - 1));
            // A profile has one row on every grid.
            2 * grid.nx() == finer.nx() && (2 * grid.ny() == finer.ny() || finer.ny() == 1)
        };
        (above == self.n_above || is_half()).then(|| LevelValues {
            rms_pressure: rms(&descent.pressure(), PIECE),
            penetration: self.problem.h_max + outcome.approach,
            friction: None,
        })
    }

    /// The start of a finer grid.
    pub(crate) fn start_from(&self, descent: &Descent<'_>, above: usize) -> Start {
        Start::Pressure(prolong(descent, self.grid(above)))
    }

    /// Solves all grids, coarsest first.
    pub(crate) fn solve_all(&self, nested: &Nested<'_>) -> ((Descent<'a>, Outcome), History) {
        nested.solve(self, nested.climb(self, self.first(), self.n_above))
    }

    /// The coarsest grid, at which a solve begins.
    pub(crate) fn first(&self) -> Begun<Start> {
        Begun { above: self.n_levels() - 1, start: Start::Nothing, history: History::default() }
    }
}

impl<'a> Levels for GridLevels<'a> {
    type Start = Start;
    type Solved = (Descent<'a>, Outcome);

    /// Levels between would only improve the start.
    const SKIPS: bool = true;

    fn grid(&self, above: usize) -> Grid {
        self.heights[above - self.n_above].grid()
    }

    fn solve_level(&self, above: usize, start: Start, goal: Goal, observer: &dyn Observer) -> Self::Solved {
        let (heights, grid) = (self.heights(above).values(), self.grid(above));
        let watch = DescentObserver { observer, mesh: &grid };
        if above == 0 && !matches!(start, Start::Nothing) && observer.should_stop() {
            let operators = certifying_operators(grid, self.kernel);
            let mut descent = Descent::without_steps(heights, grid, operators, self.problem, start);
            let outcome = descent.certify_start(goal, &watch);
            return (descent, outcome);
        }
        let mut descent = Descent::new(heights, grid, uniform_operators(grid, self.kernel), self.problem, start);
        let outcome = descent.run(goal, &watch);
        (descent, outcome)
    }

    fn info(&self, (descent, _): &Self::Solved) -> LevelInfo {
        descent.info()
    }

    fn values(&self, (descent, outcome): &Self::Solved, above: usize) -> Option<LevelValues> {
        self.values_of(descent, outcome, above)
    }

    fn start(&self, (descent, _): Self::Solved, above: usize) -> Start {
        self.start_from(&descent, above)
    }
}
