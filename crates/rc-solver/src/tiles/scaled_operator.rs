//! The multilevel operator on vectors of double precision, for fresh gaps.
//!
//! Certificates come from it. Inside, it computes in double or in single precision. In single precision, the rounding
//! of L p is below 1e-6 of the rms displacement, as is the error of the split kernel itself. Single precision takes
//! half the time and memory. Heights and gaps are in double precision either way.

use std::sync::Arc;

use rc_quadtree::BLOCK_CELLS;

use crate::descent::layout::BlockLayout;
use crate::descent::operators::BlockOperator;
use crate::problem::checked::power_of_two_near;
use crate::tiles::operator::hierarchy::Hierarchy;
use crate::tiles::operator::sizes::Real;
use crate::tiles::operator::tables::Tables;
use crate::tiles::operator::tile_operator::TileOperator;

/// An operator of precision `T` on vectors of double precision.
pub(crate) struct ScaledOperator<'a, T> {
    operator: TileOperator<T, &'a Tables<T>>,
    /// Pressure that is subtracted from every pressure before it is rounded.
    reference: f64,
    /// Displacement by that pressure, in λ.
    uniform: f64,
    /// The unit of pressures and displacements.
    ///
    /// It is a power of two, so that no scene underflows or overflows.
    unit: f64,
}

impl<'a, T: Real + Into<f64>> ScaledOperator<'a, T> {
    /// The operator of `tables` on `hierarchy`.
    ///
    /// Pressures are about `mean`, and displacements about `size`. The displacement by a uniform pressure is known, so the
    /// mean is subtracted if elements cover the cell. Far beyond full contact, the mean is much larger than the pressure from
    /// the heights. Its rounding and its part of the split kernel's error would then be larger than that pressure.
    pub(crate) fn new(hierarchy: Arc<Hierarchy>, tables: &'a Tables<T>, mean: f64, size: f64) -> Self {
        let reference = if hierarchy.cover_period() { mean } else { 0.0 };
        let (uniform, unit) = (tables.compliance * reference, power_of_two_near(size));
        Self { operator: TileOperator::new(hierarchy, tables), reference, uniform, unit }
    }

    /// Frees what reading does not need: see [`TileOperator::end`].
    pub(crate) fn end(&mut self) {
        self.operator.end();
    }

    /// Smooth remainder on the base grid, in λ: see [`TileOperator::base_displacement`].
    pub(crate) fn base_displacement(&self) -> Vec<f64> {
        self.operator.base_displacement().iter().map(|&v| self.unit * v.into() + self.uniform).collect()
    }
}

impl<T: Real + Into<f64>> BlockOperator<f64> for ScaledOperator<'_, T> {
    fn layout(&self) -> BlockLayout {
        self.operator.layout()
    }

    fn write(&mut self, write: &(dyn Fn(usize, &mut [f64]) + Sync)) {
        let (reference, unit) = (self.reference, self.unit);
        self.operator.write(&|i, cells| {
            let mut values = [0.0; BLOCK_CELLS];
            let values = &mut values[..cells.len()];
            write(i, values);
            for (cell, &value) in cells.iter_mut().zip(&*values) {
                *cell = T::rounded((value - reference) / unit);
            }
        });
    }

    fn apply(&mut self) {
        self.operator.apply();
    }

    fn read(&self, read: &(dyn Fn(usize, &[f64]) + Sync)) {
        self.operator.read(&|i, cells| {
            let mut values = [0.0; BLOCK_CELLS];
            for (value, &cell) in values.iter_mut().zip(cells) {
                *value = self.unit * cell.into() + self.uniform;
            }
            read(i, &values[..cells.len()]);
        });
    }

    fn release(&mut self) {
        self.operator.release();
    }
}
