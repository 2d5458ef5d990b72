//! L for fresh gaps: a split kernel in the precision that its error needs.

use std::sync::Arc;

use rc_core::Grid;
use rc_kernel::ScaleSplit;

use crate::descent::operators::BlockOperator;
use crate::tiles::operator::hierarchy::{Hierarchy, Reach};
use crate::tiles::operator::sizes::Real;
use crate::tiles::operator::tables::{Prepared, Tables};
use crate::tiles::scaled_operator::ScaledOperator;
use crate::tiles::solid::Solid;
use crate::tiles::split::GapSplit;

/// L on the elements of one mesh, with the smooth part of its displacement.
pub(crate) trait GapOperator: BlockOperator<f64> {
    /// Displacement of the centres of the base grid's period by the last pressure, in λ.
    ///
    /// Short-range parts are not included. Values are tile by tile, and tiles row by row.
    fn base_displacement(&self) -> Vec<f64>;

    /// Frees what the last application has left and [`BlockOperator::read`] does not need, which includes the displacement
    /// of the base grid. Nothing is written any more.
    fn end(&mut self);
}

impl<T: Real + Into<f64>> GapOperator for ScaledOperator<'_, T> {
    fn base_displacement(&self) -> Vec<f64> {
        Self::base_displacement(self)
    }

    fn end(&mut self) {
        Self::end(self);
    }
}

/// A split kernel, ready for meshes of any number of levels.
///
/// Single precision takes half the time and memory.
pub(crate) enum PreparedGap {
    Single(GapSplit, Prepared<f32>),
    Double(GapSplit, Prepared<f64>),
}

/// Tables of a split kernel for one finest grid.
pub(crate) enum GapTables {
    Single(Tables<f32>),
    Double(Tables<f64>),
}

impl PreparedGap {
    /// The split kernel for elements up to 2^`n_coarse` times as large as the smallest.
    pub(crate) fn new(split: GapSplit, solid: impl Into<Solid>, n_coarse: usize) -> Self {
        let kernel = ScaleSplit::new(split.params);
        if split.is_single_precision() {
            Self::Single(split, Prepared::displacement(&kernel, solid, n_coarse))
        } else {
            Self::Double(split, Prepared::displacement(&kernel, solid, n_coarse))
        }
    }

    /// The split kernel, if it is in single precision.
    pub(crate) fn single(&self) -> Option<&Prepared<f32>> {
        match self {
            Self::Single(_, prepared) => Some(prepared),
            Self::Double(..) => None,
        }
    }

    pub(crate) fn split(&self) -> GapSplit {
        match self {
            Self::Single(split, _) | Self::Double(split, _) => *split,
        }
    }

    /// The number of cells that values reach on a level.
    pub(crate) fn reach(&self) -> Reach {
        match self {
            Self::Single(_, prepared) => prepared.reach(),
            Self::Double(_, prepared) => prepared.reach(),
        }
    }

    /// Bound of second derivatives on the base grid: see [`Prepared::remainder_curvature`].
    pub(crate) fn remainder_curvature(&self) -> f64 {
        match self {
            Self::Single(_, prepared) => prepared.remainder_curvature(),
            Self::Double(_, prepared) => prepared.remainder_curvature(),
        }
    }

    pub(crate) fn tables(&self, finest: Grid) -> GapTables {
        match self {
            Self::Single(_, prepared) => GapTables::Single(prepared.tables(finest)),
            Self::Double(_, prepared) => GapTables::Double(prepared.tables(finest)),
        }
    }
}

impl GapTables {
    /// The operator on `hierarchy`, for pressures about `mean` and displacements of about `size`.
    pub(crate) fn operator(&self, hierarchy: Arc<Hierarchy>, mean: f64, size: f64) -> Box<dyn GapOperator + '_> {
        match self {
            Self::Single(tables) => Box::new(ScaledOperator::new(hierarchy, tables, mean, size)),
            Self::Double(tables) => Box::new(ScaledOperator::new(hierarchy, tables, mean, size)),
        }
    }
}
