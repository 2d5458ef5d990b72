//! Creep of a material that relaxes: its compliance as a sum of retardation times.
//!
//! For a time factor exp(-iωt), J~(ω) = 1/E~(ω) = J0 + Σ J/(1 - iωρ). The retardation times ρ are the zeros of the
//! modulus E~ of a Prony series, at ω = -i/ρ:
//!
//! ```text
//! Σ g τ/(ρ - τ) = 1,        J = 1/(ρ Σ g τ/(ρ - τ)²).
//! ```
//!
//! The first sum falls from +∞ to -∞ between two relaxation times, and to 0 beyond the last. So there is one zero after
//! each relaxation time. (B. Gross, *Mathematical Structure of the Theories of Viscoelasticity*, 1953)

use crate::relaxation::Relaxation;

/// A compliance relative to the relaxed one, J0 + Σ J/(1 - iωρ), with J0 + Σ J = 1.
#[derive(Clone, Debug, PartialEq)]
pub struct Retardation {
    /// J0, the compliance of the glassy material.
    pub instantaneous: f64,
    /// Pairs of J and ρ, in increasing order of ρ. All are positive. The unit of ρ is that of relaxation times.
    pub modes: Vec<[f64; 2]>,
}

impl Relaxation {
    /// The compliance as a sum of retardation times. `None` if the material is not a Prony series.
    ///
    /// It has as many times as the series has.
    #[must_use]
    pub fn retardation(&self) -> Option<Retardation> {
        self.prony_terms().map(of_terms)
    }

    /// The creep compliance J(t) after a time, relative to that of the relaxed material. `None` of a fractional solid.
    ///
    /// It is 1 - Σ J exp(-t/ρ) over the retardation times ρ, from E∞/E0 at t = 0 to 1.
    #[must_use]
    pub fn creep(&self, time: f64) -> Option<f64> {
        let left = |[compliance, rho]: &[f64; 2]| compliance * (-time / rho).exp();
        Some(1.0 - self.retardation()?.modes.iter().map(left).sum::<f64>())
    }

    /// 1/E', the inverse of the storage modulus, as J0 + Σ J/(1 + ω²ρ²). `None` if the material is not a Prony series.
    ///
    /// The storage modulus is 1 + Σ g (ωτ)²/(1 + (ωτ)²), a Prony series in ω².
    #[must_use]
    pub fn storage_retardation(&self) -> Option<Retardation> {
        let squares: Vec<[f64; 2]> = self.prony_terms()?.iter().map(|&[g, tau]| [g, tau * tau]).collect();
        let mut retardation = of_terms(&squares);
        for [_, rho] in &mut retardation.modes {
            *rho = rho.sqrt();
        }
        Some(retardation)
    }
}

/// The retardation of pairs of g and τ, in increasing order of τ.
fn of_terms(terms: &[[f64; 2]]) -> Retardation {
    let glassy: f64 = 1.0 + terms.iter().map(|[g, _]| g).sum::<f64>();
    let modes = (0..terms.len()).map(|i| mode(terms, i)).collect();
    Retardation { instantaneous: glassy.recip(), modes }
}

/// J and ρ of the zero after the relaxation time `i`.
///
/// The distance from this time is found, not ρ itself, so that a small one keeps its digits.
fn mode(terms: &[[f64; 2]], i: usize) -> [f64; 2] {
    let tau = terms[i][1];
    let sum = |after: f64, power: i32| -> f64 {
        terms.iter().map(|&[g, other]| g * other / (after + (tau - other)).powi(power)).sum()
    };
    // Beyond the last time, each term is at most g τ over the distance from that time.
    let farthest = terms.get(i + 1).map_or_else(|| terms.iter().map(|[g, t]| g * t).sum(), |next| next[1] - tau);
    let (mut low, mut high) = (0.0, farthest);
    // Each step halves the interval, or its logarithm while that is long.
    loop {
        let middle = if low > 0.0 && high > 4.0 * low { (low * high).sqrt() } else { f64::midpoint(low, high) };
        if middle <= low || middle >= high {
            break;
        }
        if sum(middle, 1) > 1.0 { low = middle } else { high = middle }
    }
    let rho = tau + high;
    [(rho * sum(high, 2)).recip(), rho]
}

#[cfg(test)]
mod tests {
    use rc_core::Complex64;

    use super::*;

    fn materials() -> Vec<Relaxation> {
        let many: Vec<[f64; 2]> =
            (0..30).map(|i| [0.3 + f64::from(i % 7), 10_f64.powf(f64::from(i) / 3.0 - 7.0)]).collect();
        let series = [
            vec![[9.0, 1e-3]],
            vec![[4.0, 1.0], [5.0, 30.0], [0.2, 31.0]],
            vec![[1e-3, 1e-6], [1e3, 1.0], [0.5, 1.0 + 1e-9]],
            many,
        ];
        series.iter().map(|terms| Relaxation::prony(terms).expect("a series")).collect()
    }

    #[test]
    fn the_compliance_is_the_inverse_of_the_modulus() {
        for material in materials() {
            let Retardation { instantaneous, modes } = material.retardation().expect("a series");
            let total: f64 = instantaneous + modes.iter().map(|[j, _]| j).sum::<f64>();
            assert!((total - 1.0).abs() < 1e-13, "{material:?}: {total}");
            for omega in (-90..90).map(|i| 10_f64.powf(0.1 * f64::from(i))) {
                let terms = modes.iter().map(|&[j, rho]| j / Complex64::new(1.0, -omega * rho));
                let (found, expected) = (instantaneous + terms.sum::<Complex64>(), material.compliance(omega));
                assert!((found - expected).norm() < 1e-13, "{material:?} at {omega}: {found} for {expected}");
            }
        }
    }

    #[test]
    fn the_inverse_of_the_storage_modulus_is_a_sum_too() {
        for material in materials() {
            let Retardation { instantaneous, modes } = material.storage_retardation().expect("a series");
            for omega in (-90..90).map(|i| 10_f64.powf(0.1 * f64::from(i))) {
                let terms = modes.iter().map(|&[j, rho]| j / (1.0 + (omega * rho).powi(2)));
                let (found, expected) = (instantaneous + terms.sum::<f64>(), material.modulus(omega).re.recip());
                assert!((found - expected).abs() < 1e-13, "{material:?} at {omega}: {found} for {expected}");
            }
        }
    }

    #[test]
    fn one_relaxation_time_is_retarded_by_the_glassy_ratio() {
        let material = Relaxation::single(10.0, 0.2).expect("a material");
        let Retardation { instantaneous, modes } = material.retardation().expect("a series");
        assert!((instantaneous - 0.1).abs() < 1e-16);
        let [[j, rho]] = modes[..] else { panic!("{modes:?}") };
        assert!((j - 0.9).abs() < 1e-15 && (rho - 2.0).abs() < 2e-15, "{j}, {rho}");
        assert_eq!(Relaxation::fractional(0.5, 10.0, 1.0).expect("a material").retardation(), None);
        let elastic = Relaxation::prony(&[]).expect("an elastic material").retardation().expect("no times");
        assert_eq!(elastic, Retardation { instantaneous: 1.0, modes: Vec::new() });
    }

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
}
