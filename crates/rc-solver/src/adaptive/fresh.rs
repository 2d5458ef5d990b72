//! Fresh gaps: the operator that certificates come from, in double or in single precision.
//!
//! In single precision the rounding of L p is below 1e-6 of the rms displacement, as is the error of the split kernel itself;
//! it takes half the time and memory. Heights and gaps are in double precision either way.

use std::sync::Arc;

use rayon::prelude::*;

use super::operator::{BLOCK_CELLS, Hierarchy, Real, Tables, TileOperator};
use crate::descent::{Blocks, Engine};

/// An operator of precision `T` on vectors of double precision.
pub(super) struct Fresh<T>(TileOperator<T>);

impl<T: Real + Into<f64>> Fresh<T> {
    pub(super) fn new(hierarchy: Arc<Hierarchy>) -> Self {
        Self(TileOperator::new(hierarchy))
    }

    pub(super) fn operator(&self) -> &TileOperator<T> {
        &self.0
    }
}

impl<T: Real + Into<f64>> Engine<f64> for Fresh<T> {
    type Table = Tables<T>;

    fn blocks(&self) -> Blocks {
        self.0.blocks()
    }

    fn fill<S, R>(&mut self, sources: S, fill: impl Fn(S::Item, &mut [f64]) -> R + Sync) -> Vec<R>
    where
        S: IndexedParallelIterator,
        R: Send,
    {
        self.0.fill(sources, |source, cells| {
            let mut values = [0.0; BLOCK_CELLS];
            let values = &mut values[..cells.len()];
            let filled = fill(source, values);
            for (cell, &value) in cells.iter_mut().zip(&*values) {
                *cell = T::rounded(value);
            }
            filled
        })
    }

    fn multiply(&mut self, table: &Tables<T>) {
        self.0.multiply(table);
    }

    fn take<K, R>(&self, table: &Tables<T>, sinks: K, take: impl Fn(K::Item, &[f64]) -> R + Sync) -> Vec<R>
    where
        K: IndexedParallelIterator,
        R: Send,
    {
        self.0.take(table, sinks, |sink, cells| {
            let mut values = [0.0; BLOCK_CELLS];
            for (value, &cell) in values.iter_mut().zip(cells) {
                *value = cell.into();
            }
            take(sink, &values[..cells.len()])
        })
    }

    fn set_mean(&self, table: &mut Tables<T>, eigenvalue: f64) {
        self.0.set_mean(table, eigenvalue);
    }
}
