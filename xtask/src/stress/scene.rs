//! A scene of the stress table, and the properties that every solved scene must have.

use anyhow::Result;
use rc_core::Field;
use rc_solver::Control;

use super::audit::Audit;
use super::row::{Row, Rows, guarded};
use super::solved::{Method, Solved, solve};

/// The tolerance of a scene, unless it says otherwise.
pub(crate) const TOLERANCE: f64 = 1e-6;

/// What an audit may find beyond the tolerance, relative to it: its own rounding, and the error of the other operator.
const AUDIT_SLACK: f64 = 0.1;

/// Iterations may be this many times the median.
const ITERATION_FACTOR: f64 = 2.0;

/// A contact problem with a name.
#[derive(Clone)]
pub(crate) struct Scene {
    pub(crate) name: String,
    pub(crate) heights: Field,
    pub(crate) method: Method,
    pub(crate) control: Control,
    pub(crate) tolerance: f64,
}

impl Scene {
    pub(crate) fn new(name: impl Into<String>, heights: &Field, method: Method, control: Control) -> Self {
        let name = format!("{} {}", method.name(), name.into());
        Self { name, heights: heights.clone(), method, control, tolerance: TOLERANCE }
    }

    pub(crate) fn solve(&self) -> Result<Solved> {
        guarded(|| solve(&self.heights, self.method, self.control, self.tolerance))
    }

    /// Whether it is solved, and how well by another operator's word. Returns the iterations.
    fn check(&self, rows: &mut Rows) -> Option<usize> {
        let solved = match self.solve() {
            Ok(solved) => solved,
            Err(error) => {
                rows.holds(&self.name, "solved", "converged", format!("{error:#}"), false);
                return None;
            }
        };
        let info = &solved.info;
        rows.holds(&self.name, "solved", "converged", "converged", true);
        let audit = match guarded(|| Audit::of(&self.heights, &solved, self.method, self.control)) {
            Ok(audit) => audit,
            Err(error) => {
                rows.holds(&self.name, "audit", "possible", format!("{error:#}"), false);
                return None;
            }
        };
        rows.at_most(&self.name, "pressures not finite or negative", audit.n_bad as f64, 0.0);
        let numbers = numbers_of(&solved);
        let n_bad = numbers.iter().filter(|value| !value.is_finite()).count();
        rows.at_most(&self.name, "observables not finite", n_bad as f64, 0.0);
        rows.at_most(&self.name, "load by audit", audit.load, self.load_bound());
        let bound = (1.0 + AUDIT_SLACK) * self.tolerance;
        rows.at_most(&self.name, "penetration by audit", audit.penetration, bound);
        // The pressure-weighted mean of the gap is zero, so its mean size is at most twice its greatest negative value.
        rows.at_most(&self.name, "complementarity by audit", audit.complementarity, 2.0 * bound);
        let claimed = info.certificate.penetration.max(info.certificate.complementarity);
        let backed = claimed + AUDIT_SLACK * self.tolerance;
        rows.at_most(&self.name, "audit within the certificate", audit.penetration, backed);
        Some(info.fine_iterations())
    }

    fn load_bound(&self) -> f64 {
        match self.control {
            Control::MeanPressure(_) => 1e-10,
            // By another operator the penetration has its error.
            Control::Penetration(_) => self.tolerance,
        }
    }
}

/// Everything a solution says of itself, but the stiffness, which is infinite in full contact.
fn numbers_of(solved: &Solved) -> [f64; 11] {
    let (info, observables) = (&solved.info, &solved.observables);
    let stiffness = observables.contact_stiffness;
    [
        info.mean_pressure,
        info.penetration,
        info.penetration_full_contact,
        info.elastic_energy,
        info.certificate.complementarity,
        info.certificate.load,
        observables.area.fraction,
        observables.rms_pressure,
        observables.max_pressure,
        observables.mean_gap,
        if stiffness == f64::INFINITY { 0.0 } else { stiffness },
    ]
}

/// Checks all scenes of a group; iterations are compared with the median of each method's.
pub(crate) fn check(group: &'static str, scenes: &[Scene]) -> Vec<Row> {
    let mut rows = Rows::of(group);
    let iterations: Vec<(usize, f64)> =
        scenes.iter().enumerate().filter_map(|(i, scene)| Some((i, scene.check(&mut rows)? as f64))).collect();
    for (i, count) in &iterations {
        let scene = &scenes[*i];
        let of_method = iterations.iter().filter(|(j, _)| scenes[*j].method == scene.method);
        let bound = ITERATION_FACTOR * median(of_method.map(|(_, count)| *count).collect());
        rows.at_most(&scene.name, "iterations", *count, bound);
    }
    rows.finish()
}

/// The median of the positive values: full contact needs no iteration.
fn median(mut values: Vec<f64>) -> f64 {
    values.retain(|value| *value > 0.0);
    values.sort_by(f64::total_cmp);
    values.get(values.len() / 2).copied().unwrap_or(0.0)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_median_passes_full_contact_over() {
        assert_eq!(median(vec![0.0, 5.0, 0.0, 7.0, 90.0]), 7.0);
    }
}
