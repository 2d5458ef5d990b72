//! Where a descent starts.

use rayon::prelude::*;

use super::{Descent, Engine, GapSums, mean_pressure, scale_to_load};
use crate::Control;

/// The pressure of a rigid overlap may miss the prescribed load by this factor before it is scaled to it, and is computed this
/// often at most. Over 57 cold starts on 64² to 512², 448 iterations and 830 applications of L, the start's included, where a
/// uniform pressure needs 976 and 1519; 444 to 456 with a factor from 1.1 to 2 and three to eight tries.
const LOAD_FACTOR: f64 = 1.3;
const MOST_OVERLAPS: usize = 3;

/// The first overlap, as a part of the height range, and the exponent of the load over the overlap until two are known.
const FIRST_OVERLAP: f64 = 0.25;
const FIRST_EXPONENT: f64 = 1.5;

/// Where a descent starts.
pub(crate) enum Start {
    /// From the overlap with the rigid surface.
    Nothing,
    /// From this pressure, up to a factor.
    Pressure(Vec<f64>),
    /// From this pressure, of which the gap is known.
    Known { pressure: Vec<f64>, gap: Vec<f64> },
}

impl<C: Engine<f32>, F: Engine<f64>> Descent<'_, C, F> {
    /// First pressure and gap.
    pub(super) fn start(&mut self) -> GapSums {
        let n_cell = self.n_cell();
        let present = mean_pressure(n_cell, &self.blocks, &self.p);
        let usable = self.has_start && present > 0.0;
        if self.has_gap && usable {
            return match self.problem.control {
                Control::MeanPressure(mean) => self.rescale(mean / present),
                Control::Penetration(_) => {
                    let sums = self.rescale(1.0);
                    self.meet_penetration(sums)
                }
            };
        }
        match self.problem.control {
            Control::MeanPressure(mean) if !usable => return self.overlap_of_load(mean),
            Control::MeanPressure(_) => scale_to_load(self.problem, n_cell, &self.blocks, &mut self.p),
            Control::Penetration(_) if usable => {}
            // The right places; how hard they press is found at once.
            Control::Penetration(_) => {
                self.overlap(self.problem.offset());
                let sums = self.fresh_gap();
                return sums.scale_to_no_gap().map_or(sums, |scale| self.rescale(scale));
            }
        }
        self.refresh()
    }

    /// Sets the pressure to what the heights overlap with a rigid plane at `floor`, in units of length.
    fn overlap(&mut self, floor: f64) {
        self.p.par_iter_mut().zip(self.heights).for_each(|(p, h)| *p = (h - floor).max(0.0));
    }

    /// The overlap with a rigid plane that carries the mean pressure `wanted`, nearly, when it is scaled so that its weighted mean gap
    /// is zero; a uniform pressure where only an overlap of more than the height range would.
    fn overlap_of_load(&mut self, wanted: f64) -> GapSums {
        let n_cell = self.n_cell();
        // A coarse level may not reach as high as the finest.
        let highest = self.heights.par_iter().copied().reduce(|| f64::NEG_INFINITY, f64::max);
        let (mut depth, mut exponent) = (FIRST_OVERLAP * self.problem.h_range, FIRST_EXPONENT);
        let mut last: Option<(f64, f64)> = None;
        for attempt in 1..=MOST_OVERLAPS {
            let floor = highest - depth;
            self.overlap(floor);
            let sums = self.fresh_gap();
            let carried = sums.pressure / n_cell;
            let scale = (sums.pressure_overlap + (self.problem.offset() - floor) * sums.pressure) / sums.work();
            let load = scale * carried;
            let missing = wanted / load;
            if !(missing > 0.0 && missing.is_finite()) {
                break;
            }
            if attempt == MOST_OVERLAPS || missing.max(missing.recip()) < LOAD_FACTOR {
                return self.rescale(wanted / carried);
            }
            if let Some((shallower, less)) = last {
                exponent = ((load / less).ln() / (depth / shallower).ln()).clamp(0.5, 4.0);
            }
            last = Some((depth, load));
            depth *= missing.powf(exponent.recip());
            // Not a number, when two loads are the same.
            if depth.is_nan() || depth > self.problem.h_range {
                break;
            }
        }
        self.p.fill(wanted);
        scale_to_load(self.problem, n_cell, &self.blocks, &mut self.p);
        self.refresh()
    }
}
