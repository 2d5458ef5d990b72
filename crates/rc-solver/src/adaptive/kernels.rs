//! The split kernels of one base grid: made when they are first asked for, and kept for all loads.

use std::sync::OnceLock;

use rc_core::Grid;
use rc_kernel::{ScaleSplit, SplitParams};

use super::gap_operator::PreparedGap;
use super::operator::Prepared;
use super::split::{GapSplit, N_SPLITS};

/// L and its approximate inverse by all splits, for one base grid and number of border levels.
pub(super) struct Kernels {
    base: Grid,
    border_level: usize,
    quick: OnceLock<Prepared<f32>>,
    preconditioner: OnceLock<Prepared<f32>>,
    response: OnceLock<Prepared<f32>>,
    gaps: [OnceLock<PreparedGap>; N_SPLITS],
}

impl Kernels {
    /// Nothing is made yet.
    pub(super) fn new(base: Grid, border_level: usize) -> Self {
        let (quick, preconditioner, response) = Default::default();
        Self { base, border_level, quick, preconditioner, response, gaps: Default::default() }
    }

    /// Kernels of the same base grid, none of which is made yet.
    pub(super) fn empty(&self) -> Self {
        Self::new(self.base, self.border_level)
    }

    /// L, a few percent off on rough pressures, for corrections.
    pub(super) fn quick(&self) -> &Prepared<f32> {
        made(&self.quick, || {
            Prepared::displacement(&ScaleSplit::new(SplitParams::quick()), self.base, self.border_level)
        })
    }

    /// The approximate inverse of L.
    pub(super) fn preconditioner(&self) -> &Prepared<f32> {
        made(&self.preconditioner, || Prepared::inverse(&ScaleSplit::new(SplitParams::quick()), self.base))
    }

    /// L for fresh gaps.
    pub(super) fn gap(&self, split: GapSplit) -> &PreparedGap {
        made(&self.gaps[split.index()], || PreparedGap::new(split, self.base, self.border_level))
    }

    /// L in single precision, for the contact stiffness and for rows of displacements.
    pub(super) fn response(&self) -> &Prepared<f32> {
        let single = self.gaps.iter().filter_map(OnceLock::get).find_map(PreparedGap::single);
        single.unwrap_or_else(|| {
            made(&self.response, || {
                Prepared::displacement(&ScaleSplit::new(SplitParams::certified()), self.base, self.border_level)
            })
        })
    }
}

/// The value of `cell`, made when there is none yet. Not under a lock: threads that wait for each other inside `make` may take up another
/// load, which wants the same value.
fn made<T>(cell: &OnceLock<T>, make: impl FnOnce() -> T) -> &T {
    if let Some(value) = cell.get() {
        return value;
    }
    let value = make();
    cell.get_or_init(|| value)
}
