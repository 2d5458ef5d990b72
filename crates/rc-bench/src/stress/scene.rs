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

/// Iterations may be this many times the median of all scenes of the method.
const ITERATION_FACTOR: f64 = 2.0;

/// A contact problem with a name.
#[derive(Clone)]
pub(crate) struct Scene {
    pub(crate) name: String,
    pub(crate) heights: Field,
    pub(crate) method: Method,
    pub(crate) control: Control,
    pub(crate) tolerance: f64,
    slack: f64,
    iteration_factor: f64,
}

impl Scene {
    pub(crate) fn new(name: impl Into<String>, heights: &Field, method: Method, control: Control) -> Self {
        let name = format!("{} {}", method.name(), name.into());
        let (slack, iteration_factor) = (AUDIT_SLACK, ITERATION_FACTOR);
        Self { name, heights: heights.clone(), method, control, tolerance: TOLERANCE, slack, iteration_factor }
    }

    /// Solved exactly, without an iteration.
    pub(crate) fn exact(self) -> Self {
        Self { iteration_factor: 0.0, ..self }
    }

    /// Known to take up to `factor` times the median number of iterations.
    pub(crate) fn slow(self, factor: f64) -> Self {
        Self { iteration_factor: factor, ..self }
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
        let bound = (1.0 + self.slack) * self.tolerance;
        rows.at_most(&self.name, "penetration by audit", audit.penetration, bound);
        // The pressure-weighted mean of the gap is zero, so its mean size is at most twice the size of its minimum.
        rows.at_most(&self.name, "complementarity by audit", audit.complementarity, 2.0 * bound);
        let claimed = info.certificate.penetration.max(info.certificate.complementarity);
        let backed = claimed + self.slack * self.tolerance;
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
    let stiffness = solved.stiffness;
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

/// Scenes of a group.
pub(crate) type Group = (&'static str, Vec<Scene>);

/// Checks all scenes; iterations are compared with the median over all scenes of the method.
pub(crate) fn check(groups: &[Group]) -> Vec<Row> {
    let mut rows = Vec::new();
    let mut iterations: Vec<(&'static str, &Scene, f64)> = Vec::new();
    for (group, scenes) in groups {
        let mut of_group = Rows::of(group);
        for scene in scenes {
            iterations.extend(scene.check(&mut of_group).map(|count| (*group, scene, count as f64)));
        }
        rows.extend(of_group.finish());
    }
    let mut medians: Vec<(Method, f64)> = Vec::new();
    for (group, scene, count) in &iterations {
        let known = medians.iter().find(|(method, _)| *method == scene.method).map(|(_, median)| *median);
        let median = known.unwrap_or_else(|| {
            let of_method = iterations.iter().filter(|(_, other, _)| other.method == scene.method);
            let median = median(of_method.map(|(_, _, count)| *count).collect());
            medians.push((scene.method, median));
            median
        });
        let mut row = Rows::of(group);
        let property =
            if scene.iteration_factor > ITERATION_FACTOR { "iterations of slow scenes" } else { "iterations" };
        row.at_most(&scene.name, property, *count, scene.iteration_factor * median);
        rows.extend(row.finish());
    }
    rows
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
        assert!((median(vec![0.0, 5.0, 0.0, 7.0, 90.0]) - 7.0).abs() < 1e-15);
    }
}
