//! The result of a descent: the certificate and the observables.

use crate::descent::certificate::Certificate;
use crate::descent::certificate::Residuals;
use crate::descent::info::{LevelInfo, LevelValues, SolveInfo};
use crate::descent::sums::GapSums;
use crate::problem::checked::Problem;

/// The result of a descent.
pub(crate) struct Outcome {
    pub(crate) converged: bool,
    pub(crate) certificate: Certificate,
    /// [`Certificate::energy`] of the computed gap, without the error of the operator.
    pub(crate) iteration_error: f64,
    /// Mean pressure.
    pub(crate) mean_pressure: f64,
    /// Pressure-weighted mean of v - h, which is the penetration minus h_max.
    pub(crate) approach: f64,
    /// ½ mean(p v).
    pub(crate) elastic_energy: f64,
    /// The gap of elements in contact. In a converged solution it is the same for all of them.
    pub(crate) contact_gap: f64,
}

/// Largest relative error of area and rms pressure, in units of such a bound on the error of the pressure.
///
/// Measured up to 0.28 for areas and 0.04 for rms pressures (32 scenes, 80 % to 99 % contact, H = 0.4 and 0.8).
pub(crate) const OF_OBSERVABLES: f64 = 0.3;

impl Outcome {
    /// The outcome from sums over all elements that may be in contact.
    ///
    /// The cell has room for `n_cell` elements.
    pub(crate) fn new(problem: &Problem, sums: &GapSums, n_cell: f64, converged: bool) -> Self {
        let mean_pressure = sums.load() / n_cell;
        let contact = sums.multiplier(problem.bounds);
        let elastic_energy = 0.5 * sums.work() / n_cell;
        let residuals = Residuals {
            least_gap: sums.min_gap - contact,
            excess: sums.excess() + (sums.mean_gap().unwrap_or(contact) - contact).abs(),
            mean_gap: contact,
            mean_pressure,
            elastic_energy: elastic_energy - problem.uniform_energy(mean_pressure),
        };
        let certificate = Certificate::new(problem, &residuals);
        Self {
            converged,
            certificate,
            iteration_error: certificate.energy,
            mean_pressure,
            approach: contact - problem.offset(),
            elastic_energy,
            contact_gap: sums.zero_gap(problem.bounds),
        }
    }

    /// The outcome with another bound on ⟨p - p*, L (p - p*)⟩, if it is smaller than G.
    ///
    /// It is close to the error itself, while errors of observables are of the order of G.
    pub(crate) fn with_energy_bound(mut self, problem: &Problem, bound: f64) -> Self {
        let energy = self.elastic_energy - problem.uniform_energy(self.mean_pressure);
        let error = (bound / energy).sqrt();
        // NaN is no bound.
        if error < self.certificate.energy {
            self.certificate.energy = error;
            self.iteration_error = self.iteration_error.min((OF_OBSERVABLES * error).sqrt());
        }
        self
    }

    /// U/σ0, the ratio of elastic energy to mean pressure. U has no energy of a uniform pressure.
    pub(crate) fn energy_length(&self, problem: &Problem) -> f64 {
        (self.elastic_energy - problem.uniform_energy(self.mean_pressure)) / self.mean_pressure
    }

    /// The outcome in the form that users get.
    ///
    /// `levels` is the work on the levels, coarsest first. `coarser` has the values of the last level but one.
    pub(crate) fn info(&self, problem: &Problem, levels: Vec<LevelInfo>, coarser: Option<LevelValues>) -> SolveInfo {
        SolveInfo {
            certificate: self.certificate,
            iteration_error: self.iteration_error,
            mean_pressure: self.mean_pressure,
            penetration: problem.h_max + self.approach,
            penetration_full_contact: problem.h_max - problem.h_mean,
            mean_displacement: problem.support.compliance * self.mean_pressure,
            elastic_energy: self.elastic_energy,
            levels,
            coarser,
            friction: None,
        }
    }
}
