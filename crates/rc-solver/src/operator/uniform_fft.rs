//! L on a uniform grid, by FFT.

use std::sync::Mutex;

use rayon::prelude::*;
use rc_core::{Grid, Kernel, Operator};
use rc_fft::{BLOCK_ROWS, Convolution, SymbolTable};

/// `v = L p` (Eq. 4) on a uniform grid: diagonal in Fourier space, in double precision.
pub struct UniformOperator {
    grid: Grid,
    symbol: SymbolTable<f64>,
    /// Holds plans and the buffer of spectra, so `apply` needs no scratch of the caller; one application at a time.
    convolution: Mutex<Convolution<f64>>,
}

impl std::fmt::Debug for UniformOperator {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("UniformOperator").field("grid", &self.grid).finish_non_exhaustive()
    }
}

impl UniformOperator {
    /// The operator of `kernel` on `grid`.
    #[must_use]
    pub fn new(grid: Grid, kernel: &dyn Kernel) -> Self {
        let eigenvalue = kernel.symbol(grid);
        let symbol = SymbolTable::new(grid, eigenvalue);
        Self { grid, symbol, convolution: Mutex::new(Convolution::new(grid)) }
    }
}

impl Operator for UniformOperator {
    fn n_elements(&self) -> usize {
        self.grid.len()
    }

    fn scratch_len(&self) -> usize {
        0
    }

    fn apply(&self, pressure: &[f64], displacement: &mut [f64], _scratch: &mut [f64]) {
        assert_eq!(pressure.len(), self.grid.len(), "length of the pressure");
        assert_eq!(displacement.len(), self.grid.len(), "length of the displacement");
        let block = BLOCK_ROWS * self.grid.nx();
        let mut convolution = self.convolution.lock().unwrap_or_else(std::sync::PoisonError::into_inner);
        convolution.apply(
            &self.symbol,
            pressure.par_chunks(block),
            |source, rows| rows.copy_from_slice(source),
            displacement.par_chunks_mut(block),
            |sink, rows| sink.copy_from_slice(rows),
        );
    }
}
