//! The effect of the split kernel's error on a certificate.

use crate::descent::certificate::Certificate;
use crate::problem::checked::Problem;
use crate::problem::control::Control;
use crate::problem::tolerance::ErrorBound;
use crate::problem::tolerance::Measure;
use crate::tiles::mesh::Mesh;
use crate::tiles::roughness::roughness;
use crate::tiles::split::GapSplit;

/// Maximum part of a relative bound that the error of an operator may take.
///
/// With a larger part, the next better operator certifies.
const LARGEST_PART: f64 = 0.5;

/// The properties of a pressure that the error of its displacement depends on.
#[derive(Clone, Copy, Debug)]
pub(crate) struct PressureScale {
    /// The deviation from the half-space that no operator resolves, as a part of 2/q.
    pub(crate) unresolved: f64,
    /// Number of levels above the base grid.
    pub(crate) n_levels: usize,
    /// Maximum displacement, in λ, without that of a uniform pressure.
    pub(crate) displacement: f64,
    /// Roughness of the pressure, in λ: see [`roughness`].
    pub(crate) roughness: f64,
    /// U/σ0, the ratio of elastic energy to mean pressure, in λ.
    pub(crate) energy_length: f64,
}

impl PressureScale {
    pub(crate) fn new(
        (elements, pressure): (&Mesh, &[f64]),
        (n_levels, unresolved): (usize, f64),
        displacement: f64,
        energy_length: f64,
    ) -> Self {
        Self { unresolved, n_levels, displacement, roughness: roughness(elements, pressure), energy_length }
    }
}

/// Bound on the error of an operator under one pressure, measured with a margin ([`GapSplit`]).
#[derive(Clone, Copy, Debug)]
pub(crate) struct OperatorError {
    /// Error of the displacement of any element, in λ.
    pub(crate) displacement: f64,
    /// Error of G/σ0 in [`Certificate::energy`], an energy.
    ///
    /// The unit is U/σ0, the length of [`Measure::Energy`].
    energy: f64,
    /// Relative error of the elastic energy.
    elastic_energy: f64,
}

impl OperatorError {
    /// The error of a split under pressures of this scale.
    pub(crate) fn of(split: GapSplit, scale: &PressureScale, control: Control) -> Self {
        let PressureScale { unresolved, n_levels, displacement, roughness, energy_length } = *scale;
        let of_waves = (split.error * n_levels as f64 + unresolved) * displacement;
        let displacement = of_waves + split.error_of_roughness * roughness;
        let relative = displacement / energy_length;
        // The errors of the mean of the gap and of its minimum may have opposite signs. Under penetration control, G
        // has the mean once more.
        let of_gap = match control {
            Control::MeanPressure(_) => 2.0,
            Control::Penetration(_) => 3.0,
        };
        Self { displacement, energy: of_gap * relative, elastic_energy: 0.5 * relative }
    }

    /// The certificate for the exact operator.
    ///
    /// `certificate` is that of a gap that was computed with this error.
    pub(crate) fn added_to(self, certificate: Certificate, h_range: f64) -> Certificate {
        let relative = 2.0 * self.displacement / h_range;
        Certificate {
            complementarity: certificate.complementarity + relative,
            penetration: certificate.penetration + relative,
            energy: self.added_to_energy(certificate.energy),
            load: certificate.load,
        }
    }

    /// √(G/U), with the maximum errors of G and U.
    fn added_to_energy(self, energy: f64) -> f64 {
        let least = 1.0 - self.elastic_energy;
        if least > 0.0 { ((energy.powi(2) + self.energy) / least).sqrt() } else { f64::INFINITY }
    }

    /// The part of the bound that is left to the computed gap.
    ///
    /// It is in units of the measure's length, and 0 if the error takes all of the bound.
    pub(crate) fn remaining(self, bound: ErrorBound, problem: &Problem) -> f64 {
        let error = match bound.measure() {
            Measure::HeightRange => 2.0 * self.displacement / problem.h_range,
            Measure::Energy => self.energy,
        };
        (bound.overlap() - error).max(0.0)
    }

    /// The error that an iteration must reach to meet the bound.
    ///
    /// If the error of the operator leaves less than that, a better operator will certify.
    pub(crate) fn goal(self, bound: ErrorBound, problem: &Problem) -> f64 {
        self.remaining(bound, problem).max(minimum_remaining(bound)).min(bound.aim())
    }

    /// Whether the bound leaves enough to the computed gap.
    fn is_small(self, bound: ErrorBound, problem: &Problem) -> bool {
        self.remaining(bound, problem) >= minimum_remaining(bound)
    }
}

/// Minimum part of the bound that an operator must leave to the computed gap.
fn minimum_remaining(bound: ErrorBound) -> f64 {
    bound.aim().min((1.0 - LARGEST_PART) * bound.overlap())
}

/// The fastest split, from `split` on, whose error is a small part of the bound.
///
/// If no split is good enough, it is the most accurate one.
pub(crate) fn certifying_split(
    split: GapSplit,
    scale: &PressureScale,
    bound: ErrorBound,
    problem: &Problem,
) -> GapSplit {
    // A coarser level that has lost its contact says nothing. There is a second check after the solve.
    if scale.energy_length.is_nan() || scale.energy_length <= 0.0 {
        return split;
    }
    let is_small = |split: &GapSplit| OperatorError::of(*split, scale, problem.bounds.control).is_small(bound, problem);
    let mut candidates = std::iter::successors(Some(split), |split| split.finer());
    candidates.find(is_small).unwrap_or_else(GapSplit::most_accurate)
}

/// Whether the error of the most accurate operator is a small part of the bound.
pub(crate) fn can_certify(scale: &PressureScale, bound: ErrorBound, problem: &Problem) -> bool {
    let split = certifying_split(GapSplit::most_accurate(), scale, bound, problem);
    // A coarser level that has lost its contact says nothing.
    scale.energy_length.is_nan()
        || scale.energy_length <= 0.0
        || OperatorError::of(split, scale, problem.bounds.control).is_small(bound, problem)
}

#[cfg(test)]
mod tests;
