//! Repeated convolutions of a single row.

use std::sync::Arc;

use realfft::{ComplexToReal, RealToComplex};
use rustfft::num_complex::Complex;

use crate::{SymbolTable, TransformReal, WaveTable};

/// Plans and buffers of convolutions `values -> inverse FFT( symbol · FFT(values) )` of one row.
///
/// It does what [`Convolution`](crate::Convolution) does on a grid of one row, without blocks of rows and panels of
/// columns. The row is one long transform, which is not divided among threads.
pub struct LineConvolution<T> {
    forward: Arc<dyn RealToComplex<T>>,
    inverse: Arc<dyn ComplexToReal<T>>,
    values: Vec<T>,
    spectrum: Vec<Complex<T>>,
    scratch: Vec<Complex<T>>,
}

impl<T: TransformReal> LineConvolution<T> {
    /// Plans for rows of `n` values, which are zero at first. *Memory*: 4 n numbers of `T`.
    #[must_use]
    pub fn new(n: usize) -> Self {
        let (forward, inverse) = (T::real_forward(n), T::real_inverse(n));
        let zero = Complex::new(T::zero(), T::zero());
        let scratch = vec![zero; forward.get_scratch_len().max(inverse.get_scratch_len())];
        Self { forward, inverse, values: vec![T::zero(); n], spectrum: vec![zero; n / 2 + 1], scratch }
    }

    /// The row.
    #[must_use]
    pub fn values(&self) -> &[T] {
        &self.values
    }

    /// The row, to be written.
    pub fn values_mut(&mut self) -> &mut [T] {
        &mut self.values
    }

    /// Convolves the row with `symbol`, the table for a grid of one row of as many elements.
    ///
    /// # Panics
    /// When the table is for another grid.
    pub fn apply(&mut self, symbol: &SymbolTable<T>) {
        let symbol = symbol.of_line();
        assert_eq!(symbol.len(), self.spectrum.len(), "waves of the table");
        self.transform(|spectrum| {
            for (wave, &factor) in spectrum.iter_mut().zip(symbol) {
                *wave = wave.scale(factor);
            }
        });
    }

    /// [`LineConvolution::apply`] with a complex symbol.
    ///
    /// # Panics
    /// When the table is for another grid.
    pub fn apply_waves(&mut self, symbol: &WaveTable<T>) {
        let symbol = symbol.of_line();
        assert_eq!(symbol.len(), self.spectrum.len(), "waves of the table");
        self.transform(|spectrum| {
            for (wave, &factor) in spectrum.iter_mut().zip(symbol) {
                *wave = *wave * factor;
            }
        });
    }

    fn transform(&mut self, scale: impl Fn(&mut [Complex<T>])) {
        let Self { forward, inverse, values, spectrum, scratch } = self;
        forward.process_with_scratch(values, spectrum, scratch).expect("buffers have the lengths of the plan");
        scale(spectrum);
        // These parts are zero up to rounding, but the plan requires exact zeros.
        spectrum[0].im = T::zero();
        if values.len().is_multiple_of(2) {
            spectrum[values.len() / 2].im = T::zero();
        }
        inverse.process_with_scratch(spectrum, values, scratch).expect("buffers have the lengths of the plan");
    }
}

impl<T> std::fmt::Debug for LineConvolution<T> {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("LineConvolution").field("n", &self.values.len()).finish_non_exhaustive()
    }
}

#[cfg(test)]
mod tests {
    use rc_core::Grid;
    use rc_core::testing::quasi_random;

    use super::*;
    use crate::Convolution;

    #[test]
    fn it_is_the_convolution_of_a_grid_of_one_row() {
        for n in [1, 2, 9, 64, 97, 1000] {
            let grid = Grid::new(n, 1).expect("a grid");
            let table = SymbolTable::<f64>::new(grid, |kx, _| 1.0 / (1.0 + kx as f64));
            let source: Vec<f64> = (0..n).map(quasi_random).collect();
            let mut expected = vec![0.0; n];
            let sources = rayon::iter::once(&source);
            let sinks = rayon::iter::once(&mut expected);
            let mut of_grid = Convolution::<f64>::new(grid);
            let write = |source: &Vec<f64>, rows: &mut [f64]| rows.copy_from_slice(source);
            of_grid.apply(&table, sources, write, sinks, |sink, rows| sink.copy_from_slice(rows));
            let mut line = LineConvolution::new(n);
            line.values_mut().copy_from_slice(&source);
            line.apply(&table);
            for (found, expected) in line.values().iter().zip(&expected) {
                assert!((found - expected).abs() < 1e-13, "n = {n}: {found} for {expected}");
            }
        }
    }
}
