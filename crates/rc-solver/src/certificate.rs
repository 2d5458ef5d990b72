//! The certificate: how far a pressure is from solving the contact problem.

use crate::Control;
use crate::problem::Problem;

/// Residuals of a contact solution, from a fresh application of L on the returned pressure.
///
/// With g the gap shifted so that its pressure-weighted mean is 0, and H = h_max - h_min.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Certificate {
    /// Σ p (g - min g) / (H Σ p).
    pub complementarity: f64,
    /// max(-g) / H.
    pub penetration: f64,
    /// |mean p - σ0| / σ0 under pressure control, |deviation of Δ| / H under penetration control.
    pub load: f64,
}

impl Certificate {
    /// Bound on [`Certificate::load`] in a solution that counts as converged.
    pub const LOAD_TOLERANCE: f64 = 1e-10;

    /// From the sums of a fresh gap: `least` is the minimum of the gap less its pressure-weighted mean, `mean_gap` that mean. NaN stays, since
    /// it must not pass for a small error.
    pub(crate) fn new(problem: &Problem, least: f64, mean_pressure: f64, mean_gap: f64) -> Self {
        // Σ p (g - min g) / Σ p with the weighted mean of g at zero is -min g: the two errors coincide.
        let error = match -least / problem.h_range {
            _ if problem.h_range == 0.0 && !least.is_nan() => 0.0,
            error if error < 0.0 => 0.0,
            error => error + 0.0,
        };
        let load = match problem.control {
            Control::MeanPressure(wanted) => (mean_pressure - wanted).abs() / wanted,
            Control::Penetration(_) => mean_gap.abs() / problem.h_range,
        };
        Self { complementarity: error, penetration: error, load }
    }
}

impl std::fmt::Display for Certificate {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let Self { complementarity, penetration, load } = self;
        write!(
            f,
            "complementarity error {complementarity:.2e}, penetration error {penetration:.2e}, load error {load:.2e}"
        )
    }
}
