//! A rigid sphere on a thin layer that is bonded to a rigid base.
//!
//! Thin means relative to the contact.

use std::f64::consts::PI;

/// A sphere of radius R on a layer of thickness d ≪ a.
///
/// The sphere is the paraboloid -r²/2R. The contact radius is a, and the approach is δ. A compressible layer is a bed
/// of springs, p = (δ - r²/2R) / c with c = d (1-2ν)/(1-ν)² for a pressure of E*. An incompressible layer (ν = 1/2)
/// flows to the sides instead. Then δ - r²/2R = -(4d³/3) ∇²p, with p and its slope zero at the edge. Both formulas are
/// of first order in d/a.
///
/// Source: K. L. Johnson, *Contact Mechanics*, Cambridge University Press 1985, section 5.8.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ThinLayer {
    /// Radius R > 0, in λ.
    pub radius: f64,
    /// Thickness d > 0, in λ.
    pub thickness: f64,
    /// Poisson's ratio ν of the layer, above -1 and at most 1/2.
    pub poisson: f64,
}

impl ThinLayer {
    /// Displacement c under a uniform pressure of E*, in λ. It is 0 for an incompressible layer.
    #[must_use]
    pub fn spring(self) -> f64 {
        self.thickness * (1.0 - 2.0 * self.poisson) / (1.0 - self.poisson).powi(2)
    }

    fn is_incompressible(self) -> bool {
        self.poisson >= 0.5
    }

    /// Approach δ = a²/2R, in λ.
    ///
    /// It is a²/4R for an incompressible layer, which bulges beside the contact.
    #[must_use]
    pub fn penetration(self, contact_radius: f64) -> f64 {
        let divisor = if self.is_incompressible() { 4.0 } else { 2.0 };
        contact_radius * contact_radius / (divisor * self.radius)
    }

    /// Load F = π a⁴ / (4Rc), in E* λ². It is π a⁶ / (128 R d³) for an incompressible layer.
    #[must_use]
    pub fn load(self, contact_radius: f64) -> f64 {
        let a = contact_radius;
        if self.is_incompressible() {
            PI * a.powi(6) / (128.0 * self.radius * self.thickness.powi(3))
        } else {
            PI * a.powi(4) / (4.0 * self.radius * self.spring())
        }
    }

    /// Pressure p(r) for r < a, in E*. It is 0 outside.
    ///
    /// The formula is (a² - r²)/(2Rc), or 3 (a² - r²)² / (128 R d³) for an incompressible layer.
    #[must_use]
    pub fn pressure(self, r: f64, contact_radius: f64) -> f64 {
        let inside = (contact_radius * contact_radius - r * r).max(0.0);
        if self.is_incompressible() {
            3.0 * inside * inside / (128.0 * self.radius * self.thickness.powi(3))
        } else {
            inside / (2.0 * self.radius * self.spring())
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::testing::{assert_close, integral};

    #[test]
    fn the_pressure_adds_up_to_the_load() {
        for poisson in [0.0, 0.3, 0.5] {
            let layer = ThinLayer { radius: 2.0, thickness: 0.01, poisson };
            let a = 0.2;
            let sum = integral(0.0, a, |r| 2.0 * PI * r * layer.pressure(r, a));
            assert_close("load", layer.load(a), sum, 1e-12);
        }
    }

    /// Tests -(4d³/3) ∇²p = δ - r²/2R with differences of the pressure.
    #[test]
    fn the_incompressible_pressure_solves_its_equation() {
        let layer = ThinLayer { radius: 2.0, thickness: 0.01, poisson: 0.5 };
        let (a, step) = (0.2, 1e-4);
        for r in [0.05, 0.1, 0.15] {
            let [before, here, after] = [r - step, r, r + step].map(|r| layer.pressure(r, a));
            let laplacian = (after - 2.0 * here + before) / (step * step) + (after - before) / (2.0 * step * r);
            let expected = layer.penetration(a) - r * r / (2.0 * layer.radius);
            let found = -4.0 / 3.0 * layer.thickness.powi(3) * laplacian;
            assert!((found - expected).abs() < 1e-5 * layer.penetration(a), "at {r}: {found} for {expected}");
        }
    }
}
