//! The first pressure and gap of a descent.

use super::gap::{mean_pressure, scale_to_load};
use super::limited::is_plastic;
use super::state::Descent;
use super::sums::GapSums;
use crate::Control;
use crate::parallel;
#[cfg(doc)]
use crate::problem::Problem;

/// The pressure of a rigid overlap may miss the prescribed load by this factor before it is scaled to it, and is
/// computed this often at most. Over 57 cold starts on 64² to 512², 448 iterations and 830 applications of L, the
/// start's included, where a uniform pressure needs 976 and 1519; 444 to 456 with a factor from 1.1 to 2 and three to
/// eight tries.
const LOAD_FACTOR: f64 = 1.3;
const MAX_OVERLAPS: usize = 3;

/// The first overlap, as a part of the range of depths ([`Problem::depth_range`]), and the exponent of the load over
/// the overlap until two are known.
const FIRST_OVERLAP: f64 = 0.25;
const FIRST_EXPONENT: f64 = 1.5;

/// The exponent of the load over the overlap is kept between these.
const EXPONENTS: [f64; 2] = [0.5, 4.0];

/// The depth of a rigid overlap that carries a load, found by trial.
struct DepthSearch {
    depth: f64,
    exponent: f64,
    /// The last depth and its load.
    last: Option<(f64, f64)>,
}

impl DepthSearch {
    fn new(range: f64) -> Self {
        Self { depth: FIRST_OVERLAP * range, exponent: FIRST_EXPONENT, last: None }
    }

    /// The next depth, when the present one carries `load`, which is too small by the factor `missing`. NaN when two
    /// loads are the same.
    fn improve(&mut self, load: f64, missing: f64) {
        if let Some((last_depth, last_load)) = self.last {
            let [least, most] = EXPONENTS;
            self.exponent = ((load / last_load).ln() / (self.depth / last_depth).ln()).clamp(least, most);
        }
        self.last = Some((self.depth, load));
        self.depth *= missing.powf(self.exponent.recip());
    }
}

impl Descent<'_> {
    /// First pressure and gap.
    pub(super) fn start(&mut self) -> GapSums {
        let n_cell = self.n_cell();
        let present = mean_pressure(n_cell, &self.layout, &self.pressure);
        let usable = self.has_start && present > 0.0;
        if usable && is_plastic(&self.pressure, self.problem.hardness) {
            return if self.has_gap { self.rescale(1.0) } else { self.limit_start() };
        }
        let sums = self.elastic_start(present, usable);
        self.limited(sums)
    }

    /// First pressure and gap, as if there were no hardness.
    fn elastic_start(&mut self, present: f64, usable: bool) -> GapSums {
        let n_cell = self.n_cell();
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
            Control::MeanPressure(_) => scale_to_load(self.problem, n_cell, &self.layout, &mut self.pressure),
            Control::Penetration(_) if usable => {}
            // The right places; how hard they press is found at once.
            Control::Penetration(_) => {
                self.overlap(self.problem.offset());
                let sums = self.fresh_gap();
                // Where all of it is beyond the hardness, nothing scales: what is limited to it is the start.
                let scale = sums.scale_to_no_gap().filter(|scale| *scale > 0.0);
                return scale.map_or(sums, |scale| self.rescale(scale));
            }
        }
        self.refresh()
    }

    /// Sets the pressure to the overlap of the heights with a rigid plane at `floor`, in units of length.
    fn overlap(&mut self, floor: f64) {
        let len = self.layout.len();
        parallel::for_each(self.elements().blocks(len), |block| {
            for (p, h) in block.pressure.iter_mut().zip(block.heights) {
                *p = (h - floor).max(0.0);
            }
        });
    }

    /// The overlap with a rigid plane that carries the mean pressure `wanted`, nearly, when it is scaled so that its
    /// weighted mean gap is zero; a uniform pressure where only an overlap of more than the range of depths would.
    fn overlap_of_load(&mut self, wanted: f64) -> GapSums {
        let n_cell = self.n_cell();
        // A coarse level may not reach as high as the finest.
        let highest = self.layout.maximum(self.heights, f64::NEG_INFINITY);
        let range = self.problem.depth_range();
        let mut search = DepthSearch::new(range);
        for attempt in 1..=MAX_OVERLAPS {
            let floor = highest - search.depth;
            self.overlap(floor);
            let sums = self.fresh_gap();
            let carried = sums.pressure / n_cell;
            let scale = (sums.pressure_overlap + (self.problem.offset() - floor) * sums.pressure) / sums.work();
            let load = scale * carried;
            let missing = wanted / load;
            if !(missing > 0.0 && missing.is_finite()) {
                break;
            }
            if attempt == MAX_OVERLAPS || missing.max(missing.recip()) < LOAD_FACTOR {
                return self.rescale(wanted / carried);
            }
            search.improve(load, missing);
            if search.depth.is_nan() || search.depth > range {
                break;
            }
        }
        self.pressure.fill(wanted);
        scale_to_load(self.problem, n_cell, &self.layout, &mut self.pressure);
        self.refresh()
    }
}
