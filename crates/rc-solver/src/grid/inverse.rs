//! The approximate inverse of L on a grid.
//!
//! It is the inverse symbol between an extension of residuals and its transpose.

use rc_core::Grid;
use rc_fft::{BLOCK_ROWS, Convolution};

use crate::grid::extension::pyramid::Extension;
use crate::grid::extension::rows::Shares;
use crate::grid::factors::Factors;
use crate::grid::passes::{read_rows, write_rows};
use crate::parallel::Tasks;

/// The approximate inverse on a periodic grid.
pub(super) struct Inverse {
    pub(super) symbol: Factors<f32>,
    pub(super) extension: Extension,
}

impl Inverse {
    pub(super) fn new(grid: Grid, symbol: Factors<f32>) -> Self {
        Self { symbol, extension: Extension::new([grid.nx(), grid.ny()]) }
    }

    /// Applies the inverse to values that are zero where elements are not active.
    pub(super) fn apply(&mut self, convolution: &mut Convolution<f32>, active: &[bool], values: &mut [f32]) {
        let Self { symbol, extension } = self;
        extension.extend(values);
        let len = BLOCK_ROWS * convolution.grid().nx();
        let filled = &*extension;
        write_rows(convolution, &|i, rows| {
            let here = i * len..i * len + rows.len();
            rows.copy_from_slice(&values[here.clone()]);
            filled.fill(i * BLOCK_ROWS, Shares::Active(&active[here]), rows);
        });
        symbol.apply(convolution);
        let tasks = Tasks::new(values.chunks_mut(len));
        read_rows(convolution, &|i, rows| tasks.run(i, |to: &mut [f32]| to.copy_from_slice(rows)));
        extension.gather(Shares::Active(active), values);
    }
}
