//! Plans of Fourier transforms, in both precisions.
//!
//! `rustfft` is generic over the number type, so every crate that makes a plan compiles all of its algorithms, for each instruction set
//! and precision: a million lines of LLVM code, and minutes for each change of `rc-solver`. Here they are compiled once; other crates get
//! a plan as a trait object.
//!
//! ```
//! use rc_fft::{Complex, Plan};
//!
//! let plan = f64::complex_forward(4);
//! let mut values = [1.0, 0.0, -1.0, 0.0].map(|re| Complex::new(re, 0.0));
//! plan.process(&mut values);
//! assert_eq!(values[1], Complex::new(2.0, 0.0));
//! ```

use std::sync::Arc;

pub use realfft::{ComplexToReal, RealToComplex};
use realfft::{FftNum, RealFftPlanner};
pub use rustfft::Fft;
use rustfft::FftPlanner;
pub use rustfft::num_complex::{Complex, Complex64};

/// `f32` or `f64`. Transforms are not normalised: there and back multiplies by the length.
pub trait Plan: FftNum {
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
        impl Plan for $real {
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
