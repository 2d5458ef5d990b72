//! The multilevel operator for corrections of a pressure, with its preconditioner.

use std::sync::Arc;

use super::hierarchy::Hierarchy;
use super::tables::Tables;
use super::tile_operator::TileOperator;
use crate::descent::{BlockLayout, BlockOperator, PreconditionedOperator};
use crate::parallel::Tasks;

/// L and its approximate inverse on the tiles of a mesh, in single precision.
pub(crate) struct TileCorrections<'a> {
    operator: TileOperator<f32>,
    displacement: &'a Tables<f32>,
    preconditioner: &'a mut Tables<f32>,
    /// Whether the preconditioner was applied last, or L.
    is_preconditioned: bool,
}

impl<'a> TileCorrections<'a> {
    /// With tables of the levels of `hierarchy`.
    pub(crate) fn new(
        hierarchy: Arc<Hierarchy>,
        displacement: &'a Tables<f32>,
        preconditioner: &'a mut Tables<f32>,
    ) -> Self {
        Self { operator: TileOperator::new(hierarchy), displacement, preconditioner, is_preconditioned: false }
    }
}

impl BlockOperator<f32> for TileCorrections<'_> {
    fn layout(&self) -> BlockLayout {
        self.operator.layout()
    }

    fn write(&mut self, write: &(dyn Fn(usize, &mut [f32]) + Sync)) {
        self.operator.write(write);
    }

    fn apply(&mut self) {
        self.is_preconditioned = false;
        self.operator.apply(self.displacement);
    }

    fn read(&self, read: &(dyn Fn(usize, &[f32]) + Sync)) {
        self.operator.read(if self.is_preconditioned { self.preconditioner } else { self.displacement }, read);
    }
}

impl PreconditionedOperator for TileCorrections<'_> {
    fn precondition(&mut self, _active: &[bool], values: &mut [f32]) {
        self.is_preconditioned = true;
        let len = self.layout().len();
        self.operator.write(&|i, block| block.copy_from_slice(&values[i * len..][..block.len()]));
        self.operator.apply(self.preconditioner);
        let preconditioner = &*self.preconditioner;
        let tasks = Tasks::new(values.chunks_mut(len));
        self.operator.read(preconditioner, &|i, block| tasks.run(i, |to: &mut [f32]| to.copy_from_slice(block)));
    }

    fn set_mean(&mut self, eigenvalue: f64) {
        self.preconditioner.set_mean(eigenvalue, self.operator.base());
    }
}
