//! The critical constriction: the narrowest place on the widest path through the film.

use std::collections::BTreeMap;

use rc_core::{DVec2, Field};

use crate::clusters::Clusters;
use crate::network::Axis;

/// Number of gaps that are tried before those between two of them are sorted.
const SAMPLES: usize = 1 << 14;

/// The narrowest place on the widest path that winds around the cell along an axis.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Constriction {
    /// Gap at the constriction, in λ.
    ///
    /// It is the largest threshold for which the elements at or above the threshold percolate.
    pub gap: f64,
    /// Centre of the element, in λ.
    pub at: DVec2,
}

/// Tests of thresholds for both axes, which are kept by the bits of the gap.
pub(crate) struct Thresholds<'a> {
    gap: &'a Field,
    tested: BTreeMap<u64, [bool; 2]>,
    sample: Vec<f64>,
}

impl<'a> Thresholds<'a> {
    pub(crate) fn new(gap: &'a Field) -> Self {
        let step = gap.values().len().div_ceil(SAMPLES);
        let sample = sorted(gap.values().iter().copied().step_by(step).filter(|&gap| gap > 0.0).collect());
        Self { gap, tested: BTreeMap::new(), sample }
    }

    fn percolates(&mut self, threshold: f64, axis: Axis) -> bool {
        let gap = self.gap;
        let test = || Clusters::above(gap, threshold, true).percolates();
        self.tested.entry(threshold.to_bits()).or_insert_with(test)[axis.index()]
    }

    /// The constriction of a film that percolates along `axis`.
    pub(crate) fn constriction(&mut self, axis: Axis) -> Option<Constriction> {
        let sample = std::mem::take(&mut self.sample);
        let n_open = sample.partition_point(|&threshold| self.percolates(threshold, axis));
        let low = if n_open > 0 { sample[n_open - 1] } else { f64::MIN_POSITIVE };
        let high = sample.get(n_open).copied().unwrap_or(f64::INFINITY);
        self.sample = sample;
        let between = self.gap.values().iter().copied().filter(|gap| (low..high).contains(gap) && *gap > 0.0);
        let candidates = sorted(between.collect());
        let n_open = candidates.partition_point(|&threshold| self.percolates(threshold, axis));
        let gap = *candidates.get(n_open.checked_sub(1)?)?;
        let index = self.gap.values().iter().position(|value| value.to_bits() == gap.to_bits())?;
        let grid = self.gap.grid();
        Some(Constriction { gap, at: grid.centre(index % grid.nx(), index / grid.nx()) })
    }
}

/// The sorted values, without repetitions.
fn sorted(mut values: Vec<f64>) -> Vec<f64> {
    values.sort_by(f64::total_cmp);
    values.dedup();
    values
}
