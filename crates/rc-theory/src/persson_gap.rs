//! Persson's relation of mean gap and pressure at low loads, σ0 = β E* exp(-ū/u0).
//!
//! At low loads the elastic energy is proportional to σ0, so the mean gap ū decreases like the logarithm of the load.
//! Thus log σ0 is linear in Δ = h_max - ū, as the paper's Fig. 7 shows. Sources: B. N. J. Persson, *Relation between
//! interfacial separation and load*, Phys. Rev. Lett. 99 (2007) 125502; C. Yang, B. N. J. Persson, J. Phys.: Condens.
//! Matter 20 (2008) 215214:
//!
//! ```text
//! u0 = √π γ ∫ q² C(q) w(q) dq,   w(q) = (π ∫ q'³ C(q') dq')^(-1/2), q' from q0 to q,   ln β = -γ_E/2 - ⟨ln w⟩
//! ```
//!
//! Here ⟨ ⟩ is weighted by the integrand of u0. γ < 1 accounts for the energy of partial contact. It is fitted, to
//! about 0.4. The theory is for systems without a highest asperity.

/// Half of Euler's constant.
const HALF_EULER: f64 = 0.288_607_832_450_766_4;

/// Number of intervals of the quadrature. Its integrand is smooth.
const N_INTERVALS: u32 = 2000;

/// A self-affine surface with a continuous spectrum C(q) ∝ q^(-2(1+H)) from q0 to N q0 (Eq. 1).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SelfAffineBand {
    /// Hurst exponent H, in (0, 1].
    pub hurst: f64,
    /// Ratio N > 1 of the ends of the band.
    pub waves: f64,
}

impl SelfAffineBand {
    /// The decay length u0/γ in units of the rms height.
    #[must_use]
    pub fn decay_length_over_gamma(self) -> f64 {
        2.0 / std::f64::consts::PI.sqrt() * self.weighted(|_| 1.0)
    }

    /// The prefactor β in units of q0 h_rms.
    #[must_use]
    pub fn prefactor(self) -> f64 {
        // -ln w = ln t.
        (self.weighted(f64::ln) / self.weighted(|_| 1.0) - HALF_EULER).exp()
    }

    /// The integral ∫ f(t)/q dt with t = 1/w from 0 to its maximum, for q0 = 1 and h_rms = 1.
    ///
    /// dt removes the singularity of w at q0. f may have a logarithmic singularity at 0. The substitution t = t1 s²
    /// removes it for a midpoint rule.
    fn weighted(self, f: impl Fn(f64) -> f64) -> f64 {
        let exponent = 2.0 - 2.0 * self.hurst;
        // The value of π C0 for ∫ q C dq = 1/2π.
        let strength = self.hurst / -(-2.0 * self.hurst * self.waves.ln()).exp_m1();
        let largest = (strength * scaled_exp(exponent, self.waves.ln())).sqrt();
        let step = f64::from(N_INTERVALS).recip();
        let values = (0..N_INTERVALS).map(|i| {
            let s = (f64::from(i) + 0.5) * step;
            let t = largest * s * s;
            2.0 * largest * s * step * f(t) * (-scaled_ln(exponent, t * t / strength)).exp()
        });
        values.sum()
    }
}

/// (exp(e x) - 1)/e, or x for e = 0.
fn scaled_exp(exponent: f64, x: f64) -> f64 {
    if exponent > 0.0 { (exponent * x).exp_m1() / exponent } else { x }
}

/// ln(1 + e y)/e, the inverse of [`scaled_exp`].
fn scaled_ln(exponent: f64, y: f64) -> f64 {
    if exponent > 0.0 { (exponent * y).ln_1p() / exponent } else { y }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::testing::{assert_close, assert_printed, integral};

    /// The paper's surfaces, H = 0.8, with values from an independent quadrature in q.
    #[test]
    fn the_papers_surfaces_match_the_table() {
        for (waves, length, prefactor) in [(64.0, "1.0492", "0.3114"), (128.0, "1.0554", "0.3153")] {
            let band = SelfAffineBand { hurst: 0.8, waves };
            assert_printed("u0/γ (h_rms)", band.decay_length_over_gamma(), length);
            assert_printed("β (q0 h_rms)", band.prefactor(), prefactor);
        }
    }

    /// Tests the integrals in q, as they are printed.
    #[test]
    fn both_are_the_integrals_over_wavenumbers() {
        for (hurst, waves) in [(0.3, 20.0), (0.8, 64.0), (1.0, 100.0)] {
            let band = SelfAffineBand { hurst, waves };
            let spectrum = |q: f64| q.powf(-2.0 - 2.0 * hurst);
            let height = 2.0 * std::f64::consts::PI * integral(1.0, waves, |q| q * spectrum(q));
            let slope =
                |q: f64| if hurst < 1.0 { (q.powf(2.0 - 2.0 * hurst) - 1.0) / (2.0 - 2.0 * hurst) } else { q.ln() };
            let w = |q: f64| (std::f64::consts::PI * slope(q) / height).powf(-0.5);
            // The substitution q = 1 + x² has no rounding at the singular end.
            let end = (waves - 1.0).sqrt();
            let weight = |x: f64| {
                let q = 1.0 + x * x;
                (q, if slope(q) > 0.0 { 2.0 * x * q * q * spectrum(q) / height * w(q) } else { 0.0 })
            };
            let total = integral(0.0, end, |x| weight(x).1);
            assert_close("u0/γ", band.decay_length_over_gamma(), std::f64::consts::PI.sqrt() * total, 1e-5);
            let logarithm = integral(0.0, end, |x| match weight(x) {
                (_, weight) if weight <= 0.0 => 0.0,
                (q, weight) => weight * w(q).ln(),
            });
            assert_close("β", band.prefactor(), (-HALF_EULER - logarithm / total).exp(), 1e-5);
        }
    }
}
