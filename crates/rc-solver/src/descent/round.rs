//! One round: conjugate-gradient steps on the active elements, then the projection.
//!
//! The projection chooses the next active elements.

use crate::descent::directions::Slope;
use crate::descent::rows::Gradient;
use crate::descent::state::Descent;
use crate::descent::stop::{Stopped, unless_stopped};
use crate::descent::sums::GapSums;
use crate::descent::values::ElementVectors;
use rc_core::{Boundary, Observer};

use crate::parallel;
use crate::problem::control::Control;
use crate::problem::steps::Step;

/// The active elements of a round.
pub(crate) struct ActiveSet {
    /// Number of active elements, in units of the smallest.
    pub(crate) n: f64,
    /// Whether the mean over the active elements stays as it is.
    pub(crate) fixed_mean: bool,
    /// Mean of the last direction over the active elements.
    direction_mean: f64,
}

/// Part of the cell in contact above which each step is clipped.
///
/// Elements that join the contact then get a pressure at once. `docs/constants.md` compares both rules.
const HEAVY_CONTACT: f64 = 0.5;

impl Descent<'_> {
    /// Takes this number of steps, clips tensile pressures and restores the load.
    ///
    /// # Errors
    /// [`Stopped`] when the observer wants to stop.
    pub(crate) fn round(&mut self, steps: usize, sums: &GapSums, observer: &dyn Observer) -> Result<GapSums, Stopped> {
        // Without a start, contact is at first too large at any load. Of operators of the caller nothing is known. Free
        // borders bend the gap of a start over long distances, so whole regions would join and press.
        let is_periodic = self.boundary() == Boundary::Periodic;
        let is_prepared = is_periodic && self.has_start && self.operators.corrections.extends();
        let is_prepared = is_prepared && !self.operators.corrections.keeps_steps();
        let is_heavy = is_prepared && sums.n_in_contact() > HEAVY_CONTACT * self.n_cell();
        let steps = if is_heavy { 1 } else { steps };
        let mut set = self.begin_round();
        if set.n == 0.0 && sums.has_plastic() {
            // The last projection left every element at one of the two bounds. It then changed the gaps by which it had
            // chosen.
            self.is_chosen = false;
            set = self.begin_round();
        }
        if set.n == 0.0 {
            return Ok(*sums);
        }
        self.precondition_mean(sums, set.n);
        for step in 1..=steps {
            let length = self.step_length(&set, observer)?;
            set.direction_mean = 0.0;
            if step == steps {
                return self.project(length, is_heavy, observer);
            }
            self.take_step(length);
        }
        Ok(*sums)
    }

    /// Writes the residual of the active elements.
    pub(crate) fn begin_round(&mut self) -> ActiveSet {
        let _running = Step::Residuals.begin();
        let (len, gradient) = (self.layout.len(), self.gradient());
        // The choice before clipping is kept only if residuals are extended.
        let is_chosen = std::mem::replace(&mut self.is_chosen, self.operators.corrections.extends());
        let directions = &mut self.directions;
        let elements = ElementVectors { heights: self.heights, pressure: &mut self.pressure, gap: &mut self.gap };
        let residuals = directions.active.chunks_mut(len).zip(directions.preconditioned.chunks_mut(len));
        let blocks = elements.blocks(len).zip(directions.direction.chunks(len).zip(residuals));
        let sums = parallel::map(blocks, |(block, (direction, (active, residual)))| {
            block.without_heights(|values| values.first_residual(&gradient, direction, (active, is_chosen), residual))
        });
        let [n, direction] = self.layout.total(sums);
        self.operators.corrections.set_active(&self.directions.active);
        let fixed_load = matches!(self.problem.bounds.control, Control::MeanPressure(_));
        // If a uniform pressure on the whole cell displaces nothing, no step along it is long enough. Other directions
        // would be scaled with it.
        let is_free = self.problem.support.is_none() && n >= self.n_cell();
        ActiveSet { n, fixed_mean: fixed_load || is_free, direction_mean: direction / n }
    }

    /// Moves on to the next direction, and returns the length of the step along it.
    fn step_length(&mut self, set: &ActiveSet, observer: &dyn Observer) -> Result<f64, Stopped> {
        unless_stopped(observer)?;
        let corrections = &mut *self.operators.corrections;
        let inverse = (self.plain.rounds == 0).then_some(&mut *corrections);
        self.info.preconditioner_applications += usize::from(inverse.is_some());
        let sums = self.directions.precondition(inverse, &self.layout);
        let mean = if set.fixed_mean { sums.preconditioned / set.n } else { 0.0 };
        let beta = ((sums.with_displacement - mean * sums.displacement) / self.curvature).max(0.0);
        let shift = if set.fixed_mean { mean - beta * set.direction_mean } else { 0.0 };
        unless_stopped(observer)?;
        self.info.operator_applications += 1;
        let slope = Slope::Gap { gap: &self.gap, zero_gap: self.zero_gap };
        let sums = self.directions.advance(corrections, &self.layout, [beta, shift], &slope);
        // A direction that does not lead down would undo progress. It is dropped, and the next direction starts afresh.
        let leads_down = sums.curvature > 0.0 && sums.slope < 0.0;
        let length = if leads_down { -self.step_factor * sums.slope / sums.curvature } else { 0.0 };
        self.curvature = if leads_down { sums.curvature } else { f64::INFINITY };
        self.info.iterations += 1;
        if let Control::MeanPressure(_) = self.problem.bounds.control {
            self.zero_gap += length * sums.displacement / set.n;
        }
        Ok(length)
    }

    /// Takes a step and writes the residual on the same elements.
    fn take_step(&mut self, length: f64) {
        let _running = Step::Residuals.begin();
        let (len, gradient) = (self.layout.len(), self.gradient());
        let elements = ElementVectors { heights: self.heights, pressure: &mut self.pressure, gap: &mut self.gap };
        let (steps, residuals) = self.directions.steps_and_residuals(len);
        parallel::for_each(elements.blocks(len).zip(steps.zip(residuals)), |(block, (step, residual))| {
            block.without_heights(|values| values.next_residual(length, &step, &gradient, residual));
        });
    }

    pub(crate) fn gradient(&self) -> Gradient {
        Gradient { zero_gap: self.zero_gap, unit: self.problem.unit().recip(), hardness: self.problem.bounds.hardness }
    }
}
