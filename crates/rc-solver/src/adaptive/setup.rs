//! What all levels of one problem share.

use std::sync::Arc;

use rc_core::Grid;
use rc_kernel::{ScaleSplit, SplitParams};
use rc_quadtree::{ContactFields, Elements, RING, divide};

use super::AdaptiveParams;
use super::element_blocks::blocks_of;
use super::exclusion::{SmoothDisplacement, possible_contact};
use super::heights::Heights;
use super::operator::{Hierarchy, Prepared, Reach, Real, Tables};
use super::prolongation::MeshStart;
use super::scaled_operator::ScaledOperator;
use crate::descent::mean_pressure;
use crate::parallel;
use crate::problem::Problem;
use crate::{Control, IterationParams};

/// Bound of the error of a displacement on the base grid, in units of the height range.
const BASE_DISPLACEMENT_ERROR: f64 = 1e-5;

/// Heights, load and operators of a problem; `T` is the precision of fresh gaps.
pub(super) struct Setup<'a, T> {
    pub(super) heights: &'a Heights<'a>,
    pub(super) problem: Problem,
    pub(super) params: IterationParams,
    pub(super) border_level: usize,
    pub(super) split: SplitParams,
    /// L, a few percent off on rough pressures, and its approximate inverse, for corrections.
    pub(super) quick: Prepared<f32>,
    pub(super) preconditioner: Prepared<f32>,
    /// L to the error of `split`, for fresh gaps.
    pub(super) certified: Prepared<T>,
}

impl<'a, T: Real + Into<f64>> Setup<'a, T> {
    pub(super) fn new(heights: &'a Heights<'a>, problem: Problem, params: &AdaptiveParams, split: SplitParams) -> Self {
        let (quick, certified) = (ScaleSplit::new(SplitParams::quick()), ScaleSplit::new(split));
        let (base, border_level) = (heights.base().grid(), params.border_level);
        Self {
            quick: Prepared::displacement(&quick, base, border_level),
            preconditioner: Prepared::inverse(&quick, base),
            certified: Prepared::displacement(&certified, base, border_level),
            heights,
            problem,
            params: params.solve,
            border_level,
            split,
        }
    }

    /// The base grid.
    pub(super) fn base(&self) -> Grid {
        self.heights.base().grid()
    }

    /// Levels from the base grid to one whose whole grid is `grid`.
    pub(super) fn n_levels(&self, grid: Grid) -> usize {
        (grid.nx() / self.base().nx()).ilog2() as usize
    }

    pub(super) fn hierarchy(&self, elements: &Elements, reach: Reach) -> Arc<Hierarchy> {
        Arc::new(Hierarchy::new(self.base().nx(), elements.clone(), reach))
    }

    /// An operator for fresh gaps under pressures like that of `start`.
    pub(super) fn operator<'t, U: Real + Into<f64>>(
        &self,
        hierarchy: Arc<Hierarchy>,
        tables: &'t Tables<U>,
        start: &MeshStart,
    ) -> ScaledOperator<'t, U> {
        let n_cell = (start.elements.finest().side() as f64).powi(2);
        let mean = match self.problem.control {
            Control::MeanPressure(mean) => mean,
            Control::Penetration(_) => mean_pressure(n_cell, &blocks_of(&start.elements), &start.pressure),
        };
        ScaledOperator::new(hierarchy, tables, mean, self.problem.h_range)
    }

    /// Tiles, of `per_side` per side of the cell, where the gap under `pressure`, which `operator` was applied to last, may be less
    /// than `gap`. `unit_curvature` bounds the second derivatives of the operator's smooth displacement for pressures up to 1
    /// ([`Prepared::remainder_curvature`]).
    pub(super) fn possible_contact<U: Real + Into<f64>>(
        &self,
        operator: &ScaledOperator<'_, U>,
        unit_curvature: f64,
        pressure: &[f64],
        per_side: usize,
        gap: f64,
    ) -> Vec<[u32; 2]> {
        let smooth = SmoothDisplacement {
            values: operator.base_displacement(),
            unit: operator.unit(),
            curvature: maximum(pressure) * unit_curvature,
            error: BASE_DISPLACEMENT_ERROR * self.problem.h_range,
        };
        possible_contact(&smooth, self.heights, gap - self.problem.offset(), per_side)
    }

    /// The mesh with elements divided wherever they are too coarse for the pressure and the gap on them; with `deepen` the smallest
    /// too.
    pub(super) fn refined(&self, fields: &ContactFields<'_>, deepen: bool) -> Elements {
        let (heights, pressure) = (self.heights.curvature(), maximum(fields.pressure));
        // No pressure is nearer than the ring: ∫ p |∂²(1/πr)/∂x²| dA ≤ max p ∫ 2/(π r³) dA.
        let of_displacement = |side: f64| 4.0 * pressure / ((RING - 1) as f64 * side);
        let chosen = fields.too_coarse(|coarser| heights + of_displacement(fields.elements.side(coarser)));
        divide(fields.elements, chosen, deepen, self.certified.reach().stencil)
    }
}

/// Largest of the values; zero at least.
fn maximum(values: &[f64]) -> f64 {
    parallel::maximum(values, 0.0)
}
