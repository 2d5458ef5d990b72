//! Nearly full contact, solved for its gap on one grid.
//!
//! Where almost everything touches, the gap g is zero but in a few pools. With K = L⁻¹ (and no mean), the pressure is
//!
//! ```text
//! p(g) = σ0 + K (h + g),        p ≥ 0,  g ≥ 0,  g p = 0.
//! ```
//!
//! The gap is interpolated from the coarser grid, and a few steps near the pools correct it ([`crate::levels::gap_sweeps`]).
//! One application of K in double precision then gives p(g). Setting it to zero in the pools and where it is negative,
//! and restoring the load nearby, makes a pressure p̂ that is admissible. With x = p̂ - p(g), the gap of p̂ is g + L x up to
//! a constant, and the exact pressure p* and gap g* obey
//!
//! ```text
//! ⟨p̂ - p*, L (p̂ - p*)⟩ = ⟨p̂ - p*, g + L x - g*⟩ ≤ ⟨p̂ g⟩ + ⟨p̂ - p*, L x⟩,
//! ```
//!
//! because p* g* = 0 and no product of a pressure with a gap is negative. Since p̂ g = 0, the error of p̂ in the energy
//! norm is at most ‖x‖ in that norm.

use std::ops::Range;

use rc_core::{Field, Grid, Kernel};
use rc_fft::{BLOCK_ROWS, Convolution};
use rc_quadtree::TILE;

use crate::descent::rows::ElementValues;
use crate::descent::sums::GapSums;
use crate::grid::passes::{layout, read_rows, write_rows};
use crate::grid::response::GridResponse;
use crate::levels::gap_sweeps::{NearKernel, Pools};
use crate::parallel::Tasks;
use crate::problem::checked::Problem;

/// Applications of L and of K.
pub(super) const APPLICATIONS: usize = 3;

/// Elements of pools reach this far for the tiles that steps change.
const MARGIN: usize = 2;

/// Elements along a row of the pieces of blocks that keep their load.
///
/// Moving load over short distances changes the gap little.
const PIECE: usize = 64;

/// Bounds of a factor that restores the load of pieces.
///
/// Where a pool covers most of a piece, the rest of the piece would have to take too much.
const FACTORS: [f64; 2] = [0.95, 1.05];

/// Growth of the squares of pieces that restore their load.
const GROWTH: usize = 4;

/// A pressure that follows from a gap.
pub(super) struct GapSolution {
    /// The admissible pressure p̂.
    pub(super) pressure: Vec<f64>,
    /// Its gap, with the offset of a descent.
    pub(super) gap: Vec<f64>,
    /// Sums over both, in units of a descent.
    pub(super) sums: GapSums,
    /// Bound on ⟨p̂ - p*, L (p̂ - p*)⟩.
    pub(super) error: f64,
}

/// The solution on a grid that follows from a `gap` interpolated to it.
pub(super) fn solve(
    gap: Vec<f64>,
    heights: &Field,
    (kernel, response): (&dyn Kernel, &GridResponse),
    (problem, mean): (&Problem, f64),
) -> GapSolution {
    let grid = heights.grid();
    let mut side = GapSide { grid, heights: heights.values(), problem, mean, pressure: vec![0.0; grid.len()], gap };
    let mut quick = Convolution::new(grid);
    side.improve(&mut quick, kernel, response);
    let pieces = side.fresh(response);
    let (error, sums) = side.make_admissible(&mut quick, response, &pieces);
    let GapSide { pressure, gap, .. } = side;
    GapSolution { pressure, gap, sums, error }
}

struct GapSide<'a> {
    grid: Grid,
    heights: &'a [f64],
    problem: &'a Problem,
    mean: f64,
    pressure: Vec<f64>,
    gap: Vec<f64>,
}

/// The factors that restore the load of pieces, and the mean gap.
struct Pieces {
    /// For each block of rows, a factor for each piece along x.
    factors: Vec<Vec<f64>>,
    mean_gap: f64,
}

impl Pieces {
    /// The factors for pieces with these loads before and after pressures are set to zero.
    ///
    /// The loads are those of blocks, piece by piece. What a piece cannot take goes to the pieces around it, in squares of
    /// growing size. The cell takes the rest, so that the load becomes `whole`.
    fn new(loads: &[Vec<[f64; 2]>], whole: f64, mean_gap: f64) -> Self {
        let mut factors: Vec<Vec<f64>> = loads.iter().map(|block| vec![1.0; block.len()]).collect();
        let (n_blocks, n_pieces) = (loads.len(), loads.first().map_or(0, Vec::len));
        let (mut rows, mut columns) = (1, 1);
        while rows < n_blocks || columns < n_pieces {
            for first in (0..n_blocks).step_by(rows) {
                for left in (0..n_pieces).step_by(columns) {
                    let (blocks, pieces) = (first..(first + rows).min(n_blocks), left..(left + columns).min(n_pieces));
                    let [before, after] = load_of(loads, &factors, (blocks.clone(), pieces.clone()));
                    let factor = before / after;
                    if factor > FACTORS[0] && factor < FACTORS[1] {
                        let within = factors[blocks].iter_mut().flat_map(|block| &mut block[pieces.clone()]);
                        within.for_each(|value| *value *= factor);
                    }
                }
            }
            (rows, columns) = (GROWTH * rows, if rows == 1 { 1 } else { GROWTH * columns });
        }
        let [_, after] = load_of(loads, &factors, (0..n_blocks, 0..n_pieces));
        factors.iter_mut().flatten().for_each(|factor| *factor *= whole / after);
        Self { factors, mean_gap }
    }

    /// The pressure p̂ of an element in block `i`.
    fn admissible(&self, (i, x): (usize, usize), pressure: f64, gap: f64) -> f64 {
        allowed(pressure, gap) * self.factors[i][x / PIECE]
    }
}

/// The loads of some blocks and pieces, before and after, with the factors on the latter.
fn load_of(loads: &[Vec<[f64; 2]>], factors: &[Vec<f64>], (blocks, pieces): (Range<usize>, Range<usize>)) -> [f64; 2] {
    let mut sums = [0.0; 2];
    for (loads, factors) in loads[blocks.clone()].iter().zip(&factors[blocks]) {
        for ([before, after], factor) in loads[pieces.clone()].iter().zip(&factors[pieces.clone()]) {
            sums[0] += before;
            sums[1] += factor * after;
        }
    }
    sums
}

/// A pressure, or zero where it must not be.
fn allowed(pressure: f64, gap: f64) -> f64 {
    if gap > 0.0 { 0.0 } else { pressure.max(0.0) }
}

impl GapSide<'_> {
    fn len(&self) -> usize {
        BLOCK_ROWS * self.grid.nx()
    }

    /// Changes the gap until the pressure nearly vanishes in the pools.
    fn improve(&mut self, quick: &mut Convolution<f32>, kernel: &dyn Kernel, response: &GridResponse) {
        let (unit, len, mean) = (self.problem.unit(), self.len(), self.mean);
        let (gap, heights, h_mean) = (&self.gap, self.heights, self.problem.h_mean);
        write_rows(quick, &|i, rows| {
            let here = i * len..i * len + rows.len();
            for ((row, h), g) in rows.iter_mut().zip(&heights[here.clone()]).zip(&gap[here]) {
                *row = ((h - h_mean + g) / unit) as f32;
            }
        });
        response.factors.storage_inverse(self.grid).apply(quick);
        let (grid, tasks) = (self.grid, Tasks::new(self.pressure.chunks_mut(len).zip(gap.chunks(len))));
        read_rows(quick, &|i, rows| {
            tasks.run(i, |(pressure, gap): (&mut [f64], &[f64])| {
                pressure.iter_mut().zip(rows).for_each(|(p, row)| *p = mean + unit * f64::from(*row));
                tiles_at_pools(grid, i * BLOCK_ROWS, [pressure, gap])
            });
        });
        let mut places = tasks.into_results().concat();
        places.sort_unstable();
        places.dedup();
        let mut pools = Pools::new(grid, places, [&self.gap, &self.pressure], unit);
        pools.relax(&NearKernel::new(kernel, grid, unit));
        pools.put_gap(grid, &mut self.gap, unit);
    }

    /// Computes p(g) afresh, in double precision.
    fn fresh(&mut self, response: &GridResponse) -> Pieces {
        let (grid, len, mean) = (self.grid, self.len(), self.mean);
        let (gap, heights, h_mean) = (&self.gap, self.heights, self.problem.h_mean);
        let mut convolution = Convolution::new(grid);
        write_rows(&mut convolution, &|i, rows| {
            let here = i * len..i * len + rows.len();
            for ((row, h), g) in rows.iter_mut().zip(&heights[here.clone()]).zip(&gap[here]) {
                *row = h - h_mean + g;
            }
        });
        response.factors.inverse(grid).apply(&mut convolution);
        let tasks = Tasks::new(self.pressure.chunks_mut(len).zip(gap.chunks(len)));
        read_rows(&convolution, &|i, rows| {
            tasks.run(i, |(pressure, gap): (&mut [f64], &[f64])| {
                pressure.iter_mut().zip(rows).for_each(|(p, row)| *p = mean + row);
                loads_of_block(grid.nx(), pressure, gap)
            });
        });
        let (loads, gaps): (Vec<_>, Vec<f64>) = tasks.into_results().into_iter().unzip();
        let n = grid.len() as f64;
        Pieces::new(&loads, mean * n, gaps.into_iter().sum::<f64>() / n)
    }

    /// Makes the pressure p̂ and its gap. Returns ⟨x L x⟩ for the change x of the pressure, and sums over the result.
    fn make_admissible(
        &mut self,
        quick: &mut Convolution<f32>,
        response: &GridResponse,
        pieces: &Pieces,
    ) -> (f64, GapSums) {
        let (len, nx, unit) = (self.len(), self.grid.nx(), self.problem.unit());
        let (pressure, gap) = (&self.pressure, &self.gap);
        write_rows(quick, &|i, rows| {
            let here = i * len..i * len + rows.len();
            for (at, (row, (p, g))) in rows.iter_mut().zip(pressure[here.clone()].iter().zip(&gap[here])).enumerate() {
                *row = ((pieces.admissible((i, at % nx), *p, *g) - p) / unit) as f32;
            }
        });
        response.factors.to_single().apply(quick);
        let (floor, shift) = (self.problem.offset(), -self.problem.h_mean - pieces.mean_gap);
        let elements = ElementValues { heights: self.heights, pressure: &mut self.pressure, gap: &mut self.gap };
        let tasks = Tasks::new(elements.blocks(len));
        let empty = GapSums::empty(f64::INFINITY, f64::INFINITY);
        read_rows(quick, &|i, rows| {
            tasks.run(i, |ElementValues { heights, pressure, gap }: ElementValues<'_>| {
                let (mut sum, mut sums) = (0.0, empty);
                for (at, (((p, g), h), row)) in pressure.iter_mut().zip(gap).zip(heights).zip(rows).enumerate() {
                    let (admissible, displacement) = (pieces.admissible((i, at % nx), *p, *g), unit * f64::from(*row));
                    sum += (admissible - *p) * displacement;
                    (*p, *g) = (admissible, *g + displacement + shift + floor);
                    sums.add_element(*p, *g, h - floor);
                }
                (sum, sums)
            });
        });
        let (works, sums): (Vec<f64>, Vec<GapSums>) = tasks.into_results().into_iter().unzip();
        let error = works.into_iter().sum::<f64>() / self.grid.len() as f64;
        (error, GapSums::total(&layout(self.grid), sums))
    }
}

/// The loads of the pieces of a block, before and after pressures are set to zero, and Σ g.
fn loads_of_block(nx: usize, pressure: &[f64], gap: &[f64]) -> (Vec<[f64; 2]>, f64) {
    let mut loads = vec![[0.0; 2]; nx.div_ceil(PIECE)];
    let mut gaps = 0.0;
    for (pressure, gap) in pressure.chunks(nx).zip(gap.chunks(nx)) {
        for ((pressure, gap), [before, after]) in pressure.chunks(PIECE).zip(gap.chunks(PIECE)).zip(&mut loads) {
            for (p, g) in pressure.iter().zip(gap) {
                *before += p;
                *after += allowed(*p, *g);
                gaps += g;
            }
        }
    }
    (loads, gaps)
}

/// The tiles at elements with a gap or a tensile pressure, in a block of rows from `first` on.
fn tiles_at_pools(grid: Grid, first: usize, [pressure, gap]: [&[f64]; 2]) -> Vec<[u32; 2]> {
    let (nx, ny) = (grid.nx(), grid.ny());
    let tiles = |i: usize, n: usize| [(i + n - MARGIN) % n / TILE, (i + MARGIN) % n / TILE];
    let mut places = Vec::new();
    for (y, (pressure, gap)) in pressure.chunks(nx).zip(gap.chunks(nx)).enumerate() {
        let (rows, mut last) = (tiles(first + y, ny), [usize::MAX; 2]);
        for (x, _) in pressure.iter().zip(gap).enumerate().filter(|(_, (p, g))| **g > 0.0 || **p < 0.0) {
            let columns = tiles(x, nx);
            if columns != last {
                last = columns;
                let at = |row: usize| columns.map(|column| [column as u32, row as u32]);
                places.extend(rows.into_iter().flat_map(at));
            }
        }
    }
    places.sort_unstable();
    places.dedup();
    places
}
