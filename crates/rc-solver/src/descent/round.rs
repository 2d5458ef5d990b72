//! One round: conjugate-gradient steps on the active elements, then the projection.
//!
//! The projection chooses the next active elements.

use crate::descent::directions::Slope;
use crate::descent::operators::{read_blocks, write_blocks};
use crate::descent::rows;
use crate::descent::rows::{ElementValues, Gradient};
use crate::descent::shares::{Load, Shares, Squares};
use crate::descent::state::Descent;
use crate::descent::stop::{Stopped, unless_stopped};
use crate::descent::sums::GapSums;
use rc_core::{Boundary, Observer};

use crate::parallel;
use crate::problem::control::Control;

/// The active elements of a round.
struct ActiveSet {
    /// Number of active elements, in units of the smallest.
    n: f64,
    /// Whether the mean over the active elements stays as it is.
    fixed_mean: bool,
    /// Mean of the last direction over the active elements.
    direction_mean: f64,
}

/// Part of the cell in contact above which each step is clipped.
///
/// Elements that join the contact then get a pressure at once. `docs/measurements-uniform.md` compares both rules.
const HEAVY_CONTACT: f64 = 0.5;

/// Pressure on a square of side 1 alone that displaces its centre by 1: π / (4 ln(1 + √2)) E*.
const ALONE: f64 = 0.891;

impl Descent<'_> {
    /// Takes this number of steps, clips tensile pressures and restores the load.
    ///
    /// # Errors
    /// [`Stopped`] when the observer wants to stop.
    pub(super) fn round(&mut self, steps: usize, sums: &GapSums, observer: &dyn Observer) -> Result<GapSums, Stopped> {
        // Without a start, contact is at first too large at any load. Of operators of the caller nothing is known. Free
        // borders bend the gap of a start over long distances, so whole regions would join and press.
        let is_periodic = self.boundary() == Boundary::Periodic;
        let is_prepared = is_periodic && self.has_start && self.operators.corrections.extends();
        let is_heavy = is_prepared && sums.n_in_contact() > HEAVY_CONTACT * self.n_cell();
        let steps = if is_heavy { 1 } else { steps };
        self.precondition_mean(sums);
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
    fn begin_round(&mut self) -> ActiveSet {
        let (len, gradient) = (self.layout.len(), self.gradient());
        // The choice before clipping is kept only if residuals are extended.
        let is_chosen = std::mem::replace(&mut self.is_chosen, self.operators.corrections.extends());
        let directions = &mut self.directions;
        let elements = ElementValues { heights: self.heights, pressure: &mut self.pressure, gap: &mut self.gap };
        let residuals = directions.active.chunks_mut(len).zip(directions.preconditioned.chunks_mut(len));
        let blocks = elements.blocks(len).zip(directions.direction.chunks(len).zip(residuals));
        let sums = parallel::map(blocks, |(block, (direction, (active, residual)))| {
            block.first_residual(&gradient, direction, (active, is_chosen), residual)
        });
        let [n, direction] = self.layout.total(sums);
        self.operators.corrections.set_active(&self.directions.active);
        let fixed_load = matches!(self.problem.control, Control::MeanPressure(_));
        // If a uniform pressure on the whole cell displaces nothing, no step along it is long enough. Other directions
        // would be scaled with it.
        let is_free = self.problem.support.is_none() && n >= self.n_cell();
        ActiveSet { n, fixed_mean: fixed_load || is_free, direction_mean: direction / n }
    }

    /// Moves on to the next direction, and returns the length of the step along it.
    fn step_length(&mut self, set: &ActiveSet, observer: &dyn Observer) -> Result<f64, Stopped> {
        unless_stopped(observer)?;
        let corrections = &mut *self.operators.corrections;
        self.info.preconditioner_applications += 1;
        let sums = self.directions.precondition(corrections, &self.layout);
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
        if let Control::MeanPressure(_) = self.problem.control {
            self.zero_gap += length * sums.displacement / set.n;
        }
        Ok(length)
    }

    /// Takes a step and writes the residual on the same elements.
    fn take_step(&mut self, length: f64) {
        let (len, gradient) = (self.layout.len(), self.gradient());
        let elements = ElementValues { heights: self.heights, pressure: &mut self.pressure, gap: &mut self.gap };
        let (steps, residuals) = self.directions.steps_and_residuals(len);
        parallel::for_each(elements.blocks(len).zip(steps.zip(residuals)), |(block, (step, residual))| {
            block.next_residual(length, &step, &gradient, residual);
        });
    }

    /// Takes a step, clips tensile pressures, and restores the load or the penetration.
    ///
    /// Each part of the load is restored where it was.
    fn project(&mut self, length: f64, is_heavy: bool, observer: &dyn Observer) -> Result<GapSums, Stopped> {
        let gradient = self.gradient();
        let (n_clipped, loads) = self.clip(length, is_heavy, &gradient);
        let shares = Shares::new(self.squares(), &loads);
        if self.is_limited(&shares) {
            unless_stopped(observer)?;
            return Ok(self.project_limited(n_clipped, (&loads, &shares), &gradient));
        }
        let wanted = match self.problem.control {
            Control::MeanPressure(mean) => Some(mean * self.n_cell()),
            Control::Penetration(_) => None,
        };
        let scale = |pressure: f64| match wanted {
            Some(wanted) if pressure > 0.0 => wanted / pressure,
            _ => 1.0,
        };
        if n_clipped == 0 {
            let sums = self.rescale(scale(loads.iter().map(|load| load.clipped).sum()));
            let sums = self.limited(sums);
            return Ok(self.meet_penetration(sums));
        }
        // Loads are only moved between squares. Scaling, which is exact, then sets the load of the cell.
        let (len, offset, range) = (self.layout.len(), self.problem.offset(), self.problem.unit());
        let blocks = self.pressure.chunks_mut(len).zip(self.directions.added().chunks(len)).enumerate();
        let layout = &self.layout;
        let sums = write_blocks(&mut *self.operators.corrections, blocks, |(i, (pressure, added)), written| {
            let mut sum = 0.0;
            layout.for_each_run(i, pressure.len(), |run, place| {
                let (pressure, added, written) = (&mut pressure[run.clone()], &added[run.clone()], &mut written[run]);
                sum += rows::share(pressure, shares.at(place), gradient.unit, added, written);
            });
            [sum]
        });
        let [pressure] = self.layout.total(sums);
        unless_stopped(observer)?;
        self.info.operator_applications += 1;
        self.operators.corrections.apply();
        let (empty, scale) = (GapSums::empty(self.pressed, self.problem.hardness), scale(pressure));
        let elements = ElementValues { heights: self.heights, pressure: &mut self.pressure, gap: &mut self.gap };
        let sums = read_blocks(&*self.operators.corrections, elements.blocks(len), |block, displacement| {
            block.add_clipped(displacement, range, scale, offset, empty)
        });
        let sums = GapSums::total(&self.layout, sums);
        self.pressed = sums.next_pressed();
        let sums = self.limited(sums);
        Ok(self.meet_penetration(sums))
    }

    /// Takes a step and clips tensile pressures.
    ///
    /// In heavy contact, elements that join get a pressure at once. Returns the number of changed pressures, and the
    /// load of each square.
    fn clip(&mut self, length: f64, is_heavy: bool, gradient: &Gradient) -> (u64, Vec<Load>) {
        let (len, squares, layout) = (self.layout.len(), self.squares(), &self.layout);
        let spacing = self.info.grid.spacing();
        let joining = if is_heavy { ALONE / (spacing.x * spacing.y).sqrt() } else { 0.0 };
        let elements = ElementValues { heights: self.heights, pressure: &mut self.pressure, gap: &mut self.gap };
        let blocks = elements.blocks(len).zip(self.directions.clipped_steps(len)).enumerate();
        let of_blocks = parallel::map(blocks, |(i, (mut block, mut step))| {
            let n_clipped = block.clip(length, joining / layout.area(i).sqrt(), &mut step, gradient);
            let (mut loads, mut last): (Vec<(usize, Load)>, _) = (Vec::new(), 0);
            layout.for_each_run(i, block.heights.len(), |run, place| {
                let (square, pressure) = (squares.at(place), &block.pressure[run.clone()]);
                let added: f64 = step.added[run].iter().copied().map(f64::from).sum();
                let load = Load { clipped: pressure.iter().sum(), added: added / gradient.unit };
                // A run lies in the same square as the one before or in the next. Each row of a block begins in the
                // first square again.
                let is_this = |&i: &usize| loads.get(i).is_some_and(|(other, _)| *other == square);
                let known = [last, last + 1, 0].into_iter().find(is_this).or_else(|| (0..loads.len()).find(is_this));
                last = known.unwrap_or_else(|| {
                    loads.push((square, Load::default()));
                    loads.len() - 1
                });
                loads[last].1 = loads[last].1.plus(load, 1.0);
            });
            (n_clipped, loads)
        });
        self.add_loads(of_blocks)
    }

    /// Number of changed pressures, and the load of each square, from those of blocks.
    fn add_loads(&self, of_blocks: Vec<(u32, Vec<(usize, Load)>)>) -> (u64, Vec<Load>) {
        let (layout, ranks) = (&self.layout, self.layout.ranks());
        let mut loads = vec![Load::default(); self.squares().len()];
        let n_clipped = ranks.count(of_blocks.iter().map(|(n, _)| *n as usize).sum());
        let of_blocks = of_blocks.into_iter().map(|(_, of_block)| of_block).enumerate();
        let all = of_blocks.flat_map(|(i, of_block)| of_block.into_iter().map(move |load| (i, load)));
        if ranks.are_alone() {
            for (i, (square, load)) in all {
                loads[square] = loads[square].plus(load, layout.area(i));
            }
        } else {
            // The order is that of blocks, including those of other ranks. All areas are 1.
            let mine = all.flat_map(|(_, (square, load))| [square as f64, load.clipped, load.added]).collect();
            for &[square, clipped, added] in ranks.concatenate(mine).as_chunks::<3>().0 {
                let square = &mut loads[square as usize];
                *square = square.plus(Load { clipped, added }, 1.0);
            }
        }
        (n_clipped as u64, loads)
    }

    pub(super) fn squares(&self) -> Squares {
        Squares::new(self.layout.sides())
    }

    fn gradient(&self) -> Gradient {
        Gradient { zero_gap: self.zero_gap, unit: self.problem.unit().recip(), hardness: self.problem.hardness }
    }
}
