//! Heavy contact, solved for its gap on one grid.
//!
//! Where most of the surface is in contact, the gap g is zero but in pools. With K = L⁻¹ (and no mean), the pressure is
//!
//! ```text
//! p(g) = σ0 + K (h + g),        p ≥ 0,  g ≥ 0,  g p = 0.
//! ```
//!
//! The gap is interpolated from the coarser grid, and cycles correct it ([`crate::levels::gap_cycle`]). One more
//! application of K gives p(g). Taking p - k g where it is positive, with the k of an element whose gap
//! closes alone, and zero elsewhere, and restoring the load nearby, makes a pressure p̂ that is admissible. With
//! x = p̂ - p(g), the gap of p̂ is g + L x up to a constant, and the exact pressure p* and gap g* obey
//!
//! ```text
//! ⟨p̂ - p*, L (p̂ - p*)⟩ = ⟨p̂ - p*, g + L x - g*⟩ ≤ ⟨p̂ g⟩ + ⟨p̂ - p*, L x⟩,
//! ```
//!
//! because p* g* = 0 and no product of a pressure with a gap is negative. The error e of p̂ in the energy norm therefore
//! has e² ≤ ⟨p̂ g⟩ + e ‖x‖, with ‖x‖ in that norm. K is applied in single precision, whose error is added to ‖x‖.

use std::ops::Range;

use rc_core::Grid;
use rc_fft::{BLOCK_ROWS, Convolution, SymbolTable};

use crate::descent::sums::GapSums;
use crate::grid::passes::{layout, read_rows, write_rows};
use crate::levels::gap_cycle::{GapGrid, Shape, cycle};
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

/// Maximum number of further corrections.
const MAX_CORRECTIONS: usize = 2;

/// Ratio of the error to its goal up to which steps near pools are the first of them.
///
/// In nearly full contact they made the error 2.4 to 10 times smaller.
const STEPS_DO: f64 = 4.0;

/// Ratio of the errors after and before a cycle above which there is no other one.
const LEAST_FALL: f64 = 0.5;

/// A gap on a grid, and the pressure σ0 + K (h + g) that it was last known to have.
pub(super) struct GapState<'a> {
    pub(super) shape: Shape<'a>,
    /// In units of [`Problem::unit`].
    pub(super) gap: Vec<f32>,
    /// In E*.
    pub(super) pressure: Vec<f32>,
}

impl<'a> GapState<'a> {
    /// A `gap` that was interpolated to the first of `grids`, improved.
    ///
    /// Either a cycle does, or only steps near pools.
    pub(super) fn improved(gap: Vec<f32>, shape: Shape<'a>, (grids, is_cycle): (&mut [GapGrid], bool)) -> Self {
        let (mut gap, mut pressure) = (gap, vec![0.0; shape.heights.len()]);
        grids[0].pressure_under(&shape, &gap, &mut pressure, |_, _| ());
        if is_cycle {
            cycle(grids, &mut gap, &mut pressure);
        } else {
            grids[0].relax(&mut gap, &mut pressure);
        }
        Self { shape, gap, pressure }
    }

    /// The solution on the first of `grids` that follows. `response` is L.
    ///
    /// Corrections go on until its error, in units of √U, is within the `goal`, or no longer falls. They are cycles, but
    /// the first may be steps near pools where contact `is_nearly_full`.
    pub(super) fn solve(
        mut self,
        (grids, response, is_nearly_full): (&mut [GapGrid], &SymbolTable<f32>, bool),
        (grid, problem): (Grid, &Problem),
        (goal, should_stop): (f64, &dyn Fn() -> bool),
    ) -> GapSolution {
        let (mut last, mut n_corrections, mut applications) = (f64::INFINITY, 0, 2);
        loop {
            let pieces = self.fresh(&mut grids[0], (grid, problem.unit()));
            let side = GapSide { grid, unit: problem.unit(), state: &self, pieces };
            let error = side.displace(grids[0].convolution(), response);
            let relative = (error / side.pieces.energy).sqrt();
            let has_fallen = relative < LEAST_FALL * last;
            if relative <= goal || n_corrections == MAX_CORRECTIONS || !has_fallen || should_stop() {
                let ([pressure, gap], sums) = side.admissible(grids[0].convolution(), problem);
                return GapSolution { pressure, gap, sums, error, applications };
            }
            if is_nearly_full && n_corrections == 0 && relative < STEPS_DO * goal {
                grids[0].relax(&mut self.gap, &mut self.pressure);
                applications += 2;
            } else {
                cycle(grids, &mut self.gap, &mut self.pressure);
                (last, applications) = (relative, applications + 3);
            }
            n_corrections += 1;
        }
    }

    /// Computes p(g) afresh.
    fn fresh(&mut self, on_grid: &mut GapGrid, (grid, unit): (Grid, f64)) -> Pieces {
        let (shape, closing) = (&self.shape, on_grid.closing());
        let len = BLOCK_ROWS * grid.nx();
        let noted = on_grid.pressure_under(shape, &self.gap, &mut self.pressure, |i, [gap, pressure]| {
            let heights = &shape.heights[i * len..][..gap.len()];
            let (mut works, mut gaps) = (0.0, 0.0);
            for (p, (g, h)) in pressure.iter().zip(gap.iter().zip(heights)) {
                let g = unit * f64::from(*g);
                works += (f64::from(*p) - shape.mean_pressure) * (h - shape.mean_height + g);
                gaps += g;
            }
            (loads_of_block((grid.nx(), closing), pressure, gap), [gaps, 0.5 * works])
        });
        let (loads, sums): (Vec<_>, Vec<[f64; 2]>) = noted.into_iter().unzip();
        let n = grid.len() as f64;
        let means = [0, 1].map(|k| sums.iter().map(|sum| sum[k]).sum::<f64>() / n);
        Pieces::new(&loads, shape.mean_pressure * n, means, closing)
    }
}

/// Error of p(g) in the energy norm by single precision, in units of √U, for each √n of n elements along a side.
///
/// White noise of 2⁻²⁴ of the heights would give it this dependence on n.
const ROUNDING: f64 = 7e-8;

/// Rounding of a stored number in single precision.
const STORED: f64 = 3e-8;

/// The error of p(g) by single precision, in units of √U.
pub(super) fn rounding(grid: Grid) -> f64 {
    ROUNDING * (grid.nx().max(grid.ny()) as f64).sqrt()
}

/// The factors that restore the load of pieces, the mean gap, and the energy U.
struct Pieces {
    /// For each block of rows, a factor for each piece along x.
    factors: Vec<Vec<f64>>,
    mean_gap: f64,
    energy: f64,
    closing: f32,
}

impl Pieces {
    /// The factors for pieces with these loads before and after pressures are set to zero.
    ///
    /// The loads are those of blocks, piece by piece. What a piece cannot take goes to the pieces around it, in squares of
    /// growing size. The cell takes the rest, so that the load becomes `whole`.
    fn new(loads: &[Vec<[f64; 2]>], whole: f64, [mean_gap, energy]: [f64; 2], closing: f32) -> Self {
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
fn allowed(pressure: f32, gap: f32, closing: f32) -> f32 {
    (pressure - closing * gap).max(0.0)
}

/// Sets pressures to zero where they must not be.
pub(super) fn allow(pressure: &mut [f32], gap: &[f32], (nx, closing): (usize, f32)) {
    parallel::for_each(pressure.chunks_mut(nx).zip(gap.chunks(nx)), |(pressure, gap)| {
        pressure.iter_mut().zip(gap).for_each(|(p, g)| *p = allowed(*p, *g, closing));
    });
}

/// A gap whose pressure is known afresh, and the pressure p̂ that follows.
struct GapSide<'a> {
    grid: Grid,
    unit: f64,
    state: &'a GapState<'a>,
    pieces: Pieces,
}

impl GapSide<'_> {
    /// Calls `of_piece` with each piece of block `i`: its factor, and its elements in the block.
    fn for_each_piece(&self, (i, n): (usize, usize), mut of_piece: impl FnMut(f64, Range<usize>)) {
        for start in (0..n).step_by(PIECE) {
            of_piece(self.pieces.factors[i][start % self.grid.nx() / PIECE], start..start + PIECE);
        }
    }

    /// Gap and pressure of block `i`.
    fn block(&self, i: usize) -> [&[f32]; 2] {
        let (len, GapState { gap, pressure, .. }) = (BLOCK_ROWS * self.grid.nx(), self.state);
        [gap, pressure].map(|values| &values[i * len..values.len().min((i + 1) * len)])
    }

    /// Computes the displacement by the change x to the pressure p̂, and returns the bound on the error.
    fn displace(&self, quick: &mut Convolution<f32>, response: &SymbolTable<f32>) -> f64 {
        let (unit, closing) = (self.unit, self.pieces.closing);
        let change = |factor: f64, p: f32, g: f32| factor * f64::from(allowed(p, g, closing)) - f64::from(p);
        write_rows(quick, &|i, rows| {
            let [gap, pressure] = self.block(i);
            self.for_each_piece((i, rows.len()), |factor, piece| {
                let elements = pressure[piece.clone()].iter().zip(&gap[piece.clone()]);
                for (row, (p, g)) in rows[piece].iter_mut().zip(elements) {
                    *row = (change(factor, *p, *g) / unit) as f32;
                }
            });
        });
        quick.apply_symbol(response);
        let tasks = Tasks::new(self.pieces.factors.iter());
        read_rows(quick, &|i, rows| {
            tasks.run(i, |_| {
                let ([gap, pressure], [mut work, mut closed]) = (self.block(i), [0.0; 2]);
                self.for_each_piece((i, rows.len()), |factor, piece| {
                    let elements = pressure[piece.clone()].iter().zip(&gap[piece.clone()]);
                    for (row, (p, g)) in rows[piece].iter().zip(elements) {
                        work += change(factor, *p, *g) * f64::from(*row);
                        closed += factor * f64::from(allowed(*p, *g, closing) * g);
                    }
                });
                [work, closed]
            });
        });
        let sums = tasks.into_results();
        let of = |k: usize| unit * sums.iter().map(|sum| sum[k]).sum::<f64>() / self.grid.len() as f64;
        // The element itself displaces by 1.12 of its side under a unit pressure, which a stored σ0 rounds.
        let stored = STORED * self.state.shape.mean_pressure * (1.12 * self.grid.spacing().x).sqrt();
        let [change, closed] = [of(0).sqrt() + rounding(self.grid) * self.pieces.energy.sqrt() + stored, of(1)];
        // e² ≤ ⟨p̂ g⟩ + e ‖x‖.
        (0.5 * change + (0.25 * change * change + closed).sqrt()).powi(2)
    }

    /// The pressure p̂ and its gap, from the displacement by the change, with sums over both.
    fn admissible(&self, quick: &Convolution<f32>, problem: &Problem) -> ([Vec<f64>; 2], GapSums) {
        let (len, closing, heights) = (BLOCK_ROWS * self.grid.nx(), self.pieces.closing, self.state.shape.heights);
        let floor = problem.offset();
        let shift = floor - problem.h_mean - self.pieces.mean_gap;
        let [mut pressure, mut gap] = [(); 2].map(|()| vec![0.0; self.grid.len()]);
        let tasks = Tasks::new(pressure.chunks_mut(len).zip(gap.chunks_mut(len)).zip(heights.chunks(len)));
        let empty = GapSums::empty(f64::INFINITY, f64::INFINITY);
        read_rows(quick, &|i, rows| {
            tasks.run(i, |((to_pressure, to_gap), heights): ((&mut [f64], &mut [f64]), &[f64])| {
                let ([gap, pressure], mut sums) = (self.block(i), empty);
                self.for_each_piece((i, rows.len()), |factor, piece| {
                    let known = pressure[piece.clone()].iter().zip(&gap[piece.clone()]);
                    let known = known.zip(rows[piece.clone()].iter().zip(&heights[piece.clone()]));
                    let to = to_pressure[piece.clone()].iter_mut().zip(&mut to_gap[piece]);
                    for ((to_p, to_g), ((p, g), (row, h))) in to.zip(known) {
                        *to_p = factor * f64::from(allowed(*p, *g, closing));
                        *to_g = self.unit * (f64::from(*g) + f64::from(*row)) + shift;
                        sums.add_element(*to_p, *to_g, h - floor);
                    }
                });
                sums
            });
        });
        let sums = GapSums::total(&layout(self.grid), tasks.into_results());
        ([pressure, gap], sums)
    }
}

/// The loads of the pieces of a block, before and after pressures are set to zero.
fn loads_of_block((nx, closing): (usize, f32), pressure: &[f32], gap: &[f32]) -> Vec<[f64; 2]> {
    let mut loads = vec![[0.0; 2]; nx / PIECE];
    for (pressure, gap) in pressure.chunks(nx).zip(gap.chunks(nx)) {
        for ((pressure, gap), [before, after]) in pressure.chunks(PIECE).zip(gap.chunks(PIECE)).zip(&mut loads) {
            for (p, g) in pressure.iter().zip(gap) {
                *before += f64::from(*p);
                *after += f64::from(allowed(*p, *g, closing));
            }
        }
    }
    loads
}

#[cfg(test)]
mod tests {
    use std::f64::consts::TAU;

    use rc_core::testing::quasi_random;
    use rc_core::{Field, Kernel as _};
    use rc_kernel::Love;

    use super::*;

    /// Rough and smooth surfaces, at mean pressures about as large as the fluctuations.
    #[test]
    fn single_precision_changes_pressures_by_less_than_is_added() {
        let mut largest: f64 = 0.0;
        for (side, n_waves, power) in [(128, 12.0, 1.8), (512, 12.0, 1.8), (512, 40.0, 1.0), (1024, 100.0, 1.8)] {
            let grid = Grid::square(side).expect("a grid");
            let waves: Vec<[f64; 4]> = (0..50)
                .map(|i| {
                    let [x, y] = [2 * i, 2 * i + 1].map(|i| (n_waves * (2.0 * quasi_random(i) - 1.0)).round());
                    [x, y, x.hypot(y).max(1.0).powf(-power), TAU * quasi_random(i + 500)]
                })
                .collect();
            let heights = Field::from_fn(grid, |at| {
                waves.iter().map(|[x, y, size, phase]| size * (TAU * (x * at.x + y * at.y) + phase).cos()).sum()
            });
            let (unit, mean) = (heights.max() - heights.min(), heights.mean());
            let (mut grids, _) = GapGrid::nested(grid, &Love, unit);
            let shape = Shape { heights: heights.values(), mean_height: mean, mean_pressure: 1.0 };
            let mut single = vec![0.0; grid.len()];
            grids[0].pressure_under(&shape, &vec![0.0; grid.len()], &mut single, |_, _| ());
            let table = SymbolTable::<f64>::new(grid, Love.symbol(grid));
            let convolved = |table: &SymbolTable<f64>, values: &[f64]| {
                let (len, mut result) = (BLOCK_ROWS * grid.nx(), vec![0.0; grid.len()]);
                let mut convolution = Convolution::new(grid);
                write_rows(&mut convolution, &|i, rows| rows.copy_from_slice(&values[i * len..][..rows.len()]));
                convolution.apply_symbol(table);
                let tasks = Tasks::new(result.chunks_mut(len));
                read_rows(&convolution, &|i, rows| tasks.run(i, |to: &mut [f64]| to.copy_from_slice(rows)));
                drop(tasks);
                result
            };
            let product = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| a * b).sum::<f64>() / grid.len() as f64;
            let shape: Vec<f64> = heights.values().iter().map(|h| h - mean).collect();
            let exact = convolved(&table.inverse(grid), &shape);
            let off: Vec<f64> = single.iter().zip(&exact).map(|(p, exact)| f64::from(*p) - 1.0 - exact).collect();
            let error = (product(&off, &convolved(&table, &off)) / (0.5 * product(&exact, &shape))).sqrt();
            assert!(error < rounding(grid), "{side}, {n_waves} waves: {error:e}");
            largest = largest.max(error / rounding(grid));
        }
        assert!(largest > 0.2, "the bound could be {largest} times as large");
    }
}
