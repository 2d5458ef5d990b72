//! The split kernels of one solid on one base grid.
//!
//! They are made when they are first needed, and kept for all loads.

use std::sync::OnceLock;

use rc_kernel::{ScaleSplit, SplitParams};

use crate::parallel::made;
use crate::tiles::base::Base;
use crate::tiles::gap_operator::PreparedGap;
use crate::tiles::operator::tables::Prepared;
use crate::tiles::solid::Solid;
use crate::tiles::split::{GapSplit, N_SPLITS};

/// L and its approximate inverse by all splits.
///
/// They are for one solid on one base grid, and one number of border levels.
pub(crate) struct Kernels {
    solid: Solid,
    border_level: usize,
    quick: OnceLock<Prepared<f32>>,
    preconditioner: OnceLock<Prepared<f32>>,
    gaps: [OnceLock<PreparedGap>; N_SPLITS],
}

impl Kernels {
    /// Kernels that are not made yet.
    pub(crate) fn new(solid: Solid, border_level: usize) -> Self {
        let (quick, preconditioner, gaps) = Default::default();
        Self { solid, border_level, quick, preconditioner, gaps }
    }

    /// Kernels of the same solid that are not made yet.
    pub(crate) fn empty(&self) -> Self {
        Self::new(self.solid.clone(), self.border_level)
    }

    /// The base grid.
    pub(crate) fn base(&self) -> Base {
        self.solid.base()
    }

    /// L for corrections, a few percent off on rough pressures.
    pub(crate) fn quick(&self) -> &Prepared<f32> {
        made(&self.quick, || {
            Prepared::displacement(&ScaleSplit::new(SplitParams::quick()), self.solid.clone(), self.border_level)
        })
    }

    /// The approximate inverse of L.
    pub(crate) fn preconditioner(&self) -> &Prepared<f32> {
        made(&self.preconditioner, || Prepared::inverse(&ScaleSplit::new(SplitParams::quick()), self.base()))
    }

    /// L for fresh gaps.
    pub(crate) fn gap(&self, split: GapSplit) -> &PreparedGap {
        made(&self.gaps[split.index()], || PreparedGap::new(split, self.solid.clone(), self.border_level))
    }

    /// L in single precision, for the contact stiffness and for rows of displacements.
    pub(crate) fn response(&self) -> &Prepared<f32> {
        self.gap(GapSplit::fastest()).single().expect("the fastest split is in single precision")
    }
}
