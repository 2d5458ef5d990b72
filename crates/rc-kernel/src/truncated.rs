//! Eq. 4-6 as the paper sums them, with a bound of the truncation error.
//!
//! The sums are over the images of K shells.

use std::f64::consts::{FRAC_1_PI, SQRT_2};

use rc_core::DVec2;

use crate::lattice::wrapped;
use crate::shells::MAX_SHELLS;
use crate::{KernelError, love_displacement};

/// Form of the uniform counter-load of the cell, l_m, as a sum of squares.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum LoadForm {
    /// Each image of the cell is one square of half-side λ/2, with the mean pressure (2d/λ)².
    Plain,
    /// Eq. 6 as printed, with squares of half-side λ around each image.
    ///
    /// Every point is covered four times, with a quarter of the mean pressure, (d/λ)². The limit is the same, and the
    /// error at the source is four times as large.
    Printed,
}

impl LoadForm {
    /// Half side of the squares, in units of λ.
    fn half_side(self) -> f64 {
        match self {
            Self::Plain => 0.5,
            Self::Printed => 1.0,
        }
    }

    /// Pressure of the squares, for unit pressure on a source of half side d.
    ///
    /// It is the ratio of the source's area to the area of a square.
    fn pressure(self, half_side: f64) -> f64 {
        (half_side / self.half_side()).powi(2)
    }

    /// Contribution of the image of the cell at `image` to l_m.
    ///
    /// The source has half side d. This is one term of the sum in Eq. (6).
    fn displacement(self, image: DVec2, half_side: f64) -> f64 {
        self.pressure(half_side) * love_displacement(image, self.half_side())
    }
}

/// `L_ij = l_ij - l_m` (Eq. 4-6) with the images |h|, |k| ≤ K = `shells`.
///
/// The source has half-side `half_side` d and is at `offset` = target minus source. Lengths are in λ, and the result is
/// in λ p/E*.
///
/// l_ij and l_m diverge separately. Here each image of the source is summed together with its part of the counter-load.
/// These (2K + 1)² differences decrease like R⁻², and like R⁻³ for opposite images together. They are summed from the
/// outermost shell inwards. As in Eq. 6, the counter-load is evaluated from the centre of the source. The offset is
/// wrapped into the cell first, so that images lie evenly around the target. Otherwise the error would be larger.
///
/// *Accuracy*: the truncation error relative to [`PeriodicLove`](crate::PeriodicLove) is within
/// [`truncation_error_bound`] (test `truncation_error_is_below_its_bound`). The rounding error is below 1e-16 (2d)² K.
///
/// # Errors
/// [`KernelError`] for an offset that is not finite, `half_side` not in (0, 1/2], or `shells` 0 or above
/// [`MAX_SHELLS`].
pub fn truncated_coefficient(offset: DVec2, half_side: f64, shells: usize, form: LoadForm) -> Result<f64, KernelError> {
    check_offset(offset)?;
    check_half_side(half_side)?;
    check_shells(shells)?;
    let nearest = wrapped(offset);
    let image = |h: i32, k: i32| {
        let image = DVec2::new(f64::from(h), f64::from(k));
        love_displacement(nearest + image, half_side) - form.displacement(image, half_side)
    };
    // Four images at a time, a quarter turn apart. The part that decreases like R⁻² cancels in each sum.
    let turned = |h: i32, k: i32| (image(h, k) + image(-h, -k)) + (image(-k, h) + image(k, -h));
    let shell = |n: i32| (1 - n..=n).map(|k| turned(n, k)).sum::<f64>();
    Ok((1..=shells as i32).rev().map(shell).sum::<f64>() + image(0, 0))
}

/// A bound of |[`truncated_coefficient`] - `L_ij`| over all offsets, in λ p/E*.
///
/// For a small source it is about (2d)² e/(π K), with e at most √2/3 for the plain form and 2√2/3 for the printed form.
/// It is infinite for `shells` = 0 or a half side outside (0, 1/2], because nothing is guaranteed then.
///
/// *Proof.* The omitted images are a tail Σ_R (t_R(source) - t_R(counter-load)). Each t_R is (2d)²/π times the mean of
/// `1/|R - a| = Σ_l |a|^l/R^(l+1) P_l(cos γ)` over a square of points a. Images a quarter turn apart are omitted
/// together:
///
/// - The term l = 0 cancels between source and counter-load. Odd l cancel between opposite images.
/// - The term l = 2 leaves ⟨|a|²⟩/(4R³). ⟨|a|²⟩ is r² + 2d²/3 for the source at offset r² ≤ 1/2, and 2c²/3 for the
///   counter-load of half-side c. So the difference is largest at one of the ends of 0 ≤ r² ≤ 1/2.
/// - For even l ≥ 4, the average of P_l over quarter turns is at most (1 + |P_l(0)|)/2 ≤ 11/16, because its Fourier
///   coefficients are positive. The series is at most geometric, 11/16 ⟨|a|⁴⟩/R⁵ · 1/(1 - A²/R²), with A the farthest
///   point and R ≥ K + 1.
///
/// A shell n of images is four trapezoidal sums of (n² + t²)^(-s/2) over -n ≤ t ≤ n. By Euler and Maclaurin these are
/// below their integrals (test `shells_are_below_their_integrals`): Σ R⁻³ ≤ 4√2/n², Σ R⁻⁵ ≤ (10√2/3)/n⁴. By convexity
/// `Σ_{n>K} n⁻² ≤ 1/(K + ½)` and `Σ_{n>K} n⁻⁴ ≤ 1/(3 (K + ½)³)`.
#[must_use]
pub fn truncation_error_bound(half_side: f64, shells: usize, form: LoadForm) -> f64 {
    if shells == 0 || check_half_side(half_side).is_err() {
        return f64::INFINITY;
    }
    let (d2, c2) = (half_side * half_side, form.half_side().powi(2));
    let (k_half, nearest2) = (shells as f64 + 0.5, (shells as f64 + 1.0).powi(2));
    let second = |r2: f64| 0.25 * (r2 + 2.0 / 3.0 * (d2 - c2)).abs();
    let fourth = |mean: f64, farthest2: f64| 11.0 / 16.0 * mean / (1.0 - farthest2 / nearest2);
    // The source is at the corner of the cell. These are ⟨a_x²⟩ and ⟨a_x⁴⟩ of one coordinate, ½ ± d.
    let (square, fourth_power) = (0.25 + d2 / 3.0, 1.0 / 16.0 + 0.5 * d2 + d2 * d2 / 5.0);
    let source = fourth(2.0 * (fourth_power + square * square), 2.0 * (0.5 + half_side).powi(2));
    let counter_load = fourth(28.0 / 45.0 * c2 * c2, 2.0 * c2);
    let cubes = 4.0 * SQRT_2 / k_half;
    let fifth_powers = 10.0 * SQRT_2 / 9.0 / k_half.powi(3);
    4.0 * d2 * FRAC_1_PI * (second(0.0).max(second(0.5)) * cubes + (source + counter_load) * fifth_powers)
}

/// The minimum number of shells with [`truncation_error_bound`] ≤ `tolerance`.
///
/// The tolerance is absolute, in λ p/E*.
///
/// # Errors
/// [`KernelError`] for `half_side` not in (0, 1/2], a `tolerance` that is not positive, or one that [`MAX_SHELLS`]
/// shells do not reach.
pub fn shells_for(half_side: f64, tolerance: f64, form: LoadForm) -> Result<usize, KernelError> {
    check_half_side(half_side)?;
    if !(tolerance > 0.0 && tolerance.is_finite()) {
        return Err(KernelError::Tolerance { tolerance });
    }
    let bound = |shells: usize| truncation_error_bound(half_side, shells, form);
    let reached = bound(MAX_SHELLS);
    if reached > tolerance {
        return Err(KernelError::Unreachable { tolerance, reached });
    }
    // The bound decreases with K, so bisection works: `low` shells are too few, `high` are enough.
    let (mut low, mut high) = (0, MAX_SHELLS);
    while high - low > 1 {
        let middle = usize::midpoint(low, high);
        if bound(middle) <= tolerance { high = middle } else { low = middle }
    }
    Ok(high)
}

pub(crate) fn check_offset(offset: DVec2) -> Result<(), KernelError> {
    if offset.is_finite() { Ok(()) } else { Err(KernelError::Offset { offset }) }
}

pub(crate) fn check_half_side(half_side: f64) -> Result<(), KernelError> {
    if half_side > 0.0 && half_side <= 0.5 { Ok(()) } else { Err(KernelError::HalfSide { half_side }) }
}

fn check_shells(shells: usize) -> Result<(), KernelError> {
    match shells {
        0 => Err(KernelError::NoShells),
        1..=MAX_SHELLS => Ok(()),
        _ => Err(KernelError::TooManyShells { shells }),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn shells_are_below_their_integrals() {
        for n in 1..=300_i32 {
            let radius = |k: i32| f64::from(n).hypot(f64::from(k));
            let sum = |power: i32| 4.0 * (1 - n..=n).map(|k| radius(k).powi(-power)).sum::<f64>();
            let n = f64::from(n);
            for (sum, integral) in [(sum(3), 4.0 * SQRT_2 / (n * n)), (sum(5), 10.0 * SQRT_2 / 3.0 / n.powi(4))] {
                assert!(sum <= integral, "shell {n}: {sum:e} above {integral:e}");
                assert!(sum >= 0.94 * integral / (1.0 + 1.0 / n), "shell {n}: {sum:e} far below {integral:e}");
            }
        }
    }
}
