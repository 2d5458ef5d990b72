//! Gauss-Legendre rules.

use std::f64::consts::PI;

/// Points and weights of the Gauss-Legendre rule on [-1, 1]. The sum of weights is 1, for means.
pub(crate) fn gauss_legendre<const N: usize>() -> [(f64, f64); N] {
    let n = N as f64;
    std::array::from_fn(|i| {
        let mut x = (PI * (i as f64 + 0.75) / (n + 0.5)).cos();
        let mut slope = 1.0;
        // Newton's method on P_N, from a start where it converges. The change of the fifth step is below rounding.
        for _ in 0..6 {
            let (mut before, mut p) = (1.0, x);
            for k in 2..=N {
                let k = k as f64;
                (before, p) = (p, ((2.0 * k - 1.0) * x * p - (k - 1.0) * before) / k);
            }
            slope = n * (x * p - before) / (x * x - 1.0);
            x -= p / slope;
        }
        (x, 1.0 / ((1.0 - x * x) * slope * slope))
    })
}
