//! Creep of a material under a constant load.

use crate::relaxation::Relaxation;

impl Relaxation {
    /// The creep compliance J(t) after a time, relative to that of the relaxed material. `None` of a fractional solid.
    ///
    /// It is 1 - Σ J exp(-t/ρ) over the retardation times ρ, from E∞/E0 at t = 0 to 1.
    #[must_use]
    pub fn creep(&self, time: f64) -> Option<f64> {
        let terms = self.terms()?;
        let left: f64 = retardation(terms).iter().map(|[compliance, rho]| compliance * (-time / rho).exp()).sum();
        Some(1.0 - left)
    }
}

/// Pairs of a compliance J and a retardation time ρ, of a Prony series in increasing order of τ.
///
/// -1/ρ are the zeros of E~(s) = 1 + Σ g sτ/(1 + sτ), which is 1 - Σ g τ/(ρ - τ) there. It increases with ρ from -∞ just
/// above each τ to +∞ below the next one, or to 1 above the last, so that one ρ is in each interval. The residues of
/// 1/E~ are J = 1/(ρ Σ g τ/(ρ - τ)²).
fn retardation(terms: &[[f64; 2]]) -> Vec<[f64; 2]> {
    let sum = |rho: f64, power: i32| terms.iter().map(|[g, tau]| g * tau / (rho - tau).powi(power)).sum::<f64>();
    let beyond: f64 = terms.iter().map(|[g, tau]| (1.0 + g) * tau).sum();
    let ends = terms.iter().skip(1).map(|[_, tau]| *tau).chain([beyond]);
    let of_interval = |(&[_, tau], end): (&[f64; 2], f64)| {
        let (mut low, mut high) = (tau, end);
        loop {
            let middle = 0.5 * (low + high);
            if middle <= low || middle >= high {
                break;
            }
            if sum(middle, 1) > 1.0 { low = middle } else { high = middle }
        }
        [1.0 / (high * sum(high, 2)), high]
    };
    terms.iter().zip(ends).map(of_interval).collect()
}

#[cfg(test)]
mod tests {
    use rc_core::Complex64;

    use super::*;

    #[test]
    fn one_time_creeps_with_its_retardation_time() {
        let material = Relaxation::single(10.0, 0.3).expect("a material");
        for time in [0.0, 0.1, 3.0, 30.0, 1e3] {
            let expected = 1.0 - 0.9 * (-time / 3.0_f64).exp();
            let found = material.creep(time).expect("a Prony series");
            assert!((found - expected).abs() < 1e-14, "{time}: {found} for {expected}");
        }
        assert_eq!(Relaxation::fractional(0.5, 10.0, 1.0).expect("a material").creep(1.0), None);
    }

    /// The compliance J~ of all retardation times is 1/E~ at any frequency.
    #[test]
    fn the_spectrum_is_that_of_the_complex_compliance() {
        let terms = [[2.0, 1e-4], [1e-6, 1e-3], [5.0, 1.1e-3], [0.5, 1.0], [40.0, 2.0]];
        let material = Relaxation::prony(&terms).expect("a material");
        let glassy = 1.0 / material.glassy_ratio();
        for omega in [0.0, 1e-2, 0.3, 10.0, 1e3, 1e5] {
            let one = |[compliance, rho]: [f64; 2]| compliance / Complex64::new(1.0, -omega * rho);
            let found = glassy + retardation(&terms).into_iter().map(one).sum::<Complex64>();
            assert!((found - material.compliance(omega)).norm() < 1e-13, "{omega}: {found}");
        }
        assert!((material.creep(0.0).expect("a series") - glassy).abs() < 1e-13);
        assert!((material.creep(1e4).expect("a series") - 1.0).abs() < 1e-13);
    }
}
