//! Sneddon's contact of a rigid cone on an infinite half-space.

use std::f64::consts::{FRAC_PI_2, PI};

/// A cone -s·r of slope s, with contact radius a and approach δ.
///
/// Sources: I. N. Sneddon, *The relation between load and penetration in the axisymmetric Boussinesq problem for a
/// punch of arbitrary profile*, Int. J. Eng. Sci. 3 (1965) 47-57; K. L. Johnson, *Contact Mechanics*, Cambridge
/// University Press 1985, section 5.2.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Cone {
    /// Slope s > 0, the tangent of the angle between side and half-space.
    pub slope: f64,
}

impl Cone {
    /// Approach δ = (π/2) a s, in λ.
    #[must_use]
    pub fn penetration(self, contact_radius: f64) -> f64 {
        FRAC_PI_2 * contact_radius * self.slope
    }

    /// Contact radius a = 2δ/(πs), in λ. It is 0 for δ ≤ 0.
    #[must_use]
    pub fn contact_radius(self, penetration: f64) -> f64 {
        (penetration / (FRAC_PI_2 * self.slope)).max(0.0)
    }

    /// Load F = (π/2) a² s, in E* λ².
    #[must_use]
    pub fn load(self, contact_radius: f64) -> f64 {
        FRAC_PI_2 * contact_radius * contact_radius * self.slope
    }

    /// Mean pressure in the contact, s/2, in E*. It is the same at every load.
    #[must_use]
    pub fn mean_contact_pressure(self) -> f64 {
        0.5 * self.slope
    }

    /// Pressure p(r) = (s/2) arcosh(a/r) for r < a, in E*.
    ///
    /// It is infinite at the tip, and 0 outside the contact.
    #[must_use]
    pub fn pressure(self, r: f64, contact_radius: f64) -> f64 {
        let r = r.abs();
        if r < contact_radius { self.mean_contact_pressure() * (contact_radius / r).acosh() } else { 0.0 }
    }

    /// Displacement of the surface, in λ, zero far away.
    ///
    /// It is δ - s r in the contact, and s [a asin(a/r) + √(r² - a²) - r] outside.
    #[must_use]
    pub fn displacement(self, r: f64, contact_radius: f64) -> f64 {
        let (r, a) = (r.abs(), contact_radius);
        if r <= a {
            return self.penetration(a) - self.slope * r;
        }
        // asin(a/r) is an angle of the triangle. √(r² - a²) - r is written without cancellation.
        let leg = ((r - a) * (r + a)).sqrt();
        self.slope * (a * a.atan2(leg) - a * a / (leg + r))
    }

    /// Elastic energy 2δ³/(3πs), in E* λ³.
    #[must_use]
    pub fn energy(self, contact_radius: f64) -> f64 {
        2.0 * self.penetration(contact_radius).powi(3) / (3.0 * PI * self.slope)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::testing::{assert_close, integral};

    const CONE: Cone = Cone { slope: 0.3 };

    #[test]
    fn pressure_adds_up_to_the_load() {
        let load = integral(0.0, 0.2, |r| 2.0 * PI * r * CONE.pressure(r, 0.2));
        assert_close("∫ p", load, CONE.load(0.2), 1e-13);
        assert_close("mean pressure", CONE.load(0.2) / (PI * 0.04), CONE.mean_contact_pressure(), 1e-15);
        assert!(CONE.pressure(0.2, 0.2) == 0.0 && CONE.pressure(0.3, 0.2) == 0.0, "pressure outside the contact");
    }

    #[test]
    fn load_and_work_follow_the_penetration() {
        let delta = 0.05;
        let a = CONE.contact_radius(delta);
        assert_close("δ", CONE.penetration(a), delta, 1e-15);
        assert_close("F = 2δ²/(πs)", CONE.load(a), 2.0 * delta * delta / (PI * 0.3), 1e-15);
        let work = integral(0.0, delta, |penetration| CONE.load(CONE.contact_radius(penetration)));
        assert_close("∫ F dδ", work, CONE.energy(a), 1e-13);
    }

    #[test]
    fn displacement_follows_the_cone_and_then_the_point_load() {
        let a = 0.1;
        let edge = CONE.displacement(a, a);
        // At the edge the slope is continuous and its derivative is not. A step of 1e-10 changes u by 1e-10.
        assert_close("at the edge", CONE.displacement(a * (1.0 + 1e-10), a), edge, 1e-9);
        // The next term is (a/r)²/12 of this term.
        assert_close("far away", CONE.displacement(1e4 * a, a), CONE.load(a) / (PI * 1e4 * a), 1e-9);
    }
}
