//! The multilevel operator as the machinery of a descent.

use rayon::prelude::*;

use super::operator::{BLOCK_CELLS, Real, Tables, TileOperator};
use crate::descent::Engine;

impl<T: Real> Engine<T> for TileOperator<T> {
    type Table = Tables<T>;

    fn block_len(&self) -> usize {
        BLOCK_CELLS
    }

    fn fill<S, R>(&mut self, sources: S, fill: impl Fn(S::Item, &mut [T]) -> R + Sync) -> Vec<R>
    where
        S: IndexedParallelIterator,
        R: Send,
    {
        TileOperator::fill(self, sources, fill)
    }

    fn multiply(&mut self, table: &Tables<T>) {
        self.spread(table);
    }

    fn take<K, R>(&self, table: &Tables<T>, sinks: K, take: impl Fn(K::Item, &[T]) -> R + Sync) -> Vec<R>
    where
        K: IndexedParallelIterator,
        R: Send,
    {
        TileOperator::take(self, table, sinks, take)
    }

    fn set_mean(&self, table: &mut Tables<T>, eigenvalue: f64) {
        let value = eigenvalue / self.hierarchy().base().len() as f64;
        table.base.set_mean(T::rounded(value));
    }
}
