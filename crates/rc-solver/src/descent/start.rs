//! The first pressure and gap of a descent.

use crate::descent::load::is_plastic;
use crate::descent::state::Descent;
use crate::descent::sums::GapSums;
use crate::parallel;
#[cfg(doc)]
use crate::problem::checked::Problem;
use crate::problem::control::Control;

/// Factor by which the pressure of a rigid overlap may miss the prescribed load.
///
/// The pressure is then scaled to the load. It is computed at most `MAX_OVERLAPS` times. `docs/constants.md`
/// compares these values with others.
const LOAD_FACTOR: f64 = 1.3;
const MAX_OVERLAPS: usize = 3;

/// First overlap, as a part of the range of depths ([`Problem::depth_range`]).
///
/// The number below is the exponent of the load as a power of the overlap, until two overlaps are known.
const FIRST_OVERLAP: f64 = 0.25;
const FIRST_EXPONENT: f64 = 1.5;

/// Bounds of the exponent of the load as a power of the overlap.
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

    /// Moves to the next depth.
    ///
    /// The present depth carries `load`, which is too small by the factor `missing`. The next depth is NaN when two
    /// loads are equal.
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
    /// Computes the first pressure and gap.
    pub(crate) fn start(&mut self) -> GapSums {
        let present = self.pressure.sum(&self.layout) / self.n_cell();
        let usable = self.has_start && present > 0.0;
        if usable && self.problem.bounds.is_limited() && is_plastic(&self.pressure.all(), self.problem.bounds) {
            return if self.has_gap { self.rescale(1.0) } else { self.plastic_start() };
        }
        let sums = self.elastic_start(present, usable);
        self.within_bounds(sums)
    }

    /// Projects a start that has reached the hardness, without a gap.
    pub(crate) fn plastic_start(&mut self) -> GapSums {
        let heights = self.heights.part(0..self.heights.len());
        for (g, h) in self.gap.all_mut().iter_mut().zip(&*heights) {
            *g = -h;
        }
        self.project_to_load();
        let sums = self.fresh_gap();
        self.settle(sums)
    }

    /// Computes the first pressure and gap, as if there were no hardness.
    fn elastic_start(&mut self, present: f64, usable: bool) -> GapSums {
        if self.has_gap && usable {
            return match self.problem.bounds.control {
                Control::MeanPressure(mean) => self.rescale(mean / present),
                Control::Penetration(_) => {
                    let sums = self.rescale(1.0);
                    self.meet_penetration(sums)
                }
            };
        }
        match self.problem.bounds.control {
            Control::MeanPressure(mean) if !usable => return self.overlap_of_load(mean),
            Control::MeanPressure(_) => self.project_to_load(),
            Control::Penetration(_) if usable => {}
            // The overlap finds the right places. The pressure is scaled at once.
            Control::Penetration(_) => {
                let sums = self.overlap(self.problem.offset());
                // On a coarse level, nothing may overlap.
                let scale = sums.scale_to_no_gap().filter(|scale| *scale > 0.0);
                return scale.map_or(sums, |scale| self.rescale(scale));
            }
        }
        self.refresh()
    }

    /// Sets the pressure to the overlap with a rigid plane at `floor`, and computes the gap.
    ///
    /// Its unit is that of length, so no hardness limits it.
    fn overlap(&mut self, floor: f64) -> GapSums {
        let len = self.layout.len();
        parallel::for_each(self.elements().blocks(len), |block| {
            block.with_heights(|values| {
                for (p, h) in values.pressure.iter_mut().zip(values.heights) {
                    *p = (h - floor).max(0.0);
                }
            });
        });
        self.fresh_gap_under(f64::INFINITY)
    }

    /// Starts from the overlap with a rigid plane that carries about the mean pressure `wanted`.
    ///
    /// The pressure of the overlap is first scaled so that its weighted mean gap is zero. The load of this pressure
    /// counts. If only an overlap beyond the range of depths would carry the load, the start is a uniform pressure.
    fn overlap_of_load(&mut self, wanted: f64) -> GapSums {
        let n_cell = self.n_cell();
        // A coarse level may not be as high as the finest.
        let highest = self.layout.maximum(&self.heights.part(0..self.heights.len()), f64::NEG_INFINITY);
        let range = self.problem.depth_range();
        let mut search = DepthSearch::new(range);
        for attempt in 1..=MAX_OVERLAPS {
            let floor = highest - search.depth;
            let sums = self.overlap(floor);
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
        self.pressure.update(|p| *p = wanted);
        self.project_to_load();
        self.refresh()
    }
}
