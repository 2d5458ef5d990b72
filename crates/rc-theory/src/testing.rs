//! Helpers of the tests: a quadrature, and comparison with printed values.

use std::f64::consts::PI;

/// ∫ f from a to b by the tanh-sinh rule (Takahasi and Mori 1974).
///
/// It is accurate to rounding, even when f or its derivatives are singular at the ends.
pub(crate) fn integral(a: f64, b: f64, f: impl Fn(f64) -> f64) -> f64 {
    let steps_per_unit = 64;
    let mut sum = 0.0;
    for step in -(4 * steps_per_unit)..=4 * steps_per_unit {
        let t = f64::from(step) / f64::from(steps_per_unit);
        let (from_a, from_b) = (1.0 / (1.0 + (-PI * t.sinh()).exp()), 1.0 / (1.0 + (PI * t.sinh()).exp()));
        // Distances are taken from the nearer end, where the integrand may be singular.
        let x = if t < 0.0 { a + (b - a) * from_a } else { b - (b - a) * from_b };
        sum += f(x) * PI * t.cosh() * from_a * from_b;
    }
    sum * (b - a) / f64::from(steps_per_unit)
}

/// Fails unless the relative error of `value` against `reference` is within `tolerance`.
#[track_caller]
pub(crate) fn assert_close(what: &str, value: f64, reference: f64, tolerance: f64) {
    let error = ((value - reference) / reference).abs();
    assert!(
        error <= tolerance,
        "{what}: {value:e}, reference {reference:e}, relative error {error:.2e} > {tolerance:e}"
    );
}

/// Fails unless `value` rounds to the printed decimal `reference`, with all its digits.
#[track_caller]
pub(crate) fn assert_printed(what: &str, value: f64, reference: &str) {
    let decimals = reference.find('.').map_or(0, |point| reference.len() - point - 1);
    assert_eq!(format!("{value:.decimals$}"), reference, "{what}: {value}");
}

#[test]
fn the_quadrature_is_exact_to_rounding_with_singular_ends() {
    assert_close("∫ √(1-x²)", integral(-1.0, 1.0, |x| (1.0 - x * x).max(0.0).sqrt()), PI / 2.0, 1e-13);
    assert_close("∫ -ln x", integral(0.0, 1.0, |x| -x.ln()), 1.0, 1e-13);
}
