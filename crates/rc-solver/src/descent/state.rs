//! Pressure and gap on one level, and the functions that improve them.

use std::borrow::Cow;

use rc_core::{Boundary, Field, Grid};

use crate::descent::directions::ConjugateDirections;
use crate::descent::gap::{fresh_gap, rescale};
use crate::descent::info::{GridSolution, LevelInfo, LevelValues, Status};
use crate::descent::layout::BlockLayout;
use crate::descent::operators::LevelOperators;
use crate::descent::outcome::Outcome;
use crate::descent::sums::GapSums;
use crate::descent::values::{ElementHeights, ElementVectors, Values};
use crate::problem::checked::Problem;

/// The start of a descent.
pub(crate) enum Start {
    /// The overlap with the rigid surface.
    Nothing,
    /// This pressure, up to a factor.
    Pressure(Vec<f64>),
    /// This pressure, whose gap is known.
    Known { pressure: Values, gap: Values },
}

/// What the displacement in the gap follows.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Follows {
    /// The pressure: v = L p.
    Pressure,
    /// Changes of the pressure only. Scaling a pressure does not scale the displacement then.
    Changes,
}

/// Rounds whose direction is the residual, without the approximate inverse.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct PlainRounds {
    /// Number of such rounds from now on.
    pub(crate) rounds: u32,
    /// Their number the last time.
    pub(crate) next: u32,
}

/// Pressure, gap and everything that one level needs to improve them.
pub(crate) struct Descent<'a> {
    pub(crate) problem: &'a Problem,
    pub(crate) layout: BlockLayout,
    pub(crate) operators: LevelOperators<'a>,
    pub(crate) heights: ElementHeights<'a>,
    pub(crate) pressure: Values,
    pub(crate) gap: Values,
    pub(crate) directions: ConjugateDirections,
    /// ⟨t, L t⟩ of the last step. Infinite if the next direction need not be conjugate to another.
    pub(crate) curvature: f64,
    /// Factor of the length of steps. It is 1 unless rounds would raise the energy.
    pub(crate) step_factor: f64,
    /// Rounds that follow the residual itself.
    pub(crate) plain: PlainRounds,
    /// Whether the last projection has chosen the active elements.
    pub(crate) is_chosen: bool,
    /// The gap of elements in contact.
    pub(crate) zero_gap: f64,
    /// Pressure above which elements are well inside contact.
    pub(crate) pressed: f64,
    /// The stiffness of the last step along p (1 - p/H), which preconditions the mean. `None` if it has none.
    pub(crate) stiffness: Option<f64>,
    pub(crate) follows: Follows,
    /// Whether a pressure was given to start from. The flag below says the same of the gap.
    pub(crate) has_start: bool,
    pub(crate) has_gap: bool,
    pub(crate) info: LevelInfo,
}

impl<'a> Descent<'a> {
    /// A descent on the level whose elements are all or some of those of `grid`.
    ///
    /// `heights` has one value for each element.
    pub(crate) fn new(
        heights: impl Into<ElementHeights<'a>>,
        grid: Grid,
        operators: LevelOperators<'a>,
        problem: &'a Problem,
        start: Start,
    ) -> Self {
        let heights = heights.into();
        let directions = ConjugateDirections::new(heights.len());
        Self::with_directions(heights, grid, operators, problem, (start, directions))
    }

    fn with_directions(
        heights: ElementHeights<'a>,
        grid: Grid,
        operators: LevelOperators<'a>,
        problem: &'a Problem,
        (start, directions): (Start, ConjugateDirections),
    ) -> Self {
        let n = heights.len();
        let layout = operators.corrections.layout();
        debug_assert_eq!(layout.len(), operators.fresh.layout().len());
        let (has_start, has_gap) = (!matches!(start, Start::Nothing), matches!(start, Start::Known { .. }));
        let (pressure, gap) = match start {
            Start::Nothing => (Values::Double(vec![0.0; n]), Values::Double(vec![0.0; n])),
            Start::Pressure(pressure) => (Values::Double(pressure), Values::Double(vec![0.0; n])),
            Start::Known { pressure, gap } => (pressure, gap),
        };
        Self {
            problem,
            layout,
            operators,
            heights,
            pressure,
            gap,
            directions,
            curvature: f64::INFINITY,
            step_factor: 1.0,
            plain: PlainRounds::default(),
            is_chosen: false,
            zero_gap: 0.0,
            pressed: f64::INFINITY,
            stiffness: None,
            follows: Follows::Pressure,
            has_start,
            has_gap,
            info: LevelInfo { grid, iterations: 0, operator_applications: 0, preconditioner_applications: 0 },
        }
    }

    /// A descent that takes no step, for [`Descent::certify_start`]. It has no memory for directions.
    pub(crate) fn without_steps(
        heights: impl Into<ElementHeights<'a>>,
        grid: Grid,
        operators: LevelOperators<'a>,
        problem: &'a Problem,
        start: Start,
    ) -> Self {
        Self::with_directions(heights.into(), grid, operators, problem, (start, ConjugateDirections::new(0)))
    }

    pub(crate) fn grid(&self) -> Grid {
        self.info.grid
    }

    /// The boundary of the heights.
    pub(crate) fn boundary(&self) -> Boundary {
        self.problem.support.boundary
    }

    pub(crate) fn info(&self) -> LevelInfo {
        self.info
    }

    pub(crate) fn pressure(&self) -> Cow<'_, [f64]> {
        self.pressure.all()
    }

    pub(crate) fn gap(&self) -> Cow<'_, [f64]> {
        self.gap.all()
    }

    /// The gap of elements in contact.
    ///
    /// A converged solution makes it the same for all of them.
    pub(crate) fn contact_gap(&self) -> f64 {
        self.zero_gap
    }

    /// Number of the smallest elements that the whole cell has room for.
    pub(crate) fn n_cell(&self) -> f64 {
        self.info.grid.len() as f64
    }

    /// Heights, pressure and gap.
    pub(crate) fn elements(&mut self) -> ElementVectors<'_> {
        ElementVectors { heights: self.heights, pressure: &mut self.pressure, gap: &mut self.gap }
    }

    /// Computes the gap from a fresh application of L, in double precision.
    pub(crate) fn fresh_gap(&mut self) -> GapSums {
        self.fresh_gap_under(self.problem.bounds.hardness)
    }

    /// [`Descent::fresh_gap`], with sums for another hardness.
    pub(crate) fn fresh_gap_under(&mut self, hardness: f64) -> GapSums {
        self.info.operator_applications += 1;
        let elements = ElementVectors { heights: self.heights, pressure: &mut self.pressure, gap: &mut self.gap };
        // Fresh gaps are rare. An operator keeps no memory for vectors while the other one works.
        self.operators.corrections.release();
        let empty = GapSums::empty(self.pressed, hardness);
        let sums = fresh_gap(&mut *self.operators.fresh, self.problem, elements, empty);
        self.operators.fresh.release();
        self.pressed = sums.next_pressed();
        sums
    }

    /// Multiplies the pressure by `scale`. The gap follows.
    pub(crate) fn rescale(&mut self, scale: f64) -> GapSums {
        let (layout, problem) = (self.layout.clone(), self.problem);
        let empty = GapSums::empty(self.pressed, problem.bounds.hardness);
        let sums = rescale(scale, &layout, problem, self.elements(), empty);
        self.pressed = sums.next_pressed();
        self.settle(sums)
    }

    /// Notes the gap of elements in contact.
    pub(crate) fn settle(&mut self, sums: GapSums) -> GapSums {
        self.zero_gap = sums.zero_gap(self.problem.bounds);
        sums
    }

    pub(crate) fn outcome(&self, sums: &GapSums, converged: bool) -> Outcome {
        Outcome::new(self.problem, sums, self.n_cell(), converged)
    }

    /// The solution on a uniform grid.
    ///
    /// `levels` is the work on all levels, coarsest first. `coarser` has the values of the last level but one.
    pub(crate) fn into_solution(
        self,
        outcome: &Outcome,
        levels: Vec<LevelInfo>,
        coarser: Option<LevelValues>,
    ) -> GridSolution {
        let (grid, problem) = (self.grid(), self.problem);
        let mut info = outcome.info(problem, levels, coarser);
        let boundary = self.boundary();
        let (pressure, gap) = self.into_vectors(outcome.approach + problem.offset());
        let field = |values| Field::new(grid, values).expect("a value for each element");
        let gap = field(gap);
        if boundary == Boundary::Free {
            info.mean_displacement += gap.mean() - info.mean_gap();
        }
        let status = if outcome.converged { Status::Converged } else { Status::NotConverged };
        GridSolution { pressure: field(pressure), gap, status, elements: None, info }
    }

    /// The pressure.
    pub(crate) fn into_pressure(self) -> Values {
        self.pressure
    }

    /// The pressure, and the gap with its pressure-weighted mean at zero.
    pub(crate) fn into_vectors(mut self, mean_gap: f64) -> (Vec<f64>, Vec<f64>) {
        self.gap.update(|g| *g -= mean_gap);
        (self.pressure.into_all(), self.gap.into_all())
    }
}
