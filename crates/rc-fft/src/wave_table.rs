//! A table of a complex symbol for one grid.

use rayon::prelude::*;
use rc_core::Grid;
use rustfft::num_complex::{Complex, Complex64};

use crate::TransformReal;

/// Table of the complex eigenvalues of a [`Convolution`](crate::Convolution) between real fields.
///
/// It covers 0 ≤ kx ≤ nx/2 and all ky. The wave (-kx, -ky) has the conjugate value. Columns of constant kx are
/// contiguous. The entries include the factor 1/(nx·ny) of the inverse transform.
#[derive(Clone, Debug)]
pub struct WaveTable<T> {
    column_len: usize,
    values: Vec<Complex<T>>,
}

impl<T: TransformReal> WaveTable<T> {
    /// Tabulates `eigenvalue(kx, ky)` for -ny/2 ≤ ky ≤ ny/2 and -nx/2 ≤ kx ≤ nx/2.
    ///
    /// A wave of half the elements along a side is the same wave in both directions, and has the mean of both values.
    ///
    /// # Panics
    /// When `T` cannot hold an `f64` after rounding. `f32` and `f64` can.
    pub fn new(grid: Grid, eigenvalue: impl Fn(i64, i64) -> Complex64 + Sync) -> Self {
        let (nx, ny) = (grid.nx() as i64, grid.ny() as i64);
        let scale = 1.0 / grid.len() as f64;
        let both_along_y = |kx: i64, ky: i64| {
            if 2 * ky == ny { 0.5 * (eigenvalue(kx, ky) + eigenvalue(kx, -ky)) } else { eigenvalue(kx, ky) }
        };
        let entry = |place: usize| {
            let (kx, row) = (place as i64 / ny, place as i64 % ny);
            let ky = if 2 * row > ny { row - ny } else { row };
            let value = if 2 * kx == nx && nx > 1 || kx == 0 && 2 * ky == ny {
                0.5 * (both_along_y(kx, ky) + both_along_y(-kx, ky))
            } else {
                both_along_y(kx, ky)
            };
            let to = |value: f64| T::from_f64(scale * value).expect("a float type holds every f64, rounded");
            Complex::new(to(value.re), to(value.im))
        };
        let values = (0..(nx as usize / 2 + 1) * ny as usize).into_par_iter().map(entry).collect();
        Self { column_len: ny as usize, values }
    }

    /// Sets the entry at k = 0. `value` includes the factor of the inverse transform.
    pub fn set_mean(&mut self, value: T) {
        self.values[0] = Complex::new(value, T::zero());
    }

    /// The table with `convert` applied to every entry but that at k = 0, which becomes 0.
    #[must_use]
    pub fn map<U: TransformReal>(&self, convert: impl Fn(Complex<T>) -> Complex<U> + Sync) -> WaveTable<U> {
        let mut values: Vec<_> = self.values.par_iter().map(|&value| convert(value)).collect();
        values[0] = Complex::new(U::zero(), U::zero());
        WaveTable { column_len: self.column_len, values }
    }

    /// The entry at k = 0, with the factor of the inverse transform.
    #[must_use]
    pub fn mean(&self) -> T {
        self.values[0].re
    }

    /// The entries column by column, with the factor of the inverse transform.
    #[must_use]
    pub fn values(&self) -> &[Complex<T>] {
        &self.values
    }

    /// The eigenvalues of a grid of one row, for 0 ≤ kx ≤ nx/2.
    ///
    /// # Panics
    /// When the table is that of a grid of more rows.
    pub(crate) fn of_line(&self) -> &[Complex<T>] {
        assert_eq!(self.column_len, 1, "rows of the grid of the table");
        &self.values
    }

    /// Multiplies the waves of column `kx` by their eigenvalues.
    pub(crate) fn scale(&self, kx: usize, column: &mut [Complex<T>]) {
        let factors = &self.values[kx * self.column_len..(kx + 1) * self.column_len];
        for (wave, &factor) in column.iter_mut().zip(factors) {
            *wave = *wave * factor;
        }
    }
}

#[cfg(test)]
mod tests {
    use rc_core::Field;

    use super::*;
    use crate::{BLOCK_ROWS, Convolution};

    fn convolved(grid: Grid, table: &WaveTable<f64>, field: &Field) -> Field {
        let (mut result, block) = (Field::zeros(grid), BLOCK_ROWS * grid.nx());
        let mut convolution = Convolution::new(grid);
        convolution.transform_rows(field.values().par_chunks(block), |from, rows| rows.copy_from_slice(from));
        convolution.apply_waves(table);
        convolution.read_rows(result.values_mut().par_chunks_mut(block), |to, rows| to.copy_from_slice(rows));
        result
    }

    /// A factor exp(2πi k·d) moves a band-limited field by -d.
    #[test]
    fn a_phase_moves_a_field() {
        for (nx, ny) in [(16, 20), (15, 9), (8, 1), (1, 6)] {
            let grid = Grid::new(nx, ny).expect("a grid");
            let [dx, dy] = [0.13, -0.22];
            let turn = |kx: i64, ky: i64| Complex64::cis(std::f64::consts::TAU * (kx as f64 * dx + ky as f64 * dy));
            let table = WaveTable::<f64>::new(grid, turn);
            let wave = |x: f64, y: f64| {
                let along = |n: usize, at: f64| if n > 2 { (std::f64::consts::TAU * at + 0.3).sin() } else { 1.0 };
                along(nx, x) + along(ny, y) * (0.5 + along(nx, x))
            };
            // Places along y are in parts of the side along x.
            let ratio = grid.cell_ratio();
            let field = Field::from_fn(grid, |at| wave(at.x, at.y / ratio));
            let moved = Field::from_fn(grid, |at| wave(at.x + dx, at.y / ratio + dy));
            let found = convolved(grid, &table, &field);
            let error = found.values().iter().zip(moved.values()).fold(0.0_f64, |most, (a, b)| most.max((a - b).abs()));
            assert!(error < 1e-14, "{nx} x {ny}: {error:e}");
        }
    }

    /// The result of any field is real: what is lost at half the grid is the imaginary part of both directions' mean.
    #[test]
    fn waves_of_half_the_grid_have_a_real_factor() {
        let grid = Grid::square(8).expect("a grid");
        let table = WaveTable::<f64>::new(grid, |kx, ky| Complex64::new(1.0, (kx + 3 * ky) as f64));
        for (kx, row) in [(0, 4), (4, 0), (4, 4)] {
            assert!(table.values()[kx * 8 + row].im.abs() < 1e-15, "({kx}, {row})");
        }
        assert_eq!(table.values()[4 * 8 + 1], table.values()[4 * 8 + 7].conj());
    }
}
