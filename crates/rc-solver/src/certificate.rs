//! The certificate: how far a pressure is from solving the contact problem.

use rc_core::Boundary;

use crate::problem::Problem;
use crate::{Control, ErrorBound};

/// Bounds on how far a pressure is from solving the discrete contact problem, from a fresh application of L on the
/// returned pressure. For the adaptive method they include the error of its operator, which is measured with a margin.
///
/// With g the gap shifted so that its pressure-weighted mean is 0, and H = h_max - h_min; on a flat patch with free
/// borders, whose H is 0, the penetration instead.
///
/// With a hardness the mean is over elements whose pressure is below it, and min g is the minimum over elements that
/// could press more. Plastic elements may overlap as much as they do. Where their gap is above min g they could press
/// less, and p (g - min g) counts the greatest of these gaps for all of them.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Certificate {
    /// Σ p (g - min g) / (H Σ p).
    pub complementarity: f64,
    /// max(-g) / H.
    pub penetration: f64,
    /// √(G/U), a bound on the relative error of the pressure in the energy norm; G = mean p (g - min g), U = mean p v
    /// / 2. The energy of a layer under the mean pressure alone is not part of U.
    ///
    /// Under penetration control G has the pressure-weighted mean of |g| times the mean of p besides. With p* the exact
    /// pressure of the same mean and ⟨ ⟩ the mean over the cell, ⟨p - p*, L (p - p*)⟩ ≤ ⟨g, p - p*⟩, because p* is the
    /// optimum. ⟨g - min g, p*⟩ is not negative, so the right side is at most G. The pits, the offset and the range of
    /// the heights are not in it. Contact area, rms pressure, mean gap and penetration were measured to be off by 0.05
    /// to 0.6 of its square where the operator is exact.
    pub energy: f64,
    /// |mean p - σ0| / σ0 under pressure control, |deviation of Δ| / H under penetration control, of the computed gap.
    pub load: f64,
}

/// Sums of a fresh gap, from which a certificate follows.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Residuals {
    /// min g over elements that could press more, less the gap of contact.
    pub(crate) least_gap: f64,
    /// Pressure-weighted mean of g - min g, where no pressure is the hardness; a bound on G over the mean of p
    /// everywhere.
    pub(crate) excess: f64,
    /// The gap of contact: the pressure-weighted mean of g.
    pub(crate) mean_gap: f64,
    /// Mean of p.
    pub(crate) mean_pressure: f64,
    /// U.
    pub(crate) elastic_energy: f64,
}

impl Certificate {
    /// Bound on [`Certificate::load`] in a solution that counts as converged.
    pub const LOAD_TOLERANCE: f64 = 1e-10;

    /// Whether the bound is met, and the load to [`Certificate::LOAD_TOLERANCE`].
    #[must_use]
    pub fn meets(&self, bound: ErrorBound) -> bool {
        let error = match bound {
            ErrorBound::Energy(_) => self.energy,
            ErrorBound::Relative(_) => self.penetration.max(self.complementarity),
        };
        // NaN meets nothing, nor does a number beside it.
        let is_number = !self.penetration.is_nan();
        is_number && error <= bound.value() && self.load <= Self::LOAD_TOLERANCE
    }

    /// The certificate of an exact solution.
    pub(crate) const EXACT: Self = Self { complementarity: 0.0, penetration: 0.0, energy: 0.0, load: 0.0 };

    /// NaN stays, since it must not pass for a small error.
    pub(crate) fn new(problem: &Problem, residuals: &Residuals) -> Self {
        let Residuals { least_gap, excess, mean_gap, mean_pressure, elastic_energy } = *residuals;
        // NaN stays.
        let positive = |value: f64| if value < 0.0 { 0.0 } else { value + 0.0 };
        let (overlap, excess) = (positive(-least_gap), positive(excess));
        let is_periodic = problem.support.boundary == Boundary::Periodic;
        let is_flat = is_periodic && problem.h_range == 0.0 && !overlap.is_nan();
        // A flat patch with free borders has no height range, and 2U/σ0 is its penetration.
        let range =
            if is_periodic || problem.h_range > 0.0 { problem.h_range } else { 2.0 * elastic_energy / mean_pressure };
        let ratio = |numerator: f64, denominator: f64| match numerator {
            0.0 => 0.0,
            _ if is_flat => 0.0,
            _ => numerator / denominator,
        };
        // Σ p (g - min g) / Σ p with the weighted mean of g at zero is -min g: the two errors coincide, unless elements
        // are plastic.
        let [complementarity, penetration] = [excess, overlap].map(|error| ratio(error, range));
        let (load, off) = match problem.control {
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
            "energy error {energy:.2e}, complementarity error {complementarity:.2e}, penetration error {penetration:.2e}, \
             load error {load:.2e}"
        )
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_not_a_number_meets_no_bound() {
        let certificate = Certificate { penetration: f64::NAN, ..Certificate::EXACT };
        assert!(!certificate.meets(ErrorBound::Energy(0.9)) && !certificate.meets(ErrorBound::Relative(0.9)));
        let unloaded = Certificate { load: 1e-9, ..Certificate::EXACT };
        assert!(!unloaded.meets(ErrorBound::Relative(0.9)));
        assert!(Certificate::EXACT.meets(ErrorBound::Energy(1e-5)));
    }
}
