//! L on a uniform grid, by FFT.

use std::sync::Mutex;

use rc_core::{Grid, Kernel, Operator};

use crate::descent::operators::{BlockOperator, read_blocks, write_blocks};
use crate::grid::operators::operator_of;
use crate::grid::response::GridResponse;

/// The operator `v = L p` (Eq. 4) on a uniform grid.
///
/// It is a convolution in Fourier space, in double precision.
pub struct UniformOperator {
    grid: Grid,
    /// It has plans and the buffer of spectra, so `apply` needs no scratch from the caller. It allows one application
    /// at a time.
    operator: Mutex<Box<dyn BlockOperator<f64> + Send>>,
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
        Self { grid, operator: Mutex::new(operator_of(grid, GridResponse::of(grid, kernel))) }
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
        let mut operator = self.operator.lock().unwrap_or_else(std::sync::PoisonError::into_inner);
        let block = operator.layout().len();
        write_blocks(&mut **operator, pressure.chunks(block), |source, rows| rows.copy_from_slice(source));
        operator.apply();
        read_blocks(&**operator, displacement.chunks_mut(block), |target, rows| target.copy_from_slice(rows));
    }
}
