//! From the base grid to the finest level, with one operator.

use rc_core::{Event, Grid, Observer};
use rc_kernel::{Love, ScaleSplit, SplitParams};

use super::AdaptiveParams;
use super::elements::Elements;
use super::heights::Heights;
use super::level::{Level, Mesh};
use super::operator::{Prepared, Real};
use super::prolongation;
use super::refinement::State;
use super::solution;
use super::split;
use super::tiles::{TILE, TileSet};
use crate::IterationParams;
use crate::problem::Problem;
use crate::solution::{LevelInfo, LevelValues};
use crate::uniform::{self, Climb, Climbed};

/// What the levels found: the operator, the finest level, its grid, the work on all, and the last but one.
pub(super) struct Solved {
    pub(super) split: SplitParams,
    pub(super) grid: Grid,
    pub(super) level: Level,
    pub(super) levels: Vec<LevelInfo>,
    pub(super) coarser: Option<LevelValues>,
}

/// What the finest level begins with.
pub(super) struct FinestStart {
    grid: Grid,
    pub(super) mesh: Mesh,
    contact_gap: f64,
    levels: Vec<LevelInfo>,
    coarser: Option<LevelValues>,
}

/// What the levels share; `T` is the precision of fresh gaps.
pub(super) struct Solver<'a, T> {
    pub(super) heights: &'a Heights<'a>,
    pub(super) problem: Problem,
    pub(super) params: IterationParams,
    border_level: usize,
    split: SplitParams,
    /// L, and its approximate inverse, for corrections.
    pub(super) response: Prepared<f32>,
    pub(super) preconditioner: Prepared<f32>,
    /// L for fresh gaps.
    pub(super) fresh: Prepared<T>,
}

impl<'a, T: Real + Into<f64>> Solver<'a, T> {
    pub(super) fn new(heights: &'a Heights<'a>, problem: Problem, params: &AdaptiveParams, split: SplitParams) -> Self {
        let (quick, certified) = (ScaleSplit::new(SplitParams::quick()), ScaleSplit::new(split));
        let (base, border_level) = (heights.base().grid(), params.border_level);
        Self {
            response: Prepared::displacement(&quick, base, border_level),
            preconditioner: Prepared::inverse(&quick, base),
            fresh: Prepared::displacement(&certified, base, border_level),
            heights,
            problem,
            params: params.solve,
            border_level,
            split,
        }
    }

    pub(super) fn base(&self) -> Grid {
        self.heights.base().grid()
    }

    /// Solves all levels but the finest, which starts from them.
    pub(super) fn prepare(&self, observer: &dyn Observer) -> FinestStart {
        let n_above = (self.heights.finest_side() / self.base().nx()).ilog2() as usize;
        let (mut mesh, mut contact_gap, mut infos, mut coarser) = self.solve_base(n_above, observer);
        for above in 1..=n_above {
            let grid = Grid::square(self.base().nx() << above).expect("a level of a checked grid");
            observer.notify(&Event::Level { grid, level: infos.len(), n_levels: infos.len() + 1 + n_above - above });
            if above == n_above {
                return FinestStart { grid, mesh, contact_gap, levels: infos, coarser };
            }
            let tolerance = uniform::coarse_tolerance(n_above - above - 1).max(self.params.tolerance);
            let level = self.prepare_level(grid, mesh, tolerance, observer);
            infos.push(level.info);
            if above + 1 == n_above {
                coarser = Some(self.values(&level));
            }
            contact_gap = level.outcome.contact_gap;
            mesh = self.refined(&level, above >= n_above - self.border_level);
        }
        unreachable!("the finest level returns")
    }

    /// Solves the finest level.
    pub(super) fn finish(&self, start: FinestStart, observer: &dyn Observer) -> Solved {
        let FinestStart { grid, mesh, contact_gap, mut levels, coarser } = start;
        let level = self.solve_finest(grid, mesh, contact_gap, observer);
        levels.push(level.info);
        Solved { split: self.split, grid, level, levels, coarser }
    }

    /// Solves the finest level where another operator has prepared it; where sizes of elements differ they are those that suit the other
    /// one, and all is done again.
    pub(super) fn take_over(&self, start: FinestStart, observer: &dyn Observer) -> Solved {
        let start = if self.border_level > 0 { self.prepare(observer) } else { start };
        self.finish(start, observer)
    }

    /// The start on elements half as large: of all, or of those `at_edges` of contacts only.
    fn refined(&self, level: &Level, at_edges: bool) -> Mesh {
        let Level { elements, pressure, gap, outcome, .. } = level;
        let function = prolongation::level_function(elements, pressure, gap, outcome.contact_gap);
        if !at_edges {
            return prolongation::prolong(elements.finest(), &function);
        }
        let chosen = self.state(elements, pressure, gap, outcome.contact_gap).too_coarse();
        let refined = split::split(elements, chosen, true, self.fresh.reach().stencil);
        let mut pressure = elements.moved(&refined, pressure, 0.0);
        prolongation::prolong_to(elements, &function, &refined, &mut pressure);
        Mesh { elements: refined, pressure }
    }

    /// What decides on the size of elements.
    pub(super) fn state<'b>(
        &self,
        elements: &'b Elements,
        pressure: &'b [f64],
        gap: &'b [f64],
        contact_gap: f64,
    ) -> State<'b> {
        State { elements, pressure, gap, contact_gap, height_curvature: self.heights.curvature() }
    }

    /// What a level found.
    fn values(&self, level: &Level) -> LevelValues {
        let Level { elements, pressure, outcome, .. } = level;
        LevelValues {
            rms_pressure: solution::rms_pressure(elements, pressure),
            penetration: self.problem.h_max + outcome.approach,
        }
    }

    /// Solves the finest level again, from what another operator has found.
    pub(super) fn improve(&self, solved: Solved, observer: &dyn Observer) -> Solved {
        let Solved { grid, level, mut levels, coarser, .. } = solved;
        let Level { elements, pressure, outcome, info: before, .. } = level;
        levels.pop();
        let mesh = Mesh { elements, pressure };
        let start = FinestStart { grid, mesh, contact_gap: outcome.contact_gap, levels, coarser };
        let mut solved = self.take_over(start, observer);
        if let Some(finest) = solved.levels.last_mut() {
            finest.iterations += before.iterations;
            finest.operator_applications += before.operator_applications;
            finest.preconditioner_applications += before.preconditioner_applications;
        }
        solved
    }

    /// Uniform grids up to the base grid: the start on the level above it, the gap in contact, the work, and what it found
    /// when one level is left.
    fn solve_base(&self, n_above: usize, observer: &dyn Observer) -> (Mesh, f64, Vec<LevelInfo>, Option<LevelValues>) {
        let base = self.heights.base();
        let (problem, params) = (&self.problem, self.params);
        let climb = Climb { kernel: &Love, problem, params, n_above, observer };
        let Climbed { descent, outcome, levels, coarser } = climb.to(base);
        let function = to_tiles(base.grid(), &uniform::level_function(&descent));
        let tiles = TileSet::full(base.grid().nx() / TILE);
        (prolongation::prolong(&tiles, &function), outcome.contact_gap, levels, coarser)
    }
}

/// Values of a grid, tile by tile.
fn to_tiles(grid: Grid, values: &[f64]) -> Vec<f64> {
    let tiles = TileSet::full(grid.nx() / TILE);
    let mut result = Vec::with_capacity(values.len());
    for &[column, row] in tiles.places() {
        for y in 0..TILE {
            let start = (row as usize * TILE + y) * grid.nx() + column as usize * TILE;
            result.extend_from_slice(&values[start..start + TILE]);
        }
    }
    result
}
