//! Heavy contact, solved for its gap on one grid.
//!
//! Where most of the surface is in contact, the gap g is zero but in pools. With K = L⁻¹ (and no mean), the pressure is
//!
//! ```text
//! p(g) = σ0 + K (h + g),        p ≥ 0,  g ≥ 0,  g p = 0.
//! ```
//!
//! The gap is interpolated from the coarser grid, and cycles correct it ([`crate::levels::gap_cycle`]). One application
//! of K in double precision then gives p(g). Taking p - k g where it is positive, with the k of an element whose gap
//! closes alone, and zero elsewhere, and restoring the load nearby, makes a pressure p̂ that is admissible. With
//! x = p̂ - p(g), the gap of p̂ is g + L x up to a constant, and the exact pressure p* and gap g* obey
//!
//! ```text
//! ⟨p̂ - p*, L (p̂ - p*)⟩ = ⟨p̂ - p*, g + L x - g*⟩ ≤ ⟨p̂ g⟩ + ⟨p̂ - p*, L x⟩,
//! ```
//!
//! because p* g* = 0 and no product of a pressure with a gap is negative. The error e of p̂ in the energy norm therefore
//! has e² ≤ ⟨p̂ g⟩ + e ‖x‖, with ‖x‖ in that norm.

use std::ops::Range;

use rc_core::{Field, Grid};
use rc_fft::{BLOCK_ROWS, Convolution};

use crate::descent::sums::GapSums;
use crate::grid::passes::{layout, read_rows, write_rows};
use crate::grid::response::GridResponse;
use crate::levels::gap_cycle::{GapGrid, cycle};
use crate::parallel::{self, Tasks};
use crate::problem::checked::Problem;

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
    /// Number of applications of L and K that it took.
    pub(super) applications: usize,
}

/// Maximum number of further cycles.
const MAX_CYCLES: usize = 2;

/// Ratio of the errors before and after a cycle above which there is no other one.
const LEAST_FALL: f64 = 0.5;

/// Improves a `gap` that was interpolated to the first of `grids`. Returns it with its pressure.
///
/// Either a cycle does, or only steps near pools.
pub(super) fn improve(
    mut gap: Vec<f64>,
    heights: &Field,
    (grids, is_cycle): (&mut [GapGrid], bool),
    (problem, mean): (&Problem, f64),
) -> [Vec<f64>; 2] {
    let mut pressure = parallel::zeros(gap.len());
    let shape = |at: usize| heights.values()[at] - problem.h_mean + gap[at];
    grids[0].pressure_under(mean, shape, &mut pressure);
    if is_cycle {
        cycle(grids, 0, &mut gap, &mut pressure);
    } else {
        grids[0].relax(&mut gap, &mut pressure);
    }
    [gap, pressure]
}

/// The solution on the first of `grids` that follows from an improved gap and its pressure.
///
/// Cycles go on until its error, in units of √U, is within the `goal`, or no longer falls.
pub(super) fn solve(
    [gap, pressure]: [Vec<f64>; 2],
    heights: &Field,
    (grids, response): (&mut [GapGrid], &GridResponse),
    (problem, mean): (&Problem, f64),
    (goal, should_stop): (f64, &dyn Fn() -> bool),
) -> GapSolution {
    let mut side = GapSide { grid: heights.grid(), heights: heights.values(), problem, mean, pressure, gap };
    let (mut last, mut n_cycles) = (f64::INFINITY, 0);
    loop {
        let pieces = side.fresh(response, grids[0].closing());
        let error = side.displace(grids[0].convolution(), response, &pieces);
        let relative = (error / pieces.energy).sqrt();
        let has_fallen = relative < LEAST_FALL * last;
        if relative <= goal || n_cycles == MAX_CYCLES || !has_fallen || should_stop() {
            let (sums, applications) = (side.make_admissible(grids[0].convolution(), &pieces), 2 + 3 * n_cycles);
            let GapSide { pressure, gap, .. } = side;
            return GapSolution { pressure, gap, sums, error, applications };
        }
        cycle(grids, 0, &mut side.gap, &mut side.pressure);
        (last, n_cycles) = (relative, n_cycles + 1);
    }
}

struct GapSide<'a> {
    grid: Grid,
    heights: &'a [f64],
    problem: &'a Problem,
    mean: f64,
    pressure: Vec<f64>,
    gap: Vec<f64>,
}

/// The factors that restore the load of pieces, the mean gap, and the energy U.
struct Pieces {
    /// For each block of rows, a factor for each piece along x.
    factors: Vec<Vec<f64>>,
    mean_gap: f64,
    energy: f64,
    closing: f64,
}

impl Pieces {
    /// The factors for pieces with these loads before and after pressures are set to zero.
    ///
    /// The loads are those of blocks, piece by piece. What a piece cannot take goes to the pieces around it, in squares of
    /// growing size. The cell takes the rest, so that the load becomes `whole`.
    fn new(loads: &[Vec<[f64; 2]>], whole: f64, [mean_gap, energy, closing]: [f64; 3]) -> Self {
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
        Self { factors, mean_gap, energy, closing }
    }

    /// The pressure p̂ of an element in block `i`.
    fn admissible(&self, (i, x): (usize, usize), pressure: f64, gap: f64) -> f64 {
        allowed(pressure, gap, self.closing) * self.factors[i][x / PIECE]
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

/// The pressure of an element whose gap closes alone, or zero.
///
/// `closing` is the pressure by which the element itself answers to a gap of 1.
fn allowed(pressure: f64, gap: f64, closing: f64) -> f64 {
    (pressure - closing * gap).max(0.0)
}

/// Sets pressures to zero where they must not be.
pub(super) fn allow(pressure: &mut [f64], gap: &[f64], (nx, closing): (usize, f64)) {
    parallel::for_each(pressure.chunks_mut(nx).zip(gap.chunks(nx)), |(pressure, gap)| {
        pressure.iter_mut().zip(gap).for_each(|(p, g)| *p = allowed(*p, *g, closing));
    });
}

impl GapSide<'_> {
    fn len(&self) -> usize {
        BLOCK_ROWS * self.grid.nx()
    }

    /// Computes p(g) afresh, in double precision.
    fn fresh(&mut self, response: &GridResponse, closing: f64) -> Pieces {
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
        let tasks = Tasks::new(self.pressure.chunks_mut(len).zip(gap.chunks(len).zip(heights.chunks(len))));
        read_rows(&convolution, &|i, rows| {
            tasks.run(i, |(pressure, (gap, heights)): (&mut [f64], (&[f64], &[f64]))| {
                let mut works = 0.0;
                for ((p, row), (g, h)) in pressure.iter_mut().zip(rows).zip(gap.iter().zip(heights)) {
                    *p = mean + row;
                    works += row * (h - h_mean + g);
                }
                (loads_of_block((grid.nx(), closing), pressure, gap), [gap.iter().sum::<f64>(), 0.5 * works])
            });
        });
        let (loads, sums): (Vec<_>, Vec<[f64; 2]>) = tasks.into_results().into_iter().unzip();
        let n = grid.len() as f64;
        let [mean_gap, energy] = [0, 1].map(|k| sums.iter().map(|sum| sum[k]).sum::<f64>() / n);
        Pieces::new(&loads, mean * n, [mean_gap, energy, closing])
    }

    /// Computes the displacement by the change x to the pressure p̂, and returns the bound on the error.
    fn displace(&self, quick: &mut Convolution<f32>, response: &GridResponse, pieces: &Pieces) -> f64 {
        let (len, nx, unit) = (self.len(), self.grid.nx(), self.problem.unit());
        let (pressure, gap) = (&self.pressure, &self.gap);
        let admissible = |i: usize, at: usize| {
            let (p, g) = (pressure[i * len + at], gap[i * len + at]);
            (pieces.admissible((i, at % nx), p, g), p, g)
        };
        write_rows(quick, &|i, rows| {
            for (at, row) in rows.iter_mut().enumerate() {
                let (allowed, p, _) = admissible(i, at);
                *row = ((allowed - p) / unit) as f32;
            }
        });
        response.factors.to_single().apply(quick);
        let tasks = Tasks::new(pressure.chunks(len));
        read_rows(quick, &|i, rows| {
            tasks.run(i, |_| {
                rows.iter().enumerate().fold([0.0; 2], |[work, closed], (at, row)| {
                    let (allowed, p, g) = admissible(i, at);
                    [work + (allowed - p) * unit * f64::from(*row), closed + allowed * g]
                })
            });
        });
        let sums = tasks.into_results();
        let [work, closed] = [0, 1].map(|k| sums.iter().map(|sum| sum[k]).sum::<f64>() / self.grid.len() as f64);
        // e² ≤ ⟨p̂ g⟩ + e ‖x‖.
        (0.5 * work.sqrt() + (0.25 * work + closed).sqrt()).powi(2)
    }

    /// Makes the pressure p̂ and its gap, from the displacement of the change. Returns sums over the result.
    fn make_admissible(&mut self, quick: &Convolution<f32>, pieces: &Pieces) -> GapSums {
        let (len, nx, unit) = (self.len(), self.grid.nx(), self.problem.unit());
        let (floor, shift) = (self.problem.offset(), -self.problem.h_mean - pieces.mean_gap);
        let blocks = self.pressure.chunks_mut(len).zip(self.gap.chunks_mut(len)).zip(self.heights.chunks(len));
        let tasks = Tasks::new(blocks);
        let empty = GapSums::empty(f64::INFINITY, f64::INFINITY);
        read_rows(quick, &|i, rows| {
            tasks.run(i, |((pressure, gap), heights): ((&mut [f64], &mut [f64]), &[f64])| {
                let mut sums = empty;
                for (at, (((p, g), h), row)) in pressure.iter_mut().zip(gap).zip(heights).zip(rows).enumerate() {
                    *p = pieces.admissible((i, at % nx), *p, *g);
                    *g += unit * f64::from(*row) + shift + floor;
                    sums.add_element(*p, *g, h - floor);
                }
                sums
            });
        });
        GapSums::total(&layout(self.grid), tasks.into_results())
    }
}

/// The loads of the pieces of a block, before and after pressures are set to zero.
fn loads_of_block((nx, closing): (usize, f64), pressure: &[f64], gap: &[f64]) -> Vec<[f64; 2]> {
    let mut loads = vec![[0.0; 2]; nx.div_ceil(PIECE)];
    for (pressure, gap) in pressure.chunks(nx).zip(gap.chunks(nx)) {
        for ((pressure, gap), [before, after]) in pressure.chunks(PIECE).zip(gap.chunks(PIECE)).zip(&mut loads) {
            for (p, g) in pressure.iter().zip(gap) {
                *before += p;
                *after += allowed(*p, *g, closing);
            }
        }
    }
    loads
}
