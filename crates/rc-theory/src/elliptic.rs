//! Contact of an ellipsoidal peak on the half-space, Hertz's contact with two radii.

use std::f64::consts::PI;

/// An elliptic contact on an infinite half-space, given by semi-axes and maximum pressure.
///
/// Shape and load follow from these. Source: K. L. Johnson, *Contact Mechanics*, Cambridge University Press 1985,
/// section 4.2 (Eq. 4.24 to 4.26).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct EllipticContact {
    /// Major semi-axis a, along x, in λ.
    pub major: f64,
    /// Minor semi-axis b, along y, in λ. 0 < b < a.
    pub minor: f64,
    /// Maximum pressure p0, in E*.
    pub peak_pressure: f64,
}

impl EllipticContact {
    /// The curvatures A and B of the heights -(A x² + B y²), in 1/λ.
    ///
    /// With e² = 1 - b²/a², A = p0 b/(e² a²) [K(e) - E(e)] and B = p0 b/(e² a²) [(a²/b²) E(e) - K(e)].
    #[must_use]
    pub fn curvatures(self) -> [f64; 2] {
        let Self { major: a, minor: b, peak_pressure } = self;
        let squared = 1.0 - (b / a).powi(2);
        let (first, second) = complete_elliptic(squared);
        let factor = peak_pressure * b / (squared * a * a);
        [factor * (first - second), factor * ((a / b).powi(2) * second - first)]
    }

    /// Load F = (2/3) p0 π a b, in E* λ².
    #[must_use]
    pub fn load(self) -> f64 {
        2.0 / 3.0 * self.peak_pressure * self.area()
    }

    /// Contact area π a b, in λ².
    #[must_use]
    pub fn area(self) -> f64 {
        PI * self.major * self.minor
    }
}

/// The complete elliptic integrals K and E of the modulus whose square is `m` in [0, 1).
///
/// They are computed by the arithmetic-geometric mean (Abramowitz & Stegun 17.6).
fn complete_elliptic(m: f64) -> (f64, f64) {
    let (mut a, mut b, mut c) = (1.0, (1.0 - m).sqrt(), m.sqrt());
    let (mut sum, mut power) = (0.5 * c * c, 1.0);
    while c.abs() > 1e-16 {
        (a, b, c) = (0.5 * (a + b), (a * b).sqrt(), 0.5 * (a - b));
        sum += 0.5 * power * 2.0 * c * c;
        power *= 2.0;
    }
    let first = PI / (2.0 * a);
    (first, first * (1.0 - sum))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::hertz::Hertz;

    #[test]
    fn elliptic_integrals_are_those_of_the_tables() {
        // Abramowitz & Stegun, table 17.1, m = 0.5 and 0.9.
        for (m, k, e) in
            [(0.5, 1.854_074_677_301_37, 1.350_643_881_047_68), (0.9, 2.578_092_113_348_17, 1.104_774_732_704_07)]
        {
            let (first, second) = complete_elliptic(m);
            assert!((first - k).abs() < 1e-13 && (second - e).abs() < 1e-13, "{first} {second}");
        }
    }

    #[test]
    fn a_nearly_round_contact_is_hertz() {
        let hertz = Hertz { radius: 2.0 };
        let a = 0.1;
        let contact = EllipticContact { major: a, minor: 0.9999 * a, peak_pressure: hertz.peak_pressure(a) };
        for curvature in contact.curvatures() {
            assert!((curvature - 0.25).abs() < 1e-4, "{curvature}");
        }
        assert!((contact.load() / hertz.load(a) - 1.0).abs() < 2e-4);
    }
}
