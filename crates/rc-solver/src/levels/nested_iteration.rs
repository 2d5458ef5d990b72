//! Nested iteration from the base grid to the finest level.
//!
//! Each level prepares the start on the next.

use rayon::prelude::*;
use rc_core::{Boundary, Event, Grid, Kernel, Observer};
use rc_quadtree::{TILE, TileSet};

use crate::descent::info::{LevelInfo, LevelValues};
use crate::grid::prolongation::edge_function;
use crate::levels::checkpoint::{LevelStart, keep, kept};
use crate::levels::finest_level::solve_finest_level;
use crate::levels::level::{SolvedLevel, add_work, solve_coarse_level};
use crate::levels::nested_grids::{FinestGrid, NestedGrids};
use crate::levels::operator_error::PressureScale;
use crate::levels::params::AdaptiveParams;
use crate::levels::setup::{Given, Setup, Splits};
use crate::problem::checked::Problem;
use crate::tiles::ladder::{Ladder, sides_of};
use crate::tiles::prolongation;
use crate::tiles::prolongation::MeshStart;
use crate::tiles::solution;

/// The solved finest level, and the work on all levels.
pub(crate) struct NestedSolution {
    /// The splits that the level was solved with.
    pub(crate) splits: Splits,
    /// The whole grid of the smallest elements.
    pub(crate) grid: Grid,
    pub(crate) level: SolvedLevel,
    /// The scale of the pressure that the error of an operator depends on.
    pub(crate) scale: PressureScale,
    /// The work on all levels, coarsest first.
    pub(crate) levels: Vec<LevelInfo>,
    /// Values of the last level but one.
    pub(crate) coarser: Option<LevelValues>,
}

/// The start from the base grid, or from a finer level that was kept.
pub(crate) struct BaseStart {
    start: LevelStart,
    /// Part of the cell in tiles that contact touches or is next to.
    ///
    /// These are tiles of the finest level.
    pub(crate) tile_fraction: f64,
}

/// All levels of one problem, with one set of operators.
pub(crate) struct NestedIteration<'a> {
    setup: Setup<'a>,
    splits: Splits,
}

impl<'a> NestedIteration<'a> {
    pub(crate) fn new(given: Given<'a>, problem: Problem, params: &AdaptiveParams, splits: Splits) -> Self {
        Self { setup: Setup::new(given, problem, params, splits), splits }
    }

    /// The kernel of the problem.
    pub(crate) fn kernel(&self) -> &'a dyn Kernel {
        self.setup.kernel
    }

    /// The splits of the operators.
    pub(crate) fn splits(&self) -> Splits {
        self.splits
    }

    /// Solves the base grid and the coarser grids that it starts from.
    ///
    /// If a start was kept, it goes on from that.
    pub(crate) fn begin(&self, observer: &dyn Observer) -> BaseStart {
        if let Some(checkpoint) = self.setup.checkpoint
            && let Some((start, tile_fraction)) =
                kept(checkpoint, (self.ladder().finest(), self.boundary()), self.setup.ranks)
            && self.ladder().grid(self.setup.n_levels(start.grid)) == start.grid
        {
            return BaseStart { start, tile_fraction };
        }
        let base = self.solve_base(self.n_above(), observer);
        self.keep(&base.start, base.tile_fraction);
        base
    }

    fn keep(&self, start: &LevelStart, tile_fraction: f64) {
        if let Some(checkpoint) = self.setup.checkpoint {
            keep(checkpoint, start, tile_fraction);
        }
    }

    fn boundary(&self) -> Boundary {
        self.setup.problem.support.boundary
    }

    fn n_above(&self) -> usize {
        self.ladder().n_levels()
    }

    fn ladder(&self) -> Ladder {
        self.setup.heights.ladder()
    }

    /// Solves all levels but the finest, which starts from them.
    pub(crate) fn prepare(&self, base: BaseStart, observer: &dyn Observer) -> LevelStart {
        let BaseStart { mut start, tile_fraction } = base;
        for finer in (1..=self.n_above() - self.setup.n_levels(start.grid)).rev() {
            announce(&start, finer, observer);
            start = self.solve_level(start, finer, observer);
            self.keep(&start, tile_fraction);
        }
        announce(&start, 0, observer);
        start
    }

    /// Solves the finest level.
    pub(crate) fn finish(&self, start: LevelStart, observer: &dyn Observer) -> NestedSolution {
        let LevelStart { grid, mesh, contact_gap, mut levels, coarser, .. } = start;
        let (level, scale) = solve_finest_level(&self.setup, grid, mesh, contact_gap, observer);
        levels.push(level.info);
        NestedSolution { splits: self.splits, grid, level, scale, levels, coarser }
    }

    /// Solves the finest level, after another operator has prepared it.
    ///
    /// If sizes of elements differ, they suit the other operator. All levels are then solved again.
    pub(crate) fn take_over(&self, start: LevelStart, observer: &dyn Observer) -> NestedSolution {
        let start = if self.setup.border_level > 0 { self.prepare(self.begin(observer), observer) } else { start };
        self.finish(start, observer)
    }

    /// Solves the finest level again, from a solution with another operator.
    pub(crate) fn improve(&self, solved: NestedSolution, observer: &dyn Observer) -> NestedSolution {
        let NestedSolution { grid, level, mut levels, coarser, .. } = solved;
        let SolvedLevel { elements, pressure, outcome, info: before, .. } = level;
        levels.pop();
        let mesh = MeshStart { elements, pressure };
        let energy_length = outcome.energy_length();
        let start = LevelStart { grid, mesh, contact_gap: outcome.contact_gap, energy_length, levels, coarser };
        let mut solved = self.take_over(start, observer);
        if let Some(finest) = solved.levels.last_mut() {
            add_work(finest, &before);
        }
        solved
    }

    /// Solves uniform grids up to the base grid, which has `n_above` levels above it.
    fn solve_base(&self, n_above: usize, observer: &dyn Observer) -> BaseStart {
        let Setup { heights, problem, params, .. } = &self.setup;
        let base = heights.base();
        let grids = NestedGrids { kernel: self.setup.kernel, problem, params: *params, n_above, observer };
        let FinestGrid { descent, outcome, levels, coarser } = grids.solve(base);
        let function = edge_function(&descent);
        let tile_fraction = tile_fraction(base.grid(), &function, (TILE >> n_above).max(1));
        let function = to_tiles(base.grid(), &function);
        let tiles = TileSet::full(sides_of(base.grid())).with_boundary(self.boundary());
        let grid = self.ladder().grid(1);
        let start = LevelStart {
            grid,
            mesh: prolongation::refine_base(&tiles, &function, grid, self.setup.ranks),
            contact_gap: outcome.contact_gap,
            energy_length: outcome.energy_length(),
            levels,
            coarser: coarser.filter(|_| self.ladder().is_even()),
        };
        BaseStart { start, tile_fraction }
    }

    /// Solves a level with `finer` levels above it.
    fn solve_level(&self, start: LevelStart, finer: usize, observer: &dyn Observer) -> LevelStart {
        let LevelStart { grid, mesh, mut levels, coarser, .. } = start;
        let tolerance = self.setup.problem.measure.coarse_tolerance(finer - 1).max(self.setup.params.bound.aim());
        let level = solve_coarse_level(&self.setup, grid, mesh, tolerance, observer);
        levels.push(level.info);
        let ladder = self.ladder();
        let finer_grid = ladder.grid(ladder.n_levels() + 1 - finer);
        LevelStart {
            grid: finer_grid,
            mesh: self.refined(&level, finer_grid, finer <= self.setup.border_level),
            contact_gap: level.outcome.contact_gap,
            energy_length: level.outcome.energy_length(),
            levels,
            coarser: if finer == 1 && ladder.is_even() { Some(self.values(&level)) } else { coarser },
        }
    }

    /// The start on the next finer `grid`.
    ///
    /// It is on all elements of the grid, or only on those `at_edges` of contacts.
    fn refined(&self, level: &SolvedLevel, grid: Grid, at_edges: bool) -> MeshStart {
        let SolvedLevel { elements, pressure, gap, outcome, .. } = level;
        let function = prolongation::edge_function(elements, pressure, gap, outcome.contact_gap);
        if at_edges {
            let refined = self.setup.refined(&level.fields(), true);
            prolongation::refine_some(elements, pressure, &function, refined)
        } else {
            prolongation::refine_all(elements, &function, grid)
        }
    }

    /// The scale of a pressure, which the error of an operator depends on.
    ///
    /// It is known as far as a start shows it.
    pub(crate) fn scale(&self, start: &LevelStart) -> PressureScale {
        let LevelStart { grid, mesh, contact_gap, energy_length, .. } = start;
        let size = self.setup.penetration(*contact_gap).abs();
        PressureScale::new((&mesh.elements, &mesh.pressure), self.setup.n_levels(*grid), size, *energy_length)
    }

    fn values(&self, level: &SolvedLevel) -> LevelValues {
        LevelValues {
            rms_pressure: solution::rms_pressure(&level.elements, &level.pressure),
            penetration: self.setup.problem.h_max + level.outcome.approach,
        }
    }
}

/// Tells the observer that a level begins. There are `finer` levels above it.
fn announce(start: &LevelStart, finer: usize, observer: &dyn Observer) {
    let level = start.levels.len();
    observer.notify(&Event::Level { grid: start.grid, level, n_levels: level + 1 + finer });
}

/// Part of the squares in which the edge function of a contact is not zero.
///
/// A square has `side` × `side` elements.
fn tile_fraction(grid: Grid, function: &[f64], side: usize) -> f64 {
    let touches = |row: &[f64]| row.iter().any(|&value| value != 0.0);
    let rows = function.par_chunks(side * grid.nx()).map(|rows| {
        let squares = 0..grid.nx() / side;
        let of_square = |i: usize| rows.chunks_exact(grid.nx()).any(|row| touches(&row[i * side..(i + 1) * side]));
        squares.filter(|&i| of_square(i)).count()
    });
    (rows.sum::<usize>() * side * side) as f64 / grid.len() as f64
}

/// Values of a grid, tile by tile.
fn to_tiles(grid: Grid, values: &[f64]) -> Vec<f64> {
    let tiles = TileSet::full(sides_of(grid));
    let mut result = Vec::with_capacity(values.len());
    for &[column, row] in tiles.places() {
        for y in 0..TILE {
            let start = (row as usize * TILE + y) * grid.nx() + column as usize * TILE;
            result.extend_from_slice(&values[start..start + TILE]);
        }
    }
    result
}
