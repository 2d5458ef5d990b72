//! Plans of transforms of one dimension.

use std::sync::Arc;

use realfft::{ComplexToReal, FftNum, RealFftPlanner, RealToComplex};
use rustfft::{Fft, FftPlanner};

/// `f32` or `f64`. Transforms are not normalised: there and back multiplies by the length.
pub trait TransformReal: FftNum {
    /// `Σ x_j exp(-2πi jk/n)` of `n` complex values, in place.
    fn complex_forward(n: usize) -> Arc<dyn Fft<Self>>;

    /// `Σ x_j exp(+2πi jk/n)` of `n` complex values, in place.
    fn complex_inverse(n: usize) -> Arc<dyn Fft<Self>>;

    /// From `n` real values to n/2 + 1 complex ones.
    fn real_forward(n: usize) -> Arc<dyn RealToComplex<Self>>;

    /// From n/2 + 1 complex values to `n` real ones.
    fn real_inverse(n: usize) -> Arc<dyn ComplexToReal<Self>>;
}

macro_rules! plan {
    ($real:ty) => {
        impl TransformReal for $real {
            fn complex_forward(n: usize) -> Arc<dyn Fft<Self>> {
                FftPlanner::new().plan_fft_forward(n)
            }

            fn complex_inverse(n: usize) -> Arc<dyn Fft<Self>> {
                FftPlanner::new().plan_fft_inverse(n)
            }

            fn real_forward(n: usize) -> Arc<dyn RealToComplex<Self>> {
                RealFftPlanner::new().plan_fft_forward(n)
            }

            fn real_inverse(n: usize) -> Arc<dyn ComplexToReal<Self>> {
                RealFftPlanner::new().plan_fft_inverse(n)
            }
        }
    };
}

plan!(f32);
plan!(f64);
