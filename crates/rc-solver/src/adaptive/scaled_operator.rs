//! The multilevel operator on vectors of double precision, for fresh gaps: certificates come from it.
//!
//! Inside it computes in double or in single precision. In single precision the rounding of L p is below 1e-6 of the rms
//! displacement, as is the error of the split kernel itself; it takes half the time and memory. Heights and gaps are in double
//! precision either way.

use std::sync::Arc;

use rayon::prelude::*;
use rc_quadtree::BLOCK_CELLS;

use super::operator::{Hierarchy, Real, Tables, TileOperator};
use crate::descent::{Blocks, Engine};
use crate::problem::power_of_two_near;

/// An operator of precision `T` on vectors of double precision.
pub(super) struct ScaledOperator<T> {
    operator: TileOperator<T>,
    /// Subtracted from every pressure before it is rounded.
    reference: f64,
    /// The unit of pressures and displacements, a power of two, so that no scene underflows or overflows.
    unit: f64,
}

impl<T: Real + Into<f64>> ScaledOperator<T> {
    /// An operator on `hierarchy` for pressures about `mean` and displacements of about `size`.
    ///
    /// A uniform pressure displaces nothing, so where elements cover the cell the mean is subtracted. Far beyond full contact its
    /// rounding, and its part of the split kernel's error, would be larger than the pressure that the heights add to it.
    pub(super) fn new(hierarchy: Arc<Hierarchy>, mean: f64, size: f64) -> Self {
        let reference = if hierarchy.elements().cover_cell() { mean } else { 0.0 };
        Self { operator: TileOperator::new(hierarchy), reference, unit: power_of_two_near(size) }
    }

    /// Unit of [`ScaledOperator::base_displacement`], in λ.
    pub(super) fn unit(&self) -> f64 {
        self.unit
    }

    /// See [`TileOperator::base_displacement`].
    pub(super) fn base_displacement(&self) -> &[T] {
        self.operator.base_displacement()
    }
}

impl<T: Real + Into<f64>> Engine<f64> for ScaledOperator<T> {
    type Table = Tables<T>;

    fn blocks(&self) -> Blocks {
        self.operator.blocks()
    }

    fn fill<S, R>(&mut self, sources: S, fill: impl Fn(S::Item, &mut [f64]) -> R + Sync) -> Vec<R>
    where
        S: IndexedParallelIterator,
        R: Send,
    {
        let (reference, unit) = (self.reference, self.unit);
        self.operator.fill(sources, |source, cells| {
            let mut values = [0.0; BLOCK_CELLS];
            let values = &mut values[..cells.len()];
            let filled = fill(source, values);
            for (cell, &value) in cells.iter_mut().zip(&*values) {
                *cell = T::rounded((value - reference) / unit);
            }
            filled
        })
    }

    fn multiply(&mut self, table: &Tables<T>) {
        self.operator.multiply(table);
    }

    fn take<K, R>(&self, table: &Tables<T>, sinks: K, take: impl Fn(K::Item, &[f64]) -> R + Sync) -> Vec<R>
    where
        K: IndexedParallelIterator,
        R: Send,
    {
        self.operator.take(table, sinks, |sink, cells| {
            let mut values = [0.0; BLOCK_CELLS];
            for (value, &cell) in values.iter_mut().zip(cells) {
                *value = self.unit * cell.into();
            }
            take(sink, &values[..cells.len()])
        })
    }

    fn set_mean(&self, table: &mut Tables<T>, eigenvalue: f64) {
        self.operator.set_mean(table, eigenvalue);
    }
}
