//! A scene of the stress table, and the properties that every solved scene must have.

use anyhow::Result;
use rc_core::Field;
use rc_solver::{Control, LevelInfo, SolveInfo};

use super::audit::{Audit, load_of_one_element};
use super::row::{Row, Rows, guarded};
use super::solved::{Method, Solved, solve};

/// Default tolerance of a scene.
pub(crate) const TOLERANCE: f64 = 1e-6;

/// Amount by which an audit may exceed the tolerance, relative to the tolerance.
///
/// It allows for the audit's rounding and for the error of the other operator.
const AUDIT_SLACK: f64 = 0.1;

/// Allowed relative error of a prescribed penetration in an audit.
///
/// It allows for rounding of heights and for the error of the other operator.
const SAME_PENETRATION: f64 = 1e-6;

/// Allowed gap of elements with large pressures, as a multiple of the tolerance.
///
/// A pressure is large from a tenth of the maximum on. The maximum of the measured values is 4.
const OPEN_PER_TOLERANCE: f64 = 10.0;

/// Allowed ratio of iterations to the median over all scenes of the method.
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

    /// Marks the scene as solved exactly, without an iteration.
    pub(crate) fn exact(self) -> Self {
        Self { iteration_factor: 0.0, ..self }
    }

    /// Marks the scene as slow.
    ///
    /// It may take up to `factor` times the median number of iterations.
    pub(crate) fn slow(self, factor: f64) -> Self {
        Self { iteration_factor: factor, ..self }
    }

    pub(crate) fn solve(&self) -> Result<Solved> {
        guarded(|| solve(&self.heights, self.method, self.control, self.tolerance))
    }

    /// Solves the scene and audits it with another operator. Returns the work.
    fn check(&self, rows: &mut Rows) -> Option<Work> {
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
        self.check_control(rows, &solved, &audit);
        let bound = (1.0 + self.slack) * self.tolerance;
        rows.at_most(&self.name, "penetration by audit", audit.penetration, bound);
        rows.at_most(&self.name, "open contacts by audit", audit.open, OPEN_PER_TOLERANCE * self.tolerance);
        let backed = info.certificate.penetration + self.slack * self.tolerance;
        rows.at_most(&self.name, "audit within the certificate", audit.penetration, backed);
        let claimed = info.certificate.energy + audit.energy_of(self.slack * self.tolerance);
        rows.at_most(&self.name, "energy error within the certificate", audit.energy, claimed);
        Some(Work::of(info))
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

/// The iterations of a solve.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Work {
    /// Iterations on the finest level.
    finest: f64,
    /// Iterations on all levels, weighted with the ratio of a level's elements to those of the finest level.
    all: f64,
}

impl Work {
    pub(crate) fn of(info: &SolveInfo) -> Self {
        let finest = info.levels.last().map_or(1, |level| level.grid.len()) as f64;
        let share = |level: &LevelInfo| level.iterations as f64 * level.grid.len() as f64 / finest;
        Self { finest: info.fine_iterations() as f64, all: info.levels.iter().map(share).sum() }
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

/// A count of [`Work`], with its names and the factor of its bound.
///
/// The names in the table are for ordinary scenes, for slow scenes and for the median. The factor is above 1 for all
/// levels, since coarser grids of a slow scene are slow too: 1.06 was measured.
type Count = ([&'static str; 3], fn(&Work) -> f64, f64);

const COUNTS: [Count; 2] = [
    (["iterations", "iterations of slow scenes", "median iterations"], |work| work.finest, 1.0),
    (
        ["iterations of all levels", "iterations of all levels of slow scenes", "median iterations of all levels"],
        |work| work.all,
        1.1,
    ),
];

/// Checks all scenes, and compares iterations with the median over all scenes of the method.
pub(crate) fn check(groups: &[Group]) -> Vec<Row> {
    let mut rows = Vec::new();
    let mut counted: Vec<(&'static str, &Scene, Work)> = Vec::new();
    for (group, scenes) in groups {
        let mut of_group = Rows::of(group);
        for scene in scenes {
            counted.extend(scene.check(&mut of_group).map(|work| (*group, scene, work)));
        }
        rows.extend(of_group.finish());
    }
    for ([ordinary, slow, ordinary_median], count, allowance) in COUNTS {
        let (mut medians, mut of_all) = (Vec::<(Method, f64)>::new(), Rows::of("iterations"));
        for (group, scene, work) in &counted {
            let known = medians.iter().find(|(method, _)| *method == scene.method).map(|(_, median)| *median);
            let median = known.unwrap_or_else(|| {
                let of_method = counted.iter().filter(|(_, other, _)| other.method == scene.method);
                let median = median(of_method.map(|(_, _, work)| count(work)).collect());
                medians.push((scene.method, median));
                of_all.at_most(scene.method.name(), ordinary_median, median, scene.method.most_iterations());
                median
            });
            let mut row = Rows::of(group);
            let property = if scene.iteration_factor > ITERATION_FACTOR { slow } else { ordinary };
            row.at_most(&scene.name, property, count(work), allowance * scene.iteration_factor * median);
            rows.extend(row.finish());
        }
        rows.extend(of_all.finish());
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
