//! L on a grid of one row: a profile that is constant along y, in plane strain.
//!
//! All waves of such a grid are along x, and their symbol is that of the half-plane, 2/(E* |q|) (Johnson, *Contact
//! Mechanics*, 1985, Eq. 2.25). The row is one long transform, and its vectors have blocks of a part of it.

use rc_core::{Boundary, Grid};
use rc_fft::{LineConvolution, TransformReal};

use crate::descent::layout::BlockLayout;
use crate::descent::operators::{BlockOperator, PreconditionedOperator};
use crate::grid::extension::pyramid::Extension;
use crate::grid::extension::rows::Shares;
use crate::grid::factors::Factors;
use crate::grid::response::GridResponse;
use crate::parallel;

/// Values in a block.
const BLOCK: usize = 4096;

/// Number of elements that count as one place.
const RUN: usize = 8;

/// Whether the response is that of a profile.
pub(super) fn is_line(grid: Grid, response: &GridResponse) -> bool {
    grid.ny() == 1 && response.boundary == Boundary::Periodic
}

/// Blocks of a row of `n` elements.
pub(super) fn layout(n: usize) -> BlockLayout {
    let centre = |first: usize| [0.5 * (first + (first + RUN).min(n)) as f32 / n as f32, 0.5];
    BlockLayout::of(BLOCK).with_runs(RUN, (0..n).step_by(RUN).map(centre).collect(), [n, 1])
}

/// L on a row.
pub(super) struct LineOperator<T> {
    convolution: LineConvolution<T>,
    factors: Factors<T>,
    layout: BlockLayout,
}

impl<T: TransformReal> LineOperator<T> {
    /// An operator on a row of `n` elements, with these factors of its waves.
    pub(super) fn new(n: usize, factors: Factors<T>) -> Self {
        Self { convolution: LineConvolution::new(n), factors, layout: layout(n) }
    }
}

impl<T: TransformReal> BlockOperator<T> for LineOperator<T> {
    fn layout(&self) -> BlockLayout {
        self.layout.clone()
    }

    fn write(&mut self, write: &(dyn Fn(usize, &mut [T]) + Sync)) {
        let blocks = self.convolution.values_mut().chunks_mut(BLOCK);
        parallel::for_each(blocks.enumerate(), |(i, values)| write(i, values));
    }

    fn apply(&mut self) {
        self.factors.apply_to_line(&mut self.convolution);
    }

    fn read(&self, read: &(dyn Fn(usize, &[T]) + Sync)) {
        parallel::for_each(self.convolution.values().chunks(BLOCK).enumerate(), |(i, values)| read(i, values));
    }
}

/// L and its approximate inverse on a row, for corrections.
pub(super) struct LineCorrections {
    operator: LineOperator<f32>,
    inverse: Factors<f32>,
    extension: Extension,
}

impl LineCorrections {
    pub(super) fn new(grid: Grid, response: &GridResponse) -> Self {
        let n = grid.nx();
        Self {
            operator: LineOperator::new(n, response.factors.to_single()),
            inverse: response.factors.storage_inverse(grid),
            extension: Extension::new([n, 1]),
        }
    }
}

impl BlockOperator<f32> for LineCorrections {
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
}

impl PreconditionedOperator for LineCorrections {
    fn keeps_steps(&self) -> bool {
        true
    }

    fn set_active(&mut self, active: &[bool]) {
        self.extension.set_active(active, |active| f32::from(u8::from(active)));
    }

    fn precondition(&mut self, active: &[bool], values: &mut [f32]) {
        let Self { operator: LineOperator { convolution, .. }, inverse, extension } = self;
        extension.extend(values);
        convolution.values_mut().copy_from_slice(values);
        extension.fill_all(Shares::Active(active), convolution.values_mut());
        inverse.apply_to_line(convolution);
        values.copy_from_slice(convolution.values());
        extension.gather(Shares::Active(active), values);
    }

    fn set_mean(&mut self, eigenvalue: f64) {
        self.inverse.set_mean((eigenvalue / self.operator.convolution.values().len() as f64) as f32);
    }
}
