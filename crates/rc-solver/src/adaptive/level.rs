//! A level on tiles that is not the finest. It prepares the next one.

use std::sync::Arc;

use rc_core::{Grid, Observer};
use rc_quadtree::ContactFields;

use super::element_heights::element_heights;
use super::mesh::Mesh;
use super::operator::TileCorrections;
use super::prolongation::MeshStart;
use super::setup::Setup;
use crate::descent::{Descent, DescentObserver, Goal, LevelOperators, Outcome, Start};
use crate::solution::LevelInfo;

/// A solved level.
pub(super) struct SolvedLevel {
    pub(super) elements: Mesh,
    pub(super) pressure: Vec<f64>,
    pub(super) gap: Vec<f64>,
    pub(super) outcome: Outcome,
    /// Number of elements whose gap was computed.
    pub(super) evaluated: usize,
    /// Number of elements of the smallest size that would cover these elements.
    ///
    /// On the finest level, all others are proven to be out of contact.
    pub(super) covered: usize,
    pub(super) info: LevelInfo,
}

impl SolvedLevel {
    /// The fields that the refinement rule needs.
    pub(super) fn fields(&self) -> ContactFields<'_> {
        ContactFields {
            elements: self.elements.elements(),
            pressure: &self.pressure,
            beyond: 0.0,
            gap: &self.gap,
            contact_gap: self.outcome.contact_gap,
        }
    }
}

/// Adds the work that `more` counts.
pub(super) fn add_work(info: &mut LevelInfo, more: &LevelInfo) {
    info.iterations += more.iterations;
    info.operator_applications += more.operator_applications;
    info.preconditioner_applications += more.preconditioner_applications;
}

/// Solves only on the elements of the prolonged pressure.
pub(super) fn solve_coarse_level(
    setup: &Setup<'_>,
    grid: Grid,
    start: MeshStart,
    tolerance: f64,
    observer: &dyn Observer,
) -> SolvedLevel {
    let hierarchy = setup.hierarchy(&start.elements, setup.quick.reach());
    let response = setup.quick.tables(grid);
    let mut preconditioner = setup.preconditioner.tables(grid);
    let operators = LevelOperators {
        corrections: Box::new(TileCorrections::new(Arc::clone(&hierarchy), &response, &mut preconditioner)),
        fresh: Box::new(setup.quick_operator(hierarchy, &response, &start)),
    };
    let MeshStart { elements, pressure } = start;
    let heights = element_heights(setup.heights, &elements, None);
    let mut descent = Descent::new(&heights, grid, operators, &setup.problem, Start::Pressure(pressure));
    let goal = Goal { tolerance, max_iterations: setup.params.max_iterations, certify: None };
    let outcome = descent.run(goal, &DescentObserver { observer, mesh: &elements });
    let info = descent.info();
    let (pressure, gap) = descent.into_vectors(0.0);
    SolvedLevel { evaluated: elements.len(), covered: elements.n_finest(), elements, pressure, gap, outcome, info }
}
