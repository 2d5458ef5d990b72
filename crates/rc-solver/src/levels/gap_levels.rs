//! Heavy contact: the finest grids are solved for their gap.
//!
//! The grid below them is solved by rounds, as all coarser ones. It shows how much of the surface is in contact. If the
//! cycles on a grid do not reach their goal, rounds go on from the grid below, as if nothing had been tried.

use rc_core::{Boundary, Kernel};
use rc_quadtree::TILE;

use crate::descent::outcome::{OF_OBSERVABLES, Outcome};
use crate::descent::run::DescentObserver;
use crate::descent::state::{Descent, Start};
use crate::grid::operators::no_operators;
use crate::grid::response::GridResponse;
use crate::levels::gap_cycle::GapGrid;
use crate::levels::gap_prolongation::prolong_gap;
use crate::levels::gap_side::{self, Goal};
use crate::levels::grids::GridLevels;
use crate::levels::nested::{History, Levels as _, Nested};
use crate::problem::tolerance::Measure;

/// Number of grids that are solved for the gap.
const LEVELS: usize = 3;

/// Part of the grid below in contact.
const HEAVY: f64 = 0.6;

/// Part of the grid below in contact from which one cycle may do.
const NEARLY_FULL: f64 = 0.9;

/// Minimum number of elements along a side of the finest grid.
const LEAST_SIDE: usize = 512;

/// Largest ratio of the energy error to its goal.
const ACCEPTED: f64 = 2.0;

/// The smallest goal of the energy error that gaps in single precision reach.
const LEAST_GOAL: f64 = 1e-5;

type Solved<'a> = ((Descent<'a>, Outcome), History);

/// Solves all grids, coarsest first. The result says whether the finest ones were solved for the gap.
pub(super) fn solve<'a>(grids: &GridLevels<'a>, kernel: &dyn Kernel, nested: &Nested<'_>) -> (Solved<'a>, bool) {
    if !is_plain(grids, kernel, nested) {
        return (grids.solve_all(nested), false);
    }
    let begun = nested.climb(grids, grids.first(), LEVELS);
    let (base, history) = nested.solve(grids, begun);
    let contact = contact_fraction(&base.0);
    if !nested.observer.should_stop()
        && contact >= std::env::var("RC_GAP_MIN").map_or(HEAVY, |s| s.parse().unwrap())
        && let Some(solved) = climb(grids, kernel, nested, (&base.0, &history), contact)
    {
        return (solved, true);
    }
    let begun = nested.next(grids, (LEVELS, 0), (base, history));
    (nested.solve(grids, nested.climb(grids, begun, 0)), false)
}

/// The energy error whose effect on observables is that of rounds.
fn goal_of(nested: &Nested<'_>) -> f64 {
    nested.params.bound.aim() / OF_OBSERVABLES
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
    problem.measure == Measure::Energy
        && goal_of(nested) >= LEAST_GOAL
        && problem.support.is_none()
        && problem.support.boundary == Boundary::Periodic
        && !problem.bounds.is_limited()
        && problem.bounds.mean().is_some()
        && kernel.sliding_velocity().is_none()
        && grids.n_levels() > LEVELS
        && has_grids()
}

/// The part of the elements in contact.
fn contact_fraction(base: &Descent<'_>) -> f64 {
    let n = base.pressure().iter().filter(|p| **p > 0.0).count();
    n as f64 / base.grid().len() as f64
}

/// Solves the finest grids for their gap. `None` if one of them does not reach its goal.
fn climb<'a>(
    grids: &GridLevels<'a>,
    kernel: &dyn Kernel,
    nested: &Nested<'_>,
    (base, history): (&Descent<'a>, &History),
    contact: f64,
) -> Option<Solved<'a>> {
    let mean = grids.problem().bounds.mean()?;
    let goal = Goal { error: goal_of(nested), cycles: if contact >= NEARLY_FULL { 1 } else { 2 } };
    let mut history = History { levels: history.levels.clone(), coarser: None };
    let mut gap = prolong_gap(base, grids.grid(LEVELS - 1));
    for above in (1..LEVELS).rev() {
        let (descent, outcome) = solve_grid(grids, kernel, nested, (gap, mean, goal), above)?;
        history.levels.push(descent.info());
        history.coarser = grids.values_of(&descent, &outcome, above);
        gap = prolong_gap(&descent, grids.grid(above - 1));
    }
    let solved = solve_grid(grids, kernel, nested, (gap, mean, goal), 0)?;
    history.levels.push(solved.0.info());
    Some((solved, history))
}

/// Solves a grid for its gap, from that of the grid below. `None` if it does not reach the goal.
fn solve_grid<'a>(
    grids: &GridLevels<'a>,
    kernel: &dyn Kernel,
    nested: &Nested<'_>,
    (gap, mean, goal): (Vec<f64>, f64, Goal),
    above: usize,
) -> Option<(Descent<'a>, Outcome)> {
    let (heights, grid, problem) = (grids.heights(above), grids.grid(above), grids.problem());
    nested.announce(grid, above);
    let response = GridResponse::of(grid, kernel);
    let mut on_grids = GapGrid::nested(grid, kernel, &response, problem.unit());
    let solution = gap_side::solve(gap, heights, (&mut on_grids, &response), (problem, mean, goal));
    let start = Start::Known { pressure: solution.pressure, gap: solution.gap };
    let mut descent = Descent::without_steps(heights.values(), grid, no_operators(grid), problem, start);
    descent.info.operator_applications = solution.applications;
    let watch = DescentObserver { observer: nested.observer, mesh: &grid };
    let outcome = descent.check_start(solution.sums, solution.error, ACCEPTED * goal.error, &watch);
    (outcome.converged && !nested.observer.should_stop()).then_some((descent, outcome))
}
