//! The split kernels of one solid on one base grid.
//!
//! They are made when they are first needed, and kept for all loads.

use std::sync::OnceLock;

use rc_core::{SlidingCompliance, SlidingModes};
use rc_kernel::{ScaleSplit, SplitParams};

use crate::parallel::made;
use crate::tiles::base::Base;
use crate::tiles::gap_operator::PreparedGap;
use crate::tiles::operator::tables::Prepared;
use crate::tiles::solid::Solid;
use crate::tiles::split::{GapSplit, N_SPLITS};

/// Error of the split for the force against a sliding surface.
///
/// Short lengths magnify it, as the force has a difference of displacements over them.
const DISSIPATION_ERROR: f64 = 2e-9;

/// L and its approximate inverse by all splits.
///
/// They are for one solid on one base grid, and one number of border levels.
pub(crate) struct Kernels {
    solid: Solid,
    /// The solid with the storage modulus of each wave, under a sliding surface.
    storage: Option<Solid>,
    border_level: usize,
    quick: OnceLock<Prepared<f32>>,
    quick_storage: OnceLock<Prepared<f32>>,
    dissipation: OnceLock<Prepared<f64>>,
    preconditioner: OnceLock<Prepared<f32>>,
    gaps: [OnceLock<PreparedGap>; N_SPLITS],
}

impl Kernels {
    /// Kernels that are not made yet.
    pub(crate) fn new(solid: Solid, border_level: usize) -> Self {
        let (quick, quick_storage, dissipation, preconditioner, gaps) = Default::default();
        Self { solid, storage: None, border_level, quick, quick_storage, dissipation, preconditioner, gaps }
    }

    /// Kernels of the same solid, of a material that relaxes while a surface slides over it.
    pub(crate) fn under_sliding(self, modes: SlidingModes) -> Self {
        let SlidingModes { compliance, storage } = modes;
        let storage = self.solid.clone().under_sliding(storage);
        let sliding = Self::new(self.solid.under_sliding(compliance), self.border_level);
        Self { storage: Some(storage), ..sliding }
    }

    /// Kernels of the same solid that are not made yet.
    pub(crate) fn empty(&self) -> Self {
        Self { storage: self.storage.clone(), ..Self::new(self.solid.clone(), self.border_level) }
    }

    /// The base grid.
    pub(crate) fn base(&self) -> Base {
        self.solid.base()
    }

    /// What a sliding surface makes of the solid, with lengths in λ. `None` at rest.
    pub(crate) fn sliding(&self) -> Option<&SlidingCompliance> {
        self.solid.sliding()
    }

    /// Displacement by a uniform pressure of 1, in λ.
    pub(crate) fn compliance(&self) -> f64 {
        self.solid.compliance()
    }

    /// The largest deviation of the solid from the half-space that no operator resolves, as a part of 2/q.
    pub(crate) fn unresolved(&self) -> f64 {
        self.solid.unresolved()
    }

    /// Whether a surface slides over the solid.
    pub(crate) fn is_sliding(&self) -> bool {
        self.solid.sliding().is_some()
    }

    /// L for corrections, a few percent off on rough pressures.
    pub(crate) fn quick(&self) -> &Prepared<f32> {
        made(&self.quick, || {
            Prepared::displacement(&ScaleSplit::new(SplitParams::quick()), self.solid.clone(), self.border_level)
        })
    }

    /// As [`Kernels::quick`], of the solid with the storage modulus of each wave. `None` at rest.
    pub(crate) fn quick_storage(&self) -> Option<&Prepared<f32>> {
        let storage = self.storage.as_ref()?;
        Some(made(&self.quick_storage, || {
            Prepared::displacement(&ScaleSplit::new(SplitParams::quick()), storage.clone(), self.border_level)
        }))
    }

    /// The operator of the force against a sliding surface, without lengths below `shortest`, in λ. `None` at rest.
    ///
    /// It is made once, so `shortest` is always the same.
    pub(crate) fn dissipation(&self, shortest: f64) -> Option<&Prepared<f64>> {
        let compliance = self.solid.sliding()?;
        Some(made(&self.dissipation, || {
            let split = SplitParams::for_error(DISSIPATION_ERROR).expect("a split for this error");
            let solid = self.solid.clone().under_sliding(compliance.dissipation(shortest));
            Prepared::displacement(&ScaleSplit::new(split), solid, self.border_level)
        }))
    }

    /// The approximate inverse of L. Under a sliding surface, it is that of the solid with the storage modulus.
    pub(crate) fn preconditioner(&self) -> &Prepared<f32> {
        made(&self.preconditioner, || {
            let solid = self.storage.as_ref().unwrap_or(&self.solid).clone();
            Prepared::inverse(&ScaleSplit::new(SplitParams::quick()), solid)
        })
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
