//! Rolling or sliding contact of a cylinder with a viscoelastic half-plane, exact.

use std::f64::consts::{FRAC_PI_4, PI};

use crate::root::increasing_root;
use crate::{OutOfRange, within};

/// A rigid cylinder that moves over a half-plane of one relaxation time, without friction at the surface.
///
/// Moduli are relative to the relaxed E* = 1. Loads are per length. The contact is x in (c - a, c + a), with x along
/// the velocity from below the axis of the cylinder.
///
/// Source: S. C. Hunter, *The rolling contact of a rigid cylinder with a viscoelastic half space*, J. Appl. Mech. 28
/// (1961) 611-617. In this form: with z = κ a/ℓ, r = K1(a/ℓ)/K0(a/ℓ) and the retardation length ℓ,
///
/// ```text
/// c = ℓ (1 - 1/κ) I1(z)/(I1(z) + r I0(z)),     W = π/(4R) (a² + 2 c a r),
/// μ R = c - ℓ/κ - π a² (c - ℓ)/(4 R W).
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Hunter {
    /// Radius R of the cylinder, > 0.
    pub radius: f64,
    /// Ratio κ of the glassy to the relaxed modulus, > 1.
    pub glassy_ratio: f64,
    /// Retardation length ℓ = v ρ, > 0, with the retardation time ρ = κ τ of the relaxation time τ.
    pub length: f64,
}

/// A contact of [`Hunter`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SlidingCylinder {
    /// Half width a.
    pub half_width: f64,
    /// Shift c of the middle of the contact along the velocity.
    pub shift: f64,
    /// Load W per length.
    pub load: f64,
    /// Friction coefficient μ.
    pub friction: f64,
}

impl Hunter {
    /// The contact of this half width.
    ///
    /// # Errors
    /// Unless the half width is between 0 and 1e4 retardation lengths.
    pub fn at_half_width(self, half_width: f64) -> Result<SlidingCylinder, OutOfRange> {
        let Self { radius, glassy_ratio, length } = self;
        let a = within("half width", half_width, 1e4 * length)?;
        let z = glassy_ratio * a / length;
        let [k0, k1] = [0.0, 1.0].map(|order| decaying(a / length, order));
        let [i0, i1] = [0.0, 1.0].map(|order| growing(z, order));
        let ratio = k1 / k0;
        let shift = length * (1.0 - 1.0 / glassy_ratio) * i1 / (i1 + ratio * i0);
        let load = FRAC_PI_4 / radius * (a * a + 2.0 * shift * a * ratio);
        let friction =
            (shift - length / glassy_ratio - FRAC_PI_4 * a * a * (shift - length) / (radius * load)) / radius;
        Ok(SlidingCylinder { half_width: a, shift, load, friction })
    }

    /// The contact under this load per length.
    ///
    /// # Errors
    /// As [`Hunter::at_half_width`], for the half width at rest.
    pub fn at_load(self, load: f64) -> Result<SlidingCylinder, OutOfRange> {
        let at_rest = within("half width", (4.0 * self.radius * load / PI).sqrt(), 1e4 * self.length)?;
        let missing = |a: f64| {
            let found = self.at_half_width(a).map_or(f64::NAN, |contact| contact.load);
            // Bisection alone: the load grows with the width.
            (found - load, f64::NAN)
        };
        let least = at_rest / self.glassy_ratio.sqrt();
        self.at_half_width(increasing_root((0.5 * least, at_rest), at_rest, missing))
    }
}

/// e^z K_n(z), from ∫ exp(-z (cosh t - 1)) cosh(n t) dt, t > 0.
fn decaying(z: f64, order: f64) -> f64 {
    // Beyond this t the integrand is below 1e-20 of its maximum, and the sum over equal steps converges exponentially.
    let last = (1.0 + 60.0 / z).acosh() + 1.0;
    let steps = 400;
    let step = last / f64::from(steps);
    let value = |i: i32| {
        let t = f64::from(i) * step;
        (-z * (t.cosh() - 1.0)).exp() * (order * t).cosh()
    };
    step * (0.5 * value(0) + (1..=steps).map(value).sum::<f64>())
}

/// e^-z I_n(z), from 1/π ∫ exp(z (cos θ - 1)) cos(n θ) dθ.
fn growing(z: f64, order: f64) -> f64 {
    let steps = 60 + (8.0 * z.sqrt()) as i32;
    let value = |i: i32| {
        let angle = PI * f64::from(i) / f64::from(steps);
        (z * (angle.cos() - 1.0)).exp() * (order * angle).cos()
    };
    (0.5 * (value(0) + value(steps)) + (1..steps).map(value).sum::<f64>()) / f64::from(steps)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// K0(1), K1(1), I0(1), I1(1), K0(0.1), K1(10) and I0(20) from tables (Abramowitz and Stegun, chapter 9).
    #[test]
    fn bessel_functions_are_those_of_tables() {
        let e = 1.0_f64.exp();
        let values = [
            (decaying(1.0, 0.0) / e, 0.421_024_438_240_708_3),
            (decaying(1.0, 1.0) / e, 0.601_907_230_197_234_6),
            (growing(1.0, 0.0) * e, 1.266_065_877_752_008_4),
            (growing(1.0, 1.0) * e, 0.565_159_103_992_485),
            (decaying(0.1, 0.0) * (-0.1_f64).exp(), 2.427_069_024_702_017),
            (decaying(10.0, 1.0) * (-10.0_f64).exp(), 1.864_877_345_382_558_5e-5),
            (growing(20.0, 0.0), 4.355_828_255_955_353_5e7 * (-20.0_f64).exp()),
        ];
        for (found, expected) in values {
            assert!((found / expected - 1.0).abs() < 1e-13, "{found:e} for {expected:e}");
        }
    }

    /// Widths, shifts and friction at both ends of the speed and between, for a width at rest of 1 and R = 1.
    #[test]
    fn contacts_are_those_of_a_dense_solution() {
        let load = FRAC_PI_4;
        let table = [
            (10.0, 0.01, 0.995_500, 0.004_488, 0.008_951),
            (10.0, 0.1, 0.955_060, 0.043_760, 0.085_059),
            (10.0, 1.0, 0.600_919, 0.317_426, 0.463_906),
            (10.0, 100.0, 0.316_287, 0.026_425, 0.027_550),
        ];
        for (glassy_ratio, length, half_width, shift, friction) in table {
            let found = Hunter { radius: 1.0, glassy_ratio, length }.at_load(load).expect("a contact");
            assert!((found.half_width - half_width).abs() < 1e-6, "{length}: {found:?}");
            assert!((found.shift - shift).abs() < 1e-6, "{length}: {found:?}");
            assert!((found.friction - friction).abs() < 1e-6, "{length}: {found:?}");
            assert!((found.load / load - 1.0).abs() < 1e-12);
        }
        // Far above the relaxation, the contact is that of Hertz with the glassy modulus.
        let fast = Hunter { radius: 1.0, glassy_ratio: 10.0, length: 1e5 }.at_load(load).expect("a contact");
        assert!((fast.half_width / 0.1_f64.sqrt() - 1.0).abs() < 1e-4 && fast.friction < 1e-4);
    }
}
