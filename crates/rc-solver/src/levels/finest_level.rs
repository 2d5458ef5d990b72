//! The finest level: solved to the tolerance, and certified for the whole cell.
//!
//! It takes rounds of two steps. A descent improves the pressure on the elements that press, or nearly do. An
//! evaluation then computes the gap afresh wherever contact is possible. This gives the certificate, and adds elements
//! until bounds exclude contact everywhere else.

use std::ops::Range;
use std::sync::Arc;

use rc_core::{Grid, Observer};
use rc_quadtree::{BLOCK_CELLS, ContactFields};

use crate::descent::info::LevelInfo;
use crate::descent::load::project_to_load;
use crate::descent::operators::{BlockOperator, LevelOperators, write_blocks};
use crate::descent::run::{DescentObserver, Goal};
use crate::descent::state::{Descent, Start};
use crate::descent::values::{ElementHeights, Values};
use crate::levels::coarse_level::{SolvedLevel, add_work};
use crate::levels::evaluation::{CANDIDATE_MARGIN, Evaluated, Evaluation, near_contact, out_of_reach};
use crate::levels::operator_error::PressureScale;
use crate::levels::tile_descent::{StorageTables, TileDescent};
use crate::levels::tiles::TileLevels;
use crate::sliding::newton::Work;
use crate::tiles::element_heights::{block_heights, element_heights};
use crate::tiles::exclusion::SmoothDisplacement;
use crate::tiles::gap_operator::{GapTables, PreparedGap};
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
    levels: &TileLevels<'_>,
    grid: Grid,
    start: MeshStart,
    contact_gap: f64,
    observer: &dyn Observer,
) -> (SolvedLevel, PressureScale) {
    let mut level = FinestLevel::new(levels, grid, start, contact_gap);
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
        if is_stuck || evaluation.outcome.certificate.meets(levels.params.solve.bound) {
            break;
        }
    }
    level.into_solved(evaluation)
}

/// Tables of the operators.
struct OperatorTables {
    quick: Tables<f32>,
    preconditioner: Tables<f32>,
    storage: Option<StorageTables>,
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
    fn choose<'t>(&'t self, levels: &'t TileLevels<'_>, certify: bool) -> (&'t PreparedGap, &'t GapTables) {
        match &self.certificates {
            Some(certified) if certify => (levels.certified(), certified),
            _ => (levels.fresh(), &self.descents),
        }
    }
}

struct FinestLevel<'s, 'a> {
    levels: &'s TileLevels<'a>,
    tables: OperatorTables,
    /// Elements where contact is possible.
    candidates: Mesh,
    /// The pressure of the last descent, or the start before the first descent.
    current: MeshStart,
    info: LevelInfo,
    work: Work,
}

impl<'s, 'a> FinestLevel<'s, 'a> {
    fn new(levels: &'s TileLevels<'a>, grid: Grid, mut start: MeshStart, contact_gap: f64) -> Self {
        let (n_cell, layout) = (grid.len() as f64, start.elements.layout());
        project_to_load(&levels.problem, n_cell, &layout, &mut start.pressure, None);
        let kernels = &levels.data.kernels;
        let preconditioner = kernels.preconditioner().tables(grid);
        let tables = OperatorTables {
            quick: kernels.quick().tables(grid),
            storage: kernels.quick_storage().map(|quick| StorageTables::new(quick.tables(grid), &preconditioner)),
            preconditioner,
            gaps: TablesForGaps {
                descents: levels.fresh().tables(grid),
                certificates: levels.better().map(|better| better.tables(grid)),
            },
        };
        let candidates = first_candidates(levels, &start, &tables.quick, contact_gap);
        let info = LevelInfo { grid, iterations: 0, operator_applications: 0, preconditioner_applications: 0 };
        Self { levels, tables, candidates, current: start, info, work: Work::default() }
    }

    /// Improves the pressure on the elements near contact. Returns whether it reached the tolerance there.
    ///
    /// Fresh gaps come from the operator for certificates if `certify`. The first round uses the operator for descents.
    fn improve(self, evaluation: Evaluation, certify: bool, observer: &dyn Observer) -> (Self, bool) {
        let Self { levels, mut tables, candidates, current, mut info, mut work } = self;
        let tolerance = evaluation.error.goal(levels.params.solve.bound, &levels.problem);
        let near = NearContact::choose(&candidates, &current, evaluation, levels);
        let hierarchy = levels.hierarchy(&near.elements, levels.data.kernels.quick().reach());
        let (prepared, fresh) = tables.gaps.choose(levels, certify);
        let fresh_hierarchy = levels.hierarchy(&near.elements, prepared.reach());
        let storage = tables.storage.as_mut().map(|storage| storage.corrections(Arc::clone(&hierarchy)));
        let operators = LevelOperators {
            corrections: Box::new(TileCorrections::new(hierarchy, &tables.quick, &mut tables.preconditioner)),
            fresh: levels.operator(fresh_hierarchy, fresh, &current),
        };
        drop(current);
        let NearContact { elements, heights, pressure, gap } = near;
        let on_demand = |block, cells: &mut [f64]| {
            cells.fill(out_of_reach(levels, &elements));
            block_heights(&levels.data.heights, (&elements, block), cells);
        };
        let heights = match &heights {
            Some(heights) => ElementHeights::Known(heights),
            None => ElementHeights::OnDemand(elements.n_own(), &on_demand),
        };
        let descent = Descent::new(heights, info.grid, operators, &levels.problem, Start::Known { pressure, gap });
        let mut descent = TileDescent::new(descent, storage);
        let max_iterations = levels.params.solve.max_iterations;
        let goal = |factor: f64| Goal { tolerance: factor * tolerance, max_iterations, certify: None };
        let observer = DescentObserver { observer, mesh: &elements };
        let first = descent.run(goal(FIRST_TOLERANCE), &observer);
        let last = if observer.observer.should_stop() {
            // The gap is evaluated next in any case.
            first
        } else {
            // Without a step, the gap is as fresh as before, and comes from a better operator.
            if descent.info().iterations > 0 || levels.better().is_none() {
                descent.refresh();
            }
            descent.run(goal(LAST_TOLERANCE), &observer)
        };
        let reached = last.converged && !observer.observer.should_stop();
        add_work(&mut info, &descent.info());
        work = work.plus(descent.work());
        let pressure = descent.into_descent().into_pressure();
        let (is_rounded, mut pressure) = (pressure.is_single(), pressure.into_all());
        if is_rounded {
            project_to_load(&levels.problem, info.grid.len() as f64, &elements.layout(), &mut pressure, None);
        }
        let current = MeshStart { elements, pressure };
        (Self { levels, tables, candidates, current, info, work }, reached)
    }

    /// The gap on all candidates, and the displacement of the base grid.
    ///
    /// They come from the operator for certificates if `certify`, otherwise from the one for descents.
    fn evaluate(&self, certify: bool) -> (Evaluation, Vec<f64>) {
        let Self { levels, tables, candidates, current, info, .. } = self;
        let evaluated = Evaluated { levels, grid: info.grid, elements: candidates, current };
        evaluated.evaluate(tables.gaps.choose(levels, certify))
    }

    /// The gap on all candidates, for the choice of those near contact.
    fn evaluate_candidates(&mut self) -> Evaluation {
        self.info.operator_applications += 1;
        self.evaluate(false).0
    }

    /// Evaluates the gap, and adds candidates until no contact is possible elsewhere.
    fn evaluate_whole_cell(&mut self) -> Evaluation {
        loop {
            self.info.operator_applications += 1;
            let (evaluation, base) = self.evaluate(true);
            let more = self.with_more_candidates(&evaluation, base);
            if more.n_cells() <= self.candidates.n_cells() {
                return evaluation;
            }
            self.candidates = more;
        }
    }

    /// The elements of the candidates, with more elements where they are needed.
    ///
    /// Elements are divided where they are too coarse. Tiles of the coarsest level are added wherever contact is
    /// possible.
    fn with_more_candidates(&self, evaluation: &Evaluation, mut base: Vec<f64>) -> Mesh {
        let (levels, elements) = (self.levels, &self.candidates);
        let Evaluation { pressed, gap, outcome, error, scaling, .. } = evaluation;
        let MeshStart { elements: pressing, pressure } = pressed.as_ref().unwrap_or(&self.current);
        for v in &mut base {
            *v *= scaling;
        }
        let smooth = SmoothDisplacement {
            values: &base,
            curvature: levels.certified().remainder_curvature() * pressing.layout().maximum(pressure, 0.0),
            error: EXCLUSION_MARGIN * error.displacement,
        };
        let places = levels.possible_contact(&smooth, elements.coarsest().extent(), outcome.contact_gap);
        if elements.levels().len() == 1 {
            return Mesh::new(elements.with(&places), levels.ranks());
        }
        let elements = elements.elements();
        let fields =
            ContactFields { elements, pressure, beyond: 0.0, gap: &gap.all(), contact_gap: outcome.contact_gap };
        levels.refined(&fields, false).with(&places).into()
    }

    fn into_solved(self, evaluation: Evaluation) -> (SolvedLevel, PressureScale) {
        let Self { candidates, current, info, work, .. } = self;
        let Evaluation { pressed, kept, gap, outcome, scale, .. } = evaluation;
        let pressed = pressed.unwrap_or(current);
        let (evaluated, covered) = (candidates.n_cells(), candidates.n_finest());
        let elements = kept.unwrap_or(candidates);
        let pressure = pressed.elements.moved(&elements, &pressed.pressure, 0.0);
        // The pressure is not kept twice beside the gap.
        drop(pressed);
        let gap = gap.into_all();
        (SolvedLevel { elements, pressure, gap, outcome, evaluated, covered, info, work }, scale)
    }
}

/// Elements where the start may touch according to the quick operator.
fn first_candidates(levels: &TileLevels<'_>, start: &MeshStart, tables: &Tables<f32>, contact_gap: f64) -> Mesh {
    let MeshStart { elements, pressure } = start;
    let mut quick =
        levels.quick_operator(levels.hierarchy(elements, levels.data.kernels.quick().reach()), tables, start);
    write_blocks(&mut quick, pressure.chunks(BLOCK_CELLS), |p, cells| cells.copy_from_slice(p));
    quick.apply();
    // Contact is not nearer than the first touch, even if coarser heights reach beyond the highest point.
    let first_touch = levels.problem.offset() - levels.problem.h_max;
    // This is not a proof yet. The margin also stands for the quick operator's error.
    let gap = contact_gap.max(first_touch) + CANDIDATE_MARGIN * levels.largest_displacement(start, contact_gap);
    let curvature = levels.data.kernels.quick().remainder_curvature() * elements.layout().maximum(pressure, 0.0);
    let smooth = SmoothDisplacement { values: &quick.base_displacement(), curvature, error: 0.0 };
    let places = levels.possible_contact(&smooth, elements.coarsest().extent(), gap);
    Mesh::new(elements.with(&places), levels.ranks())
}

/// The candidates that a descent works on.
///
/// These are elements that press or nearly press, or did so when the round began.
struct NearContact {
    elements: Mesh,
    /// `None` if they are put together on demand.
    heights: Option<Vec<f64>>,
    pressure: Values,
    gap: Values,
}

impl NearContact {
    /// Chooses the candidates near contact, among which are those of the last descent.
    ///
    /// `current` is the pressure that was evaluated.
    fn choose(candidates: &Mesh, current: &MeshStart, evaluation: Evaluation, levels: &TileLevels<'_>) -> Self {
        let Evaluation { pressed, kept, gap, outcome, .. } = evaluation;
        let candidates = kept.as_ref().unwrap_or(candidates);
        let near = near_contact(&outcome, levels, kept.is_some());
        // No other elements than those of the last descent press, unless pressures were brought to all candidates.
        let on_all = pressed.as_ref().filter(|pressed| pressed.pressure.len() == gap.len());
        let is_near = |sides: [usize; 2], place: [u32; 2], mut cells: Range<usize>| {
            current.elements.has(sides, place)
                || cells.any(|i| gap.at(i) < near || on_all.is_some_and(|pressed| pressed.pressure[i] > 0.0))
        };
        let elements = candidates.chosen(is_near);
        // The vectors are moved one after the other. Nothing presses on values that fill up a level.
        let lowest = out_of_reach(levels, &elements);
        let spares = levels.spares(elements.n_cells());
        let as_spared = |values: Values, origin| match (spares, values.is_single()) {
            (true, false) => values.to_single(origin),
            (false, true) => Values::Double(values.into_all()),
            _ => values,
        };
        let moved_gap = candidates.moved_vector(&elements, &gap, levels.problem.offset() - lowest);
        drop(gap);
        let gap = as_spared(moved_gap, outcome.contact_gap);
        let MeshStart { elements: pressing, pressure } = pressed.as_ref().unwrap_or(current);
        let pressure = as_spared(Values::Double(pressing.moved(&elements, pressure, 0.0)), 0.0);
        // On demand they take a tenth of the time of the descent. Up to twice the number they are kept.
        let are_kept = !levels.spares(elements.n_cells() / 2);
        let heights = are_kept.then(|| element_heights(&levels.data.heights, &elements, lowest));
        Self { elements, heights, pressure, gap }
    }
}

#[cfg(test)]
mod tests {
    use std::f64::consts::TAU;

    use rc_core::testing::quasi_random;
    use rc_core::{Field, HeightSource, Silent};
    use rc_kernel::{HalfSpace, Love};

    use super::*;
    use crate::levels::params::AdaptiveParams;
    use crate::levels::tiles::prepare;
    use crate::problem::contact_problem::ContactProblem;
    use crate::problem::control::Control;
    use crate::problem::params::IterationParams;
    use crate::problem::tolerance::ErrorBound;

    /// What single precision, heights on demand and streamed gaps change is within the errors of the iteration.
    #[test]
    fn a_solve_that_spares_memory_finds_the_same_contact() {
        let waves: Vec<[f64; 4]> = (0..60)
            .map(|i| {
                let [x, y] = [2 * i, 2 * i + 1].map(|i| (24.0 * quasi_random(i) - 12.0).round());
                [x, y, (1.0 + x * x + y * y).powf(-0.9), TAU * quasi_random(i + 500)]
            })
            .collect();
        let heights = Field::from_fn(Grid::square(512).expect("a grid"), |at| {
            waves.iter().map(|[x, y, size, phase]| 1e-2 * size * (TAU * (x * at.x + y * at.y) + phase).cos()).sum()
        });
        let bound = ErrorBound::Energy(1e-2);
        let [usual, spared] = [usize::MAX, 0].map(|spare_above| {
            let params = AdaptiveParams {
                solve: IterationParams { bound, max_iterations: 200 },
                operator_error: 1e-6,
                spare_above,
                border_level: 0,
                base_side: None,
                memory_limit: None,
            };
            let data = Arc::new(prepare(HeightSource::Map(&heights), &Love, &HalfSpace, &params).expect("heights"));
            let problem = ContactProblem::new(&heights, Control::MeanPressure(2e-3)).with_kernel(&Love);
            let levels = TileLevels::new(&data, &problem, &params).expect("a problem");
            assert_eq!(levels.spares(1000), spare_above == 0);
            levels.solve(false, &Silent).expect("a contact for tiles")
        });
        // Errors of such quantities are below the square of the energy error (Certificate::energy), in both solutions.
        for (name, usual, spared) in [
            ("area", usual.area.fraction, spared.area.fraction),
            ("penetration", usual.info.penetration, spared.info.penetration),
            ("energy", usual.info.elastic_energy, spared.info.elastic_energy),
        ] {
            assert!(usual.to_bits() != spared.to_bits(), "{name}: memory was not spared");
            assert!((spared / usual - 1.0).abs() < 2e-4, "{name}: {spared} for {usual}");
        }
        for solution in [usual, spared] {
            assert!(solution.converged && solution.info.certificate.meets(bound), "{}", solution.info.certificate);
        }
    }
}
