//! The multilevel operator for corrections of a pressure, with its preconditioner.

use std::sync::Arc;

use crate::descent::layout::BlockLayout;
use crate::descent::operators::{BlockOperator, PreconditionedOperator};
use crate::tiles::operator::extension::TileExtension;
use crate::tiles::operator::hierarchy::Hierarchy;
use crate::tiles::operator::tables::Tables;
use crate::tiles::operator::tile_operator::TileOperator;

/// L and its approximate inverse on the tiles of a mesh, in single precision.
pub(crate) struct TileCorrections<'a> {
    operator: TileOperator<f32, &'a Tables<f32>>,
    extension: TileExtension,
    preconditioner: &'a mut Tables<f32>,
}

impl<'a> TileCorrections<'a> {
    /// The operators with tables of the levels of `hierarchy`.
    pub(crate) fn new(
        hierarchy: Arc<Hierarchy>,
        displacement: &'a Tables<f32>,
        preconditioner: &'a mut Tables<f32>,
    ) -> Self {
        let extension = TileExtension::new(hierarchy.halved());
        Self { operator: TileOperator::new(hierarchy, displacement), extension, preconditioner }
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
        self.operator.apply();
    }

    fn read(&self, read: &(dyn Fn(usize, &[f32]) + Sync)) {
        self.operator.read(read);
    }

    fn release(&mut self) {
        self.operator.release();
    }
}

impl PreconditionedOperator for TileCorrections<'_> {
    fn set_active(&mut self, active: &[bool]) {
        self.extension.set_active(active, self.operator.buffers());
    }

    fn precondition(&mut self, active: &[bool], values: &mut [f32]) {
        self.extension.precondition(self.operator.buffers(), self.preconditioner, active, values);
    }

    fn set_mean(&mut self, eigenvalue: f64) {
        self.preconditioner.set_mean(eigenvalue, self.operator.base());
    }
}
