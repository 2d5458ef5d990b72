//! Convolutions of real fields, `field → inverse FFT( symbol · FFT(field) )`.
//!
//! A convolution is periodic on the grid of the field, or on a larger grid where the field is zero elsewhere. There are
//! three passes over memory:
//!
//! 1. Rows are transformed block by block and stored in tiles.
//! 2. Panels of a few columns are gathered from the tiles, transformed, multiplied by the symbol, transformed back and
//!    scattered.
//! 3. Rows are transformed back.
//!
//! The caller writes and reads rows block by block, so that its own vector work is done while they are in cache. Work
//! is parallel over blocks and panels, never inside one transform, so results do not depend on the number of threads.

use std::sync::{Arc, Mutex};

use rayon::prelude::*;
use rc_core::Grid;
use rustfft::Fft;
use rustfft::num_complex::Complex;

use crate::rows::{ROWS, RowBuffers, RowPlans};
use crate::{SymbolTable, TransformReal, WaveTable};

/// Number of rows in a block of a [`Convolution`]. A convolution requests and returns one block at a time. The last
/// block of a grid may have fewer rows.
pub const BLOCK_ROWS: usize = 16;

/// Columns per panel. Sixteen complex values of f32 are two cache lines.
const PANEL_COLUMNS: usize = 16;

/// Unused values after each column of a panel. Without them, if the number of rows is a power of two, all columns would
/// compete for a few cache lines. This happens while a panel is gathered or scattered.
const PANEL_PADDING: usize = 16;

/// Plans and buffers for convolutions on one grid.
///
/// [`Convolution::apply`] runs all three passes. Callers that do something else between the passes call them one by
/// one.
///
/// ```
/// use rayon::prelude::*;
/// use rc_core::{Field, Grid};
/// use rc_fft::{BLOCK_ROWS, Convolution, SymbolTable};
///
/// // The symbol |k|² turns a wave with one period along x into itself.
/// let grid = Grid::new(32, 20)?;
/// let symbol = SymbolTable::<f64>::new(grid, |kx, ky| (kx * kx + ky * ky) as f64);
/// let wave = Field::from_fn(grid, |at| (std::f64::consts::TAU * at.x).cos());
/// let mut result = Field::zeros(grid);
/// let block = BLOCK_ROWS * grid.nx();
/// Convolution::new(grid).apply(
///     &symbol,
///     wave.values().par_chunks(block),
///     |source, rows| rows.copy_from_slice(source),
///     result.values_mut().par_chunks_mut(block),
///     |sink, rows| sink.copy_from_slice(rows),
/// );
/// assert!(result.values().iter().zip(wave.values()).all(|(a, b)| (a - b).abs() < 1e-12));
/// # Ok::<(), rc_core::GridError>(())
/// ```
pub struct Convolution<T> {
    grid: Grid,
    /// Elements of the transforms along x and y, at least as many as the grid has.
    period: [usize; 2],
    row_plans: RowPlans<T>,
    column_forward: Arc<dyn Fft<T>>,
    column_inverse: Arc<dyn Fft<T>>,
    /// Row spectra in tiles. The order is block of rows, panel of columns, row, column.
    spectrum: Vec<Complex<T>>,
    /// One workspace per thread, locked by the thread that uses it.
    workspaces: Vec<Mutex<Workspace<T>>>,
}

struct Workspace<T> {
    /// Rows of one block.
    rows: Vec<T>,
    row_buffers: RowBuffers<T>,
    /// Spectra of the rows that are transformed at once.
    row_spectra: Vec<Complex<T>>,
    /// One panel, with contiguous columns.
    panel: Vec<Complex<T>>,
    scratch: Vec<Complex<T>>,
}

impl<T: TransformReal> Convolution<T> {
    /// Plans for periodic convolutions on `grid`.
    ///
    /// They have a workspace for each thread of the present rayon pool. *Memory*: nx·ny complex numbers of `T`.
    #[must_use]
    pub fn new(grid: Grid) -> Self {
        Self::padded(grid, [grid.nx(), grid.ny()])
    }

    /// Plans for fields on `grid` that are zero on the rest of a larger grid.
    ///
    /// `period` is the number of elements of the larger grid along x and y. The symbol is tabulated for the larger
    /// grid. Only the result on `grid` is kept. Transforms of rows that are zero are omitted. *Memory*: about
    /// period\[0\] · ny / 2 complex numbers.
    ///
    /// With a period of at least 2n - 1 elements along a side of n, elements do not act on each other across the
    /// border.
    ///
    /// # Panics
    /// When the period is shorter than the grid.
    #[must_use]
    pub fn padded(grid: Grid, period: [usize; 2]) -> Self {
        let [nx, ny] = period;
        assert!(nx >= grid.nx() && ny >= grid.ny(), "a period of {nx} x {ny} elements for {grid}");
        let row_plans = RowPlans::new(nx);
        let (column_forward, column_inverse) = (T::complex_forward(ny), T::complex_inverse(ny));
        let scratch_len = column_forward.get_inplace_scratch_len().max(column_inverse.get_inplace_scratch_len());
        let n_columns = nx / 2 + 1;
        let zero = Complex::new(T::zero(), T::zero());
        let workspace = || Workspace {
            rows: vec![T::zero(); BLOCK_ROWS * grid.nx()],
            row_buffers: row_plans.buffers(),
            row_spectra: vec![zero; ROWS * n_columns],
            panel: vec![zero; PANEL_COLUMNS * (ny + PANEL_PADDING)],
            scratch: vec![zero; scratch_len],
        };
        let workspaces = (0..rayon::current_num_threads()).map(|_| Mutex::new(workspace())).collect();
        // All threads write it, because a large spectrum is new memory.
        let spectrum = rayon::iter::repeat_n(zero, n_columns * grid.ny()).collect();
        Self { grid, period, row_plans, column_forward, column_inverse, spectrum, workspaces }
    }

    /// The grid.
    #[must_use]
    pub fn grid(&self) -> Grid {
        self.grid
    }

    /// Convolves with `symbol`, the table for the same grid.
    ///
    /// `sources` and `sinks` have one item for each block of [`BLOCK_ROWS`] rows of the grid, in order. `write` writes
    /// the rows of the field in its block. It is called once for each block before the first call of `read`. `read`
    /// receives the rows of the result. Its return values are collected in the order of blocks, so that the caller can
    /// sum them.
    ///
    /// # Panics
    /// When the length of `sources` or `sinks` is not the number of blocks.
    pub fn apply<S, F, K, R>(
        &mut self,
        symbol: &SymbolTable<T>,
        sources: S,
        write: F,
        sinks: K,
        read: impl Fn(K::Item, &[T]) -> R + Sync,
    ) -> Vec<R>
    where
        S: IndexedParallelIterator,
        F: Fn(S::Item, &mut [T]) + Sync,
        K: IndexedParallelIterator,
        R: Send,
    {
        self.transform_rows(sources, |source, rows| write(source, rows));
        self.apply_symbol(symbol);
        self.read_rows(sinks, read)
    }

    /// First pass, which transforms the rows that `write` writes. Returns what `write` returns, in the order of blocks.
    ///
    /// # Panics
    /// As for [`Convolution::apply`].
    pub fn transform_rows<S, R>(&mut self, sources: S, write: impl Fn(S::Item, &mut [T]) -> R + Sync) -> Vec<R>
    where
        S: IndexedParallelIterator,
        R: Send,
    {
        let (nx, n_columns) = (self.grid.nx(), self.period[0] / 2 + 1);
        let (row_plans, workspaces) = (&self.row_plans, &self.workspaces);
        let blocks = self.spectrum.par_chunks_mut(BLOCK_ROWS * n_columns);
        blocks
            .zip_eq(sources)
            .map(|(block, source)| {
                let n_rows = block.len() / n_columns;
                let mut workspace = lock(workspaces);
                let Workspace { rows, row_buffers, row_spectra, .. } = &mut *workspace;
                let rows = &mut rows[..n_rows * nx];
                let written = write(source, rows);
                for (iy, rows) in (0..).step_by(ROWS).zip(rows.chunks(ROWS * nx)) {
                    let spectra = &mut row_spectra[..rows.len() / nx * n_columns];
                    row_plans.forward(rows, nx, spectra, row_buffers);
                    for (iy, spectrum) in (iy..).zip(spectra.chunks_exact(n_columns)) {
                        to_tiles(spectrum, block, iy);
                    }
                }
                written
            })
            .collect()
    }

    /// Second pass, which transforms columns, multiplies by `symbol`, and transforms back. `symbol` is the table for
    /// the same grid.
    pub fn apply_symbol(&mut self, symbol: &SymbolTable<T>) {
        self.for_each_column(|kx, column| scale_column(column, symbol.column(kx)));
    }

    /// Second pass with a complex symbol: as [`Convolution::apply_symbol`].
    pub fn apply_waves(&mut self, symbol: &WaveTable<T>) {
        self.for_each_column(|kx, column| symbol.scale(kx, column));
    }

    /// Transforms columns, calls `scale` with the index and the waves of each, and transforms back.
    fn for_each_column(&mut self, scale: impl Fn(usize, &mut [Complex<T>]) + Sync) {
        let (n_rows, [nx, ny]) = (self.grid.ny(), self.period);
        let n_columns = nx / 2 + 1;
        let (forward, inverse, workspaces) = (&self.column_forward, &self.column_inverse, &self.workspaces);
        let mut panels: Vec<Vec<&mut [Complex<T>]>> = Vec::new();
        panels.resize_with(n_columns.div_ceil(PANEL_COLUMNS), || Vec::with_capacity(n_rows.div_ceil(BLOCK_ROWS)));
        for block in self.spectrum.chunks_mut(BLOCK_ROWS * n_columns) {
            let n_rows = block.len() / n_columns;
            for (tile, panel) in block.chunks_mut(PANEL_COLUMNS * n_rows).zip(&mut panels) {
                panel.push(tile);
            }
        }
        panels.par_iter_mut().enumerate().for_each(|(panel_idx, tiles)| {
            let first_column = panel_idx * PANEL_COLUMNS;
            let width = PANEL_COLUMNS.min(n_columns - first_column);
            let mut workspace = lock(workspaces);
            let Workspace { panel, scratch, .. } = &mut *workspace;
            let panel = &mut panel[..width * (ny + PANEL_PADDING)];
            gather(tiles, panel, width);
            for (column_idx, column) in panel.chunks_exact_mut(ny + PANEL_PADDING).enumerate() {
                let column = &mut column[..ny];
                column[n_rows..].fill(Complex::new(T::zero(), T::zero()));
                forward.process_with_scratch(column, scratch);
                scale(first_column + column_idx, column);
                inverse.process_with_scratch(column, scratch);
            }
            scatter(panel, tiles, width);
        });
    }

    /// Third pass, which transforms rows back and passes them to `read`. The return values of `read` are collected in
    /// the order of blocks.
    ///
    /// # Panics
    /// As for [`Convolution::apply`].
    pub fn read_rows<K, R>(&self, sinks: K, read: impl Fn(K::Item, &[T]) -> R + Sync) -> Vec<R>
    where
        K: IndexedParallelIterator,
        R: Send,
    {
        let (nx, n_columns) = (self.grid.nx(), self.period[0] / 2 + 1);
        let blocks = self.spectrum.par_chunks(BLOCK_ROWS * n_columns);
        blocks
            .zip_eq(sinks)
            .map(|(block, sink)| {
                let n_rows = block.len() / n_columns;
                let mut workspace = lock(&self.workspaces);
                let Workspace { rows, row_buffers, row_spectra, .. } = &mut *workspace;
                let rows = &mut rows[..n_rows * nx];
                for (iy, rows) in (0..).step_by(ROWS).zip(rows.chunks_mut(ROWS * nx)) {
                    let spectra = &mut row_spectra[..rows.len() / nx * n_columns];
                    for (iy, spectrum) in (iy..).zip(spectra.chunks_exact_mut(n_columns)) {
                        from_tiles(block, iy, spectrum);
                    }
                    self.row_plans.inverse(spectra, rows, nx, row_buffers);
                }
                read(sink, rows)
            })
            .collect()
    }
}

impl<T> std::fmt::Debug for Convolution<T> {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Convolution").field("grid", &self.grid).finish_non_exhaustive()
    }
}

/// The workspace of the calling thread. A thread waits for a lock only if more threads run than when the plan was made.
fn lock<T>(workspaces: &[Mutex<Workspace<T>>]) -> std::sync::MutexGuard<'_, Workspace<T>> {
    let thread = rayon::current_thread_index().unwrap_or(0) % workspaces.len();
    workspaces[thread].lock().unwrap_or_else(std::sync::PoisonError::into_inner)
}

/// Writes row `iy` of a block to its tiles, one for each panel.
fn to_tiles<T: TransformReal>(row: &[Complex<T>], block: &mut [Complex<T>], iy: usize) {
    let n_rows = block.len() / row.len();
    let (panels, rest) = row.as_chunks::<PANEL_COLUMNS>();
    let (tiles, rest_tile) = block.split_at_mut(panels.len() * PANEL_COLUMNS * n_rows);
    let (tile_rows, _) = tiles.as_chunks_mut::<PANEL_COLUMNS>();
    for (values, tile_row) in panels.iter().zip(tile_rows.iter_mut().skip(iy).step_by(n_rows)) {
        *tile_row = *values;
    }
    rest_tile[iy * rest.len()..][..rest.len()].copy_from_slice(rest);
}

/// Reads row `iy` of a block from the tiles of the block.
fn from_tiles<T: TransformReal>(block: &[Complex<T>], iy: usize, row: &mut [Complex<T>]) {
    let n_rows = block.len() / row.len();
    let (panels, rest) = row.as_chunks_mut::<PANEL_COLUMNS>();
    let (tiles, rest_tile) = block.split_at(panels.len() * PANEL_COLUMNS * n_rows);
    let (tile_rows, _) = tiles.as_chunks::<PANEL_COLUMNS>();
    for (values, tile_row) in panels.iter_mut().zip(tile_rows.iter().skip(iy).step_by(n_rows)) {
        *values = *tile_row;
    }
    rest.copy_from_slice(&rest_tile[iy * rest.len()..][..rest.len()]);
}

/// Copies tiles (rows of a few columns) to padded columns.
fn gather<T: TransformReal>(tiles: &[&mut [Complex<T>]], panel: &mut [Complex<T>], width: usize) {
    let stride = panel.len() / width;
    for (tile_idx, tile) in tiles.iter().enumerate() {
        for (column_idx, column) in panel.chunks_exact_mut(stride).enumerate() {
            let column = &mut column[tile_idx * BLOCK_ROWS..];
            for (value, row) in column.iter_mut().zip(tile.chunks_exact(width)) {
                *value = row[column_idx];
            }
        }
    }
}

/// Copies padded columns back to tiles.
fn scatter<T: TransformReal>(panel: &[Complex<T>], tiles: &mut [&mut [Complex<T>]], width: usize) {
    let stride = panel.len() / width;
    for (tile_idx, tile) in tiles.iter_mut().enumerate() {
        for (column_idx, column) in panel.chunks_exact(stride).enumerate() {
            let column = &column[tile_idx * BLOCK_ROWS..];
            for (value, row) in column.iter().zip(tile.chunks_exact_mut(width)) {
                row[column_idx] = *value;
            }
        }
    }
}

/// Multiplies a column by the symbol, which is even in ky.
fn scale_column<T: TransformReal>(column: &mut [Complex<T>], symbol: &[T]) {
    let ny = column.len();
    let (low, high) = column.split_at_mut(symbol.len());
    for (value, &factor) in low.iter_mut().zip(symbol) {
        *value = value.scale(factor);
    }
    // ky = ny - 1, ny - 2, … down to the first wave beyond `low`.
    for (value, &factor) in high.iter_mut().rev().zip(&symbol[1..]) {
        *value = value.scale(factor);
    }
    debug_assert_eq!(low.len() + high.len(), ny);
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Periods of grids, and periods so long that the sum has no images.
    #[test]
    fn a_convolution_is_the_sum_over_its_period() {
        let padded = [(12, 10, 24, 20), (5, 33, 9, 65), (16, 16, 32, 31), (1, 7, 1, 16), (40, 3, 81, 6)];
        let periodic = [(12, 10), (19, 18), (37, 33), (1, 9), (101, 3), (9, 1)].map(|(nx, ny)| (nx, ny, nx, ny));
        for (nx, ny, px, py) in padded.into_iter().chain(periodic) {
            let grid = Grid::new(nx, ny).expect("a grid");
            let around = Grid::in_cell(px, py, 1.0).expect("a grid");
            let kernel = |dx: usize, dy: usize| 1.0 / (1.0 + (dx * dx) as f64 + (dy * dy) as f64);
            let nearest = |d: usize, n: usize| d.min(n - d);
            let values = (0..around.len()).map(|i| kernel(nearest(i % px, px), nearest(i / px, py))).collect();
            let response = rc_core::Field::new(around, values).expect("a value for each element");
            let waves = crate::half_plane_values(&response, 0.0, |wave| wave.re);
            let table = SymbolTable::<f64>::new(around, |kx, ky| waves[kx * py + ky]);
            let source: Vec<f64> = (0..grid.len()).map(rc_core::testing::quasi_random).collect();
            let mut found = vec![0.0; grid.len()];
            let block = BLOCK_ROWS * nx;
            let mut convolution = Convolution::<f64>::padded(grid, [px, py]);
            // The second run shows that no values of the first one remain.
            for _ in 0..2 {
                convolution.apply(
                    &table,
                    source.par_chunks(block),
                    |source, rows| rows.copy_from_slice(source),
                    found.par_chunks_mut(block),
                    |found, rows| found.copy_from_slice(rows),
                );
            }
            for (i, found) in found.iter().enumerate() {
                let (dx, dy) = (|j| (i % nx).abs_diff(j % nx), |j| (i / nx).abs_diff(j / nx));
                let of = |(j, p): (usize, &f64)| p * kernel(nearest(dx(j), px), nearest(dy(j), py));
                let expected: f64 = source.iter().enumerate().map(of).sum();
                assert!((found - expected).abs() < 1e-12 * expected, "{grid} in {px} x {py}: {found} for {expected}");
            }
        }
    }
}
