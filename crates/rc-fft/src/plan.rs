//! Plans of one-dimensional transforms.

use std::sync::Arc;

use realfft::{ComplexToReal, FftNum, RealFftPlanner, RealToComplex};
use rustfft::{Fft, FftDirection, FftPlanner, FftPlannerScalar, FftPlannerSse};

use crate::Instructions;
use crate::real_by_complex::RealByComplex;

/// A number type of transforms, `f32` or `f64`.
///
/// Transforms are not normalised. A forward and an inverse transform together multiply by the length. Plans are made
/// for [`Instructions::of_process`].
pub trait TransformReal: FftNum {
    /// A plan of `Σ x_j exp(-2πi jk/n)` for `n` complex values, in place.
    fn complex_forward(n: usize) -> Arc<dyn Fft<Self>>;

    /// A plan of `Σ x_j exp(+2πi jk/n)` for `n` complex values, in place.
    fn complex_inverse(n: usize) -> Arc<dyn Fft<Self>>;

    /// A plan from `n` real values to n/2 + 1 complex values.
    fn real_forward(n: usize) -> Arc<dyn RealToComplex<Self>>;

    /// A plan from n/2 + 1 complex values to `n` real values.
    fn real_inverse(n: usize) -> Arc<dyn ComplexToReal<Self>>;
}

macro_rules! plan {
    ($real:ty) => {
        impl TransformReal for $real {
            fn complex_forward(n: usize) -> Arc<dyn Fft<Self>> {
                complex(Instructions::of_process(), n, FftDirection::Forward)
            }

            fn complex_inverse(n: usize) -> Arc<dyn Fft<Self>> {
                complex(Instructions::of_process(), n, FftDirection::Inverse)
            }

            fn real_forward(n: usize) -> Arc<dyn RealToComplex<Self>> {
                match Instructions::of_process() {
                    Instructions::Best => RealFftPlanner::new().plan_fft_forward(n),
                    fewer => Arc::new(RealByComplex::new(complex(fewer, n, FftDirection::Forward))),
                }
            }

            fn real_inverse(n: usize) -> Arc<dyn ComplexToReal<Self>> {
                match Instructions::of_process() {
                    Instructions::Best => RealFftPlanner::new().plan_fft_inverse(n),
                    fewer => Arc::new(RealByComplex::new(complex(fewer, n, FftDirection::Inverse))),
                }
            }
        }
    };
}

plan!(f32);
plan!(f64);

fn complex<T: FftNum>(instructions: Instructions, n: usize, direction: FftDirection) -> Arc<dyn Fft<T>> {
    match instructions {
        Instructions::Best => FftPlanner::new().plan_fft(n, direction),
        Instructions::Sse => match FftPlannerSse::new() {
            Ok(mut planner) => planner.plan_fft(n, direction),
            Err(()) => complex(Instructions::Scalar, n, direction),
        },
        Instructions::Scalar => FftPlannerScalar::new().plan_fft(n, direction),
    }
}

#[cfg(test)]
mod tests {
    use realfft::RealFftPlanner;

    use super::*;

    /// Any instructions give the same transforms up to rounding. The lengths cover every kind of algorithm.
    #[test]
    fn fewer_instructions_give_the_same_transforms() {
        for n in [1, 2, 5, 16, 60, 97, 256] {
            for instructions in [Instructions::Scalar, Instructions::Sse] {
                let plan = |direction| RealByComplex::<f64>::new(complex(instructions, n, direction));
                let values: Vec<f64> = (0..n).map(|j| (1.7 * j as f64).sin() + 0.1 * j as f64).collect();
                let forward = RealFftPlanner::new().plan_fft_forward(n);
                let (mut expected, mut spectrum) = (forward.make_output_vec(), forward.make_output_vec());
                forward.process(&mut values.clone(), &mut expected).expect("lengths of the plan");
                RealToComplex::process(&plan(FftDirection::Forward), &mut values.clone(), &mut spectrum)
                    .expect("lengths of the plan");
                for (a, b) in expected.iter().zip(&spectrum) {
                    assert!((a - b).norm() < 1e-13 * n as f64 * n as f64, "n = {n}: {a} against {b}");
                }
                let mut back = vec![0.0; n];
                ComplexToReal::process(&plan(FftDirection::Inverse), &mut spectrum, &mut back)
                    .expect("lengths of the plan");
                for (a, b) in values.iter().zip(&back) {
                    assert!((a - b / n as f64).abs() < 1e-13 * n as f64, "n = {n}: {a} there and back is {b}");
                }
            }
        }
    }
}
