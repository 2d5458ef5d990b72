//! The finest level: solved to the tolerance, and certified for the whole cell.
//!
//! It takes rounds of two steps. A descent improves the pressure on the elements that press, or nearly do. An
//! evaluation then computes the gap afresh wherever contact is possible. This gives the certificate, and adds elements
//! until bounds exclude contact everywhere else.

use std::ops::Range;

use rayon::prelude::*;
use rc_core::{Grid, Observer};
use rc_quadtree::{BLOCK_CELLS, ContactFields};

use crate::descent::gap::{fresh_gap, rescale};
use crate::descent::info::LevelInfo;
use crate::descent::load::{has_drifted, project_to_load};
use crate::descent::operators::{BlockOperator, LevelOperators, write_blocks};
use crate::descent::outcome::Outcome;
use crate::descent::rows::ElementValues;
use crate::descent::run::{DescentObserver, Goal};
use crate::descent::state::{Descent, Start};
use crate::descent::sums::GapSums;
use crate::levels::level::{SolvedLevel, add_work};
use crate::levels::operator_error::{OperatorError, PressureScale};
use crate::levels::setup::Setup;
use crate::tiles::element_heights::element_heights;
use crate::tiles::exclusion::SmoothDisplacement;
use crate::tiles::gap_operator::{GapOperator, GapTables, PreparedGap};
use crate::tiles::mesh::Mesh;
use crate::tiles::operator::corrections::TileCorrections;
use crate::tiles::operator::tables::Tables;
use crate::tiles::prolongation::MeshStart;

/// Multiple of the tolerance to which the finest level is first solved.
///
/// The gap is computed afresh after that. The reason is that corrections come from the quick operator, which is a few
/// percent off on pressures as rough as corrections.
const FIRST_TOLERANCE: f64 = 20.0;

/// Error that is left to the fresh gap when corrections end, relative to the tolerance.
///
/// Two fresh gaps of one pressure, computed on different tiles, differ a little. The maximum difference over ten
/// million elements is about a tenth of the tolerance.
const LAST_TOLERANCE: f64 = 0.7;

/// Maximum number of rounds of descents and evaluations.
///
/// Each round but the first starts with elements that the last one has missed. One round is the rule, and two are the
/// exception.
const MAX_ROUNDS: usize = 20;

/// Margin for the choice of candidates for contact, in units of the penetration.
///
/// Small changes of the pressure then do not add others.
const CANDIDATE_MARGIN: f64 = 7e-3;

/// Error of the smooth displacement that the exclusion of contact allows for.
///
/// The displacement is that on the base grid. The unit is the bound on the error of displacements ([`OperatorError`]).
/// The error was measured to be within it (test `the_smooth_displacement_is_as_exact_as_the_others`).
const EXCLUSION_MARGIN: f64 = 2.0;

/// Solves to the tolerance from `start`, and proves the solution for the whole cell.
///
/// The gap in contact of the start is `contact_gap`. The second result is the scale on which the error of an operator
/// depends.
pub(super) fn solve_finest_level(
    setup: &Setup<'_>,
    grid: Grid,
    start: MeshStart,
    contact_gap: f64,
    observer: &dyn Observer,
) -> (SolvedLevel, PressureScale) {
    let mut level = FinestLevel::new(setup, grid, start, contact_gap);
    if observer.should_stop() {
        let evaluation = level.evaluate_whole_cell();
        return level.into_solved(evaluation);
    }
    let mut evaluation = level.evaluate_candidates();
    for round in 0..MAX_ROUNDS {
        let before = level.info.iterations;
        let reached;
        (level, reached) = level.improve(evaluation, round > 0, observer);
        evaluation = level.evaluate_whole_cell();
        // In a later round without a step, the iteration has reached its goal. The rest is the error of the operator.
        let is_stuck = !reached || round > 0 && level.info.iterations == before;
        if is_stuck || evaluation.outcome.certificate.meets(setup.params.bound) {
            break;
        }
    }
    level.into_solved(evaluation)
}

/// Elements where contact is possible, with their heights.
struct Candidates {
    elements: Mesh,
    heights: Vec<f64>,
}

/// Pressure and gap on all candidates, and the certificate that follows from them.
struct Evaluation {
    pressure: Vec<f64>,
    gap: Vec<f64>,
    /// Outcome with a certificate that includes the error of the certifying operator.
    outcome: Outcome,
    scale: PressureScale,
    error: OperatorError,
    /// Factor by which pressure and gap were scaled after the application of the operator.
    scaling: f64,
}

/// Tables of the operators.
struct OperatorTables {
    quick: Tables<f32>,
    preconditioner: Tables<f32>,
    gaps: TablesForGaps,
}

/// Tables of the operators for fresh gaps.
struct TablesForGaps {
    descents: GapTables,
    /// Tables for certificates, if they differ from those for descents.
    certificates: Option<GapTables>,
}

impl TablesForGaps {
    /// The operator for certificates if `certify`, otherwise the operator for descents.
    fn choose<'t>(&'t self, setup: &'t Setup<'_>, certify: bool) -> (&'t PreparedGap, &'t GapTables) {
        match &self.certificates {
            Some(certified) if certify => (setup.certified(), certified),
            _ => (setup.fresh, &self.descents),
        }
    }
}

/// The maximum |v| of elements with these heights and gaps.
///
/// c in `g = v - h + c` is `offset`.
fn maximum_displacement(mesh: &Mesh, heights: &[f64], gap: &[f64], offset: f64) -> f64 {
    let pairs = heights.par_iter().zip(gap);
    let own = pairs.map(|(h, g)| (g + (h - offset)).abs()).reduce(|| 0.0, f64::max);
    mesh.ranks().maximum(own, 0.0)
}

struct FinestLevel<'s, 'a> {
    setup: &'s Setup<'a>,
    tables: OperatorTables,
    candidates: Candidates,
    /// The pressure of the last descent, or the start before the first descent.
    current: MeshStart,
    info: LevelInfo,
}

impl<'s, 'a> FinestLevel<'s, 'a> {
    fn new(setup: &'s Setup<'a>, grid: Grid, mut start: MeshStart, contact_gap: f64) -> Self {
        let (n_cell, layout) = (grid.len() as f64, start.elements.layout());
        project_to_load(&setup.problem, n_cell, &layout, &mut start.pressure, None);
        let tables = OperatorTables {
            quick: setup.quick.tables(grid),
            preconditioner: setup.preconditioner.tables(grid),
            gaps: TablesForGaps {
                descents: setup.fresh.tables(grid),
                certificates: setup.better.map(|better| better.tables(grid)),
            },
        };
        let candidates = first_candidates(setup, &start, &tables.quick, contact_gap);
        let info = LevelInfo { grid, iterations: 0, operator_applications: 0, preconditioner_applications: 0 };
        Self { setup, tables, candidates, current: start, info }
    }

    /// Improves the pressure on the elements near contact. Returns whether it reached the tolerance there.
    ///
    /// Fresh gaps come from the operator for certificates if `certify`. The first round uses the operator for descents.
    fn improve(self, evaluation: Evaluation, certify: bool, observer: &dyn Observer) -> (Self, bool) {
        let Self { setup, mut tables, mut candidates, current, mut info } = self;
        let tolerance = evaluation.error.goal(setup.params.bound, &setup.problem);
        let near = NearContact::choose(&mut candidates, &current.elements, evaluation, setup);
        let hierarchy = setup.hierarchy(&near.elements, setup.quick.reach());
        let (prepared, fresh) = tables.gaps.choose(setup, certify);
        let fresh_hierarchy = setup.hierarchy(&near.elements, prepared.reach());
        let operators = LevelOperators {
            corrections: Box::new(TileCorrections::new(hierarchy, &tables.quick, &mut tables.preconditioner)),
            fresh: setup.operator(fresh_hierarchy, fresh, &current),
        };
        drop(current);
        let start = Start::Known { pressure: near.pressure, gap: near.gap };
        let mut descent = Descent::new(&near.heights, info.grid, operators, &setup.problem, start);
        let max_iterations = setup.params.max_iterations;
        let goal = |factor: f64| Goal { tolerance: factor * tolerance, max_iterations, certify: None };
        let observer = DescentObserver { observer, mesh: &near.elements };
        let first = descent.run(goal(FIRST_TOLERANCE), &observer);
        let last = if observer.observer.should_stop() {
            // The gap is evaluated next in any case.
            first
        } else {
            // Without a step, the gap is as fresh as before, and comes from a better operator.
            if descent.info().iterations > 0 || setup.better.is_none() {
                descent.refresh();
            }
            descent.run(goal(LAST_TOLERANCE), &observer)
        };
        let reached = last.converged && !observer.observer.should_stop();
        add_work(&mut info, &descent.info());
        let pressure = descent.into_pressure();
        candidates.heights = candidate_heights(setup, &candidates.elements, Some((&near.elements, &near.heights)));
        let current = MeshStart { elements: near.elements, pressure };
        (Self { setup, tables, candidates, current, info }, reached)
    }

    /// The gap on all candidates, and the operator that computed it.
    ///
    /// The operator is the one for certificates if `certify`, otherwise the one for descents.
    fn evaluate(&self, certify: bool) -> (Evaluation, Box<dyn GapOperator + '_>) {
        let Self { setup, tables, candidates: Candidates { elements, heights }, current, info } = self;
        let (prepared, tables) = tables.gaps.choose(setup, certify);
        let mut pressure = current.elements.moved(elements, &current.pressure, 0.0);
        let mut gap = vec![0.0; pressure.len()];
        let (n_cell, layout) = (info.grid.len() as f64, elements.layout());
        if has_drifted(setup.problem.bounds, n_cell, &layout, &pressure) {
            project_to_load(&setup.problem, n_cell, &layout, &mut pressure, None);
        }
        let hierarchy = setup.hierarchy(elements, prepared.reach());
        let mut operator = setup.operator(hierarchy, tables, current);
        let empty = GapSums::empty(f64::INFINITY, setup.problem.bounds.hardness);
        let values = ElementValues { heights, pressure: &mut pressure, gap: &mut gap };
        let mut sums = fresh_gap(&mut *operator, &setup.problem, values, empty);
        let scaling = sums.scale_to_penetration(&setup.problem);
        if let Some(scale) = scaling {
            let values = ElementValues { heights, pressure: &mut pressure, gap: &mut gap };
            sums = rescale(scale, &elements.layout(), &setup.problem, values, empty);
        }
        let mut outcome = Outcome::new(&setup.problem, &sums, info.grid.len() as f64, true);
        let size = maximum_displacement(elements, heights, &gap, setup.problem.offset());
        let n_levels = setup.n_levels(info.grid);
        let scale = PressureScale::new((elements, &pressure), n_levels, size, outcome.energy_length());
        // Descents leave room for the error of the certifying operator.
        let error = OperatorError::of(setup.certified().split(), &scale, setup.problem.bounds.control);
        outcome.iteration_error = outcome.certificate.energy;
        outcome.certificate = error.added_to(outcome.certificate, setup.problem.h_range);
        (Evaluation { pressure, gap, outcome, scale, error, scaling: scaling.unwrap_or(1.0) }, operator)
    }

    /// The gap on all candidates.
    fn evaluate_candidates(&mut self) -> Evaluation {
        self.info.operator_applications += 1;
        self.evaluate(false).0
    }

    /// Evaluates the gap, and adds candidates until no contact is possible elsewhere.
    fn evaluate_whole_cell(&mut self) -> Evaluation {
        loop {
            self.info.operator_applications += 1;
            let (evaluation, operator) = self.evaluate(true);
            let more = self.with_more_candidates(&evaluation, &*operator);
            if more.n_cells() <= self.candidates.elements.n_cells() {
                return evaluation;
            }
            drop(operator);
            self.candidates = Candidates::new(self.setup, more);
        }
    }

    /// The elements of the candidates, with more elements where they are needed.
    ///
    /// Elements are divided where they are too coarse. Tiles of the coarsest level are added wherever contact is
    /// possible.
    fn with_more_candidates(&self, evaluation: &Evaluation, operator: &dyn GapOperator) -> Mesh {
        let (setup, elements) = (self.setup, &self.candidates.elements);
        let Evaluation { pressure, gap, outcome, error, scaling, .. } = evaluation;
        let mut values = operator.base_displacement();
        for v in &mut values {
            *v *= scaling;
        }
        let smooth = SmoothDisplacement {
            values: &values,
            curvature: setup.certified().remainder_curvature() * elements.layout().maximum(pressure, 0.0),
            error: EXCLUSION_MARGIN * error.displacement,
        };
        let places = setup.possible_contact(&smooth, elements.coarsest().extent(), outcome.contact_gap);
        if elements.levels().len() == 1 {
            return Mesh::new(elements.with(&places), setup.ranks);
        }
        let elements = elements.elements();
        let fields = ContactFields { elements, pressure, beyond: 0.0, gap, contact_gap: outcome.contact_gap };
        setup.refined(&fields, false).with(&places).into()
    }

    fn into_solved(self, evaluation: Evaluation) -> (SolvedLevel, PressureScale) {
        let Self { candidates: Candidates { elements, .. }, info, .. } = self;
        let Evaluation { pressure, gap, outcome, scale, .. } = evaluation;
        let (evaluated, covered) = (elements.n_cells(), elements.n_finest());
        (SolvedLevel { elements, pressure, gap, outcome, evaluated, covered, info }, scale)
    }
}

impl Candidates {
    fn new(setup: &Setup<'_>, elements: Mesh) -> Self {
        Self { heights: candidate_heights(setup, &elements, None), elements }
    }
}

/// The heights of `elements`, of which some may be `known`.
fn candidate_heights(setup: &Setup<'_>, elements: &Mesh, known: Option<(&Mesh, &[f64])>) -> Vec<f64> {
    element_heights(setup.heights, elements, known, out_of_reach(setup, elements))
}

/// The height of values that stand for no element.
fn out_of_reach(setup: &Setup<'_>, elements: &Mesh) -> f64 {
    setup.problem.out_of_reach(elements.finest().sides().into_iter().product())
}

/// Elements where the start may touch according to the quick operator.
fn first_candidates(setup: &Setup<'_>, start: &MeshStart, tables: &Tables<f32>, contact_gap: f64) -> Candidates {
    let MeshStart { elements, pressure } = start;
    let mut quick = setup.quick_operator(setup.hierarchy(elements, setup.quick.reach()), tables, start);
    write_blocks(&mut quick, pressure.chunks(BLOCK_CELLS), |p, cells| cells.copy_from_slice(p));
    quick.apply();
    // Contact is not nearer than the first touch, even if coarser heights reach beyond the highest point.
    let first_touch = setup.problem.offset() - setup.problem.h_max;
    // This is not a proof yet. The margin also stands for the quick operator's error.
    let gap = contact_gap.max(first_touch) + CANDIDATE_MARGIN * setup.penetration(contact_gap).abs();
    let curvature = setup.quick.remainder_curvature() * elements.layout().maximum(pressure, 0.0);
    let smooth = SmoothDisplacement { values: &quick.base_displacement(), curvature, error: 0.0 };
    let places = setup.possible_contact(&smooth, elements.coarsest().extent(), gap);
    Candidates::new(setup, Mesh::new(elements.with(&places), setup.ranks))
}

/// The candidates that a descent works on.
///
/// These are elements that press or nearly press, or did so when the round began.
struct NearContact {
    elements: Mesh,
    heights: Vec<f64>,
    pressure: Vec<f64>,
    gap: Vec<f64>,
}

impl NearContact {
    /// Chooses the candidates near contact. `before` are the elements of the last descent.
    ///
    /// The candidates lose their heights, because descents need the memory.
    fn choose(candidates: &mut Candidates, before: &Mesh, evaluation: Evaluation, setup: &Setup<'_>) -> Self {
        let Evaluation { pressure, gap, outcome, .. } = evaluation;
        // Elements that are nearer to contact than the error may still come into contact.
        let error = match outcome.mean_pressure {
            // If coarser levels have lost a contact that they hardly resolve, there is no pressure. The contact begins
            // anew.
            0.0 => CANDIDATE_MARGIN * (setup.problem.h_max - setup.problem.h_mean),
            _ => outcome.certificate.penetration * setup.problem.h_range,
        };
        let near = outcome.contact_gap + error;
        let is_near = |sides: [usize; 2], place: [u32; 2], mut cells: Range<usize>| {
            before.has(sides, place) || cells.any(|i| pressure[i] > 0.0 || gap[i] < near)
        };
        let elements = candidates.elements.chosen(is_near);
        // The vectors are moved one after the other. Nothing presses on values that fill up a level.
        let lowest = out_of_reach(setup, &elements);
        let chosen = |values: Vec<f64>, elsewhere: f64| candidates.elements.moved(&elements, &values, elsewhere);
        let heights = chosen(std::mem::take(&mut candidates.heights), lowest);
        let (gap, pressure) = (chosen(gap, setup.problem.offset() - lowest), chosen(pressure, 0.0));
        Self { elements, heights, pressure, gap }
    }
}
