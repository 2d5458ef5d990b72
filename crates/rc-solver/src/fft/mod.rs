//! Periodic convolutions of real fields: `field → inverse FFT( symbol · FFT(field) )`.

mod convolution;
mod symbol_table;

pub(crate) use convolution::{BLOCK_ROWS, Convolution};
pub(crate) use symbol_table::SymbolTable;

/// Adds arrays of sums in the order of blocks.
pub(crate) fn total<const N: usize>(blocks: Vec<[f64; N]>) -> [f64; N] {
    let mut sum = [0.0; N];
    for block in blocks {
        for (sum, value) in sum.iter_mut().zip(block) {
            *sum += value;
        }
    }
    sum
}
