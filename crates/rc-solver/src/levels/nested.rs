//! Nested iteration: from the coarsest level to the finest, each of which starts the next.

use rc_core::{Event, Grid, Observer};

use crate::descent::info::{LevelInfo, LevelValues};
use crate::descent::run::Goal;
use crate::problem::checked::Problem;
use crate::problem::params::IterationParams;

/// Levels of one kind of mesh.
///
/// A level is named by the number of levels above it. That of the finest is 0.
pub(crate) trait Levels {
    /// What a level is started from.
    type Start;
    /// A solved level.
    type Solved;

    /// Whether a solve that is stopped goes on with the last level. Otherwise each level ends by itself.
    const SKIPS: bool;

    /// The whole grid of the level.
    fn grid(&self, above: usize) -> Grid;

    /// Solves a level.
    fn solve_level(&self, above: usize, start: Self::Start, goal: Goal, observer: &dyn Observer) -> Self::Solved;

    /// The work on a solved level.
    fn info(&self, solved: &Self::Solved) -> LevelInfo;

    /// The values that the next level is compared with. `None` if that level does not halve its elements.
    fn values(&self, solved: &Self::Solved, above: usize) -> Option<LevelValues>;

    /// The start of a finer level.
    fn start(&self, solved: Self::Solved, above: usize) -> Self::Start;

    /// Keeps the start of a level, if a solve is to be continued.
    fn keep(&self, _begun: &Begun<Self::Start>) {}
}

/// The levels that were solved so far.
#[derive(Default)]
pub(crate) struct History {
    /// The work on them, coarsest first.
    pub(crate) levels: Vec<LevelInfo>,
    /// Values of the last level but one.
    pub(crate) coarser: Option<LevelValues>,
}

/// A solve that has come to a level.
pub(crate) struct Begun<S> {
    /// Number of levels above this one.
    pub(crate) above: usize,
    pub(crate) start: S,
    pub(crate) history: History,
}

/// What all levels of a solve share.
#[derive(Clone, Copy)]
pub(crate) struct Nested<'a> {
    pub(crate) problem: &'a Problem,
    pub(crate) params: IterationParams,
    /// Number of all levels, whatever their meshes.
    pub(crate) n_levels: usize,
    pub(crate) observer: &'a dyn Observer,
}

impl Nested<'_> {
    /// Solves the levels up to the one with `last` levels above it, and returns the start of that one.
    pub(crate) fn climb<L: Levels>(&self, levels: &L, mut begun: Begun<L::Start>, last: usize) -> Begun<L::Start> {
        while begun.above > last {
            let above = begun.above;
            let solved = self.solve(levels, begun);
            begun = self.next(levels, (above, last), solved);
        }
        begun
    }

    /// The level after the solved one with `above` levels above it, which is the `last` one if the solve is stopped.
    pub(crate) fn next<L: Levels>(
        &self,
        levels: &L,
        (above, last): (usize, usize),
        (solved, mut history): (L::Solved, History),
    ) -> Begun<L::Start> {
        let skips = L::SKIPS && self.observer.should_stop();
        if skips {
            history.coarser = None;
        }
        let next = if skips { last } else { above - 1 };
        let begun = Begun { above: next, start: levels.start(solved, next), history };
        levels.keep(&begun);
        begun
    }

    /// Solves the level that a solve has come to.
    pub(crate) fn solve<L: Levels>(&self, levels: &L, begun: Begun<L::Start>) -> (L::Solved, History) {
        let Begun { above, start, mut history } = begun;
        self.announce(levels.grid(above), above);
        let solved = levels.solve_level(above, start, self.goal(above), self.observer);
        history.levels.push(levels.info(&solved));
        if above == 1 {
            history.coarser = levels.values(&solved, above);
        }
        (solved, history)
    }

    /// Tells the observer that a level begins.
    pub(crate) fn announce(&self, grid: Grid, above: usize) {
        self.observer.notify(&Event::Level { grid, level: self.n_levels - 1 - above, n_levels: self.n_levels });
    }

    /// What a level must reach. Only the finest is certified.
    fn goal(&self, above: usize) -> Goal {
        let wanted = self.params.bound.aim();
        let tolerance = match above {
            0 => wanted,
            _ => self.problem.measure.coarse_tolerance(above - 1).max(wanted),
        };
        let certify = (above == 0).then_some(self.params.bound);
        Goal { tolerance, max_iterations: self.params.max_iterations, certify }
    }
}
