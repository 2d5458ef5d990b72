//! The function χ(x) = 1 - Ψ(x), where Ψ is the integral of a Kaiser-Bessel window, and its transform.
//!
//! ```text
//! Ψ(x) = ∫₀^x I₀(β√(1-t²)) dt / ∫₀¹ I₀(β√(1-t²)) dt        (∫₀¹ = sinh β / β),     Ψ = 1 from x = 1 on
//! ```

use crate::bessel::bessel_series;
use crate::chebyshev::Series;
use crate::gauss_legendre::gauss_legendre;

/// Number of terms of the expansions before negligible ones are dropped.
///
/// The expansions reach rounding accuracy up to β = 24 and cutoffs of 24 elements.
const TERMS: usize = 64;

/// The function χ, tabulated.
#[derive(Clone, Debug)]
pub(crate) struct Window {
    /// Ψ(x)/x in Chebyshev polynomials of x², of which it is an entire function.
    rise: Series,
    /// `2 ∫₀¹ χ(x) J₀(q x) dx` in Chebyshev polynomials of q², q ≤ `reach`.
    transform: Series,
    /// q·c at the corner of the Brillouin zone of the coarser level, with a small margin.
    reach: f64,
}

impl Window {
    pub(super) fn new(shape: f64, cutoff: usize) -> Self {
        let reach = 2.25 * cutoff as f64;
        let rule = gauss_legendre::<TERMS>();
        let total = if shape == 0.0 { 1.0 } else { shape.sinh() / shape };
        // Ψ(x)/x = ∫₀¹ I₀(β√(1 - x² s²)) ds / total.
        let rise = Series::new(TERMS, |square| {
            let integral: f64 = rule
                .iter()
                .map(|(s, w)| w * bessel_i0(shape * (1.0 - square * (0.5 + 0.5 * s).powi(2)).max(0.0).sqrt()))
                .sum();
            integral / total
        });
        let values: Vec<(f64, f64)> = rule
            .iter()
            .map(|(s, w)| {
                let x = 0.5 + 0.5 * s;
                (x, 2.0 * w * (1.0 - x * rise.at(x * x)))
            })
            .collect();
        let transform = Series::new(TERMS, |square| {
            let q = reach * square.sqrt();
            values.iter().map(|(x, weight)| weight * libm::j0(q * x)).sum()
        });
        Self { rise, transform, reach }
    }

    /// The function Ψ(x)/x.
    pub(super) fn rise_over(&self, x: f64) -> f64 {
        if x < 1.0 { self.rise.at(x * x) } else { 1.0 / x }
    }

    /// ∫∫ |∂²f/∂x²| of f = Ψ(r)/r over the plane.
    pub(super) fn curvature(&self) -> f64 {
        let rule = gauss_legendre::<TERMS>();
        let angles = 64;
        let cosines: Vec<f64> = (0..angles)
            .map(|i| (std::f64::consts::TAU * (f64::from(i) + 0.5) / f64::from(angles)).cos().powi(2))
            .collect();
        // Mean over the angle of |f'' cos² + f'/r sin²|.
        let mean = |second: f64, first: f64| {
            cosines.iter().map(|c| (second * c + first * (1.0 - c)).abs()).sum::<f64>() / f64::from(angles)
        };
        let f = |r: f64| self.rise.at(r * r);
        let step = 1e-3;
        let inside: f64 = rule
            .iter()
            .map(|(s, w)| {
                let r = 0.5 + 0.5 * s;
                let second = (f(r + step) - 2.0 * f(r) + f(r - step)) / (step * step);
                let first = (f(r + step) - f(r - step)) / (2.0 * step);
                w * mean(second, first / r) * r
            })
            .sum();
        // The slope jumps where the window ends. Beyond, f = 1/r.
        let jump = 0.5 * ((f(1.0) - f(1.0 - step)) / step + 1.0).abs();
        std::f64::consts::TAU * (inside + jump + mean(2.0, -1.0))
    }

    /// Transform of `χ(r)/(π r)` at the wavenumber `q`, `2 ∫₀¹ χ(r) J₀(q r) dr`.
    ///
    /// Beyond the tabulated range its asymptote 2/q is used.
    pub(super) fn short_range(&self, q: f64) -> f64 {
        if q < self.reach { self.transform.at((q / self.reach).powi(2)) } else { 2.0 / q }
    }
}

/// Modified Bessel function I₀.
fn bessel_i0(x: f64) -> f64 {
    bessel_series(0.25 * x * x, 0)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_window_falls_from_one_to_zero() {
        for shape in [0.0, 3.0, 8.0, 20.0] {
            let window = Window::new(shape, 6);
            let chi = |x: f64| 1.0 - x * window.rise_over(x);
            assert!((chi(0.0) - 1.0).abs() < 1e-14 && chi(1.0 - 1e-12).abs() < 1e-10 && chi(2.0).abs() < 1e-14);
            let falls = (0..100).all(|i| chi(f64::from(i) / 100.0) >= chi(f64::from(i + 1) / 100.0) - 1e-14);
            assert!(falls, "shape {shape}");
        }
    }

    #[test]
    fn the_transform_agrees_with_a_fine_rule() {
        for shape in [3.0, 8.0, 18.0] {
            let window = Window::new(shape, 24);
            let rule = gauss_legendre::<400>();
            for q in [0.0, 0.1, 2.0, 9.0, 25.0, 50.0] {
                let fine: f64 = rule
                    .iter()
                    .map(|(s, w)| {
                        let x = 0.5 + 0.5 * s;
                        2.0 * w * (1.0 - x * window.rise_over(x)) * libm::j0(q * x)
                    })
                    .sum();
                let value = window.short_range(q);
                assert!((value - fine).abs() < 2e-13, "shape {shape}, q {q}: {value} for {fine}");
            }
        }
    }
}
