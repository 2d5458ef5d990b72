//! Finer and finer grids, until the contact area is as accurate as wanted.

use rc_core::{Grid, HeightField, Observer};

use crate::problem::capabilities::{Feature, refusal};
use crate::problem::contact_problem::ContactProblem;
use crate::solution::whole::Solution;
use crate::solve::error::SolveError;
use crate::solve::params::SolveParams;

/// Elements per shortest wave of the first grid.
const COARSEST: usize = 4;

/// Elements per shortest wave of the last grid.
const FINEST: usize = 256;

/// Minimum number of elements per side of the first grid.
const SMALLEST_SIDE: usize = 64;

/// Order at which the error bar falls with the element side.
///
/// Most of the error is random, because edges lie at random positions between the centres of elements. If n elements
/// are at edges, the error is proportional to √n element areas. The number n is inversely proportional to the element
/// side, so the order is 2 - 1/2.
const ORDER: f64 = 1.5;

/// Solves on finer grids until the contact area is accurate enough.
///
/// Its relative error bar is then at most `wanted`.
pub(super) fn solve<'a>(
    problem: &ContactProblem<'a>,
    wanted: f64,
    params: &SolveParams,
    observer: &dyn Observer,
) -> Result<Solution<'a>, SolveError> {
    let waves = waves_of(problem)?;
    let mut elements_per_wave = COARSEST;
    loop {
        let side = side(waves, elements_per_wave);
        let grid = Grid::square(side)?;
        let heights = problem.heights.clone().on_grid(grid);
        let solution = ContactProblem { heights, ..problem.clone() }.plan(params)?.solve(observer)?;
        let reached = solution.area().relative_error();
        if reached <= wanted {
            return Ok(solution);
        }
        if elements_per_wave >= FINEST {
            return Err(SolveError::AreaError { wanted, reached, side });
        }
        elements_per_wave = next(elements_per_wave, reached / wanted);
    }
}

/// The first grid of the search.
///
/// All later grids are finer. Their numbers of elements per side are multiples of the number on this one.
pub(super) fn coarsest_grid(problem: &ContactProblem<'_>) -> Result<Grid, SolveError> {
    Ok(Grid::square(side(waves_of(problem)?, COARSEST))?)
}

/// The largest wavenumber of the surface, if its grid can be chosen.
fn waves_of(problem: &ContactProblem<'_>) -> Result<usize, SolveError> {
    let heights = &problem.heights;
    let waves = heights.surface().and_then(HeightField::band_limit).filter(|&waves| waves > 0);
    let features = [
        Some(Feature::AreaError),
        waves.is_none().then_some(Feature::HeightMap),
        (!heights.grid().has_square_cell()).then_some(Feature::OblongGrid),
        problem.checkpoint.as_ref().map(|_| Feature::Checkpoint),
    ];
    let features: Vec<_> = features.into_iter().flatten().collect();
    if let Some(refused) = refusal(&features, None) {
        return Err(refused.into());
    }
    Ok(waves.expect("heights without waves are refused"))
}

/// Elements per side of the grid with `elements_per_wave` for the shortest wave.
///
/// There are more if the grid would be tiny.
fn side(waves: usize, elements_per_wave: usize) -> usize {
    let mut side = waves.saturating_mul(elements_per_wave);
    while side < SMALLEST_SIDE * elements_per_wave / COARSEST {
        side *= 2;
    }
    side
}

/// Elements per wave for an error smaller by `factor`.
fn next(elements_per_wave: usize, factor: f64) -> usize {
    let halvings = (factor.log2() / ORDER).ceil().max(1.0) as u32;
    (elements_per_wave << halvings.min(8)).min(FINEST)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_next_grid_is_where_the_error_should_be_reached() {
        for (factor, expected) in [(1.01, 8), (2.8, 8), (2.9, 16), (8.0, 16), (9.0, 32), (1e9, 256)] {
            assert_eq!(next(4, factor), expected, "{factor}");
        }
    }
}
