//! A scene of the stress table, and the properties that every solved scene must have.

use rc_core::Field;
use rc_solver::Control;

use super::audit::{Audit, load_of_one_element};
use super::row::{Row, Rows, guarded};
use super::solved::{Method, Solved, solve};

/// Tolerance of the scenes.
pub(crate) const TOLERANCE: f64 = 1e-6;

/// Amount by which an audit may exceed the tolerance or the certificate, relative to the height range.
///
/// It allows for the audit's rounding and for the error of the other operator.
const AUDIT_SLACK: f64 = 0.1 * TOLERANCE;

/// Allowed relative error of a prescribed penetration in an audit.
///
/// It allows for rounding of heights and for the error of the other operator.
const SAME_PENETRATION: f64 = 1e-6;

/// Allowed gap of elements with large pressures, relative to the height range.
///
/// A pressure is large from a tenth of the maximum on. The maximum of the measured values is 4 tolerances.
const OPEN: f64 = 10.0 * TOLERANCE;

/// Allowed ratio of iterations to the median over all scenes of the method.
const ITERATION_FACTOR: f64 = 2.0;

/// A contact problem with a name.
#[derive(Clone)]
pub(crate) struct Scene {
    name: String,
    heights: Field,
    method: Method,
    control: Control,
    iteration_factor: f64,
}

impl Scene {
    pub(crate) fn new(name: impl Into<String>, heights: &Field, method: Method, control: Control) -> Self {
        let name = format!("{} {}", method.name(), name.into());
        Self { name, heights: heights.clone(), method, control, iteration_factor: ITERATION_FACTOR }
    }

    /// Marks the scene as solved exactly, without an iteration.
    pub(crate) fn exact(self) -> Self {
        self.slow(0.0)
    }

    /// Marks the scene as slow.
    ///
    /// It may take up to `factor` times the median number of iterations.
    pub(crate) fn slow(self, factor: f64) -> Self {
        Self { iteration_factor: factor, ..self }
    }

    /// Solves the scene and audits it with another operator. Returns the iterations on the finest level.
    fn check(&self, rows: &mut Rows) -> Option<f64> {
        let name = &self.name;
        let solved = guarded(|| {
            let solved = solve(&self.heights, self.method, self.control, TOLERANCE)?;
            let audit = Audit::of(&self.heights, &solved, self.method, self.control)?;
            Ok((solved, audit))
        });
        let (solved, audit) = match solved {
            Ok(solved) => solved,
            Err(error) => {
                rows.holds(name, "solved and audited", "converged", format!("{error:#}"), false);
                return None;
            }
        };
        rows.holds(name, "solved and audited", "converged", "converged", true);
        rows.at_most(name, "pressures not finite or negative", audit.n_bad as f64, 0.0);
        let n_bad = numbers_of(&solved).iter().filter(|value| !value.is_finite()).count();
        rows.at_most(name, "observables not finite", n_bad as f64, 0.0);
        self.check_control(rows, &solved, &audit);
        let certificate = &solved.info.certificate;
        rows.at_most(name, "penetration by audit", audit.penetration, TOLERANCE + AUDIT_SLACK);
        rows.at_most(name, "open contacts by audit", audit.open, OPEN);
        rows.at_most(name, "audit within the certificate", audit.penetration, certificate.penetration + AUDIT_SLACK);
        let claimed = certificate.energy + audit.energy_of(AUDIT_SLACK);
        rows.at_most(name, "energy error within the certificate", audit.energy, claimed);
        Some(solved.info.fine_iterations() as f64)
    }

    /// Checks that the load or the penetration is the prescribed one.
    ///
    /// Under a small prescribed penetration it also checks the load of a single element in contact.
    fn check_control(&self, rows: &mut Rows, solved: &Solved, audit: &Audit) {
        match self.control {
            Control::MeanPressure(_) => rows.at_most(&self.name, "load by audit", audit.load, 1e-10),
            Control::Penetration(penetration) => {
                rows.at_most(&self.name, "penetration against the prescribed one", audit.load, SAME_PENETRATION);
                if let Some(load) = load_of_one_element(&self.heights, self.method, penetration) {
                    let error = (solved.info.mean_pressure / load - 1.0).abs();
                    rows.at_most(&self.name, "load of one element in contact", error, SAME_PENETRATION);
                }
            }
        }
    }
}

/// All numbers of a solution. The stiffness of full contact, which is infinite, is replaced by zero.
fn numbers_of(solved: &Solved) -> [f64; 11] {
    let (info, observables) = (&solved.info, &solved.observables);
    let stiffness = solved.stiffness;
    [
        info.mean_pressure,
        info.penetration,
        info.penetration_full_contact,
        info.elastic_energy,
        info.certificate.penetration,
        info.certificate.load,
        observables.area.fraction,
        observables.rms_pressure,
        observables.max_pressure,
        observables.mean_gap,
        if stiffness == f64::INFINITY { 0.0 } else { stiffness },
    ]
}

/// The name and the scenes of a group.
pub(crate) type Group = (&'static str, Vec<Scene>);

/// Checks all scenes, and compares iterations with the median over all scenes of the method.
pub(crate) fn check(groups: &[Group]) -> Vec<Row> {
    let mut rows = Vec::new();
    let mut counted: Vec<(&'static str, &Scene, f64)> = Vec::new();
    for (group, scenes) in groups {
        let mut of_group = Rows::of(group);
        for scene in scenes {
            counted.extend(scene.check(&mut of_group).map(|iterations| (*group, scene, iterations)));
        }
        rows.extend(of_group.finish());
    }
    for method in Method::ALL {
        let of_method = || counted.iter().filter(move |(_, scene, _)| scene.method == method);
        let median = median(of_method().map(|(.., iterations)| *iterations).collect());
        let mut of_all = Rows::of("iterations");
        of_all.at_most(method.name(), "median iterations", median, method.most_iterations());
        rows.extend(of_all.finish());
        for (group, scene, iterations) in of_method() {
            let mut row = Rows::of(group);
            let property =
                if scene.iteration_factor > ITERATION_FACTOR { "iterations of slow scenes" } else { "iterations" };
            row.at_most(&scene.name, property, *iterations, scene.iteration_factor * median);
            rows.extend(row.finish());
        }
    }
    rows
}

/// The median of the positive values. Zeros are scenes in full contact, which need no iteration.
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
