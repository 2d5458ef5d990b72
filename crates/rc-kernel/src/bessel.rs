//! Modified Bessel functions from their series, for windows.

/// `F_m(q) = Σ_n qⁿ / (n! (n + m)!)` for q ≥ 0, to rounding accuracy because all terms are positive.
///
/// Modified Bessel functions are `I_m(x) = (x/2)^m F_m(x²/4)`, and `F_m' = F_(m+1)`. The number of terms grows like √q.
#[must_use]
pub fn bessel_series(q: f64, m: usize) -> f64 {
    let mut term = 1.0 / (1..=m).map(|n| n as f64).product::<f64>();
    let mut sum = 0.0;
    let mut n = 0.0;
    while term > f64::EPSILON * 1e-2 * sum {
        sum += term;
        n += 1.0;
        term *= q / (n * (n + m as f64));
    }
    sum
}

#[cfg(test)]
mod tests {
    use std::f64::consts::TAU;

    use super::*;

    /// I_m(x) as the mean of exp(x cos θ) cos(m θ). With 128 angles it is exact up to rounding.
    fn modified_bessel(x: f64, m: usize) -> f64 {
        let angles = (0..128).map(|i| TAU * f64::from(i) / 128.0);
        angles.map(|angle| (x * angle.cos()).exp() * (m as f64 * angle).cos()).sum::<f64>() / 128.0
    }

    #[test]
    fn the_series_agrees_with_the_integral() {
        for (x, m) in [(0.0_f64, 0), (1.0, 0), (10.0, 0), (28.0, 0), (1.0, 1), (20.0, 1), (3.0, 2), (20.0, 2)] {
            let (value, expected) = ((0.5 * x).powi(m as i32) * bessel_series(0.25 * x * x, m), modified_bessel(x, m));
            assert!((value / expected - 1.0).abs() < 1e-13, "I{m}({x}): {value}, not {expected}");
        }
    }
}
