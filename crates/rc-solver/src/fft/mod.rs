//! Periodic convolutions of real fields: `field → inverse FFT( symbol · FFT(field) )`.

mod convolution;
mod symbol_table;

pub(crate) use convolution::{BLOCK_ROWS, Convolution};
pub(crate) use symbol_table::SymbolTable;
