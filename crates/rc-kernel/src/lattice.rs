//! The lattice function φ by Ewald's sum.
//!
//! φ is the potential of unit charges on all images, with a uniform neutralising background. A point load on the unit
//! cell and all its images, with the uniform counter-load of Eq. 3, displaces the surface by φ(r)/(π E*). Here
//! `φ(r) = Σ_{q≠0} (2π/|q|) exp(iq·r)`, which has zero mean. φ is the slow reference: the fast coefficients are fitted
//! to it and tested against it.

use std::f64::consts::{FRAC_1_PI, PI, TAU};

use rc_core::DVec2;

use crate::gauss_legendre::gauss_legendre;
use crate::love_displacement;

/// Number of images and of waves per direction. Both sums end below 1e-17 of φ.
const SHELLS: i32 = 3;

/// φ(0) - 1/r, the lattice sum of 1/R minus its background.
///
/// The value is `-C = 4 ζ(1/2) β(1/2)` with Dirichlet's β. It comes from Ewald's sum with two splitting parameters, to
/// 27 digits.
pub const LATTICE_CONSTANT: f64 = -3.900_264_920_001_956;

/// φ at `offset` from a source, in units of 1/λ. φ/(π E*) is the 𝓛 of Eq. (3).
///
/// φ is +∞ on the source and its images.
///
/// ```text
/// φ(r) = Σ_R erfc(√π |r - R|)/|r - R| + Σ_{n≠0} erfc(√π |n|)/|n| cos(2π n·r) - 2
/// ```
///
/// Source: Ewald, *Ann. Phys.* 369 (1921) 253, for charges in a plane with 1/r between them. Near a source
/// `φ = 1/r - C + (S3/4) r² + …`.
///
/// *Accuracy*: 1e-14, absolute, and relative near a source (test `lattice_function_has_its_known_values`).
#[must_use]
pub fn ewald_phi(offset: DVec2) -> f64 {
    let nearest = wrapped(offset);
    let r = nearest.x.hypot(nearest.y);
    libm::erfc(PI.sqrt() * r) / r + images_and_waves(nearest)
}

/// φ - 1/r at `offset`, |x|, |y| ≤ 0.6.
///
/// This function is smooth. It is the sum of the background and of all images except the nearest.
pub(crate) fn ewald_remainder(offset: DVec2) -> f64 {
    let r = offset.x.hypot(offset.y);
    let own = if r == 0.0 { 2.0 } else { libm::erf(PI.sqrt() * r) / r };
    images_and_waves(offset) - own
}

/// The offset to the nearest image, in [-1/2, 1/2]². It is exact, and odd in both coordinates.
#[inline]
pub(crate) fn wrapped(offset: DVec2) -> DVec2 {
    DVec2::new(wrap(offset.x), wrap(offset.y))
}

/// One coordinate of [`wrapped`].
#[inline]
pub(crate) fn wrap(x: f64) -> f64 {
    // Adding 3 · 2^51 removes all digits after the point. This is faster than `round`, for which older processors have
    // no instruction.
    const SHIFT: f64 = 6_755_399_441_055_744.0;
    let nearest = if x.abs() < 1e15 { (x + SHIFT) - SHIFT } else { x.round() };
    x - nearest
}

/// Ewald's sum without the charge at the origin.
fn images_and_waves(DVec2 { x, y }: DVec2) -> f64 {
    let root_pi = PI.sqrt();
    let (mut images, mut waves) = (0.0, 0.0);
    for k in -SHELLS..=SHELLS {
        for h in -SHELLS..=SHELLS {
            let (h, k) = (f64::from(h), f64::from(k));
            if (h, k) != (0.0, 0.0) {
                let r = (x - h).hypot(y - k);
                images += libm::erfc(root_pi * r) / r;
            }
            // The waves (±h, ±k) together. Each component that is not zero doubles their number.
            if h >= 0.0 && k >= 0.0 && h + k > 0.0 {
                let n = h.hypot(k);
                let count = if h > 0.0 { 2.0 } else { 1.0 } * if k > 0.0 { 2.0 } else { 1.0 };
                waves += count * libm::erfc(root_pi * n) / n * (TAU * h * x).cos() * (TAU * k * y).cos();
            }
        }
    }
    images + waves - 2.0
}

/// `L_ij` by quadrature of Ewald's sum, in one millisecond.
///
/// It is the slow reference for [`PeriodicLove`](crate::PeriodicLove), with the same arguments. The contribution of the
/// nearest image is [`love_displacement`]. The other images and the background are averaged over the source by 24 × 24
/// Gauss-Legendre points. Squares above λ/4 are divided into quarters first. `half_side` must be in (0, 1/2]. Otherwise
/// the result is NaN.
///
/// *Accuracy*: 2e-14 of the larger of |L| and (2d)², by comparison with a 17-digit table (test
/// `coefficients_match_the_seventeen_digit_table`).
#[must_use]
pub fn ewald_coefficient(offset: DVec2, half_side: f64) -> f64 {
    if !(half_side > 0.0 && half_side <= 0.5) {
        return f64::NAN;
    }
    let nearest = wrapped(offset);
    if half_side > 0.125 {
        let half = 0.5 * half_side;
        let quarters = [(-half, -half), (half, half), (-half, half), (half, -half)];
        return quarters.iter().map(|&centre| ewald_coefficient(nearest + DVec2::from(centre), half)).sum();
    }
    let rule = gauss_legendre::<24>();
    let mut mean = 0.0;
    for (u, weight_u) in rule {
        for (v, weight_v) in rule {
            mean += weight_u * weight_v * ewald_remainder(nearest + half_side * DVec2::new(u, v));
        }
    }
    love_displacement(nearest, half_side) + 4.0 * half_side * half_side * FRAC_1_PI * mean
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lattice_function_has_its_known_values() {
        // Sums of Madelung's type to 16 digits (mpmath).
        let known =
            [(0.5, 0.5, -1.6155426267128243), (0.5, 0.0, -1.1423611466445647), (0.25, 0.1, -0.01824371850081752)];
        for (x, y, reference) in known {
            for (x, y) in [(x, y), (y, -x), (x + 1.0, y - 3.0)] {
                let value = ewald_phi(DVec2::new(x, y));
                let error = (value - reference).abs();
                assert!(error <= 1e-14, "at ({x}, {y}): {value}, reference {reference}, off by {error:.1e}");
            }
        }
        assert!((ewald_remainder(DVec2::ZERO) - LATTICE_CONSTANT).abs() <= 1e-14);
        assert!(ewald_phi(DVec2::new(2.0, -1.0)) == f64::INFINITY);
    }

    #[test]
    fn lattice_function_has_its_known_curvature_and_quartic_terms_at_the_source() {
        // φ - 1/r + C = (S3/4) r² + (9/64) S5 r⁴ + (35/64) C4 r⁴ cos 4θ + O(r⁶).
        const S3: f64 = 9.03362168310095;
        const S5: f64 = 5.090258233665483;
        const C4: f64 = 3.37386569;
        for (x, y) in [(0.02_f64, 0.0_f64), (0.014, 0.014), (0.01, 0.017)] {
            let (r2, cos_4) = (x * x + y * y, 1.0 - 8.0 * (x * y / (x * x + y * y)).powi(2));
            let expected = 0.25 * S3 * r2 + (9.0 * S5 + 35.0 * C4 * cos_4) / 64.0 * r2 * r2;
            let value = ewald_remainder(DVec2::new(x, y)) - LATTICE_CONSTANT;
            assert!((value - expected).abs() <= 20.0 * r2.powi(3), "at ({x}, {y}): {value:e}, expected {expected:e}");
        }
    }
}
