//! Westergaard's contact of a one-dimensional wave, exact at every load.

use std::f64::consts::PI;

use crate::root::increasing_root;
use crate::{OutOfRange, within};

/// The surface A cos(2πx) under the mean pressure p̄ over the cell.
///
/// There is one wave per cell, with crests at integer x. The relative load is P = p̄/p^, and contact is full for P ≥ 1.
/// Contact is |x| < a around the crests, with P = sin²(πa).
///
/// Sources: H. M. Westergaard, *Bearing pressures and cracks*, J. Appl. Mech. 6 (1939) A49-A53; K. L. Johnson, *Contact
/// Mechanics*, Cambridge University Press 1985, section 13.2. Mean gap, Δ and energy follow by integration (tests).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Westergaard {
    /// Amplitude A > 0, in λ, half the height from trough to crest.
    pub amplitude: f64,
}

impl Westergaard {
    /// The smallest mean pressure with full contact, p^ = πA, in E*.
    #[must_use]
    pub fn full_contact_pressure(self) -> f64 {
        PI * self.amplitude
    }

    /// Half width of a contact a = asin(√P)/π, in λ, at most ½.
    #[must_use]
    pub fn half_width(self, mean_pressure: f64) -> f64 {
        self.ratio(mean_pressure).sqrt().asin() / PI
    }

    /// Area fraction A/A0 = 2a.
    #[must_use]
    pub fn area_fraction(self, mean_pressure: f64) -> f64 {
        2.0 * self.half_width(mean_pressure)
    }

    /// Pressure p(x) = 2p^ cos(πx) √(P - sin²(πx)) in the contact, in E*.
    ///
    /// In full contact it is p̄ + p^ cos(2πx).
    #[must_use]
    pub fn pressure(self, x: f64, mean_pressure: f64) -> f64 {
        let (full, (sine, cosine)) = (self.full_contact_pressure(), phase(x));
        if mean_pressure >= full {
            return mean_pressure + full * (1.0 - 2.0 * sine * sine);
        }
        2.0 * full * cosine * (self.ratio(mean_pressure) - sine * sine).max(0.0).sqrt()
    }

    /// Maximum pressure, at the crest, in E*. It is 2p^ √P, and p̄ + p^ in full contact.
    #[must_use]
    pub fn peak_pressure(self, mean_pressure: f64) -> f64 {
        self.pressure(0.0, mean_pressure)
    }

    /// Gap at x, in λ. It is 0 in contact.
    ///
    /// Out of contact it is 2A [s χ - P ln((s + χ)/√P)] with s = |sin πx| and χ = √(s² - P).
    #[must_use]
    pub fn gap(self, x: f64, mean_pressure: f64) -> f64 {
        let (ratio, (sine, _)) = (self.ratio(mean_pressure), phase(x));
        let chi_squared = sine * sine - ratio;
        if chi_squared <= 0.0 {
            return 0.0;
        }
        let chi = chi_squared.sqrt();
        let logarithm = if ratio > 0.0 { ratio * ((sine + chi) / ratio.sqrt()).ln() } else { 0.0 };
        2.0 * self.amplitude * (sine * chi - logarithm)
    }

    /// Mean gap A (1 - P + P ln P), in λ.
    #[must_use]
    pub fn mean_gap(self, mean_pressure: f64) -> f64 {
        self.amplitude - self.penetration(mean_pressure)
    }

    /// Penetration Δ = A P (1 - ln P), in λ, equal to A minus the mean gap.
    ///
    /// It is A in full contact.
    #[must_use]
    pub fn penetration(self, mean_pressure: f64) -> f64 {
        self.amplitude * relative_penetration(self.ratio(mean_pressure))
    }

    /// Elastic energy per nominal area, A p^ P² (1/4 - ln(P)/2), in E* λ.
    ///
    /// In full contact it is A p^/4 and does not grow with the load.
    #[must_use]
    pub fn energy(self, mean_pressure: f64) -> f64 {
        let ratio = self.ratio(mean_pressure);
        let logarithm = if ratio > 0.0 { ratio.ln() } else { 0.0 };
        self.amplitude * self.full_contact_pressure() * ratio * ratio * (0.25 - 0.5 * logarithm)
    }

    /// Mean pressure at penetration Δ, in E*, from Δ/A = P (1 - ln P).
    ///
    /// Near full contact Δ is flat in P, so the error of P is the square root of rounding.
    ///
    /// # Errors
    /// [`OutOfRange`] unless 0 ≤ Δ ≤ A.
    pub fn mean_pressure_at(self, penetration: f64) -> Result<f64, OutOfRange> {
        let relative = within("penetration", penetration, self.amplitude)? / self.amplitude;
        // P (1 - ln P) > P and P < Δ/A give this upper bound. It is near the root for small Δ.
        let start = if relative > 0.0 { relative / (1.0 - relative.ln()) } else { 0.0 };
        let root = increasing_root((0.0, 1.0), start, |p| (relative_penetration(p) - relative, -p.ln()));
        Ok(self.full_contact_pressure() * root)
    }

    /// The relative load P, between 0 and 1.
    fn ratio(self, mean_pressure: f64) -> f64 {
        (mean_pressure / self.full_contact_pressure()).clamp(0.0, 1.0)
    }
}

/// The function P (1 - ln P), continued to 0 at P = 0.
fn relative_penetration(ratio: f64) -> f64 {
    if ratio > 0.0 { ratio * (1.0 - ratio.ln()) } else { 0.0 }
}

/// |sin| and cos ≥ 0 of πx, where x is measured from the nearest crest.
fn phase(x: f64) -> (f64, f64) {
    let (sine, cosine) = (PI * (x - x.round())).sin_cos();
    (sine.abs(), cosine.max(0.0))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::testing::{assert_close, assert_printed, integral};

    const WAVE: Westergaard = Westergaard { amplitude: 0.02 };

    fn mean_pressure(half_width: f64) -> f64 {
        WAVE.full_contact_pressure() * (PI * half_width).sin().powi(2)
    }

    /// Values (a, P, Δ/A, largest p/p^, U/(A p^)), independently evaluated. Every printed digit must agree.
    #[test]
    fn states_match_the_table() {
        let table = [
            (0.05, "0.0244717419", "0.1152676849", "0.3128689301", "0.00126068"),
            (0.10, "0.0954915028", "0.3197741154", "0.6180339887", "0.01298820"),
            (0.20, "0.3454915028", "0.7126754601", "1.1755705046", "0.09327056"),
            (0.25, "0.5000000000", "0.8465735903", "1.4142135624", "0.14914340"),
            (0.30, "0.6545084972", "0.9319354792", "1.6180339887", "0.19788450"),
            (0.40, "0.9045084972", "0.9952882080", "1.9021130326", "0.24558942"),
            (0.45, "0.9755282581", "0.9996980940", "1.9753766812", "0.24970302"),
        ];
        let (amplitude, full) = (WAVE.amplitude, WAVE.full_contact_pressure());
        for (a, ratio, penetration, peak, energy) in table {
            let load = mean_pressure(a);
            assert_printed("P", load / full, ratio);
            assert_close("a", WAVE.half_width(load), a, 1e-14);
            assert_printed("Δ/A", WAVE.penetration(load) / amplitude, penetration);
            assert_printed("p_max/p^", WAVE.peak_pressure(load) / full, peak);
            assert_printed("U/(A p^)", WAVE.energy(load) / (amplitude * full), energy);
        }
    }

    #[test]
    fn pressure_adds_up_to_the_load_and_gap_to_the_mean_gap() {
        for a in [0.01, 0.1, 0.25, 0.4, 0.49] {
            let load = mean_pressure(a);
            assert_close("∫ p", 2.0 * integral(0.0, a, |x| WAVE.pressure(x, load)), load, 1e-12);
            // The gap closes towards full contact, so its error is relative to A.
            let mean_gap = 2.0 * integral(a, 0.5, |x| WAVE.gap(x, load));
            let error = (mean_gap - WAVE.mean_gap(load)).abs() / WAVE.amplitude;
            assert!(error <= 1e-14, "mean gap {mean_gap:e}, closed form {:e}", WAVE.mean_gap(load));
        }
    }

    /// The displacement of a pressure wave c cos(2πkx) is c/(πk) times the wave.
    ///
    /// The displacement is v = h - A + Δ + gap. The first three waves are compared by quadrature.
    #[test]
    fn pressure_and_gap_belong_together() {
        let load = mean_pressure(0.2);
        for k in 1..=3 {
            let wave = |x: f64| (2.0 * PI * f64::from(k) * x).cos();
            let pressure = 2.0 * integral(0.0, 0.2, |x| wave(x) * WAVE.pressure(x, load));
            let gap = 2.0 * integral(0.2, 0.5, |x| wave(x) * WAVE.gap(x, load));
            let height = if k == 1 { WAVE.amplitude / 2.0 } else { 0.0 };
            assert_close(&format!("wave {k}"), height + gap, pressure / (PI * f64::from(k)), 1e-12);
        }
    }

    #[test]
    fn work_of_the_load_is_the_energy() {
        let load = mean_pressure(0.3);
        let work = integral(0.0, WAVE.penetration(load), |delta| WAVE.mean_pressure_at(delta).expect("below A"));
        assert_close("∫ p̄ dΔ", work, WAVE.energy(load), 1e-12);
    }

    #[test]
    fn the_load_is_found_from_the_penetration() {
        for ratio in [1e-300, 1e-20, 1e-6, 0.3, 0.9] {
            let load = ratio * WAVE.full_contact_pressure();
            assert_close("p̄", WAVE.mean_pressure_at(WAVE.penetration(load)).expect("below A"), load, 2e-14);
        }
        // Here 1 - Δ/A = (1 - P)²/2, so the error of P is the square root of the rounding of Δ.
        let load = WAVE.mean_pressure_at(WAVE.amplitude).expect("full contact");
        assert_close("p̄ at Δ = A", load, WAVE.full_contact_pressure(), 5e-8);
        assert_eq!(WAVE.mean_pressure_at(0.0), Ok(0.0));
    }

    #[test]
    fn full_contact_is_a_cosine_on_the_mean() {
        let full = WAVE.full_contact_pressure();
        let load = 1.5 * full;
        for x in [0.0, 0.1, -0.3, 0.5, 7.25] {
            let expected = load + full * (2.0 * PI * x).cos();
            assert_close(&format!("p({x})"), WAVE.pressure(x, load), expected, 1e-14);
            assert!(WAVE.gap(x, load) == 0.0, "gap in full contact");
        }
        assert_close("area", WAVE.area_fraction(load), 1.0, 1e-15);
        assert_close("Δ", WAVE.penetration(load), WAVE.amplitude, 1e-15);
        assert_close("U", WAVE.energy(load), WAVE.amplitude * full / 4.0, 1e-15);
    }

    #[test]
    fn without_load_the_gap_is_the_wave() {
        assert_close("gap", WAVE.gap(0.2, 0.0), 2.0 * WAVE.amplitude * (0.2 * PI).sin().powi(2), 1e-15);
        let nothing = [WAVE.half_width(0.0), WAVE.pressure(0.0, 0.0), WAVE.penetration(0.0), WAVE.energy(0.0)];
        assert!(nothing.iter().all(|&value| value == 0.0), "half width, pressure, Δ, energy: {nothing:?}");
    }

    #[test]
    fn penetrations_beyond_full_contact_are_refused() {
        for penetration in [-1e-9, 0.021, f64::NAN] {
            assert!(WAVE.mean_pressure_at(penetration).is_err(), "Δ = {penetration}");
        }
    }
}
