//! What the error of the split kernel does to a certificate.

use super::mesh::Mesh;
use super::roughness::roughness;
use super::split::GapSplit;
use crate::problem::Problem;
use crate::tolerance::Measure;
use crate::{Certificate, Control, ErrorBound};

/// The part of a relative bound that the error of an operator may take; with more, the next better operator certifies.
const LARGEST_PART: f64 = 0.5;

/// A pressure, as far as the error of its displacement depends on it.
#[derive(Clone, Copy, Debug)]
pub(super) struct PressureScale {
    /// Levels above the base grid.
    pub(super) n_levels: usize,
    /// Greatest displacement, in λ.
    pub(super) displacement: f64,
    /// See [`roughness`], in λ.
    pub(super) roughness: f64,
    /// U/σ0, the elastic energy over the mean pressure, in λ.
    pub(super) energy_length: f64,
}

impl PressureScale {
    pub(super) fn new(
        (elements, pressure): (&Mesh, &[f64]),
        n_levels: usize,
        displacement: f64,
        energy_length: f64,
    ) -> Self {
        Self { n_levels, displacement, roughness: roughness(elements, pressure), energy_length }
    }
}

/// The error of an operator under one pressure at most, as measured with a margin ([`GapSplit`]).
#[derive(Clone, Copy, Debug)]
pub(super) struct OperatorError {
    /// Of the displacement of any element, in λ.
    pub(super) displacement: f64,
    /// Of an energy: G/σ0 of [`Certificate::energy`], in units of U/σ0, the length of [`Measure::Energy`].
    energy: f64,
    /// Of the elastic energy, relative.
    elastic_energy: f64,
}

impl OperatorError {
    /// Under pressures of this scale.
    pub(super) fn of(split: GapSplit, scale: &PressureScale, control: Control) -> Self {
        let PressureScale { n_levels, displacement, roughness, energy_length } = *scale;
        let displacement = split.error * n_levels as f64 * displacement + split.error_of_roughness * roughness;
        let relative = displacement / energy_length;
        // The mean of the gap and its minimum may be off to opposite sides; under penetration control G has the mean
        // once more.
        let of_gap = match control {
            Control::MeanPressure(_) => 2.0,
            Control::Penetration(_) => 3.0,
        };
        Self { displacement, energy: of_gap * relative, elastic_energy: 0.5 * relative }
    }

    /// The certificate for the exact operator, from that of a gap that was computed with this error.
    pub(super) fn added_to(self, certificate: Certificate, h_range: f64) -> Certificate {
        let relative = 2.0 * self.displacement / h_range;
        Certificate {
            complementarity: certificate.complementarity + relative,
            penetration: certificate.penetration + relative,
            energy: self.added_to_energy(certificate.energy),
            load: certificate.load,
        }
    }

    /// √(G/U), both as far off as they may be.
    fn added_to_energy(self, energy: f64) -> f64 {
        let least = 1.0 - self.elastic_energy;
        if least > 0.0 { ((energy.powi(2) + self.energy) / least).sqrt() } else { f64::INFINITY }
    }

    /// What the bound leaves to the computed gap, in units of the measure's length; 0 when the error takes all of it.
    pub(super) fn remaining(self, bound: ErrorBound, problem: &Problem) -> f64 {
        let error = match bound.measure() {
            Measure::HeightRange => 2.0 * self.displacement / problem.h_range,
            Measure::Energy => self.energy,
        };
        (bound.overlap() - error).max(0.0)
    }

    /// What an iteration has to reach for the bound to be met. Where the error leaves less than that, a better operator
    /// will certify.
    pub(super) fn goal(self, bound: ErrorBound, problem: &Problem) -> f64 {
        self.remaining(bound, problem).max(minimum_remaining(bound)).min(bound.aim())
    }

    /// Whether the computed gap has enough of the bound to itself.
    fn is_small(self, bound: ErrorBound, problem: &Problem) -> bool {
        self.remaining(bound, problem) >= minimum_remaining(bound)
    }
}

/// What an operator has to leave to the computed gap.
fn minimum_remaining(bound: ErrorBound) -> f64 {
    bound.aim().min((1.0 - LARGEST_PART) * bound.overlap())
}

/// The fastest split, from `split` on, whose error is a small part of the bound; the most accurate one where no error
/// is.
pub(super) fn certifying_split(
    split: GapSplit,
    scale: &PressureScale,
    bound: ErrorBound,
    problem: &Problem,
) -> GapSplit {
    // A coarser level that has lost its contact tells nothing; there is a second look after the solve.
    if scale.energy_length.is_nan() || scale.energy_length <= 0.0 {
        return split;
    }
    let is_small = |split: &GapSplit| OperatorError::of(*split, scale, problem.control).is_small(bound, problem);
    let mut candidates = std::iter::successors(Some(split), |split| split.finer());
    candidates.find(is_small).unwrap_or_else(GapSplit::most_accurate)
}

/// Whether the error of the most accurate operator is a small part of the bound.
pub(super) fn can_certify(scale: &PressureScale, bound: ErrorBound, problem: &Problem) -> bool {
    let split = certifying_split(GapSplit::most_accurate(), scale, bound, problem);
    // A coarser level that has lost its contact tells nothing.
    scale.energy_length.is_nan()
        || scale.energy_length <= 0.0
        || OperatorError::of(split, scale, problem.control).is_small(bound, problem)
}

#[cfg(test)]
mod tests;
