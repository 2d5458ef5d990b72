//! Persson's distribution of stress between randomly rough surfaces, Eq. 7.

use std::f64::consts::PI;

use libm::erf;

use crate::OutOfRange;
use crate::root::increasing_root;

/// The stress density P(σ) of Eq. 7, over the whole nominal area.
///
/// P(σ) = (4πΛ)^(-1/2) {exp[-(σ-σ0)²/4Λ] - exp[-(σ+σ0)²/4Λ]} for σ > 0. The Λ of the theory is E*²⟨|∇h|²⟩/8
/// ([`Persson::from_rms_slope`]). The paper fits Λ instead. Since ∫σP dσ = σ0 for every Λ, area and Λ are not
/// independent. A fit of the distribution determines the area, [`Persson::from_area_fraction`].
///
/// This is a theory, not an exact result. At low load it gives κ = A/A0 · slope/σ0 → 1.596, whereas simulations find
/// about 2. Source: B. N. J. Persson, *Theory of rubber friction and contact mechanics*, J. Chem. Phys. 115 (2001)
/// 3840-3861.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Persson {
    /// Mean pressure over the cell σ0 ≥ 0, in E*.
    pub mean_pressure: f64,
    /// Half the variance of the stress in full contact, Λ > 0, in E*².
    pub lambda: f64,
}

impl Persson {
    /// κ of the theory at low load, √(8/π), where A/A0 = κ σ0/slope.
    pub const KAPPA: f64 = 1.595_769_121_605_730_7;

    /// The theory without a fit, Λ = slope²/8, in E*².
    ///
    /// Full contact then has the variance slope²/4.
    #[must_use]
    pub fn from_rms_slope(mean_pressure: f64, rms_slope: f64) -> Self {
        Self { mean_pressure, lambda: rms_slope * rms_slope / 8.0 }
    }

    /// The distribution with a known area fraction.
    ///
    /// # Errors
    /// [`OutOfRange`] unless the fraction is above 0 and below 1.
    pub fn from_area_fraction(mean_pressure: f64, area_fraction: f64) -> Result<Self, OutOfRange> {
        if !(area_fraction > 0.0 && area_fraction < 1.0) {
            return Err(OutOfRange { quantity: "area fraction", value: area_fraction, max: 1.0 });
        }
        // erf is below its tangent at 0, so its inverse is above the inverse of this line. erf(6) rounds to 1.
        let slope = 2.0 / PI.sqrt();
        let z =
            increasing_root((0.0, 6.0), area_fraction / slope, |z| (erf(z) - area_fraction, slope * (-z * z).exp()));
        Ok(Self { mean_pressure, lambda: (0.5 * mean_pressure / z).powi(2) })
    }

    /// The Λ of Eq. 7 that is nearest to `densities` (stress, P) by least squares.
    ///
    /// The mean stress is given, so Λ is the only parameter. The fit is a golden-section search in ln Λ. At the lower
    /// limit, Eq. 7 is much narrower than the range of the given stresses. At the upper limit, its peak is far beyond
    /// them. All three quantities may be in any common unit of stress.
    #[must_use]
    pub fn fit(mean_pressure: f64, densities: &[(f64, f64)]) -> Self {
        let largest = densities.iter().fold(0.0, |largest: f64, at| largest.max(at.0));
        let least = densities.iter().fold(largest, |least, at| least.min(at.0));
        // In full contact all stresses may be near their mean, or even equal.
        let range = if least > 0.5 * largest { (largest - least).max(1e-9 * largest) } else { largest };
        let of = |logarithm: f64| Self { mean_pressure, lambda: logarithm.exp() };
        let misfit = |logarithm: f64| {
            let persson = of(logarithm);
            densities.iter().map(|&(stress, density)| (density - persson.density(stress)).powi(2)).sum::<f64>()
        };
        let section = 0.5 * (5_f64.sqrt() - 1.0);
        let (mut low, mut high) = ((1e-6 * range * range).ln(), (largest * largest).ln());
        // The interval shrinks to 1e-13 of its width.
        for _ in 0..62 {
            let (left, right) = (high - section * (high - low), low + section * (high - low));
            if misfit(left) < misfit(right) { high = right } else { low = left }
        }
        of(0.5 * (low + high))
    }

    /// P(σ) of Eq. (7), in 1/E*, for a stress in E*.
    ///
    /// It is 0 for σ ≤ 0. Non-contact is a separate peak of weight 1 - A/A0.
    #[must_use]
    pub fn density(self, stress: f64) -> f64 {
        if stress <= 0.0 {
            return 0.0;
        }
        let (s, s0, lambda) = (stress, self.mean_pressure, self.lambda);
        // The difference of the two exponentials, without cancellation near σ = 0.
        let mirrored = -(-s * s0 / lambda).exp_m1();
        (-(s - s0).powi(2) / (4.0 * lambda)).exp() * mirrored / (4.0 * PI * lambda).sqrt()
    }

    /// Area fraction A/A0 = ∫P dσ = erf(σ0/2√Λ).
    #[must_use]
    pub fn area_fraction(self) -> f64 {
        erf(self.scaled_pressure())
    }

    /// Mean square stress ⟨σ²⟩ over the nominal area, in E*².
    ///
    /// It is (σ0² + 2Λ) erf(σ0/2√Λ) + 2σ0 √(Λ/π) exp(-σ0²/4Λ).
    #[must_use]
    pub fn second_moment(self) -> f64 {
        let (s0, lambda, z) = (self.mean_pressure, self.lambda, self.scaled_pressure());
        (s0 * s0 + 2.0 * lambda) * erf(z) + 2.0 * s0 * (lambda / PI).sqrt() * (-z * z).exp()
    }

    /// Derivative dP/dσ at σ = 0, σ0 exp(-σ0²/4Λ) / (2√π Λ^(3/2)), in 1/E*².
    #[must_use]
    pub fn slope_at_zero(self) -> f64 {
        let z = self.scaled_pressure();
        self.mean_pressure * (-z * z).exp() / (2.0 * PI.sqrt() * self.lambda.powf(1.5))
    }

    /// The argument σ0/2√Λ.
    fn scaled_pressure(self) -> f64 {
        0.5 * self.mean_pressure / self.lambda.sqrt()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::full_contact;
    use crate::testing::{assert_close, assert_printed, integral};

    /// Values (σ0/slope, A/A0).
    #[test]
    fn areas_match_the_table() {
        let table = [(0.001, "0.00159577"), (0.01, "0.01595663"), (0.1, "0.15851942"), (0.3, "0.45149376")];
        for (ratio, area) in table {
            let value = Persson::from_rms_slope(0.02 * ratio, 0.02).area_fraction();
            assert_printed(&format!("area at σ0 = {ratio} slope"), value, area);
        }
        assert_printed("κ", Persson::KAPPA, "1.5957691216");
        assert_close("κ", Persson::from_rms_slope(1e-9, 1.0).area_fraction(), Persson::KAPPA * 1e-9, 1e-15);
    }

    /// Values (slope, Λ, A/A0) of the paper's surfaces at σ0/E* = 8.9e-4.
    #[test]
    fn the_papers_surfaces_match_the_table() {
        let surfaces = [
            (0.026_232_747_0, "8.601963", "0.054098"),
            (0.030_810_458_3, "11.866054", "0.046070"),
            (0.026_990_361_7, "9.105995", "0.052582"),
            (0.031_633_691_3, "12.508630", "0.044873"),
        ];
        for (slope, lambda, area) in surfaces {
            let theory = Persson::from_rms_slope(8.9e-4, slope);
            assert_printed("Λ (1e-5 E*²)", theory.lambda * 1e5, lambda);
            assert_printed("area", theory.area_fraction(), area);
        }
    }

    /// The Λ that follow from the paper's two areas.
    #[test]
    fn an_area_has_one_lambda() {
        for (area, lambda) in [(0.0673, "5.5535"), (0.0588, "7.2793")] {
            let fit = Persson::from_area_fraction(8.9e-4, area).expect("a partial contact");
            assert_printed("Λ (1e-5 E*²)", fit.lambda * 1e5, lambda);
        }
        for area in [1e-100, 1e-9, 0.3, 0.999, 1.0 - 1e-12] {
            let fit = Persson::from_area_fraction(0.01, area).expect("a partial contact");
            assert_close("area", fit.area_fraction(), area, 4e-15);
        }
        for area in [0.0, -0.1, 1.0, 1.5, f64::NAN] {
            assert!(Persson::from_area_fraction(0.01, area).is_err(), "area {area}");
        }
    }

    #[test]
    fn the_fit_finds_the_lambda_of_eq_7() {
        // At loads far beyond full contact, all stresses are near their mean.
        let far = Persson { mean_pressure: 5.0, lambda: 1e-8 };
        let densities: Vec<(f64, f64)> =
            (-100..=100).map(|k| 5.0 + 5e-6 * f64::from(k)).map(|stress| (stress, far.density(stress))).collect();
        let found = Persson::fit(5.0, &densities);
        assert!((found.lambda / far.lambda - 1.0).abs() < 1e-6, "{found:?} against {far:?}");
        for exact in [Persson { mean_pressure: 8.9e-4, lambda: 5.5e-5 }, Persson { mean_pressure: 0.02, lambda: 1e-4 }]
        {
            let densities: Vec<(f64, f64)> =
                (1..200).map(|k| 2.5e-4 * f64::from(k)).map(|stress| (stress, exact.density(stress))).collect();
            let found = Persson::fit(exact.mean_pressure, &densities);
            assert!((found.lambda / exact.lambda - 1.0).abs() < 1e-6, "{found:?} against {exact:?}");
            // The unit of stress does not matter.
            let pascals: Vec<(f64, f64)> = densities.iter().map(|&(s, p)| (5e8 * s, p / 5e8)).collect();
            let found = Persson::fit(5e8 * exact.mean_pressure, &pascals).lambda / 25e16;
            assert!((found / exact.lambda - 1.0).abs() < 1e-6, "{found:e} against {exact:?}");
        }
    }

    /// Tests low, middle and nearly full contact.
    #[test]
    fn moments_are_those_of_the_density() {
        for mean_pressure in [1e-4, 0.02, 0.2] {
            let theory = Persson::from_rms_slope(mean_pressure, 0.1);
            let end = mean_pressure + 40.0 * theory.lambda.sqrt();
            let moment = |n: i32| integral(0.0, end, |s| s.powi(n) * theory.density(s));
            assert_close("∫ P", moment(0), theory.area_fraction(), 1e-12);
            assert_close("∫ σ P", moment(1), mean_pressure, 1e-12);
            assert_close("∫ σ² P", moment(2), theory.second_moment(), 1e-12);
        }
    }

    #[test]
    fn the_density_is_eq_7_and_starts_linearly() {
        let theory = Persson { mean_pressure: 0.03, lambda: 4e-4 };
        for s in [0.01_f64, 0.03, 0.08] {
            let part = |x: f64| (-x * x / (4.0 * 4e-4)).exp();
            let printed = (part(s - 0.03) - part(s + 0.03)) / (2.0 * (PI * 4e-4).sqrt());
            assert_close(&format!("P({s})"), theory.density(s), printed, 1e-14);
        }
        // The next term of P/σ is of order σ²/Λ.
        assert_close("P/σ at 0", theory.density(1e-10) / 1e-10, theory.slope_at_zero(), 1e-13);
        assert!(theory.density(0.0) == 0.0 && theory.density(-0.01) == 0.0, "density without compression");
    }

    #[test]
    fn limits_are_low_load_and_full_contact() {
        let slope = 0.1;
        let low = Persson::from_rms_slope(1e-7, slope);
        assert_close("low load", low.second_moment(), 1e-7 * slope * (2.0 / PI).sqrt(), 1e-5);
        let full = Persson::from_rms_slope(2.0, slope);
        let variance = full.second_moment() - 4.0;
        assert_close("full contact", variance, full_contact::rms_pressure(slope).powi(2), 1e-12);
    }
}
