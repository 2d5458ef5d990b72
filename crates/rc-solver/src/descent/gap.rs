//! The gap under a pressure, and the sums over both that scale the pressure and measure its error.

use rayon::prelude::*;

use super::{Blocks, Engine, rows};
use crate::Control;
use crate::problem::Problem;

/// Scaling of the pressure under penetration control is bounded by this factor per round.
const GREATEST_SCALING: f64 = 4.0;

/// Sums over elements in contact or at risk, which the iteration needs after a change of the pressure.
#[derive(Clone, Copy, Debug)]
pub(crate) struct GapSums {
    /// Σ p
    pub(super) pressure: f64,
    /// Σ p g
    pub(super) pressure_gap: f64,
    /// Σ p (h - c), with the constant c of `g = L p - h + c`
    pub(super) pressure_overlap: f64,
    /// min g
    pub(super) min_gap: f64,
    /// Σ g over p > 0
    pub(super) contact_gap: f64,
    /// Σ 1 over p > 0
    pub(super) n_contact: f64,
}

impl GapSums {
    pub(super) const EMPTY: Self = Self {
        pressure: 0.0,
        pressure_gap: 0.0,
        pressure_overlap: 0.0,
        min_gap: f64::INFINITY,
        contact_gap: 0.0,
        n_contact: 0.0,
    };

    pub(super) fn add_element(&mut self, p: f64, g: f64, overlap: f64) {
        self.min_gap = lesser(self.min_gap, g);
        if p > 0.0 {
            self.pressure += p;
            self.pressure_gap += p * g;
            self.pressure_overlap += p * overlap;
            self.contact_gap += g;
            self.n_contact += 1.0;
        }
    }

    /// Adds blocks in their order, weighted by the area of their elements.
    pub(super) fn total(blocks: &Blocks, sums: Vec<Self>) -> Self {
        sums.into_iter().enumerate().fold(Self::EMPTY, |sum, (i, block)| {
            let area = blocks.area(i);
            Self {
                pressure: sum.pressure + area * block.pressure,
                pressure_gap: sum.pressure_gap + area * block.pressure_gap,
                pressure_overlap: sum.pressure_overlap + area * block.pressure_overlap,
                min_gap: lesser(sum.min_gap, block.min_gap),
                contact_gap: sum.contact_gap + area * block.contact_gap,
                n_contact: sum.n_contact + area * block.n_contact,
            }
        })
    }

    /// Pressure-weighted mean of the gap.
    pub(super) fn mean_gap(&self) -> f64 {
        if self.pressure > 0.0 { self.pressure_gap / self.pressure } else { 0.0 }
    }

    /// Σ p v
    pub(super) fn work(&self) -> f64 {
        self.pressure_gap + self.pressure_overlap
    }

    /// The gap of elements in contact: its mean, or zero where the penetration is prescribed.
    pub(super) fn zero_gap(&self, problem: &Problem) -> f64 {
        match problem.control {
            Control::MeanPressure(_) if self.n_contact > 0.0 => self.contact_gap / self.n_contact,
            Control::MeanPressure(_) => self.min_gap,
            Control::Penetration(_) => 0.0,
        }
    }

    /// The factor on the pressure that makes its weighted mean gap zero, under penetration control; within [`GREATEST_SCALING`].
    pub(crate) fn scale_to_penetration(&self, problem: &Problem) -> Option<f64> {
        let Control::Penetration(_) = problem.control else { return None };
        self.scale_to_no_gap().map(|scale| scale.clamp(GREATEST_SCALING.recip(), GREATEST_SCALING))
    }

    /// The factor on the pressure that makes its weighted mean gap zero.
    pub(super) fn scale_to_no_gap(&self) -> Option<f64> {
        let scale = self.pressure_overlap / self.work();
        (scale.is_finite() && self.work() > 0.0).then_some(scale)
    }
}

/// The lesser of two gaps; NaN when one is, which `f64::min` would pass over: what is not a number must not pass for contact.
fn lesser(a: f64, b: f64) -> f64 {
    if b < a || b.is_nan() { b } else { a }
}

/// The positive part of an error; NaN stays, since it is no small one.
pub(super) fn positive_part(error: f64) -> f64 {
    if error < 0.0 { 0.0 } else { error }
}

/// Computes the gap `g` under pressure `p`, from a fresh application of L, on elements with heights `h`.
pub(crate) fn fresh_gap<F: Engine<f64>>(
    engine: &mut F,
    response: &F::Table,
    problem: &Problem,
    (h, p, g): (&[f64], &[f64], &mut [f64]),
) -> GapSums {
    let (blocks, offset) = (engine.blocks(), problem.offset());
    let block = blocks.len();
    engine.fill(p.par_chunks(block), |p, values| values.copy_from_slice(p));
    engine.multiply(response);
    let sinks = (h.par_chunks(block), p.par_chunks(block), g.par_chunks_mut(block));
    let sums = engine.take(response, sinks.into_par_iter(), |(h, p, g), rows| rows::fresh_gap(rows, offset, h, p, g));
    GapSums::total(&blocks, sums)
}

/// Multiplies the pressure `p` by `scale`; the gap `g` follows, since v is linear in p.
pub(crate) fn rescale(
    scale: f64,
    blocks: &Blocks,
    problem: &Problem,
    (h, p, g): (&[f64], &mut [f64], &mut [f64]),
) -> GapSums {
    let (block, offset) = (blocks.len(), problem.offset());
    let vectors = (h.par_chunks(block), p.par_chunks_mut(block), g.par_chunks_mut(block)).into_par_iter();
    GapSums::total(blocks, vectors.map(|(h, p, g)| rows::rescale(scale, offset, h, p, g)).collect())
}

/// Mean of the pressure over a cell of `n_cell` of the smallest elements.
pub(crate) fn mean_pressure(n_cell: f64, blocks: &Blocks, pressure: &[f64]) -> f64 {
    let [sum] = blocks.total(pressure.par_chunks(blocks.len()).map(|block| [block.iter().sum()]).collect());
    sum / n_cell
}

/// Multiplies the pressure so that its mean over a cell of `n_cell` of the smallest elements is the prescribed one, if one is and anything
/// presses.
pub(crate) fn scale_to_load(problem: &Problem, n_cell: f64, blocks: &Blocks, pressure: &mut [f64]) {
    if let Control::MeanPressure(wanted) = problem.control {
        let mean = mean_pressure(n_cell, blocks, pressure);
        if mean > 0.0 {
            scale_all(pressure, wanted / mean);
        }
    }
}

fn scale_all(values: &mut [f64], factor: f64) {
    values.par_iter_mut().for_each(|value| *value *= factor);
}
