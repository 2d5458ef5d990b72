//! A level on tiles that is not the finest. It prepares the next one.

use std::sync::Arc;

use rc_core::{Grid, Observer};
use rc_quadtree::ContactFields;

use crate::descent::info::LevelInfo;
use crate::descent::operators::LevelOperators;
use crate::descent::outcome::Outcome;
use crate::descent::run::{DescentObserver, Goal};
use crate::descent::state::{Descent, Start};
use crate::levels::tile_descent::{StorageTables, TileDescent};
use crate::levels::tiles::TileLevels;
use crate::sliding::newton::Work;
use crate::tiles::element_heights::element_heights;
use crate::tiles::mesh::Mesh;
use crate::tiles::operator::corrections::TileCorrections;
use crate::tiles::prolongation::MeshStart;

/// A solved level.
pub(crate) struct SolvedLevel {
    pub(crate) elements: Mesh,
    pub(crate) pressure: Vec<f64>,
    pub(crate) gap: Vec<f64>,
    pub(crate) outcome: Outcome,
    /// Number of elements whose gap was computed.
    pub(crate) evaluated: usize,
    /// Number of elements of the smallest size that would cover these elements.
    ///
    /// On the finest level, all others are proven to be out of contact.
    pub(crate) covered: usize,
    pub(crate) info: LevelInfo,
    /// The work of Newton's method under a sliding surface.
    pub(crate) work: Work,
}

impl SolvedLevel {
    /// The fields that the refinement rule needs.
    pub(crate) fn fields(&self) -> ContactFields<'_> {
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
pub(crate) fn add_work(info: &mut LevelInfo, more: &LevelInfo) {
    info.iterations += more.iterations;
    info.operator_applications += more.operator_applications;
    info.preconditioner_applications += more.preconditioner_applications;
}

/// Solves only on the elements of the prolonged pressure.
pub(crate) fn solve_coarse_level(
    levels: &TileLevels<'_>,
    grid: Grid,
    start: MeshStart,
    goal: Goal,
    observer: &dyn Observer,
) -> SolvedLevel {
    let kernels = &levels.data.kernels;
    let hierarchy = levels.hierarchy(&start.elements, kernels.quick().reach());
    let response = kernels.quick().tables(grid);
    let mut preconditioner = kernels.preconditioner().tables(grid);
    let mut storage = kernels.quick_storage().map(|quick| StorageTables::new(quick.tables(grid), &preconditioner));
    let storage = storage.as_mut().map(|storage| storage.corrections(Arc::clone(&hierarchy)));
    let operators = LevelOperators {
        corrections: Box::new(TileCorrections::new(Arc::clone(&hierarchy), &response, &mut preconditioner)),
        fresh: Box::new(levels.quick_operator(hierarchy, &response, &start)),
    };
    let MeshStart { elements, pressure } = start;
    let heights = element_heights(&levels.data.heights, &elements, levels.problem.out_of_reach(grid.len()));
    let descent = Descent::new(&*heights, grid, operators, &levels.problem, Start::Pressure(pressure));
    let mut descent = TileDescent::new(descent, storage);
    let outcome = descent.run(goal, &DescentObserver { observer, mesh: &elements });
    let (info, work) = (descent.info(), descent.work());
    let (pressure, gap) = descent.into_descent().into_vectors(0.0);
    let (evaluated, covered) = (elements.len(), elements.n_finest());
    SolvedLevel { elements, pressure, gap, outcome, evaluated, covered, info, work }
}
