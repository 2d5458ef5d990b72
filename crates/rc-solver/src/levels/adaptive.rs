//! The adaptive method: work and memory grow with the contact.
//!
//! From each level to the next finer one, the side of the elements is halved. The coarsest levels, up to the base grid,
//! are whole grids. Each finer level has only the tiles of 8 × 8 cells that contact touches or nearly touches. The
//! multilevel operator applies L on them. The module `exclusion` proves that the rest of the cell is out of contact.

use std::sync::Arc;

use rayon::prelude::*;
use rc_core::{Boundary, Grid, Observer};
use rc_quadtree::{TILE, TileSet};

use crate::descent::info::{Friction, LevelInfo, LevelValues, SolveInfo, Status};
use crate::descent::run::Goal;
use crate::grid::prolongation::edge_function;
use crate::levels::agreed_stop::AgreedStop;
use crate::levels::checkpoint::{TileStart, keep, kept};
use crate::levels::coarse_level::{SolvedLevel, add_work, solve_coarse_level};
use crate::levels::estimate::Estimate;
use crate::levels::finest_level::solve_finest_level;
use crate::levels::grids::{GridLevels, SMALLEST_SIDE, coarser_heights};
use crate::levels::nested::{Begun, History, Levels, Nested};
use crate::levels::operator_error::{PressureScale, can_certify, certifying_split};
use crate::levels::sliding::SlidingLevels;
use crate::levels::tiles::TileLevels;
use crate::sliding::friction::finished;
use crate::sliding::newton::Work;
use crate::tiles::contact_area::Values;
use crate::tiles::friction::SlidingContact;
use crate::tiles::ladder::sides_of;
use crate::tiles::mesh::Mesh;
use crate::tiles::patch::displacement_of_patch;
use crate::tiles::prolongation::{self, MeshStart, refine_all, refine_base, refine_some};
use crate::tiles::solution::{TileSolution, rms_pressure};
use crate::tiles::split::GapSplit;

/// The reason why the uniform grid is better than tiles.
///
/// An estimate had chosen the adaptive method.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Unsuitable {
    /// Contact is near so many tiles that the uniform grid is faster.
    Scattered {
        /// Part of the tiles that is near contact.
        tile_fraction: f64,
    },
    /// Pressures are so rough that no operator can certify the tolerance.
    Rough,
}

/// The solved finest level.
pub(crate) struct Finest {
    /// The split that certified it.
    pub(crate) certified: GapSplit,
    /// The whole grid of the smallest elements.
    pub(crate) grid: Grid,
    pub(crate) level: SolvedLevel,
    /// The scale of the pressure that the error of an operator depends on.
    pub(crate) scale: PressureScale,
    pub(crate) tile_fraction: f64,
    pub(crate) history: History,
}

impl<'a> TileLevels<'a> {
    /// Solves the problem. If the solve `may_leave`, it ends early where the uniform grid is better.
    ///
    /// The levels below the finest show which method is better. The certificate comes from a fresh application of L on
    /// the returned pressure, plus bounds on the error of that operator. It covers every cell where a bound does not
    /// exclude contact. The result is bitwise the same for any number of threads.
    ///
    /// # Errors
    /// [`Unsuitable`].
    pub(crate) fn solve(&self, may_leave: bool, observer: &dyn Observer) -> Result<TileSolution<'a>, Unsuitable> {
        let observer = &AgreedStop { observer, ranks: self.ranks() };
        let begun = self.begin(observer);
        let tile_fraction = begun.start.tile_fraction;
        if may_leave && tile_fraction > Estimate::GREATEST_TILE_FRACTION {
            return Err(Unsuitable::Scattered { tile_fraction });
        }
        let begun = self.climb(begun, observer);
        if may_leave && !can_certify(&self.scale(&begun.start), self.params.solve.bound, &self.problem) {
            return Err(Unsuitable::Rough);
        }
        Ok(self.solution(self.finish(begun, observer)))
    }

    /// Solves the base grid and the coarser grids that it starts from.
    ///
    /// If a start was kept, it goes on from that.
    pub(crate) fn begin(&self, observer: &dyn Observer) -> Begun<TileStart> {
        if let Some(checkpoint) = &self.checkpoint
            && let Some((start, history)) = kept(&**checkpoint, (self.finest(), self.boundary()), self.ranks())
            && self.ladder().grid(self.n_levels(start.grid)) == start.grid
        {
            return Begun { above: self.ladder().n_levels() - self.n_levels(start.grid), start, history };
        }
        let begun = self.solve_base(observer);
        self.keep(&begun);
        begun
    }

    /// Solves whole grids up to the base grid.
    fn solve_base(&self, observer: &dyn Observer) -> Begun<TileStart> {
        let (heights, n_above) = (self.data.heights.base(), self.ladder().n_levels());
        let coarser = coarser_heights(heights, self.boundary(), SMALLEST_SIDE);
        let grids = GridLevels::new(self.kernel.get(), &self.problem, (heights, &coarser), n_above);
        let (nested, kernel) = (self.nested(grids.n_levels(), observer), self.kernel.get());
        let ((descent, outcome), mut history) = if kernel.sliding_velocity().is_some() {
            let ((sliding, outcome), history) = SlidingLevels { grids, kernel }.solve_all(&nested, n_above);
            ((sliding.descent, outcome), history)
        } else {
            grids.solve_all(&nested)
        };
        let function = edge_function(&descent);
        let tile_fraction = tile_fraction(heights.grid(), &function, (TILE >> n_above).max(1));
        let function = to_tiles(heights.grid(), &function);
        let tiles = TileSet::full(sides_of(heights.grid())).with_boundary(self.boundary());
        let grid = self.ladder().grid(1);
        let mesh = refine_base(&tiles, &function, grid, self.ranks());
        let (contact_gap, energy_length) = (outcome.contact_gap, outcome.energy_length(&self.problem));
        history.coarser = history.coarser.filter(|_| self.ladder().is_even());
        Begun {
            above: n_above - 1,
            start: TileStart { grid, mesh, contact_gap, energy_length, tile_fraction },
            history,
        }
    }

    /// Solves all levels but the finest, which starts from them.
    pub(crate) fn climb(&self, begun: Begun<TileStart>, observer: &dyn Observer) -> Begun<TileStart> {
        self.nested(begun.history.levels.len() + 1 + begun.above, observer).climb(self, begun, 0)
    }

    /// Solves the finest level, with operators that are as accurate as the bound needs.
    pub(crate) fn finish(&self, begun: Begun<TileStart>, observer: &dyn Observer) -> Finest {
        let certified = self.certifying(self.certified, &self.scale(&begun.start));
        let solved = if certified == self.certified {
            self.solve_finest(begun, observer)
        } else {
            self.with(certified).take_over(begun, observer)
        };
        // A pressure may be rougher than its start.
        let better = self.certifying(solved.certified, &solved.scale);
        let is_done = solved.level.outcome.certificate.meets(self.params.solve.bound) || observer.should_stop();
        if better == solved.certified || is_done { solved } else { self.with(better).improve(solved, observer) }
    }

    /// The first split, from `split` on, that can certify a pressure of this scale.
    fn certifying(&self, split: GapSplit, scale: &PressureScale) -> GapSplit {
        certifying_split(split, scale, self.params.solve.bound, &self.problem)
    }

    fn solve_finest(&self, begun: Begun<TileStart>, observer: &dyn Observer) -> Finest {
        let Begun { start: TileStart { grid, mesh, contact_gap, tile_fraction, .. }, mut history, .. } = begun;
        self.nested(history.levels.len() + 1, observer).announce(grid, 0);
        let (level, scale) = solve_finest_level(self, grid, mesh, contact_gap, observer);
        history.levels.push(level.info);
        Finest { certified: self.certified, grid, level, scale, tile_fraction, history }
    }

    /// Solves the finest level, after another operator has prepared it.
    ///
    /// If sizes of elements differ, they suit the other operator. All levels are then solved again.
    fn take_over(&self, begun: Begun<TileStart>, observer: &dyn Observer) -> Finest {
        let is_again = self.params.border_level > 0;
        let begun = if is_again { self.climb(self.begin(observer), observer) } else { begun };
        self.solve_finest(begun, observer)
    }

    /// Solves the finest level again, from a solution with another operator.
    fn improve(&self, solved: Finest, observer: &dyn Observer) -> Finest {
        let Finest { grid, level, tile_fraction, mut history, .. } = solved;
        let SolvedLevel { elements, pressure, outcome, info: before, work, .. } = level;
        history.levels.pop();
        let mesh = MeshStart { elements, pressure };
        let (contact_gap, energy_length) = (outcome.contact_gap, outcome.energy_length(&self.problem));
        let start = TileStart { grid, mesh, contact_gap, energy_length, tile_fraction };
        let mut solved = self.take_over(Begun { above: 0, start, history }, observer);
        if let Some(finest) = solved.history.levels.last_mut() {
            add_work(finest, &before);
        }
        solved.level.work = solved.level.work.plus(work);
        solved
    }

    /// Makes the solution from the solved levels.
    fn solution(&self, solved: Finest) -> TileSolution<'a> {
        let Finest { grid, level, history, .. } = solved;
        let SolvedLevel { elements, pressure, gap, outcome, evaluated, covered, work, .. } = level;
        let (contact_gap, hardness) = (outcome.contact_gap, self.problem.bounds.hardness);
        let bias = self.kernel.get().edge_bias(grid);
        let moduli = [1.0; 2];
        let values = Values { mesh: &elements, pressure: &pressure, gap: &gap, contact_gap, hardness, bias, moduli };
        let area = match self.data.kernels.sliding() {
            Some(compliance) => values.sliding_area(grid, compliance),
            None => values.contact_area(grid),
        };
        let plastic = values.plastic_edges(grid);
        drop(gap);
        let mut info = outcome.info(&self.problem, history.levels, history.coarser);
        if self.boundary() == Boundary::Free {
            info.mean_displacement += displacement_of_patch(&elements, &pressure, grid);
        }
        info.friction = self.friction(grid, (&elements, &pressure), &info, work);
        let (mesh, pressure) = self.in_contact(elements, pressure);
        TileSolution {
            data: Arc::clone(&self.data),
            h_max: self.problem.h_max,
            converged: outcome.certificate.meets(self.params.solve.bound),
            grid: self.solution_grid(),
            finest: grid,
            mesh,
            pressure,
            area,
            hardness,
            plastic,
            info,
            evaluated,
            proven: grid.len() - covered,
        }
    }

    /// The tiles in contact and the pressure on them, on which later sums have the same digits.
    fn in_contact(&self, elements: Mesh, pressure: Vec<f64>) -> (Mesh, Vec<f64>) {
        // A uniform displacement is subtracted where elements cover the cell, and tails skip missing tiles.
        if elements.cover_cell() || self.data.kernels.is_sliding() {
            return (elements, pressure);
        }
        match elements.thinned(|cells| pressure[cells].iter().any(|p| *p > 0.0 || p.is_nan())) {
            Some(mesh) if !mesh.is_empty() => {
                let pressure = elements.moved(&mesh, &pressure, 0.0);
                (mesh, pressure)
            }
            _ => (elements, pressure),
        }
    }

    /// Friction coefficient of a level. `None` if nothing slides.
    fn coefficient(&self, above: usize, level: &SolvedLevel) -> Option<f64> {
        let (kernel, grid) = (self.kernel.get(), self.grid(above));
        kernel.sliding_velocity()?;
        let (mesh, pressure) = (&level.elements, &level.pressure);
        let contact = SlidingContact { data: &self.data, kernel, grid, mesh, pressure };
        Some(contact.force() / level.outcome.mean_pressure)
    }

    /// Friction of a pressure on elements of `grid`. `None` if nothing slides.
    fn friction(
        &self,
        grid: Grid,
        (mesh, pressure): (&Mesh, &[f64]),
        info: &SolveInfo,
        work: Work,
    ) -> Option<Friction> {
        let kernel = self.kernel.get();
        let contact = SlidingContact { data: &self.data, kernel, grid, mesh, pressure };
        Some(finished((info, Status::Converged, false), &contact.sums()?, kernel.sliding_velocity()?, work))
    }

    fn nested<'n>(&'n self, n_levels: usize, observer: &'n dyn Observer) -> Nested<'n> {
        Nested { problem: &self.problem, params: self.params.solve, n_levels, observer }
    }

    /// The scale of a pressure, which the error of an operator depends on.
    ///
    /// It is known as far as a start shows it.
    pub(crate) fn scale(&self, start: &TileStart) -> PressureScale {
        let TileStart { grid, mesh, contact_gap, energy_length, .. } = start;
        let size = self.largest_displacement(mesh, *contact_gap);
        let levels = (self.n_levels(*grid), self.data.kernels.unresolved());
        PressureScale::new((&mesh.elements, &mesh.pressure), levels, size, *energy_length)
    }
}

impl Levels for TileLevels<'_> {
    type Start = TileStart;
    type Solved = (SolvedLevel, f64);

    const SKIPS: bool = false;

    fn grid(&self, above: usize) -> Grid {
        self.ladder().grid(self.ladder().n_levels() - above)
    }

    fn solve_level(&self, above: usize, start: TileStart, goal: Goal, observer: &dyn Observer) -> Self::Solved {
        (solve_coarse_level(self, self.grid(above), start.mesh, goal, observer), start.tile_fraction)
    }

    fn info(&self, (level, _): &Self::Solved) -> LevelInfo {
        level.info
    }

    fn values(&self, (level, _): &Self::Solved, above: usize) -> Option<LevelValues> {
        self.ladder().is_even().then(|| LevelValues {
            rms_pressure: rms_pressure(&level.elements, &level.pressure),
            penetration: self.problem.h_max + level.outcome.approach,
            friction: self.coefficient(above, level),
        })
    }

    /// The start on all elements of the grid, or only on those at edges of contacts.
    fn start(&self, (level, tile_fraction): Self::Solved, above: usize) -> TileStart {
        let SolvedLevel { elements, pressure, gap, outcome, .. } = &level;
        let function = prolongation::edge_function(elements, pressure, gap, outcome.contact_gap);
        let grid = self.grid(above);
        let mesh = if above < self.params.border_level {
            refine_some(elements, pressure, &function, self.refined(&level.fields(), true))
        } else {
            refine_all(elements, &function, grid)
        };
        let (contact_gap, energy_length) = (outcome.contact_gap, outcome.energy_length(&self.problem));
        TileStart { grid, mesh, contact_gap, energy_length, tile_fraction }
    }

    fn keep(&self, begun: &Begun<TileStart>) {
        if let Some(checkpoint) = &self.checkpoint {
            keep(&**checkpoint, &begun.start, &begun.history);
        }
    }
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
