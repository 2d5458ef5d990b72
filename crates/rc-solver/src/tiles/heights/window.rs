//! The window that interpolates heights, of Kaiser and Bessel, and its derivatives.
//!
//! A wave of frequency ξ (waves per grid cell) with samples `exp(2πi ξ j)` is the sum over cells j of `φ(x - j) c_j`.
//! The coefficients are `c_j = exp(2πi ξ j) / φ̂(ξ)`. Aliases have the relative size `φ̂(ξ + m) / φ̂(ξ)`, m ≠ 0.
//!
//! A Fourier transform divides by φ̂ once. All of the window's width is then left to suppress the aliases. An
//! interpolation of the samples themselves needs twice as many taps: 24 instead of 12 at four samples per wave.
//!
//! This is the interpolation step of a non-uniform Fourier transform (Jackson, Meyer, Nishimura, Macovski, IEEE Trans.
//! Med. Imaging 10 (1991) 473-478; Barnett, Magland, af Klinteberg, SIAM J. Sci. Comput. 41 (2019) C479-C504).

use std::f64::consts::PI;

use rc_kernel::bessel_series;

/// Number of coefficients that one interpolated value uses along a direction.
pub(super) const TAPS: usize = 12;

/// Maximum frequency that is interpolated, in waves per cell: four samples in a wave.
pub(super) const HIGHEST_FREQUENCY: f64 = 0.25;

/// Shape parameter β. The main lobe of φ̂ ends about where the first alias begins.
///
/// The first alias begins at 1 - [`HIGHEST_FREQUENCY`]. β is one per cent below the value for this. The largest error
/// is then a third, since φ̂ is not yet small where its main lobe ends.
const SHAPE: f64 = 0.99 * PI * TAPS as f64 * (1.0 - HIGHEST_FREQUENCY);

/// Errors of the interpolated wave of amplitude 1 and of its first and second derivative.
///
/// Derivatives are per cell. The errors are those in one direction, at any place and any frequency up to
/// [`HIGHEST_FREQUENCY`]. Test `errors_of_waves_are_as_stated`.
pub(super) const ERRORS: [f64; 3] = [1e-10, 2e-9, 1e-7];

/// The window φ at `x` cells from its centre, or its first or second derivative.
///
/// It is zero from TAPS/2 on. `φ = I0(β √(1 - u²)) / c`, with `u = 2 x / TAPS` and c such that its integral is 1. In
/// `q = β² (1 - u²) / 4` it is `F_0(q) / c`, with the series F_m of [`bessel_series`], where `F_m' = F_(m+1)`.
pub(super) fn window(x: f64, derivative: Derivative) -> f64 {
    let width = TAPS as f64;
    let u = 2.0 * x / width;
    if u.abs() >= 1.0 {
        return 0.0;
    }
    let q = 0.25 * SHAPE * SHAPE * (1.0 - u * u);
    // The slope dq/dx. The second derivative is constant.
    let (slope, curvature) = (-SHAPE * SHAPE * u / width, -2.0 * SHAPE * SHAPE / (width * width));
    let value = match derivative {
        Derivative::None => bessel_series(q, 0),
        Derivative::First => bessel_series(q, 1) * slope,
        Derivative::Second => bessel_series(q, 2) * slope * slope + bessel_series(q, 1) * curvature,
    };
    value * SHAPE / (width * SHAPE.sinh())
}

/// The derivative of the heights that a set of taps gives.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Derivative {
    None,
    First,
    Second,
}

impl Derivative {
    /// All derivatives, by order.
    pub(super) const ALL: [Self; 3] = [Self::None, Self::First, Self::Second];
}

/// The Fourier transform φ̂(ξ) of the window, for |ξ| up to [`HIGHEST_FREQUENCY`].
///
/// It is between 0.1 and 1.
pub(super) fn transform(frequency: f64) -> f64 {
    let z = (SHAPE * SHAPE - (PI * TAPS as f64 * frequency).powi(2)).sqrt();
    (z.sinh() / z) * (SHAPE / SHAPE.sinh())
}

#[cfg(test)]
mod tests {
    use std::f64::consts::TAU;

    use rc_fft::Complex64;

    use super::*;

    /// Largest error of a derivative of the unit wave.
    ///
    /// It is over frequencies and places in a cell.
    fn worst_error(derivative: Derivative, order: i32) -> f64 {
        let mut worst = 0.0_f64;
        for i in 0..=200 {
            let frequency = HIGHEST_FREQUENCY * f64::from(i) / 200.0;
            let exact = Complex64::new(0.0, TAU * frequency).powi(order);
            for j in 0..=128 {
                let x = f64::from(j) / 128.0;
                let taps = (0..TAPS).map(|tap| tap as f64 - (TAPS / 2 - 1) as f64);
                let sum: Complex64 =
                    taps.map(|c| window(x - c, derivative) * Complex64::cis(TAU * frequency * (c - x))).sum();
                worst = worst.max((sum / transform(frequency) - exact).norm());
            }
        }
        worst
    }

    #[test]
    fn errors_of_waves_are_as_stated() {
        for (order, derivative) in Derivative::ALL.into_iter().enumerate() {
            let (worst, stated) = (worst_error(derivative, order as i32), ERRORS[order]);
            // There is room for errors between the places and frequencies tried. A stated error that is far too large
            // would hide a loss.
            let allowed = 0.1 * stated..0.8 * stated;
            assert!(allowed.contains(&worst), "{derivative:?}: {worst:e}, stated {stated:e}");
        }
    }
}
