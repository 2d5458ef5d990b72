//! Nearly full contact: the finest grids are solved for their gap.
//!
//! The grid below them is solved by rounds, as all coarser ones. It shows whether the contact is nearly full and its
//! pools are narrow, because steps near pools do not correct long waves. A solution is accepted only if its bound is
//! far below the tolerance, because a bound on the energy alone does not bound the area. Otherwise rounds go on from the
//! grid below, as if nothing had been tried.

use rc_core::{Boundary, Kernel};
use rc_quadtree::TILE;

use crate::descent::outcome::Outcome;
use crate::descent::run::DescentObserver;
use crate::descent::state::{Descent, Start};
use crate::grid::operators::no_operators;
use crate::grid::response::GridResponse;
use crate::levels::gap_prolongation::prolong_gap;
use crate::levels::gap_side;
use crate::levels::grids::GridLevels;
use crate::levels::nested::{History, Levels as _, Nested};
use crate::parallel;
use crate::problem::tolerance::Measure;

/// Number of grids that are solved for the gap.
const LEVELS: usize = 3;

/// Part of the grid below in contact.
const NEARLY_FULL: f64 = 0.95;

/// Largest mean width of pools of the grid below, in elements.
const WIDEST: f64 = 3.5;

/// Elements that a width is counted to on either side.
const FARTHEST: usize = 64;

/// Minimum number of elements along a side of the finest grid.
const LEAST_SIDE: usize = 512;

/// Largest ratio of the bound on the energy error to the tolerance.
const SAFETY: f64 = 0.25;

type Solved<'a> = ((Descent<'a>, Outcome), History);

/// Solves all grids, coarsest first. The result says whether the finest ones were solved for the gap.
pub(super) fn solve<'a>(grids: &GridLevels<'a>, kernel: &dyn Kernel, nested: &Nested<'_>) -> (Solved<'a>, bool) {
    if !is_plain(grids, kernel) {
        return (grids.solve_all(nested), false);
    }
    let begun = nested.climb(grids, grids.first(), LEVELS);
    let (base, history) = nested.solve(grids, begun);
    if !nested.observer.should_stop()
        && is_nearly_full(&base.0)
        && let Some(solved) = climb(grids, kernel, nested, (&base.0, &history))
    {
        return (solved, true);
    }
    let begun = nested.next(grids, (LEVELS, 0), (base, history));
    (nested.solve(grids, nested.climb(grids, begun, 0)), false)
}

/// Whether the problem and its grids are such that the gap can be solved for.
fn is_plain(grids: &GridLevels<'_>, kernel: &dyn Kernel) -> bool {
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
        && problem.support.is_none()
        && problem.support.boundary == Boundary::Periodic
        && !problem.bounds.is_limited()
        && problem.bounds.mean().is_some()
        && kernel.sliding_velocity().is_none()
        && grids.n_levels() > LEVELS
        && has_grids()
}

/// Whether almost everything touches and pools are narrow.
///
/// The width of a pool at an element is the number of elements without contact along its row or its column, whichever
/// is smaller. The mean is over all elements without contact.
fn is_nearly_full(base: &Descent<'_>) -> bool {
    let (nx, ny) = (base.grid().nx(), base.grid().ny());
    let pressure = base.pressure();
    let is_open = |x: usize, y: usize| pressure[y % ny * nx + x % nx] <= 0.0;
    let count = |at: &dyn Fn(usize) -> bool| (1..=FARTHEST).take_while(|step| at(*step)).count();
    let width = |x: usize, y: usize| {
        let along_x = count(&|step| is_open(x + step, y)) + count(&|step| is_open(x + nx * step - step, y));
        let along_y = count(&|step| is_open(x, y + step)) + count(&|step| is_open(x, y + ny * step - step));
        1 + along_x.min(along_y)
    };
    let rows = parallel::map(0..ny, |y| {
        let open = (0..nx).filter(|&x| is_open(x, y));
        open.fold([0, 0], |[n, sum], x| [n + 1, sum + width(x, y)])
    });
    let [n, sum] = rows.into_iter().fold([0, 0], |[n, sum], row| [n + row[0], sum + row[1]]);
    n as f64 <= (1.0 - NEARLY_FULL) * base.grid().len() as f64 && sum as f64 <= WIDEST * n as f64
}

/// Solves the finest grids for their gap. `None` if a bound is not far below the tolerance.
fn climb<'a>(
    grids: &GridLevels<'a>,
    kernel: &dyn Kernel,
    nested: &Nested<'_>,
    (base, history): (&Descent<'a>, &History),
) -> Option<Solved<'a>> {
    let mean = grids.problem().bounds.mean()?;
    let mut history = History { levels: history.levels.clone(), coarser: None };
    let mut gap = prolong_gap(base, grids.grid(LEVELS - 1));
    for above in (1..LEVELS).rev() {
        let (descent, outcome) = solve_grid(grids, kernel, nested, (gap, mean), above)?;
        history.levels.push(descent.info());
        history.coarser = grids.values_of(&descent, &outcome, above);
        gap = prolong_gap(&descent, grids.grid(above - 1));
    }
    let solved = solve_grid(grids, kernel, nested, (gap, mean), 0)?;
    history.levels.push(solved.0.info());
    Some((solved, history))
}

/// Solves a grid for its gap, from that of the grid below. `None` if its bound is not far below the tolerance.
fn solve_grid<'a>(
    grids: &GridLevels<'a>,
    kernel: &dyn Kernel,
    nested: &Nested<'_>,
    (gap, mean): (Vec<f64>, f64),
    above: usize,
) -> Option<(Descent<'a>, Outcome)> {
    let (heights, grid, problem) = (grids.heights(above), grids.grid(above), grids.problem());
    nested.announce(grid, above);
    let response = GridResponse::of(grid, kernel);
    let solution = gap_side::solve(gap, heights, (kernel, &response), (problem, mean));
    let start = Start::Known { pressure: solution.pressure, gap: solution.gap };
    let mut descent = Descent::without_steps(heights.values(), grid, no_operators(grid), problem, start);
    descent.info.operator_applications = gap_side::APPLICATIONS;
    let watch = DescentObserver { observer: nested.observer, mesh: &grid };
    let tolerance = SAFETY * nested.params.bound.value();
    let outcome = descent.check_start(solution.sums, solution.error, tolerance, &watch);
    (outcome.converged && !nested.observer.should_stop()).then_some((descent, outcome))
}
