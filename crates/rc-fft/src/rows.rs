//! Transforms of rows between real values and the waves kx ≥ 0.

use std::sync::Arc;

use realfft::{ComplexToReal, RealToComplex};
use rustfft::Fft;
use rustfft::num_complex::Complex;

use crate::TransformReal;

/// Maximum number of rows that are transformed at once.
pub(crate) const ROWS: usize = 2;

/// Plans for rows of one length. The values may be the first part of a row whose rest is zero.
pub(crate) enum RowPlans<T> {
    /// Rows of an even length, one by one.
    Even(Arc<dyn RealToComplex<T>>, Arc<dyn ComplexToReal<T>>),
    /// Two rows of an odd length are the real and the imaginary part of one complex row.
    ///
    /// `realfft` would use a complex transform of this length for each row.
    Odd(Arc<dyn Fft<T>>, Arc<dyn Fft<T>>),
}

/// Buffers for the transforms of one thread.
pub(crate) struct RowBuffers<T> {
    /// A row of an even length.
    row: Vec<T>,
    /// Two rows of an odd length.
    pair: Vec<Complex<T>>,
    scratch: Vec<Complex<T>>,
}

impl<T: TransformReal> RowPlans<T> {
    /// Plans for rows of `n` values.
    pub(crate) fn new(n: usize) -> Self {
        if n.is_multiple_of(2) {
            Self::Even(T::real_forward(n), T::real_inverse(n))
        } else {
            Self::Odd(T::complex_forward(n), T::complex_inverse(n))
        }
    }

    /// Buffers for these plans.
    pub(crate) fn buffers(&self) -> RowBuffers<T> {
        let zero = Complex::new(T::zero(), T::zero());
        let (n_row, n_pair, n_scratch) = match self {
            Self::Even(forward, inverse) => {
                (forward.len(), 0, forward.get_scratch_len().max(inverse.get_scratch_len()))
            }
            Self::Odd(forward, inverse) => {
                (0, forward.len(), forward.get_inplace_scratch_len().max(inverse.get_inplace_scratch_len()))
            }
        };
        RowBuffers { row: vec![T::zero(); n_row], pair: vec![zero; n_pair], scratch: vec![zero; n_scratch] }
    }

    /// Transforms up to [`ROWS`] rows of `nx` values into as many spectra, one after the other.
    pub(crate) fn forward(&self, rows: &[T], nx: usize, spectra: &mut [Complex<T>], buffers: &mut RowBuffers<T>) {
        let RowBuffers { row, pair, scratch } = buffers;
        match self {
            Self::Even(forward, _) => {
                for (values, spectrum) in rows.chunks_exact(nx).zip(spectra.chunks_exact_mut(row.len() / 2 + 1)) {
                    row[..nx].copy_from_slice(values);
                    row[nx..].fill(T::zero());
                    let transformed = forward.process_with_scratch(row, spectrum, scratch);
                    transformed.expect("buffers have the lengths of the plan");
                }
            }
            Self::Odd(forward, _) => {
                let (first, second) = rows.split_at(nx);
                for (value, &re) in pair.iter_mut().zip(first) {
                    *value = Complex::new(re, T::zero());
                }
                for (value, &im) in pair.iter_mut().zip(second) {
                    value.im = im;
                }
                pair[nx..].fill(Complex::new(T::zero(), T::zero()));
                forward.process_with_scratch(pair, scratch);
                separate(pair, spectra);
            }
        }
    }

    /// Transforms up to [`ROWS`] spectra back to rows of `nx` values. Destroys the spectra.
    pub(crate) fn inverse(&self, spectra: &mut [Complex<T>], rows: &mut [T], nx: usize, buffers: &mut RowBuffers<T>) {
        let RowBuffers { row, pair, scratch } = buffers;
        match self {
            Self::Even(_, inverse) => {
                for (values, spectrum) in rows.chunks_exact_mut(nx).zip(spectra.chunks_exact_mut(row.len() / 2 + 1)) {
                    // These parts are zero up to rounding, but the plan requires exact zeros.
                    spectrum[0].im = T::zero();
                    spectrum[row.len() / 2].im = T::zero();
                    let transformed = inverse.process_with_scratch(spectrum, row, scratch);
                    transformed.expect("buffers have the lengths of the plan");
                    values.copy_from_slice(&row[..nx]);
                }
            }
            Self::Odd(_, inverse) => {
                unite(spectra, pair);
                inverse.process_with_scratch(pair, scratch);
                let (first, second) = rows.split_at_mut(nx);
                for (to, value) in first.iter_mut().zip(&*pair) {
                    *to = value.re;
                }
                for (to, value) in second.iter_mut().zip(&*pair) {
                    *to = value.im;
                }
            }
        }
    }
}

/// The spectra of the real and of the imaginary part, if two are wanted, from that of complex values.
fn separate<T: TransformReal>(pair: &[Complex<T>], spectra: &mut [Complex<T>]) {
    let half = T::from_f64(0.5).expect("a float type has 1/2");
    let (first, second) = spectra.split_at_mut(pair.len() / 2 + 1);
    // The wave -k of k = 0 is itself.
    let opposite = || std::iter::once(&pair[0]).chain(pair.iter().rev());
    for ((wave, z), w) in first.iter_mut().zip(pair).zip(opposite()) {
        *wave = Complex::new(half * (z.re + w.re), half * (z.im - w.im));
    }
    for ((wave, z), w) in second.iter_mut().zip(pair).zip(opposite()) {
        *wave = Complex::new(half * (z.im + w.im), half * (w.re - z.re));
    }
}

/// The inverse of [`separate`]. A second spectrum that is missing counts as zero.
fn unite<T: TransformReal>(spectra: &[Complex<T>], pair: &mut [Complex<T>]) {
    let n_waves = pair.len() / 2 + 1;
    let (first, second) = spectra.split_at(n_waves);
    let (waves, opposite) = pair.split_at_mut(n_waves);
    if second.is_empty() {
        waves.copy_from_slice(first);
        opposite.iter_mut().rev().zip(&first[1..]).for_each(|(to, wave)| *to = wave.conj());
    } else {
        for ((to, a), b) in waves.iter_mut().zip(first).zip(second) {
            *to = Complex::new(a.re - b.im, a.im + b.re);
        }
        for ((to, a), b) in opposite.iter_mut().rev().zip(&first[1..]).zip(&second[1..]) {
            *to = Complex::new(a.re + b.im, b.re - a.im);
        }
        // The waves k = 0 are real up to rounding.
        waves[0] = Complex::new(first[0].re, second[0].re);
    }
}
