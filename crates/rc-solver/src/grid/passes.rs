//! The rows of a convolution, block by block.

use rayon::prelude::*;
use rc_core::Grid;
use rc_fft::{BLOCK_ROWS, Convolution, TransformReal};

use crate::descent::layout::BlockLayout;

/// Blocks of rows, as the convolution transforms them.
pub(crate) fn layout(grid: Grid) -> BlockLayout {
    BlockLayout::of_rows(BLOCK_ROWS, [grid.nx(), grid.ny()])
}

fn n_blocks(grid: Grid) -> usize {
    grid.ny().div_ceil(BLOCK_ROWS)
}

/// Calls `write` once for each block of rows, with its index and the rows.
///
/// It fills in the rows. All callers pass closures in this form. The transforms are compiled once for it.
pub(crate) fn write_rows<T: TransformReal>(convolution: &mut Convolution<T>, write: &(dyn Fn(usize, &mut [T]) + Sync)) {
    let blocks = (0..n_blocks(convolution.grid())).into_par_iter();
    convolution.transform_rows(blocks, write);
}

/// Calls `read` once for each block of rows, with its index and the rows.
pub(crate) fn read_rows<T: TransformReal>(convolution: &Convolution<T>, read: &(dyn Fn(usize, &[T]) + Sync)) {
    let blocks = (0..n_blocks(convolution.grid())).into_par_iter();
    convolution.read_rows(blocks, read);
}
