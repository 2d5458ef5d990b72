//! A symbol tabulated for one grid.

use rayon::prelude::*;
use rc_core::Grid;

use crate::TransformReal;

/// Eigenvalues of a [`Convolution`](crate::Convolution) for 0 ≤ kx ≤ nx/2 and 0 ≤ ky ≤ ny/2, even in kx and in ky; columns of constant
/// kx are contiguous, and the 1/(nx·ny) of the inverse transform is a factor of the entries.
#[derive(Clone, Debug)]
pub struct SymbolTable<T> {
    column_len: usize,
    values: Vec<T>,
}

impl<T: TransformReal> SymbolTable<T> {
    /// Tabulates `eigenvalue(kx, ky)`. On a square grid of a square cell, where it is symmetric, it is asked for ky ≥ kx only.
    ///
    /// # Panics
    /// When `T` cannot hold an `f64`, rounded: `f32` and `f64` can.
    pub fn new(grid: Grid, eigenvalue: impl Fn(usize, usize) -> f64 + Sync) -> Self {
        let column_len = grid.ny() / 2 + 1;
        let symmetric = grid.is_square();
        let scale = 1.0 / grid.len() as f64;
        let mut values = vec![T::zero(); (grid.nx() / 2 + 1) * column_len];
        values.par_chunks_exact_mut(column_len).enumerate().for_each(|(kx, column)| {
            for (ky, value) in column.iter_mut().enumerate().skip(if symmetric { kx } else { 0 }) {
                *value = T::from_f64(scale * eigenvalue(kx, ky)).expect("a float type holds every f64, rounded");
            }
        });
        if symmetric {
            for kx in 1..column_len {
                for ky in 0..kx {
                    values[kx * column_len + ky] = values[ky * column_len + kx];
                }
            }
        }
        Self { column_len, values }
    }

    /// The table of the inverse operator on the same grid: reciprocals, and 0 at k = 0.
    #[must_use]
    pub fn inverse(&self, grid: Grid) -> SymbolTable<f64>
    where
        T: Into<f64>,
    {
        let scale = 1.0 / grid.len() as f64;
        let mut values: Vec<f64> = self.values.par_iter().map(|&value| scale * scale / value.into()).collect();
        values[0] = 0.0;
        SymbolTable { column_len: self.column_len, values }
    }

    /// Sets the entry at k = 0, factor of the inverse transform included.
    pub fn set_mean(&mut self, value: T) {
        self.values[0] = value;
    }

    /// The table with `convert` applied to every entry, as to another precision.
    #[must_use]
    pub fn map<U: Send>(&self, convert: impl Fn(T) -> U + Sync) -> SymbolTable<U> {
        let values = self.values.par_iter().map(|&value| convert(value)).collect();
        SymbolTable { column_len: self.column_len, values }
    }

    /// The column of `kx`: eigenvalues for 0 ≤ ky ≤ ny/2.
    pub(crate) fn column(&self, kx: usize) -> &[T] {
        &self.values[kx * self.column_len..(kx + 1) * self.column_len]
    }
}
