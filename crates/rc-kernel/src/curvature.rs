//! The curvature of the displacements that a smooth isotropic kernel causes.

use std::f64::consts::{FRAC_PI_4, PI};

use crate::gauss_legendre::gauss_legendre;

/// Factor for extremes that lie between the samples.
const MARGIN: f64 = 1.02;

/// Bound of the second derivatives, along any axis, of displacements by pressures between 0 and 1.
///
/// The displacement of a wave ξ is that of the pressure times f(ξ)/ξ. f is smooth, and decreases from ξ = `length`⁻¹ to
/// zero at 40. Lengths on which its transform changes are between 1/20 and a few times `length` ≥ 1.
///
/// The displacement by a load at the origin is κ(r) = k(r)/2π with k(r) = ∫ f(ξ) J0(ξ r) dξ. Since ∫ ∂²κ/∂x² dA = 0, no
/// pressure between 0 and 1 has more than half of ∫ |∂²κ/∂x²| dA, which is at most ∫ (|k''| r + |k'|) dr/2. The two
/// terms are the variations of r k' - k and of k. Both functions are evaluated at points that lie closely. Beyond the
/// last, they tend to zero without turning, like f(0)/r.
///
/// *Accuracy*: within 3 % above the bound (test `the_bound_is_that_of_a_known_transform`).
pub(crate) fn curvature(f: impl Fn(f64) -> f64, length: f64) -> f64 {
    let waves = waves(f, length);
    let at = |r: f64| {
        let sums = waves.iter().fold([0.0; 2], |[k, slope], &(xi, weighted)| {
            let [j0, j1] = bessel(xi * r);
            [k + weighted * j0, slope - weighted * xi * r * j1]
        });
        [sums[0], sums[1] - sums[0]]
    };
    let last = 10.0 * length;
    let points = std::iter::successors(Some(0.05), |r| Some(1.08 * r)).take_while(|&r| r <= last);
    let values = std::iter::once(0.0).chain(points).map(at).chain([[0.0; 2]]);
    let (mut before, mut variation) = (at(0.0), 0.0);
    for values in values {
        variation += (values[0] - before[0]).abs() + (values[1] - before[1]).abs();
        before = values;
    }
    MARGIN * 0.25 * variation
}

/// Points ξ of a quadrature, with their weights times f. They lie more closely towards zero.
fn waves(f: impl Fn(f64) -> f64, length: f64) -> Vec<(f64, f64)> {
    let rule = gauss_legendre::<16>();
    let ends = std::iter::successors(Some(1e-3 / length), |end| Some(1.4 * end)).take_while(|&end| end < 40.0);
    let mut start = 0.0;
    let mut waves = Vec::new();
    for end in ends.chain([40.0]) {
        let (middle, half) = (0.5 * (start + end), 0.5 * (end - start));
        waves.extend(rule.map(|(x, weight)| {
            let xi = middle + half * x;
            (xi, 2.0 * half * weight * f(xi))
        }));
        start = end;
    }
    waves
}

/// The Bessel functions J0 and J1 for x ≥ 0, to about 1e-8.
fn bessel(x: f64) -> [f64; 2] {
    if x < 10.0 {
        let quarter = -0.25 * x * x;
        let sum = |m: f64| {
            let terms = (1..40).rev().map(f64::from);
            terms.fold(1.0, |sum, n| 1.0 + sum * quarter / (n * (n + m)))
        };
        return [sum(0.0), 0.5 * x * sum(1.0)];
    }
    // Hankel's asymptotic series.
    let amplitude = (2.0 / (PI * x)).sqrt();
    [0.0, 1.0].map(|m: f64| {
        let (mut term, mut parts) = (1.0, [0.0; 2]);
        for n in 0..10_u32 {
            let sign = if n % 4 < 2 { 1.0 } else { -1.0 };
            parts[n as usize % 2] += sign * term;
            let n = f64::from(n);
            term *= (4.0 * m * m - (2.0 * n + 1.0).powi(2)) / ((n + 1.0) * 8.0 * x);
        }
        let phase = x - FRAC_PI_4 * (2.0 * m + 1.0);
        amplitude * (parts[0] * phase.cos() - parts[1] * phase.sin())
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    /// J_m(x) is the mean of cos(x sin θ - m θ), which 256 angles give to rounding.
    #[test]
    fn the_functions_of_bessel_are_their_integrals() {
        for x in [0.0, 0.3, 2.0, 9.9, 10.1, 25.0, 100.0] {
            let found = bessel(x);
            for (m, value) in [0.0, 1.0].into_iter().zip(found) {
                let angles = (0..256).map(|i| f64::from(i) * PI / 128.0);
                let expected = angles.map(|angle| (x * angle.sin() - m * angle).cos()).sum::<f64>() / 256.0;
                assert!((value - expected).abs() < 1e-7, "J{m}({x}) = {value}, not {expected}");
            }
        }
    }

    /// f = exp(-a ξ) has k = (a² + r²)^(-1/2). It and r k' - k = -(a² + 2 r²)/(a² + r²)^(3/2) are known.
    ///
    /// The second has one extreme, where r² = a²/2, as its derivative is r k''.
    #[test]
    fn the_bound_is_that_of_a_known_transform() {
        for (decay, length) in [(1.0_f64, 1.0), (2.0, 1.0), (5.0, 5.0), (100.0, 100.0)] {
            let found = curvature(|xi| (-decay * xi).exp(), length);
            let extreme = 2.0 / 1.5_f64.powf(1.5);
            let expected = 0.25 * (1.0 + (extreme - 1.0) + extreme) / decay;
            let ratio = found / expected;
            assert!((1.0..1.03).contains(&ratio), "{decay}: {found}, not {expected}");
        }
    }
}
