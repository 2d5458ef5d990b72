//! Hertz's contact of a rigid sphere on the half-space, infinite or periodic.
//!
//! The paper's Fig. 4 shows this contact in a periodic cell. At a given Δ it is noticeably larger there than on an
//! infinite half-space, because of image contacts and the zero-mean convention. So compare a solution in a cell with
//! [`PeriodicHertz`].

use std::f64::consts::PI;

use crate::lattice::{C, S3};
use crate::root::increasing_root;
use crate::{OutOfRange, within};

/// A sphere of radius R, as the paraboloid -r²/2R, on an infinite half-space.
///
/// The contact radius is a, and the approach is δ. Source: K. L. Johnson, *Contact Mechanics*, Cambridge University
/// Press 1985, sections 3.4 and 4.2.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Hertz {
    /// Radius R > 0, in λ.
    pub radius: f64,
}

impl Hertz {
    /// Contact radius a = √(Rδ), in λ. It is 0 for δ ≤ 0.
    #[must_use]
    pub fn contact_radius(self, penetration: f64) -> f64 {
        (self.radius * penetration).max(0.0).sqrt()
    }

    /// Contact radius a = (3FR/4)^(1/3), in λ, for a load in E* λ².
    #[must_use]
    pub fn contact_radius_at_load(self, load: f64) -> f64 {
        (0.75 * load * self.radius).cbrt()
    }

    /// Approach δ = a²/R, in λ.
    #[must_use]
    pub fn penetration(self, contact_radius: f64) -> f64 {
        contact_radius * contact_radius / self.radius
    }

    /// Load F = 4a³/(3R), in E* λ².
    #[must_use]
    pub fn load(self, contact_radius: f64) -> f64 {
        4.0 * contact_radius.powi(3) / (3.0 * self.radius)
    }

    /// Maximum pressure p0 = 2a/(πR), in E*. It is 3/2 of the mean pressure in the contact.
    #[must_use]
    pub fn peak_pressure(self, contact_radius: f64) -> f64 {
        2.0 * contact_radius / (PI * self.radius)
    }

    /// Pressure p(r) = p0 √(1 - r²/a²) for r < a, in E*. It is 0 outside.
    #[must_use]
    pub fn pressure(self, r: f64, contact_radius: f64) -> f64 {
        self.peak_pressure(contact_radius) * (1.0 - (r / contact_radius).powi(2)).max(0.0).sqrt()
    }

    /// Displacement of the surface, in λ, zero far away.
    ///
    /// It is δ - r²/2R in the contact, and (1/πR) [(2a² - r²) asin(a/r) + a √(r² - a²)] outside. The relative rounding
    /// error outside grows as (r/a)².
    #[must_use]
    pub fn displacement(self, r: f64, contact_radius: f64) -> f64 {
        let (r, a) = (r.abs(), contact_radius);
        if r <= a {
            return self.penetration(a) - r * r / (2.0 * self.radius);
        }
        // asin(a/r) is an angle of the triangle. In this form it is well-conditioned at the edge too.
        let leg = ((r - a) * (r + a)).sqrt();
        ((2.0 * a * a - r * r) * a.atan2(leg) + a * leg) / (PI * self.radius)
    }

    /// Elastic energy (8/15) √R δ^(5/2) = 8a⁵/(15R²), in E* λ³.
    #[must_use]
    pub fn energy(self, contact_radius: f64) -> f64 {
        8.0 * contact_radius.powi(5) / (15.0 * self.radius * self.radius)
    }
}

/// A sphere of radius R in the periodic cell, with the zero-mean displacement of Eq. 3.
///
/// Images and uniform counter-load add φ(r) - 1/r = -C + (S3/4) r² + O(r⁴) to the displacement of each load (see
/// [`crate::lattice`]). The constant shifts Δ. The quadratic part is a curvature, so the contact remains a Hertz
/// contact, on a sphere of effective radius `R_e`. With t = a/λ,
///
/// ```text
/// R_e = R [1 - (2 S3/3π) t³],   F = 4a³/(3 R_e),   Δ = a²/R_e - (F/π) [C - (S3/10) t²]
/// ```
///
/// *Accuracy*: the omitted terms are of relative order t⁵. A Fourier solution at 1024² (spectral kernel) has the same Δ
/// within 1e-5 up to t = 0.1, and within 3e-4 at t = 0.2.
///
/// *Source*: derived here. The parts are in K. L. Johnson 1985.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PeriodicHertz {
    /// Radius R > 0, in λ.
    pub radius: f64,
}

/// A state of [`PeriodicHertz`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PeriodicContact {
    /// Contact radius a, in λ.
    pub contact_radius: f64,
    /// Effective radius `R_e`, in λ.
    pub effective_radius: f64,
    /// Load F, in E* λ². It equals the mean pressure over the cell, in E*.
    pub load: f64,
    /// Penetration Δ, in λ.
    pub penetration: f64,
    /// Maximum pressure p0 = 2a/(π`R_e`), in E*.
    pub peak_pressure: f64,
}

impl PeriodicContact {
    /// Pressure p(r) = p0 √(1 - r²/a²) at distance r from the centre of the contact, in E*.
    ///
    /// It is 0 outside.
    #[must_use]
    pub fn pressure(&self, r: f64) -> f64 {
        Hertz { radius: self.effective_radius }.pressure(r, self.contact_radius)
    }
}

impl PeriodicHertz {
    /// Maximum contact radius of the formulas, in λ.
    ///
    /// The omitted terms grow about as t⁵, and reach about 1e-3 of Δ there.
    pub const MAX_CONTACT_RADIUS: f64 = 0.25;

    /// The contact of radius a, in λ.
    ///
    /// # Errors
    /// [`OutOfRange`] unless 0 ≤ a ≤ [`Self::MAX_CONTACT_RADIUS`].
    pub fn at_contact_radius(self, contact_radius: f64) -> Result<PeriodicContact, OutOfRange> {
        within("contact radius", contact_radius, Self::MAX_CONTACT_RADIUS).map(|a| self.contact(a))
    }

    /// The contact under a load F, in E* λ².
    ///
    /// The mean pressure in E* has the same value. The radius follows from a³ = FR / (4/3 + (2 S3/3π) FR).
    ///
    /// # Errors
    /// [`OutOfRange`] unless the contact radius is in the range of [`Self::at_contact_radius`].
    pub fn at_load(self, load: f64) -> Result<PeriodicContact, OutOfRange> {
        within("load", load, self.contact(Self::MAX_CONTACT_RADIUS).load)?;
        let scaled = load * self.radius;
        Ok(self.contact((scaled / (4.0 / 3.0 + CURVATURE * scaled)).cbrt()))
    }

    /// The contact at penetration Δ, in λ.
    ///
    /// # Errors
    /// [`OutOfRange`] unless the contact radius is in the range of [`Self::at_contact_radius`].
    pub fn at_penetration(self, penetration: f64) -> Result<PeriodicContact, OutOfRange> {
        within("penetration", penetration, self.contact(Self::MAX_CONTACT_RADIUS).penetration)?;
        let scaled = penetration * self.radius;
        // Δ < a²/R, so Hertz's radius is below the root. It is near the root for small contacts.
        let start = scaled.sqrt();
        let bounds = (start.min(Self::MAX_CONTACT_RADIUS), Self::MAX_CONTACT_RADIUS);
        let root = increasing_root(bounds, start, |t| {
            let (value, derivative) = scaled_penetration(t);
            (value - scaled, derivative)
        });
        Ok(self.contact(root))
    }

    fn contact(self, a: f64) -> PeriodicContact {
        let effective_radius = self.radius * (1.0 - CURVATURE * a.powi(3));
        let effective = Hertz { radius: effective_radius };
        PeriodicContact {
            contact_radius: a,
            effective_radius,
            load: effective.load(a),
            penetration: scaled_penetration(a).0 / self.radius,
            peak_pressure: effective.peak_pressure(a),
        }
    }
}

/// The factor 2 S3/(3π).
const CURVATURE: f64 = 2.0 * S3 / (3.0 * PI);

/// ΔR/λ² as a function of t = a/λ, and its derivative.
///
/// The function is [t² - (4/3π) t³ (C - (S3/10) t²)] / (1 - (2 S3/3π) t³).
fn scaled_penetration(t: f64) -> (f64, f64) {
    let b = 4.0 / (3.0 * PI);
    let numerator = t * t * (1.0 - b * t * (C - 0.1 * S3 * t * t));
    let numerator_slope = t * (2.0 - b * t * (3.0 * C - 0.5 * S3 * t * t));
    let denominator = 1.0 - CURVATURE * t.powi(3);
    let denominator_slope = -3.0 * CURVATURE * t * t;
    let value = numerator / denominator;
    (value, (numerator_slope - value * denominator_slope) / denominator)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::testing::{assert_close, integral};

    /// The paper's Fig. 4 in SI units: R = 1 cm, Δ = 25 µm, E = 0.4e9 Pa, ν = 0.45.
    ///
    /// Lengths are in metres, pressures in pascals.
    const RADIUS: f64 = 1e-2;
    const PENETRATION: f64 = 25e-6;
    const E_STAR: f64 = 0.4e9 / (1.0 - 0.45 * 0.45);

    #[test]
    fn the_papers_sphere_has_its_known_contact() {
        let sphere = Hertz { radius: RADIUS };
        let a = sphere.contact_radius(PENETRATION);
        assert_close("E*", E_STAR, 501_567_398.119, 1e-12);
        assert_close("a", a, 5e-4, 1e-15);
        assert_close("area", PI * a * a, 7.853_982e-7, 1e-7);
        assert_close("F", sphere.load(a) * E_STAR, 8.359_457, 6e-8);
        assert_close("p0", sphere.peak_pressure(a) * E_STAR, 15.965_386e6, 4e-8);
        assert_close("mean pressure", sphere.load(a) * E_STAR / (PI * a * a), 10.643_591e6, 5e-8);
        assert_close("a from F", sphere.contact_radius_at_load(sphere.load(a)), a, 1e-15);
        assert_close("δ from a", sphere.penetration(a), PENETRATION, 1e-15);
    }

    #[test]
    fn pressure_adds_up_to_the_load() {
        let (sphere, a) = (Hertz { radius: 0.7 }, 0.03);
        let load = integral(0.0, a, |r| 2.0 * PI * r * sphere.pressure(r, a));
        assert_close("∫ p", load, sphere.load(a), 1e-13);
        assert!(sphere.pressure(1.01 * a, a) == 0.0, "pressure outside the contact");
    }

    #[test]
    fn work_of_the_load_is_the_energy() {
        let sphere = Hertz { radius: 0.7 };
        let work = integral(0.0, 2e-3, |penetration| sphere.load(sphere.contact_radius(penetration)));
        assert_close("∫ F dδ", work, sphere.energy(sphere.contact_radius(2e-3)), 1e-13);
    }

    #[test]
    fn displacement_follows_the_sphere_and_then_the_point_load() {
        let (sphere, a) = (Hertz { radius: 2.0 }, 0.1);
        let edge = sphere.displacement(a, a);
        assert_close("at the edge", sphere.displacement(a * (1.0 + 1e-12), a), edge, 1e-11);
        assert_close("at the edge, half of δ", edge, sphere.penetration(a) / 2.0, 1e-14);
        // The next term of the expansion is (a/r)²/10 of the displacement of a point load.
        let r = 1e3 * a;
        assert_close("far away", sphere.displacement(r, a), sphere.load(a) / (PI * r), 2e-7);
        assert!(sphere.displacement(1.1 * a, a) > sphere.penetration(a) - 1.21 * a * a / 4.0, "the gap is open");
    }

    /// Values (t, FR, ΔR), independently evaluated to ten digits.
    #[test]
    fn periodic_contacts_match_the_table() {
        let table = [
            (0.02, 1.066_683_025e-5, 3.867_645_675e-4),
            (0.05, 1.667_066_136e-4, 2.293_753_971e-3),
            (0.10, 1.335_894_235e-3, 8.364_544_927e-3),
            (0.15, 4.529_303_94e-3, 1.705_272_503e-2),
            (0.20, 1.083_279_794e-2, 2.729_874_919e-2),
        ];
        for (t, load, penetration) in table {
            let contact = PeriodicHertz { radius: 1.0 }.at_contact_radius(t).expect("in range");
            // Half a unit of the last printed digit.
            assert_close(&format!("F at t = {t}"), contact.load, load, 6e-10);
            assert_close(&format!("Δ at t = {t}"), contact.penetration, penetration, 5e-10);
        }
    }

    /// In a cell of 1 cm the paper's sphere has a 4.6 % larger contact and 14.5 % more load.
    ///
    /// This is relative to the infinite half-space.
    #[test]
    fn the_papers_sphere_in_cells_of_several_sizes() {
        let infinite = Hertz { radius: RADIUS };
        let (a, load) = (infinite.contact_radius(PENETRATION), infinite.load(5e-4));
        for (cell, radius_excess, load_excess) in [(0.01, 4.615, 14.5), (0.02, 2.18, 6.7), (0.08, 0.52, 1.6)] {
            let sphere = PeriodicHertz { radius: RADIUS / cell };
            let contact = sphere.at_penetration(PENETRATION / cell).expect("in range");
            let excess = |value: f64, reference: f64| 100.0 * (value / reference - 1.0);
            let (radius, load) = (excess(contact.contact_radius * cell, a), excess(contact.load * cell * cell, load));
            assert!((radius - radius_excess).abs() < 0.005, "cell {cell} m: radius + {radius} %, not {radius_excess}");
            assert!((load - load_excess).abs() < 0.05, "cell {cell} m: load + {load} %, not {load_excess}");
        }
        let contact = PeriodicHertz { radius: 1.0 }.at_penetration(2.5e-3).expect("in range");
        assert_close("a in a cell of 1 cm", contact.contact_radius, 0.052_307_4, 1e-6);
    }

    #[test]
    fn inversions_return_to_the_contact_radius() {
        let sphere = PeriodicHertz { radius: 3.7 };
        for t in [0.0, 1e-60, 1e-9, 1e-3, 0.07, 0.2, 0.249_999, 0.25] {
            let contact = sphere.at_contact_radius(t).expect("in range");
            let by_load = sphere.at_load(contact.load).expect("in range").contact_radius;
            let by_penetration = sphere.at_penetration(contact.penetration).expect("in range").contact_radius;
            for (what, a) in [("load", by_load), ("penetration", by_penetration)] {
                assert!((a - t).abs() <= 1e-14 * t, "from {what}: {a:e}, not {t:e}");
            }
        }
    }

    #[test]
    fn periodic_pressure_adds_up_to_the_load() {
        let contact = PeriodicHertz { radius: 0.4 }.at_contact_radius(0.15).expect("in range");
        let load = integral(0.0, 0.15, |r| 2.0 * PI * r * contact.pressure(r));
        assert_close("∫ p", load, contact.load, 1e-13);
        assert_close("p(0)", contact.pressure(0.0), contact.peak_pressure, 1e-15);
    }

    #[test]
    fn small_periodic_contacts_are_those_of_the_infinite_half_space() {
        let contact = PeriodicHertz { radius: 2.0 }.at_contact_radius(1e-8).expect("in range");
        let infinite = Hertz { radius: 2.0 };
        assert_close("F", contact.load, infinite.load(1e-8), 1e-14);
        // Relative to Δ, its shift is (4C/3π) t = 1.66 t.
        assert_close("Δ", contact.penetration, infinite.penetration(1e-8), 2e-8);
    }

    #[test]
    fn contacts_beyond_the_range_are_refused() {
        let sphere = PeriodicHertz { radius: 1.0 };
        for value in [-1e-9, 0.26, f64::NAN, f64::INFINITY] {
            assert!(sphere.at_contact_radius(value).is_err(), "contact radius {value}");
            assert!(sphere.at_penetration(value).is_err(), "penetration {value}");
            assert!(sphere.at_load(value).is_err(), "load {value}");
        }
        let error = sphere.at_contact_radius(0.5).expect_err("beyond the range");
        assert_eq!(error.to_string(), "contact radius 5e-1 is out of range: it must be between 0 and 2.5e-1");
    }
}
