//! Real transforms by a complex transform of the same length.
//!
//! They serve planners that `realfft` cannot use.

use std::sync::Arc;

use realfft::{ComplexToReal, FftError, FftNum, RealToComplex};
use rustfft::Fft;
use rustfft::num_complex::Complex;

/// A real transform with twice the work of `realfft`.
///
/// `realfft` cannot be used, because it always takes the instructions that `rustfft` chooses.
pub(crate) struct RealByComplex<T> {
    plan: Arc<dyn Fft<T>>,
}

impl<T: FftNum> RealByComplex<T> {
    /// A transform with a forward plan for [`RealToComplex`], or an inverse plan for [`ComplexToReal`].
    pub(crate) fn new(plan: Arc<dyn Fft<T>>) -> Self {
        Self { plan }
    }

    fn n(&self) -> usize {
        self.plan.len()
    }

    /// Transforms the complex values that `set` writes.
    fn transform<'a>(&self, scratch: &'a mut [Complex<T>], set: impl FnOnce(&mut [Complex<T>])) -> &'a [Complex<T>] {
        let (values, scratch) = scratch.split_at_mut(self.n());
        set(values);
        self.plan.process_with_scratch(values, scratch);
        values
    }

    fn scratch_len(&self) -> usize {
        self.n() + self.plan.get_inplace_scratch_len()
    }

    /// Checks lengths. Returns the errors of `realfft` for a wrong length.
    fn check(&self, n_real: usize, n_complex: usize, n_scratch: usize) -> Result<(), FftError> {
        let wanted = self.n() / 2 + 1;
        if n_real != self.n() {
            Err(FftError::InputBuffer(self.n(), n_real))
        } else if n_complex != wanted {
            Err(FftError::OutputBuffer(wanted, n_complex))
        } else if n_scratch < self.scratch_len() {
            Err(FftError::ScratchBuffer(self.scratch_len(), n_scratch))
        } else {
            Ok(())
        }
    }
}

impl<T: FftNum> RealToComplex<T> for RealByComplex<T> {
    fn process(&self, input: &mut [T], output: &mut [Complex<T>]) -> Result<(), FftError> {
        RealToComplex::process_with_scratch(self, input, output, &mut RealToComplex::make_scratch_vec(self))
    }

    fn process_with_scratch(
        &self,
        input: &mut [T],
        output: &mut [Complex<T>],
        scratch: &mut [Complex<T>],
    ) -> Result<(), FftError> {
        self.check(input.len(), output.len(), scratch.len())?;
        let spectrum = self.transform(scratch, |values| {
            for (value, &real) in values.iter_mut().zip(&*input) {
                *value = Complex::new(real, T::zero());
            }
        });
        output.copy_from_slice(&spectrum[..output.len()]);
        Ok(())
    }

    fn get_scratch_len(&self) -> usize {
        self.scratch_len()
    }

    fn len(&self) -> usize {
        self.n()
    }

    fn make_input_vec(&self) -> Vec<T> {
        vec![T::zero(); self.n()]
    }

    fn make_output_vec(&self) -> Vec<Complex<T>> {
        vec![Complex::new(T::zero(), T::zero()); self.n() / 2 + 1]
    }

    fn make_scratch_vec(&self) -> Vec<Complex<T>> {
        vec![Complex::new(T::zero(), T::zero()); self.scratch_len()]
    }
}

impl<T: FftNum> ComplexToReal<T> for RealByComplex<T> {
    fn process(&self, input: &mut [Complex<T>], output: &mut [T]) -> Result<(), FftError> {
        ComplexToReal::process_with_scratch(self, input, output, &mut ComplexToReal::make_scratch_vec(self))
    }

    fn process_with_scratch(
        &self,
        input: &mut [Complex<T>],
        output: &mut [T],
        scratch: &mut [Complex<T>],
    ) -> Result<(), FftError> {
        self.check(output.len(), input.len(), scratch.len())?;
        let field = self.transform(scratch, |values| {
            values[..input.len()].copy_from_slice(input);
            // The other half of the spectrum of a real field, by symmetry.
            for (value, conjugate) in values[input.len()..].iter_mut().rev().zip(&input[1..]) {
                *value = conjugate.conj();
            }
        });
        for (real, value) in output.iter_mut().zip(field) {
            *real = value.re;
        }
        Ok(())
    }

    fn get_scratch_len(&self) -> usize {
        self.scratch_len()
    }

    fn len(&self) -> usize {
        self.n()
    }

    fn make_input_vec(&self) -> Vec<Complex<T>> {
        RealToComplex::make_output_vec(self)
    }

    fn make_output_vec(&self) -> Vec<T> {
        RealToComplex::make_input_vec(self)
    }

    fn make_scratch_vec(&self) -> Vec<Complex<T>> {
        RealToComplex::make_scratch_vec(self)
    }
}
