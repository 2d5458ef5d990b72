//! Preconditioned projected conjugate gradients on one grid.
//!
//! One round chooses the active elements (pressing or penetrating), takes [`STEPS_PER_ROUND`] conjugate-gradient steps on
//! them, clips tensile pressures and restores the load. Directions survive a change of the active set: β makes the new
//! direction L-orthogonal to the old one as it was (Hestenes and Stiefel), and is kept non-negative. Clipping in every
//! second step only saves its convolution; clipping rarer costs more steps than it saves.
//!
//! Corrections (directions, their displacements, residuals) are in single precision, pressure and gap in double: each
//! correction is added to exact values, as in iterative refinement, and a fresh application of L in double precision
//! settles what single precision left. All corrections are relative to the height range H, so no scene underflows.

use rayon::prelude::*;
use rc_core::{Event, Field, Grid, Kernel, Observer};

use super::Problem;
use super::rows::{self, GapSums};
use crate::fft::{BLOCK_ROWS, Convolution, SymbolTable, total};
use crate::solution::LevelInfo;
use crate::{Certificate, Control};

/// Conjugate-gradient steps between two clippings. Measured at 1024², N = 64, σ0/E* = 8.9e-4 to 1e-6: 1, 2, 3 steps need
/// 37, 36, 36 convolutions, but only 2 does it everywhere from 0.1 % to 86 % contact.
const STEPS_PER_ROUND: usize = 2;

/// Rounds without progress before the iteration becomes cautious, and then gives up.
const PATIENCE: usize = 20;

/// Scaling of the pressure under penetration control is bounded by this factor per round.
const GREATEST_SCALING: f64 = 4.0;

/// What a descent found.
pub(super) struct Outcome {
    pub(super) converged: bool,
    pub(super) certificate: Certificate,
    /// Mean pressure.
    pub(super) mean_pressure: f64,
    /// Pressure-weighted mean of v - h: penetration minus h_max.
    pub(super) approach: f64,
    /// ½ mean(p v).
    pub(super) elastic_energy: f64,
}

/// Pressure, gap and everything that one grid needs to improve them.
pub(super) struct Descent<'a> {
    heights: &'a Field,
    problem: &'a Problem,
    /// Corrections, in single precision: L, its inverse, and where they are applied.
    response: SymbolTable<f32>,
    preconditioner: SymbolTable<f32>,
    corrections: Convolution<f32>,
    /// L in double precision, for fresh gaps.
    fresh_response: SymbolTable<f64>,
    fresh: Convolution<f64>,
    p: Field,
    g: Field,
    z: Vec<f32>,
    t: Vec<f32>,
    u: Vec<f32>,
    active: Vec<bool>,
    /// <t, u> of the last step; infinite when there is no direction to be conjugate to.
    curvature: f64,
    zero_gap: f64,
    info: LevelInfo,
}

impl<'a> Descent<'a> {
    /// A descent from `start`, or from a uniform pressure.
    pub(super) fn new(heights: &'a Field, kernel: &dyn Kernel, problem: &'a Problem, start: Option<Field>) -> Self {
        let grid = heights.grid();
        let eigenvalue = kernel.symbol(grid);
        let fresh_response = SymbolTable::new(grid, &eigenvalue);
        let response = fresh_response.map(|value| value as f32);
        let preconditioner = fresh_response.inverse(grid).map(|value| value as f32);
        let zeros = || vec![0.0; grid.len()];
        Self {
            heights,
            problem,
            response,
            preconditioner,
            corrections: Convolution::new(grid),
            fresh_response,
            fresh: Convolution::new(grid),
            p: start.unwrap_or_else(|| Field::zeros(grid)),
            g: Field::zeros(grid),
            z: zeros(),
            t: zeros(),
            u: zeros(),
            active: vec![false; grid.len()],
            curvature: f64::INFINITY,
            zero_gap: 0.0,
            info: LevelInfo { grid, iterations: 0, operator_applications: 0, preconditioner_applications: 0 },
        }
    }

    pub(super) fn grid(&self) -> Grid {
        self.heights.grid()
    }

    pub(super) fn info(&self) -> LevelInfo {
        self.info
    }

    pub(super) fn pressure(&self) -> &[f64] {
        self.p.values()
    }

    pub(super) fn gap(&self) -> &[f64] {
        self.g.values()
    }

    /// The gap of elements in contact, which a converged solution makes the same for all.
    pub(super) fn contact_gap(&self) -> f64 {
        self.zero_gap
    }

    /// Iterates until the error is within `tolerance`; with `certify`, until a fresh application says so.
    pub(super) fn run(
        &mut self,
        tolerance: f64,
        max_iterations: usize,
        certify: bool,
        observer: &dyn Observer,
    ) -> Outcome {
        let mut sums = self.start();
        let (mut best, mut rounds_since_best, mut steps) = (f64::INFINITY, 0, STEPS_PER_ROUND);
        loop {
            let mut error = self.error(&sums);
            let iteration = self.info.iterations;
            observer.notify(&Event::Iteration { iteration, error, tolerance, n_contact: sums.n_contact });
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
            }
            if rounds_since_best == PATIENCE {
                // Caution: clip after every step, forget the directions.
                (steps, self.curvature) = (1, f64::INFINITY);
            }
            if iteration >= max_iterations || rounds_since_best > 3 * PATIENCE {
                let sums = self.refresh();
                return self.outcome(&sums, false);
            }
            sums = self.round(steps, &sums);
        }
    }

    /// First pressure and gap.
    fn start(&mut self) -> GapSums {
        let nx = self.grid().nx();
        let rows: Vec<f64> = self.p.values().par_chunks(nx).map(|row| row.iter().sum()).collect();
        let total = rows.into_iter().sum::<f64>() / self.grid().len() as f64;
        match self.problem.control {
            Control::MeanPressure(mean) if total > 0.0 => scale_all(self.p.values_mut(), mean / total),
            Control::MeanPressure(mean) => self.p.values_mut().fill(mean),
            Control::Penetration(_) if total > 0.0 => {}
            // What the rigid surface would displace: the right places, and `refresh` finds the amount.
            Control::Penetration(_) => {
                let offset = self.problem.offset();
                for (p, h) in self.p.values_mut().iter_mut().zip(self.heights.values()) {
                    *p = (h - offset).max(0.0);
                }
            }
        }
        self.refresh()
    }

    /// The gap from a fresh application of L, in double precision, and the pressure at the prescribed load or penetration.
    fn refresh(&mut self) -> GapSums {
        let sums = self.fresh_gap();
        let Some(scale) = self.scale_to_penetration(&sums) else { return self.settle(sums) };
        scale_all(self.p.values_mut(), scale);
        let sums = self.fresh_gap();
        self.settle(sums)
    }

    fn fresh_gap(&mut self) -> GapSums {
        let block = BLOCK_ROWS * self.grid().nx();
        let offset = self.problem.offset();
        let (p, h) = (self.p.values(), self.heights.values());
        let sinks = (h.par_chunks(block), p.par_chunks(block), self.g.values_mut().par_chunks_mut(block));
        self.info.operator_applications += 1;
        let sums = self.fresh.apply(
            &self.fresh_response,
            p.par_chunks(block),
            |p, rows| rows.copy_from_slice(p),
            sinks.into_par_iter(),
            |(h, p, g), rows| rows::fresh_gap(rows, offset, h, p, g),
        );
        GapSums::total(sums)
    }

    /// The factor on the pressure that makes its weighted mean gap zero, under penetration control.
    fn scale_to_penetration(&self, sums: &GapSums) -> Option<f64> {
        let Control::Penetration(_) = self.problem.control else { return None };
        let wanted = sums.pressure_height - self.problem.offset() * sums.pressure;
        let displaced = sums.pressure_gap + wanted;
        let scale = wanted / displaced;
        let possible = scale.is_finite() && displaced > 0.0;
        possible.then(|| scale.clamp(GREATEST_SCALING.recip(), GREATEST_SCALING))
    }

    /// Notes the gap of elements in contact.
    fn settle(&mut self, sums: GapSums) -> GapSums {
        self.zero_gap = match self.problem.control {
            Control::MeanPressure(_) if sums.n_contact > 0 => sums.contact_gap / sums.n_contact as f64,
            Control::MeanPressure(_) => sums.min_gap,
            Control::Penetration(_) => 0.0,
        };
        sums
    }

    /// The error as the certificate defines it, from the running gap.
    fn error(&self, sums: &GapSums) -> f64 {
        let mean_gap = if sums.pressure > 0.0 { sums.pressure_gap / sums.pressure } else { 0.0 };
        let penetration = (mean_gap - sums.min_gap) / self.problem.h_range;
        match self.problem.control {
            Control::MeanPressure(_) => penetration,
            Control::Penetration(_) => penetration.max(mean_gap.abs() / self.problem.h_range),
        }
        .max(0.0)
    }

    /// Conjugate-gradient steps on the active elements, then the projection.
    fn round(&mut self, steps: usize, sums: &GapSums) -> GapSums {
        self.precondition_mean(sums);
        let [n_active, t_sum] = self.choose_active();
        if n_active == 0.0 {
            return *sums;
        }
        let mut t_mean = t_sum / n_active;
        for step in 0..steps {
            let [z_sum, zu, u_sum] = self.precondition();
            let fixed_load = matches!(self.problem.control, Control::MeanPressure(_));
            let z_mean = if fixed_load { z_sum / n_active } else { 0.0 };
            let beta = ((zu - z_mean * u_sum) / self.curvature).max(0.0);
            let shift = if fixed_load { z_mean - beta * t_mean } else { 0.0 };
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

    /// Under penetration control the mean pressure is free too. It is preconditioned by the stiffness of the present
    /// pressure to being scaled, σ0²/mean(p v), which grows without bound towards full contact as the true one does.
    fn precondition_mean(&mut self, sums: &GapSums) {
        let Control::Penetration(_) = self.problem.control else { return };
        let n = self.grid().len() as f64;
        let work = sums.pressure_gap + sums.pressure_height - self.problem.offset() * sums.pressure;
        let stiffness = sums.pressure * sums.pressure / (n * work);
        if stiffness.is_finite() && work > 0.0 {
            self.preconditioner.set_mean((stiffness / n) as f32);
        }
    }

    /// Chooses the active elements and starts the transform of their residual. Returns their number and Σ t.
    fn choose_active(&mut self) -> [f64; 2] {
        let block = BLOCK_ROWS * self.grid().nx();
        let (zero_gap, unit) = (self.zero_gap, self.problem.h_range.recip());
        let sources = (
            self.p.values().par_chunks(block),
            self.g.values().par_chunks(block),
            self.t.par_chunks(block),
            self.active.par_chunks_mut(block),
        );
        total(self.corrections.transform_rows(sources.into_par_iter(), |(p, g, t, active), rows| {
            rows::first_residual((p, g), (zero_gap, unit), t, active, rows)
        }))
    }

    /// Takes a step and starts the transform of the residual on the same elements.
    fn advance(&mut self, length: f64) {
        let block = BLOCK_ROWS * self.grid().nx();
        let (zero_gap, unit) = (self.zero_gap, self.problem.h_range.recip());
        let sources = (
            self.p.values_mut().par_chunks_mut(block),
            self.g.values_mut().par_chunks_mut(block),
            self.t.par_chunks(block),
            self.u.par_chunks(block),
            self.active.par_chunks(block),
        );
        self.corrections.transform_rows(sources.into_par_iter(), |(p, g, t, u, active), rows| {
            rows::next_residual(length, (zero_gap, unit), (p, g), (t, u), active, rows);
        });
    }

    /// Applies the preconditioner to the residual whose rows are already transformed. Returns Σ z, Σ z u, Σ u.
    fn precondition(&mut self) -> [f64; 3] {
        let block = BLOCK_ROWS * self.grid().nx();
        self.info.preconditioner_applications += 1;
        self.corrections.multiply(&self.preconditioner);
        let sinks = (self.u.par_chunks(block), self.active.par_chunks(block), self.z.par_chunks_mut(block));
        total(
            self.corrections
                .take_rows(sinks.into_par_iter(), |(u, active, z), rows| rows::take_preconditioned(rows, u, active, z)),
        )
    }

    /// The next direction t and its displacement u = L t. Returns <t, u>, <residual, t> and Σ u.
    fn respond(&mut self, beta: f64, shift: f64) -> [f64; 3] {
        let block = BLOCK_ROWS * self.grid().nx();
        let (beta, shift, zero_gap) = (beta as f32, shift as f32, self.zero_gap);
        self.info.operator_applications += 1;
        let (z, active) = (&self.z, &self.active);
        let sources = (z.par_chunks(block), active.par_chunks(block), self.t.par_chunks_mut(block));
        self.corrections.transform_rows(sources.into_par_iter(), |(z, active, t), rows| {
            rows::next_direction(z, beta, shift, active, t, rows);
        });
        self.corrections.multiply(&self.response);
        let sinks = (
            self.t.par_chunks(block),
            self.g.values().par_chunks(block),
            active.par_chunks(block),
            self.u.par_chunks_mut(block),
        );
        total(self.corrections.take_rows(sinks.into_par_iter(), |(t, g, active, u), rows| {
            rows::take_response(rows, t, g, zero_gap, active, u)
        }))
    }

    /// Takes a step, clips tensile pressures and restores the load or the penetration.
    fn project(&mut self, length: f64) -> GapSums {
        let block = BLOCK_ROWS * self.grid().nx();
        let (offset, range) = (self.problem.offset(), self.problem.h_range);
        let sources = (
            self.p.values_mut().par_chunks_mut(block),
            self.g.values_mut().par_chunks_mut(block),
            self.t.par_chunks(block),
            self.u.par_chunks(block),
        );
        let [pressure, clipped] =
            total(self.corrections.transform_rows(sources.into_par_iter(), |(p, g, t, u), rows| {
                rows::clip(length, range.recip(), (p, g), (t, u), rows)
            }));
        let scale = match self.problem.control {
            Control::MeanPressure(mean) if pressure > 0.0 => mean * self.grid().len() as f64 / pressure,
            _ => 1.0,
        };
        let response = if clipped > 0.0 {
            self.info.operator_applications += 1;
            self.corrections.multiply(&self.response);
            range
        } else {
            0.0
        };
        let sinks = (
            self.heights.values().par_chunks(block),
            self.p.values_mut().par_chunks_mut(block),
            self.g.values_mut().par_chunks_mut(block),
        );
        let sums = self.corrections.take_rows(sinks.into_par_iter(), |(h, p, g), rows| {
            rows::take_clipped(rows, response, scale, offset, h, (p, g))
        });
        let sums = GapSums::total(sums);
        match self.scale_to_penetration(&sums) {
            None => self.settle(sums),
            Some(scale) => self.rescale(scale),
        }
    }

    fn rescale(&mut self, scale: f64) -> GapSums {
        let block = BLOCK_ROWS * self.grid().nx();
        let offset = self.problem.offset();
        let vectors = (
            self.heights.values().par_chunks(block),
            self.p.values_mut().par_chunks_mut(block),
            self.g.values_mut().par_chunks_mut(block),
        );
        let sums = vectors.into_par_iter().map(|(h, p, g)| rows::rescale(scale, offset, h, p, g)).collect();
        let sums = GapSums::total(sums);
        self.settle(sums)
    }

    fn outcome(&self, sums: &GapSums, converged: bool) -> Outcome {
        let (h_range, n) = (self.problem.h_range, self.grid().len() as f64);
        let mean_pressure = sums.pressure / n;
        let mean_gap = if sums.pressure > 0.0 { sums.pressure_gap / sums.pressure } else { 0.0 };
        let penetration = ((mean_gap - sums.min_gap) / h_range).max(0.0);
        let load = match self.problem.control {
            Control::MeanPressure(wanted) => (mean_pressure - wanted).abs() / wanted,
            Control::Penetration(_) => mean_gap.abs() / h_range,
        };
        let offset = self.problem.offset();
        let displacement_work = sums.pressure_gap + sums.pressure_height - offset * sums.pressure;
        Outcome {
            converged,
            // Σ p (g - min g) / Σ p with the weighted mean of g as zero is -min g: the two errors coincide.
            certificate: Certificate { complementarity: penetration, penetration, load },
            mean_pressure,
            approach: mean_gap - offset,
            elastic_energy: 0.5 * displacement_work / n,
        }
    }

    /// Pressure, and gap with its pressure-weighted mean at zero.
    pub(super) fn into_fields(mut self, mean_gap: f64) -> (Field, Field) {
        self.g.values_mut().par_iter_mut().for_each(|g| *g -= mean_gap);
        (self.p, self.g)
    }
}

fn scale_all(values: &mut [f64], factor: f64) {
    values.par_iter_mut().for_each(|value| *value *= factor);
}
