//! The certificate: bounds on the error of a pressure.

use rc_core::Boundary;

use crate::problem::checked::Problem;
use crate::problem::control::Control;
use crate::problem::tolerance::ErrorBound;

/// Bounds on the error of a pressure in the discrete contact problem.
///
/// The bounds come from a fresh application of the elastic operator L on the returned pressure. For the adaptive method
/// they include the error of its operator, which is measured with a margin.
///
/// g is the gap, shifted so that its pressure-weighted mean is 0. H is h_max - h_min. On a flat patch with free borders
/// h_max - h_min is 0, and H is the penetration.
///
/// With a hardness, the mean is over elements whose pressure is below it. min g is then the minimum over elements that
/// could press more. Plastic elements may overlap by any amount. Where their gap is above min g, they could press less.
/// p (g - min g) then counts the largest of these gaps for all plastic elements.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Certificate {
    /// Σ p (g - min g) / (H Σ p).
    pub complementarity: f64,
    /// max(-g) / H.
    pub penetration: f64,
    /// √(G/U), a bound on the relative error of the pressure in the energy norm.
    ///
    /// Here G = mean p (g - min g) and U = mean p v / 2. On a layer, U lacks the energy under the mean pressure alone.
    /// Under penetration control, G also has the pressure-weighted mean of |g| times the mean of p.
    ///
    /// Let p* be the exact pressure of the same mean, and ⟨ ⟩ the mean over the cell. Because p* is the optimum, ⟨p -
    /// p*, L (p - p*)⟩ ≤ ⟨g, p - p*⟩. Because ⟨g - min g, p*⟩ is not negative, the right side is at most G.
    ///
    /// Pits, the offset and the range of the heights do not enter the bound. Errors of contact area, rms pressure, mean
    /// gap and penetration were measured. They are 0.05 to 0.6 of the bound's square where the operator is exact.
    ///
    /// Of a heavy contact that was solved for its gap, p* is compared with an admissible pressure in another way
    /// (`docs/uniform-grid.md`), and the errors are up to 0.3 of the bound itself, which is as much smaller.
    pub energy: f64,
    /// Relative error of the load.
    ///
    /// |mean p - σ0| / σ0 under pressure control, |deviation of Δ| / H under penetration control, of the computed gap.
    pub load: f64,
}

/// Sums of a fresh gap, from which a certificate follows.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Residuals {
    /// min g over elements that could press more, minus the gap of contact.
    pub(crate) least_gap: f64,
    /// Bound on G divided by the mean of p.
    ///
    /// Without plastic elements it is the pressure-weighted mean of g - min g.
    pub(crate) excess: f64,
    /// The gap of contact: the pressure-weighted mean of g.
    pub(crate) mean_gap: f64,
    /// Mean of p.
    pub(crate) mean_pressure: f64,
    /// U.
    pub(crate) elastic_energy: f64,
}

impl Certificate {
    /// Maximum of [`Certificate::load`] in a converged solution.
    pub const LOAD_TOLERANCE: f64 = 1e-10;

    /// Whether the bound is met, and the load is within [`Certificate::LOAD_TOLERANCE`].
    #[must_use]
    pub fn meets(&self, bound: ErrorBound) -> bool {
        // NaN meets no bound.
        self.error(bound) <= bound.value() && self.load <= Self::LOAD_TOLERANCE
    }

    /// The error that `bound` limits. A number beside a NaN does not count.
    pub(crate) fn error(&self, bound: ErrorBound) -> f64 {
        match bound {
            _ if self.penetration.is_nan() || self.complementarity.is_nan() => f64::NAN,
            ErrorBound::Energy(_) => self.energy,
            ErrorBound::Relative(_) => self.penetration.max(self.complementarity),
        }
    }

    /// The certificate of an exact solution.
    pub(crate) const EXACT: Self = Self { complementarity: 0.0, penetration: 0.0, energy: 0.0, load: 0.0 };

    /// The certificate that follows from `residuals`. NaN stays, since it must not pass for a small error.
    pub(crate) fn new(problem: &Problem, residuals: &Residuals) -> Self {
        let Residuals { least_gap, excess, mean_gap, mean_pressure, elastic_energy } = *residuals;
        // NaN stays.
        let positive = |value: f64| if value < 0.0 { 0.0 } else { value + 0.0 };
        let (overlap, excess) = (positive(-least_gap), positive(excess));
        let is_periodic = problem.support.boundary == Boundary::Periodic;
        let is_flat = is_periodic && problem.h_range == 0.0 && !overlap.is_nan();
        // A flat patch with free borders has no height range. Its penetration is 2U/σ0.
        let range =
            if is_periodic || problem.h_range > 0.0 { problem.h_range } else { 2.0 * elastic_energy / mean_pressure };
        let ratio = |numerator: f64, denominator: f64| match numerator {
            0.0 => 0.0,
            _ if is_flat => 0.0,
            _ => numerator / denominator,
        };
        // The weighted mean of g is zero, so Σ p (g - min g) / Σ p is -min g. The two errors coincide, unless elements
        // are plastic.
        let [complementarity, penetration] = [excess, overlap].map(|error| ratio(error, range));
        let (load, off) = match problem.bounds.control {
            Control::MeanPressure(wanted) => ((mean_pressure - wanted).abs() / wanted, 0.0),
            Control::Penetration(_) => (ratio(mean_gap.abs(), range), mean_gap.abs()),
        };
        let energy = ratio((excess + off) * mean_pressure, elastic_energy).sqrt();
        Self { complementarity, penetration, energy, load }
    }
}

impl std::fmt::Display for Certificate {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let Self { complementarity, penetration, energy, load } = self;
        write!(
            f,
            "energy error {energy:.2e}, complementarity error {complementarity:.2e}, deepest overlap {penetration:.2e} (both relative to the height range), \
             load error {load:.2e}"
        )
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_not_a_number_meets_no_bound() {
        let overlap = Certificate { penetration: f64::NAN, ..Certificate::EXACT };
        let of_plastic = Certificate { complementarity: f64::NAN, ..Certificate::EXACT };
        for certificate in [overlap, of_plastic] {
            assert!(!certificate.meets(ErrorBound::Energy(0.9)) && !certificate.meets(ErrorBound::Relative(0.9)));
        }
        let unloaded = Certificate { load: 1e-9, ..Certificate::EXACT };
        assert!(!unloaded.meets(ErrorBound::Relative(0.9)));
        assert!(Certificate::EXACT.meets(ErrorBound::Energy(1e-5)));
    }
}
