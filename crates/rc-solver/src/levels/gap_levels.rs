//! Heavy contact: the finest grids are solved for their gap.
//!
//! The grid below them is solved by rounds, as all coarser ones. It shows how much of the surface is in contact. If the
//! cycles on a grid do not reach their goal, rounds go on from the grid below, as if nothing had been tried.

use rc_core::{Boundary, Grid, Kernel};
use rc_kernel::{Love, Spectral};
use rc_quadtree::TILE;

use crate::descent::info::{LevelInfo, LevelValues};
use crate::descent::outcome::{OF_OBSERVABLES, Outcome};
use crate::descent::run::DescentObserver;
use crate::descent::state::{Descent, Start};
use crate::descent::values::Values;
use crate::grid::operators::no_operators;
use crate::levels::gap_cycle::{GapGrid, Shape};
use crate::levels::gap_prolongation::prolong_gap;
use crate::levels::gap_side::{self, GapState};
use crate::levels::grids::GridLevels;
use crate::levels::nested::{History, Levels as _, Nested};
use crate::parallel;
use crate::problem::tolerance::Measure;

/// Number of grids that are solved for the gap.
const LEVELS: usize = 3;

/// Part of the base grid in contact from which steps near pools may do on the finest grid.
const NEARLY_FULL: f64 = 0.95;

/// The same from which a cycle may do, and the number of edges of contact for each element up to which it does.
///
/// One cycle reached its goal in 9 of 10 scenes of 78 to 93 % within these limits, and took 1.2 to 1.9 times less time
/// than rounds. It failed in all of 9 with more edges, and two took 1.15 times as long as rounds to twice as long. In less
/// contact, a cycle corrects long waves too little.
const HEAVY: f64 = 0.8;
const MOST_EDGES: f64 = 0.13;

/// Ratio of edges on a finer grid to this limit from which the base grid does not show them, for edges as long.
const MORE_EDGES: f64 = 1.5;

/// Minimum number of elements along a side of the finest grid.
const LEAST_SIDE: usize = 512;

/// Ratio of the errors of observables to those of rounds.
const AS_ROUNDS: f64 = 2.0;

/// The smallest goal of the energy error that gaps in single precision reach, and its least ratio to their rounding.
const LEAST_GOAL: f64 = 1e-5;
const GOAL_OF_ROUNDING: f64 = 4.0;

/// The smallest heights, in λ, whose pressures have a number in single precision.
const LEAST_UNIT: f64 = 1e-25;

type Solved<'a> = ((Descent<'a>, Outcome), History);

/// Solves all grids, coarsest first. The result says whether the finest ones were solved for the gap.
pub(super) fn solve<'a>(grids: &GridLevels<'a>, kernel: &dyn Kernel, nested: &Nested<'_>) -> (Solved<'a>, bool) {
    if !is_plain(grids, kernel, nested) {
        return (grids.solve_all(nested), false);
    }
    let begun = nested.climb(grids, grids.first(), LEVELS);
    let (base, history) = nested.solve(grids, begun);
    let pressure = base.0.pressure();
    let contact = GridContact::of(base.0.grid(), |i| pressure[i] > 0.0);
    drop(pressure);
    if !nested.observer.should_stop()
        && contact.is_heavy()
        && let Some(solved) = climb(grids, kernel, nested, (&base.0, &history), contact.is_nearly_full())
    {
        return (solved, true);
    }
    let begun = nested.next(grids, (LEVELS, 0), (base, history));
    (nested.solve(grids, nested.climb(grids, begun, 0)), false)
}

/// The energy error whose effect on observables is about that of rounds.
fn goal_of(nested: &Nested<'_>) -> f64 {
    AS_ROUNDS * nested.params.bound.aim() / OF_OBSERVABLES
}

/// Whether the problem and its grids are such that the gap can be solved for.
fn is_plain(grids: &GridLevels<'_>, kernel: &dyn Kernel, nested: &Nested<'_>) -> bool {
    let problem = grids.problem();
    let has_grids = || {
        let (finest, base) = (grids.grid(0), grids.grid(LEVELS));
        let is_doubled = |n: usize, of: usize| n == of << LEVELS && n >= LEAST_SIDE && of.is_multiple_of(TILE);
        let spacing = finest.spacing();
        is_doubled(finest.nx(), base.nx())
            && is_doubled(finest.ny(), base.ny())
            && (spacing.x / spacing.y - 1.0).abs() < 1e-9
    };
    // Short-ranged kernels are those of L ∝ 1/q on any lattice.
    let is_half_space = [Love.name(), Spectral.name()].contains(&kernel.name()) && kernel.half_space().is_none();
    is_half_space
        && problem.measure == Measure::Energy
        && goal_of(nested) >= LEAST_GOAL.max(GOAL_OF_ROUNDING * gap_side::rounding(grids.grid(0)))
        && (LEAST_UNIT..LEAST_UNIT.recip()).contains(&problem.unit())
        && problem.support.is_none()
        && problem.support.boundary == Boundary::Periodic
        && !problem.bounds.is_limited()
        && problem.bounds.mean().is_some()
        && kernel.sliding_velocity().is_none()
        && grids.n_levels() > LEVELS
        && has_grids()
}

/// How much of a grid is in contact.
struct GridContact {
    /// The part of its elements.
    fraction: f64,
    /// Edges between an element in contact and one without, for each element.
    edges: f64,
}

impl GridContact {
    fn of(grid: Grid, is_contact: impl Fn(usize) -> bool + Sync) -> Self {
        let [nx, ny] = [grid.nx(), grid.ny()];
        let at = |x: usize, y: usize| is_contact(y % ny * nx + x % nx);
        let counts = parallel::map(0..ny, |y| {
            let edges = |x: usize| usize::from(at(x, y) != at(x + 1, y)) + usize::from(at(x, y) != at(x, y + 1));
            [(0..nx).filter(|&x| at(x, y)).count(), (0..nx).map(edges).sum()]
        });
        let [fraction, edges] =
            [0, 1].map(|k| counts.iter().map(|count| count[k]).sum::<usize>() as f64 / grid.len() as f64);
        Self { fraction, edges }
    }

    fn is_nearly_full(&self) -> bool {
        self.fraction >= NEARLY_FULL
    }

    fn is_heavy(&self) -> bool {
        self.is_nearly_full() || self.fraction >= HEAVY && self.edges <= MOST_EDGES
    }
}

/// Solves the finest grids for their gap. `None` if the last one does not reach its goal.
fn climb<'a>(
    grids: &GridLevels<'a>,
    kernel: &dyn Kernel,
    nested: &Nested<'_>,
    (base, history): (&Descent<'a>, &History),
    is_nearly_full: bool,
) -> Option<Solved<'a>> {
    let problem = grids.problem();
    let mean = problem.bounds.mean()?;
    let (mut on_grids, response) = GapGrid::nested(grids.grid(0), kernel, problem.unit());
    let shape = |above: usize| Shape {
        heights: grids.heights(above).values(),
        mean_height: problem.h_mean,
        mean_pressure: mean,
    };
    let mut history = History { levels: history.levels.clone(), coarser: None };
    let of_base = |values: &[f64], zero: f64, unit: f64| values.iter().map(|v| ((v - zero) / unit) as f32).collect();
    let (pressure, gap) =
        (of_base(&base.pressure(), 0.0, 1.0), of_base(&base.gap(), base.contact_gap(), problem.unit()));
    let mut gap = prolong_gap([pressure, gap], problem.unit(), [base.grid(), grids.grid(LEVELS - 1)]);
    for above in (1..LEVELS).rev() {
        let grid = grids.grid(above);
        nested.announce(grid, above);
        let GapState { gap: better, mut pressure, .. } =
            GapState::improved(gap, shape(above), (&mut on_grids[above..], true));
        gap_side::allow(&mut pressure, &better, (grid.nx(), on_grids[above].closing()));
        history.levels.push(level_info(grid, 2));
        history.coarser = Some(LevelValues {
            rms_pressure: mean_of(&pressure, grid.nx(), |p| p * p).sqrt(),
            penetration: problem.h_max - problem.h_mean - problem.unit() * mean_of(&better, grid.nx(), |g| g),
            friction: None,
        });
        let edges = GridContact::of(grid, |i| pressure[i] > 0.0).edges * f64::from(1 << (LEVELS - above));
        if nested.observer.should_stop() || edges > MORE_EDGES * MOST_EDGES {
            return None;
        }
        gap = prolong_gap([pressure, better], problem.unit(), [grid, grids.grid(above - 1)]);
    }
    let (heights, grid) = (grids.heights(0), grids.grid(0));
    nested.announce(grid, 0);
    let (is_cycle, goal) = (!is_nearly_full, goal_of(nested));
    let improved = GapState::improved(gap, shape(0), (&mut on_grids, is_cycle));
    let should_stop = || nested.observer.should_stop();
    let solution = improved.solve((&mut on_grids, &response, is_nearly_full), (grid, problem), (goal, &should_stop));
    let start = Start::Known { pressure: Values::Double(solution.pressure), gap: Values::Double(solution.gap) };
    let mut descent = Descent::without_steps(heights.values(), grid, no_operators(grid), problem, start);
    descent.info = level_info(grid, solution.applications + if is_cycle { 2 } else { 1 });
    history.levels.push(descent.info());
    let watch = DescentObserver { observer: nested.observer, mesh: &grid };
    let outcome = descent.check_start(solution.sums, solution.error, goal, &watch);
    (outcome.converged || should_stop()).then_some(((descent, outcome), history))
}

/// The work on a grid that is solved for its gap.
fn level_info(grid: Grid, operator_applications: usize) -> LevelInfo {
    LevelInfo { grid, iterations: 0, operator_applications, preconditioner_applications: 0 }
}

/// The mean of a function of values, summed in pieces of `len`.
fn mean_of(values: &[f32], len: usize, of: impl Fn(f64) -> f64 + Sync) -> f64 {
    let sums = parallel::map(values.chunks(len), |values| values.iter().map(|v| of(f64::from(*v))).sum::<f64>());
    sums.into_iter().sum::<f64>() / values.len() as f64
}
