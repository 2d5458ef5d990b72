//! A table of a symbol for one grid.

use rayon::prelude::*;
use rc_core::Grid;

use crate::TransformReal;

/// Number of columns that are filled at once.
///
/// Each cache line of the columns before the diagonal is then read once.
const COLUMNS: usize = 16;

/// Table of the eigenvalues of a [`Convolution`](crate::Convolution).
///
/// It covers 0 ≤ kx ≤ nx/2 and 0 ≤ ky ≤ ny/2, because eigenvalues are even in kx and in ky. Columns of constant kx are
/// contiguous. The entries include the factor 1/(nx·ny) of the inverse transform.
#[derive(Clone, Debug)]
pub struct SymbolTable<T> {
    column_len: usize,
    values: Vec<T>,
}

impl<T: TransformReal> SymbolTable<T> {
    /// Tabulates `eigenvalue(kx, ky)`.
    ///
    /// On a [square](Grid::is_square) grid eigenvalues are symmetric, so the function is called for ky ≥ kx only.
    ///
    /// # Panics
    /// When `T` cannot hold an `f64` after rounding. `f32` and `f64` can.
    pub fn new(grid: Grid, eigenvalue: impl Fn(usize, usize) -> f64 + Sync) -> Self {
        let column_len = grid.ny() / 2 + 1;
        let symmetric = grid.is_square();
        let scale = 1.0 / grid.len() as f64;
        let entry = |kx, ky| T::from_f64(scale * eigenvalue(kx, ky)).expect("a float type holds every f64, rounded");
        let n_columns = grid.nx() / 2 + 1;
        let mut values = vec![T::zero(); n_columns * column_len];
        if !symmetric {
            values.par_iter_mut().enumerate().for_each(|(i, value)| *value = entry(i / column_len, i % column_len));
            return Self { column_len, values };
        }
        // Only entries from the diagonal on are computed. The others follow from symmetry.
        let columns: Vec<Vec<T>> =
            (0..n_columns).into_par_iter().map(|kx| (kx..column_len).map(|ky| entry(kx, ky)).collect()).collect();
        values.par_chunks_mut(COLUMNS * column_len).enumerate().for_each(|(panel, values)| {
            for ky in 0..column_len {
                for (column, kx) in values.chunks_exact_mut(column_len).zip(panel * COLUMNS..) {
                    column[ky] = if ky < kx { columns[ky][kx - ky] } else { columns[kx][ky - kx] };
                }
            }
        });
        Self { column_len, values }
    }

    /// Table of the inverse operator: reciprocals, and 0 at k = 0.
    ///
    /// The grid is the same. The precision `U` may be another one.
    ///
    /// # Panics
    /// As for [`SymbolTable::new`].
    #[must_use]
    pub fn inverse<U: TransformReal>(&self, grid: Grid) -> SymbolTable<U>
    where
        T: Into<f64>,
    {
        let scale = 1.0 / grid.len() as f64;
        let inverse = |value: T| U::from_f64(scale * scale / value.into());
        let mut table = self.map(|value| inverse(value).expect("a float type holds every f64, rounded"));
        table.set_mean(U::zero());
        table
    }

    /// Sets the entry at k = 0. `value` includes the factor of the inverse transform.
    pub fn set_mean(&mut self, value: T) {
        self.values[0] = value;
    }

    /// The table with `convert` applied to every entry, for example to change the precision.
    #[must_use]
    pub fn map<U: Send>(&self, convert: impl Fn(T) -> U + Sync) -> SymbolTable<U> {
        let values = self.values.par_iter().map(|&value| convert(value)).collect();
        SymbolTable { column_len: self.column_len, values }
    }

    /// The eigenvalues of a grid of one row, for 0 ≤ kx ≤ nx/2.
    ///
    /// # Panics
    /// When the table is that of a grid of more rows.
    pub(crate) fn of_line(&self) -> &[T] {
        assert_eq!(self.column_len, 1, "rows of the grid of the table");
        &self.values
    }

    /// The eigenvalues of column `kx`, for 0 ≤ ky ≤ ny/2.
    pub(crate) fn column(&self, kx: usize) -> &[T] {
        &self.values[kx * self.column_len..(kx + 1) * self.column_len]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn tables_of_any_size_have_the_eigenvalues_and_their_reciprocals() {
        for (nx, ny) in [(64, 64), (37, 37), (30, 41), (1, 1)] {
            let grid = Grid::new(nx, ny).expect("a grid");
            // Symmetric in kx and ky, like eigenvalues on square grids.
            let eigenvalue = |kx: usize, ky: usize| (kx * kx + ky * ky) as f64 + (kx * ky) as f64 / 7.0;
            let table = SymbolTable::<f64>::new(grid, eigenvalue);
            let inverse: SymbolTable<f32> = table.inverse(grid);
            for kx in 0..=nx / 2 {
                for ky in 0..=ny / 2 {
                    let expected = eigenvalue(kx, ky) / grid.len() as f64;
                    assert!((table.column(kx)[ky] - expected).abs() <= 1e-15 * expected, "{grid}: ({kx}, {ky})");
                    let product = f64::from(inverse.column(kx)[ky]) * eigenvalue(kx, ky) * grid.len() as f64;
                    let expected = if kx + ky == 0 { 0.0 } else { 1.0 };
                    assert!((product - expected).abs() < 1e-6, "{grid}: ({kx}, {ky}): {product}");
                }
            }
        }
    }
}
