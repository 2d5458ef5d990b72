//! Preconditioned projected conjugate gradients on one level, whatever its mesh ([`Engine`]).
//!
//! One round chooses the active elements (pressing or penetrating), takes [`STEPS_PER_ROUND`] conjugate-gradient steps on
//! them, clips tensile pressures and restores the load. Directions survive a change of the active set: β makes the new
//! direction L-orthogonal to the old one as it was (Hestenes and Stiefel), and is kept non-negative. Clipping in every
//! second step only saves its convolution; clipping rarer costs more steps than it saves.
//!
//! Corrections (directions, their displacements, residuals) are in single precision, pressure and gap in double: each
//! correction is added to exact values, as in iterative refinement, and a fresh application of L in double precision
//! settles what single precision left. All corrections are relative to the height range H, so no scene underflows.

mod blocks;
mod engine;
mod gap;
mod mean;
mod outcome;
mod rows;
mod shown;
mod start;

use rayon::prelude::*;
use rc_core::{Event, Grid, Observer};

pub(crate) use blocks::Blocks;
pub(crate) use engine::Engine;
use gap::positive_part;
pub(crate) use gap::{GapSums, fresh_gap, mean_pressure, rescale, scale_to_load};
pub(crate) use outcome::Outcome;
pub(crate) use shown::Shown;
pub(crate) use start::Start;

use crate::problem::Problem;
use crate::solution::LevelInfo;
use crate::{Certificate, Control};

/// Conjugate-gradient steps between two clippings. Measured at 1024², N = 64, σ0/E* = 8.9e-4 to 1e-6: 1, 2, 3 steps need
/// 37, 36, 36 convolutions, but only 2 does it everywhere from 0.1 % to 86 % contact.
const STEPS_PER_ROUND: usize = 2;

/// Rounds without progress before directions are forgotten, and three times as many before the iteration gives up. From the first of them
/// on tensile pressures are clipped after every step: where pressures are smooth over many contacts, steps are large, contacts change under
/// them, and two steps between clippings lead astray. In cells 50 and 100 times as long as wide, 15 of 144 loads did not converge without
/// this rule, and 1 with it, in half the iterations; N = 1024 on 2304² needs 29 instead of 36, and other scenes are as before.
const PATIENCE: usize = 20;

/// What applies L and its approximate inverse on one level.
pub(crate) struct Machinery<C: Engine<f32>, F: Engine<f64>> {
    /// Corrections, in single precision.
    pub(crate) corrections: C,
    /// L.
    pub(crate) response: C::Table,
    /// Its approximate inverse.
    pub(crate) preconditioner: C::Table,
    /// Fresh gaps, in double precision.
    pub(crate) fresh: F,
    /// L.
    pub(crate) fresh_response: F::Table,
}

/// Pressure, gap and everything that one level needs to improve them.
pub(crate) struct Descent<'a, C: Engine<f32>, F: Engine<f64>> {
    heights: &'a [f64],
    problem: &'a Problem,
    blocks: Blocks,
    machinery: Machinery<C, F>,
    p: Vec<f64>,
    g: Vec<f64>,
    z: Vec<f32>,
    t: Vec<f32>,
    u: Vec<f32>,
    active: Vec<bool>,
    has_start: bool,
    has_gap: bool,
    /// <t, u> of the last step; infinite when there is no direction to be conjugate to.
    curvature: f64,
    zero_gap: f64,
    info: LevelInfo,
}

impl<'a, C: Engine<f32>, F: Engine<f64>> Descent<'a, C, F> {
    /// A descent on the level whose elements are those of `grid`, or some of them: `heights` has one value for each.
    pub(crate) fn new(
        heights: &'a [f64],
        grid: Grid,
        machinery: Machinery<C, F>,
        problem: &'a Problem,
        start: Start,
    ) -> Self {
        let n = heights.len();
        let blocks = machinery.corrections.blocks();
        debug_assert_eq!(blocks.len(), machinery.fresh.blocks().len());
        let (has_start, has_gap) = (!matches!(start, Start::Nothing), matches!(start, Start::Known { .. }));
        let (p, g) = match start {
            Start::Nothing => (vec![0.0; n], vec![0.0; n]),
            Start::Pressure(pressure) => (pressure, vec![0.0; n]),
            Start::Known { pressure, gap } => (pressure, gap),
        };
        let zeros = || vec![0.0; n];
        Self {
            heights,
            problem,
            blocks,
            machinery,
            p,
            g,
            z: zeros(),
            t: zeros(),
            u: zeros(),
            active: vec![false; n],
            has_start,
            has_gap,
            curvature: f64::INFINITY,
            zero_gap: 0.0,
            info: LevelInfo { grid, iterations: 0, operator_applications: 0, preconditioner_applications: 0 },
        }
    }

    pub(crate) fn grid(&self) -> Grid {
        self.info.grid
    }

    pub(crate) fn info(&self) -> LevelInfo {
        self.info
    }

    pub(crate) fn pressure(&self) -> &[f64] {
        &self.p
    }

    pub(crate) fn gap(&self) -> &[f64] {
        &self.g
    }

    /// The gap of elements in contact, which a converged solution makes the same for all.
    pub(crate) fn contact_gap(&self) -> f64 {
        self.zero_gap
    }

    /// Values in a block.
    fn block(&self) -> usize {
        self.blocks.len()
    }

    /// The smallest elements that the whole cell has room for.
    fn n_cell(&self) -> f64 {
        self.info.grid.len() as f64
    }

    /// Iterates until the error is within `tolerance`; with `certify`, until a fresh application says so. `mesh` is where the
    /// observer sees the pressure.
    pub(crate) fn run(
        &mut self,
        tolerance: f64,
        max_iterations: usize,
        certify: bool,
        observer: &dyn Observer,
        mesh: &impl Shown,
    ) -> Outcome {
        let mut sums = self.start();
        let (mut best, mut rounds_since_best, mut steps) = (f64::INFINITY, 0, STEPS_PER_ROUND);
        loop {
            let mut error = self.error(&sums);
            let iteration = self.info.iterations;
            observer.notify(&Event::Iteration { iteration, error, tolerance, n_contact: sums.n_contact as usize });
            mesh.show(&self.p, observer);
            if error <= tolerance {
                if !certify {
                    return self.outcome(&sums, true);
                }
                sums = self.refresh();
                error = self.error(&sums);
                let outcome = self.outcome(&sums, true);
                if error <= tolerance && outcome.certificate.load <= Certificate::LOAD_TOLERANCE {
                    return outcome;
                }
            }
            if error < 0.9 * best {
                (best, rounds_since_best) = (error, 0);
            } else {
                rounds_since_best += 1;
                steps = 1;
            }
            if rounds_since_best == PATIENCE {
                self.curvature = f64::INFINITY;
            }
            if iteration >= max_iterations || rounds_since_best > 3 * PATIENCE || observer.should_stop() {
                let sums = self.refresh();
                return self.outcome(&sums, false);
            }
            sums = self.round(steps, &sums);
        }
    }

    /// Computes the gap afresh between two runs.
    pub(crate) fn renew(&mut self) {
        self.refresh();
    }

    /// The gap from a fresh application of L, in double precision, and the pressure at the prescribed load or penetration: the gap follows
    /// scaling to rounding, since v is linear in p.
    fn refresh(&mut self) -> GapSums {
        let sums = self.fresh_gap();
        self.meet_penetration(sums)
    }

    fn fresh_gap(&mut self) -> GapSums {
        self.info.operator_applications += 1;
        let Machinery { fresh, fresh_response, .. } = &mut self.machinery;
        fresh_gap(fresh, fresh_response, self.problem, (self.heights, &self.p, &mut self.g))
    }

    /// Notes the gap of elements in contact.
    fn settle(&mut self, sums: GapSums) -> GapSums {
        self.zero_gap = sums.zero_gap(self.problem);
        sums
    }

    /// The error as the certificate defines it, from the running gap.
    fn error(&self, sums: &GapSums) -> f64 {
        let mean_gap = sums.mean_gap();
        let penetration = (mean_gap - sums.min_gap) / self.problem.h_range;
        positive_part(match self.problem.control {
            Control::MeanPressure(_) => penetration,
            // NaN in the mean is in both.
            Control::Penetration(_) if penetration.is_nan() => penetration,
            Control::Penetration(_) => penetration.max(mean_gap.abs() / self.problem.h_range),
        })
    }

    /// Conjugate-gradient steps on the active elements, then the projection.
    fn round(&mut self, steps: usize, sums: &GapSums) -> GapSums {
        self.precondition_mean(sums);
        let [n_active, t_sum] = self.choose_active();
        if n_active == 0.0 {
            return *sums;
        }
        let mut t_mean = t_sum / n_active;
        let fixed_load = matches!(self.problem.control, Control::MeanPressure(_));
        // A uniform pressure on the whole cell displaces nothing: no step along it is long enough, and others would be scaled with it.
        let fixed_mean = fixed_load || n_active >= self.n_cell();
        for step in 0..steps {
            let [z_sum, zu, u_sum] = self.precondition();
            let z_mean = if fixed_mean { z_sum / n_active } else { 0.0 };
            let beta = ((zu - z_mean * u_sum) / self.curvature).max(0.0);
            let shift = if fixed_mean { z_mean - beta * t_mean } else { 0.0 };
            let [curvature, slope, u_sum] = self.respond(beta, shift);
            // A direction that does not lead down would undo progress; it is dropped, and the next one starts afresh.
            let leads_down = curvature > 0.0 && slope < 0.0;
            let length = if leads_down { -slope / curvature } else { 0.0 };
            self.curvature = if leads_down { curvature } else { f64::INFINITY };
            self.info.iterations += 1;
            if fixed_load {
                self.zero_gap += length * u_sum / n_active;
            }
            t_mean = 0.0;
            if step + 1 == steps {
                return self.project(length);
            }
            self.advance(length);
        }
        *sums
    }

    /// Chooses the active elements and starts the transform of their residual. Returns their number and Σ t.
    fn choose_active(&mut self) -> [f64; 2] {
        let block = self.block();
        let (zero_gap, unit) = (self.zero_gap, self.problem.h_range.recip());
        let sources = (
            self.p.par_chunks(block),
            self.g.par_chunks(block),
            self.t.par_chunks(block),
            self.active.par_chunks_mut(block),
        );
        self.blocks.total(self.machinery.corrections.fill(sources.into_par_iter(), |(p, g, t, active), rows| {
            rows::first_residual((p, g), (zero_gap, unit), t, active, rows)
        }))
    }

    /// Takes a step and starts the transform of the residual on the same elements.
    fn advance(&mut self, length: f64) {
        let block = self.block();
        let (zero_gap, unit) = (self.zero_gap, self.problem.h_range.recip());
        let sources = (
            self.p.par_chunks_mut(block),
            self.g.par_chunks_mut(block),
            self.t.par_chunks(block),
            self.u.par_chunks(block),
            self.active.par_chunks(block),
        );
        self.machinery.corrections.fill(sources.into_par_iter(), |(p, g, t, u, active), rows| {
            rows::next_residual(length, (zero_gap, unit), (p, g), (t, u), active, rows);
        });
    }

    /// Applies the preconditioner to the residual whose rows are already transformed. Returns Σ z, Σ z u, Σ u.
    fn precondition(&mut self) -> [f64; 3] {
        let block = self.block();
        self.info.preconditioner_applications += 1;
        let Machinery { corrections, preconditioner, .. } = &mut self.machinery;
        corrections.multiply(preconditioner);
        let sinks = (self.u.par_chunks(block), self.active.par_chunks(block), self.z.par_chunks_mut(block));
        self.blocks.total(corrections.take(preconditioner, sinks.into_par_iter(), |(u, active, z), rows| {
            rows::take_preconditioned(rows, u, active, z)
        }))
    }

    /// The next direction t and its displacement u = L t. Returns <t, u>, <residual, t> and Σ u.
    fn respond(&mut self, beta: f64, shift: f64) -> [f64; 3] {
        let block = self.block();
        let (beta, shift, zero_gap) = (beta as f32, shift as f32, self.zero_gap);
        self.info.operator_applications += 1;
        let (z, active) = (&self.z, &self.active);
        let sources = (z.par_chunks(block), active.par_chunks(block), self.t.par_chunks_mut(block));
        self.machinery.corrections.fill(sources.into_par_iter(), |(z, active, t), rows| {
            rows::next_direction(z, beta, shift, active, t, rows);
        });
        self.machinery.corrections.multiply(&self.machinery.response);
        let sinks = (
            self.t.par_chunks(block),
            self.g.par_chunks(block),
            active.par_chunks(block),
            self.u.par_chunks_mut(block),
        );
        self.blocks.total(self.machinery.corrections.take(
            &self.machinery.response,
            sinks.into_par_iter(),
            |(t, g, active, u), rows| rows::take_response(rows, t, g, zero_gap, active, u),
        ))
    }

    /// Takes a step, clips tensile pressures and restores the load or the penetration.
    fn project(&mut self, length: f64) -> GapSums {
        let block = self.block();
        let (offset, range) = (self.problem.offset(), self.problem.h_range);
        let sources = (
            self.p.par_chunks_mut(block),
            self.g.par_chunks_mut(block),
            self.t.par_chunks(block),
            self.u.par_chunks(block),
        );
        let [pressure, clipped] =
            self.blocks.total(self.machinery.corrections.fill(sources.into_par_iter(), |(p, g, t, u), rows| {
                rows::clip(length, range.recip(), (p, g), (t, u), rows)
            }));
        let scale = match self.problem.control {
            Control::MeanPressure(mean) if pressure > 0.0 => mean * self.n_cell() / pressure,
            _ => 1.0,
        };
        let response = if clipped > 0.0 {
            self.info.operator_applications += 1;
            self.machinery.corrections.multiply(&self.machinery.response);
            range
        } else {
            0.0
        };
        let sinks = (self.heights.par_chunks(block), self.p.par_chunks_mut(block), self.g.par_chunks_mut(block));
        let sums =
            self.machinery.corrections.take(&self.machinery.response, sinks.into_par_iter(), |(h, p, g), rows| {
                rows::take_clipped(rows, response, scale, offset, h, (p, g))
            });
        let sums = GapSums::total(&self.blocks, sums);
        self.meet_penetration(sums)
    }

    fn rescale(&mut self, scale: f64) -> GapSums {
        let sums = rescale(scale, &self.blocks, self.problem, (self.heights, &mut self.p, &mut self.g));
        self.settle(sums)
    }

    fn outcome(&self, sums: &GapSums, converged: bool) -> Outcome {
        Outcome::new(self.problem, sums, self.n_cell(), converged)
    }

    /// The machinery, to be used again, and the pressure.
    pub(crate) fn into_machinery(self) -> (Machinery<C, F>, Vec<f64>) {
        (self.machinery, self.p)
    }

    /// Pressure, and gap with its pressure-weighted mean at zero.
    pub(crate) fn into_vectors(mut self, mean_gap: f64) -> (Vec<f64>, Vec<f64>) {
        self.g.par_iter_mut().for_each(|g| *g -= mean_gap);
        (self.p, self.g)
    }
}
