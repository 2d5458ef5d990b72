//! Cycles over coarser grids, which correct the gap of heavy contact.
//!
//! Steps with the short-ranged kernel correct short waves of the gap only. Longer ones are corrected on coarser grids:
//! the restricted gap is changed until the restricted pressure obeys the conditions of contact there. Only pressures of
//! elements that have a gap, or overlap, are restricted, and only gaps of these elements are corrected, so that a
//! solution stays one (a truncated full approximation scheme, Kornhuber 1994).

use rc_core::{Grid, Kernel};
use rc_fft::{BLOCK_ROWS, Convolution, SymbolTable};
use rc_quadtree::TILE;

use crate::grid::passes::{read_rows, write_rows};
use crate::levels::gap_sweeps::{NearKernel, NearWeights, Pools, is_active};
use crate::parallel::{self, Tasks};

/// Minimum number of elements along a side of the coarsest grid of a cycle.
const SMALLEST_SIDE: usize = 32;

/// Elements of pools reach this far for the tiles that steps change.
const MARGIN: usize = 2;

/// The operator K = L⁻¹ on a grid, and its kernel near an element.
pub(super) struct GapGrid {
    grid: Grid,
    inverse: SymbolTable<f32>,
    near: NearKernel,
    convolution: Convolution<f32>,
    /// Gaps are in this unit.
    unit: f64,
}

/// The shape that a gap is added to, and the mean pressure.
pub(super) struct Shape<'a> {
    pub(super) heights: &'a [f64],
    pub(super) mean_height: f64,
    pub(super) mean_pressure: f64,
}

impl GapGrid {
    /// The `finest` grid and those below it, finest first. Also returns L on the finest one.
    pub(super) fn nested(finest: Grid, kernel: &dyn Kernel, unit: f64) -> (Vec<Self>, SymbolTable<f32>) {
        let near = NearWeights::of(kernel);
        let with_table = |grid: Grid| {
            let response = SymbolTable::new(grid, kernel.symbol(grid));
            let (inverse, near) = (response.inverse(grid), NearKernel::new(&near, grid, unit));
            (Self { grid, inverse, near, convolution: Convolution::new(grid), unit }, response)
        };
        let (first, response) = with_table(finest);
        let mut grids = vec![first];
        let is_even = |n: usize| n.is_multiple_of(2 * TILE) && n >= 2 * SMALLEST_SIDE;
        let half = |grid: Grid| grid.with_elements(grid.nx() / 2, grid.ny() / 2).ok();
        let mut next = finest;
        while is_even(next.nx())
            && is_even(next.ny())
            && let Some(grid) = half(next)
        {
            grids.push(with_table(grid).0);
            next = grid;
        }
        (grids, response)
    }

    /// Number of elements of a block of rows.
    fn len(&self) -> usize {
        BLOCK_ROWS * self.grid.nx()
    }

    /// The pressure of an element alone that answers to a gap of one unit, in E*.
    pub(super) fn closing(&self) -> f32 {
        self.near.closing
    }

    /// The convolution in single precision.
    pub(super) fn convolution(&mut self) -> &mut Convolution<f32> {
        &mut self.convolution
    }

    /// Computes the pressure σ0 + K (h + g). Returns what `note` makes of each block of rows: gap and pressure.
    pub(super) fn pressure_under<R: Send>(
        &mut self,
        shape: &Shape<'_>,
        gap: &[f32],
        pressure: &mut [f32],
        note: impl Fn(usize, [&[f32]; 2]) -> R + Sync,
    ) -> Vec<R> {
        let (len, unit) = (self.len(), self.unit as f32);
        write_rows(&mut self.convolution, &|i, rows| {
            let here = i * len..i * len + rows.len();
            for ((row, h), g) in rows.iter_mut().zip(&shape.heights[here.clone()]).zip(&gap[here]) {
                *row = ((h - shape.mean_height) / self.unit) as f32 + g;
            }
        });
        self.convolution.apply_symbol(&self.inverse);
        let (tasks, mean) = (Tasks::new(pressure.chunks_mut(len).zip(gap.chunks(len))), shape.mean_pressure as f32);
        read_rows(&self.convolution, &|i, rows| {
            tasks.run(i, |(pressure, gap): (&mut [f32], &[f32])| {
                pressure.iter_mut().zip(rows).for_each(|(p, row)| *p = mean + unit * row);
                note(i, [gap, pressure])
            });
        });
        tasks.into_results()
    }

    /// Changes the gap, and the pressure with it. `change` is called with an element and its gap and pressure.
    fn change(&mut self, [gap, pressure]: [&mut [f32]; 2], change: impl Fn(usize, f32, f32) -> f32 + Sync) {
        let (len, unit) = (self.len(), self.unit as f32);
        {
            let (gap, pressure) = (&*gap, &*pressure);
            write_rows(&mut self.convolution, &|i, rows| {
                let here = i * len..i * len + rows.len();
                let elements = gap[here.clone()].iter().zip(&pressure[here.clone()]);
                for (at, (row, (g, p))) in here.zip(rows.iter_mut().zip(elements)) {
                    *row = change(at, *g, *p);
                }
            });
        }
        self.convolution.apply_symbol(&self.inverse);
        let tasks = Tasks::new(gap.chunks_mut(len).zip(pressure.chunks_mut(len)));
        read_rows(&self.convolution, &|i, rows| {
            tasks.run(i, |(gap, pressure): (&mut [f32], &mut [f32])| {
                for (at, ((g, p), row)) in gap.iter_mut().zip(pressure).zip(rows).enumerate() {
                    *g += change(i * len + at, *g, *p);
                    *p += unit * row;
                }
            });
        });
    }

    /// Takes steps near the pools.
    pub(super) fn relax(&self, gap: &mut [f32], pressure: &mut [f32]) {
        let (grid, len) = (self.grid, self.len());
        let blocks = pressure.chunks(len).zip(gap.chunks(len)).enumerate();
        let mut places =
            parallel::map(blocks, |(i, (pressure, gap))| tiles_at_pools(grid, i * BLOCK_ROWS, [pressure, gap]))
                .concat();
        places.sort_unstable();
        places.dedup();
        let mut pools = Pools::new(grid, places, [gap, pressure]);
        pools.relax(&self.near);
        pools.put(grid, [gap, pressure]);
    }
}

/// Improves a gap on the first grid, whose pressure is known. The pressure follows near pools.
pub(super) fn cycle(grids: &mut [GapGrid], gap: &mut [f32], pressure: &mut [f32]) {
    let Some((here, coarser)) = grids.split_first_mut() else { return };
    if !coarser.is_empty() {
        let sides = [here.grid.nx(), here.grid.ny()];
        let [before, mut coarse_pressure] = restricted(sides, gap, pressure);
        let mut correction = before.clone();
        cycle(coarser, &mut correction, &mut coarse_pressure);
        let rows = correction.chunks_mut(sides[0]).zip(before.chunks(sides[0]));
        parallel::for_each(rows, |(after, before)| after.iter_mut().zip(before).for_each(|(g, before)| *g -= before));
        here.change(
            [gap, pressure],
            |at, g, p| {
                if is_active(g, p) { interpolated(&correction, sides, at).max(-g) } else { 0.0 }
            },
        );
    }
    here.relax(gap, pressure);
}

/// Gap and pressure on a grid with half the elements.
///
/// Where some of four elements are active, it is the pressure of these.
fn restricted([nx, ny]: [usize; 2], gap: &[f32], pressure: &[f32]) -> [Vec<f32>; 2] {
    let [mut gaps, mut pressures] = [(); 2].map(|()| parallel::zeros(nx / 2 * (ny / 2)));
    let rows = gaps.chunks_mut(nx / 2).zip(pressures.chunks_mut(nx / 2));
    let finer = gap.chunks(2 * nx).zip(pressure.chunks(2 * nx));
    parallel::for_each(rows.zip(finer), |((gaps, pressures), (gap, pressure))| {
        for (x, (g, p)) in gaps.iter_mut().zip(pressures).enumerate() {
            let four = [2 * x, 2 * x + 1, nx + 2 * x, nx + 2 * x + 1];
            let is_active = four.map(|at| is_active(gap[at], pressure[at]));
            let is_any = is_active.contains(&true);
            *g = 0.25 * four.iter().map(|&at| gap[at]).sum::<f32>();
            *p = 0.25
                * four
                    .iter()
                    .zip(is_active)
                    .filter(|(_, active)| *active || !is_any)
                    .map(|(&at, _)| pressure[at])
                    .sum::<f32>();
        }
    });
    [gaps, pressures]
}

/// The value of a field on a coarser grid at an element of one with twice these elements, by bilinear interpolation.
fn interpolated(coarse: &[f32], [nx, ny]: [usize; 2], at: usize) -> f32 {
    let near = |i: usize, n: usize| {
        let half = n / 2;
        [i / 2, if i.is_multiple_of(2) { (i / 2 + half - 1) % half } else { (i / 2 + 1) % half }]
    };
    let (columns, rows) = (near(at % nx, nx), near(at / nx, ny).map(|y| y * (nx / 2)));
    let along = |row: usize| 0.75 * coarse[row + columns[0]] + 0.25 * coarse[row + columns[1]];
    0.75 * along(rows[0]) + 0.25 * along(rows[1])
}

/// The tiles at elements with a gap or a tensile pressure, in a block of rows from `first` on.
fn tiles_at_pools(grid: Grid, first: usize, [pressure, gap]: [&[f32]; 2]) -> Vec<[u32; 2]> {
    let (nx, ny) = (grid.nx(), grid.ny());
    let tiles = |i: usize, n: usize| [(i + n - MARGIN) % n / TILE, (i + MARGIN) % n / TILE];
    let mut places = Vec::new();
    for (y, (pressure, gap)) in pressure.chunks(nx).zip(gap.chunks(nx)).enumerate() {
        let (rows, mut last) = (tiles(first + y, ny), [usize::MAX; 2]);
        for (x, _) in pressure.iter().zip(gap).enumerate().filter(|(_, (p, g))| is_active(**g, **p)) {
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
