//! What an iteration needs to know of the mesh: how a table (of L, or of its approximate inverse) is applied to a vector.

use rayon::prelude::*;
use rc_fft::{BLOCK_ROWS, Convolution, Plan, SymbolTable};

use super::Blocks;

/// Applies tables to vectors, block by block, so that the caller's vector work rides along: first the caller fills a vector,
/// then a table is applied, then the caller takes the result. What closures return is collected in the order of blocks.
pub(crate) trait Engine<T> {
    /// An operator, tabulated.
    type Table: Sync;

    /// How vectors are divided.
    fn blocks(&self) -> Blocks;

    /// `fill` writes the vector; one item of `sources` for each block.
    fn fill<S, R>(&mut self, sources: S, fill: impl Fn(S::Item, &mut [T]) -> R + Sync) -> Vec<R>
    where
        S: IndexedParallelIterator,
        R: Send;

    /// Applies a table to the vector, except for what [`Engine::take`] does on the way.
    fn multiply(&mut self, table: &Self::Table);

    /// Hands out the result of the last [`Engine::multiply`], of the same table; one item of `sinks` for each block. Without
    /// one it is the vector itself that an engine may hand out, or not: nothing may depend on it.
    fn take<K, R>(&self, table: &Self::Table, sinks: K, take: impl Fn(K::Item, &[T]) -> R + Sync) -> Vec<R>
    where
        K: IndexedParallelIterator,
        R: Send;

    /// Changes the eigenvalue of a table for constant vectors.
    fn set_mean(&self, table: &mut Self::Table, eigenvalue: f64);
}

impl<T: Plan> Engine<T> for Convolution<T> {
    type Table = SymbolTable<T>;

    fn blocks(&self) -> Blocks {
        Blocks::of(BLOCK_ROWS * self.grid().nx())
    }

    fn fill<S, R>(&mut self, sources: S, fill: impl Fn(S::Item, &mut [T]) -> R + Sync) -> Vec<R>
    where
        S: IndexedParallelIterator,
        R: Send,
    {
        self.transform_rows(sources, fill)
    }

    fn multiply(&mut self, table: &SymbolTable<T>) {
        Convolution::multiply(self, table);
    }

    fn take<K, R>(&self, _table: &SymbolTable<T>, sinks: K, take: impl Fn(K::Item, &[T]) -> R + Sync) -> Vec<R>
    where
        K: IndexedParallelIterator,
        R: Send,
    {
        self.take_rows(sinks, take)
    }

    fn set_mean(&self, table: &mut SymbolTable<T>, eigenvalue: f64) {
        let value = eigenvalue / self.grid().len() as f64;
        table.set_mean(T::from_f64(value).expect("a float type holds every f64, rounded"));
    }
}
