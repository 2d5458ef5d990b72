//! Data that all levels of one problem share.

use std::sync::Arc;

use rc_comm::Ranks;
use rc_core::Grid;
use rc_quadtree::{ContactFields, Elements, RING, divide};

use super::AdaptiveParams;
use super::base::Base;
use super::checkpoint::Checkpoint;
use super::exclusion::{SmoothDisplacement, possible_contact};
use super::gap_operator::{GapOperator, GapTables, PreparedGap};
use super::ground::Ground;
use super::heights::Heights;
use super::ladder;
use super::mesh::Mesh;
use super::operator::{Hierarchy, Prepared, Reach, Tables};
use super::prolongation::MeshStart;
use super::scaled_operator::ScaledOperator;
use super::split::GapSplit;
use crate::descent::{is_plastic, mean_pressure};
use crate::parallel;
use crate::problem::Problem;
use crate::{Control, IterationParams};

/// The splits of the kernel for gaps.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Splits {
    /// Split in descents.
    pub(super) fresh: GapSplit,
    /// Split for certificates: the same or a better one.
    pub(super) certified: GapSplit,
}

/// The place where a problem is solved.
#[derive(Clone, Default)]
pub(crate) struct Place {
    /// Ranks that the mesh is dealt among.
    pub(crate) ranks: Ranks,
    /// Storage for the start of each level, if a solve is to be continued.
    pub(crate) checkpoint: Option<Arc<dyn Checkpoint>>,
}

/// Heights, load and operators of a problem.
pub(super) struct Setup<'a> {
    pub(super) heights: &'a Heights<'a>,
    base: Base,
    pub(super) problem: Problem,
    pub(super) params: IterationParams,
    pub(super) border_level: usize,
    /// Ranks that elements are dealt among.
    pub(super) ranks: &'a Ranks,
    /// Storage for the start of each level, if a solve is to be continued.
    pub(super) checkpoint: Option<&'a dyn Checkpoint>,
    /// L for corrections, a few percent off on rough pressures. Its approximate inverse is below.
    pub(super) quick: &'a Prepared<f32>,
    pub(super) preconditioner: &'a Prepared<f32>,
    /// L for fresh gaps of descents.
    pub(super) fresh: &'a PreparedGap,
    /// L for certificates, if it differs from that of descents.
    pub(super) better: Option<&'a PreparedGap>,
}

impl<'a> Setup<'a> {
    pub(super) fn new(
        (ground, place): (&'a Ground<'_>, &'a Place),
        problem: Problem,
        params: &AdaptiveParams,
        splits: Splits,
    ) -> Self {
        let Ground { heights, kernels, .. } = ground;
        let Splits { fresh, certified } = splits;
        Self {
            quick: kernels.quick(),
            preconditioner: kernels.preconditioner(),
            fresh: kernels.gap(fresh),
            better: (certified != fresh).then(|| kernels.gap(certified)),
            heights,
            base: kernels.base(),
            problem,
            params: params.solve,
            border_level: params.border_level,
            ranks: &place.ranks,
            checkpoint: place.checkpoint.as_deref(),
        }
    }

    /// L for certificates.
    pub(super) fn certified(&self) -> &'a PreparedGap {
        self.better.unwrap_or(self.fresh)
    }

    /// Number of levels from the base grid to one whose whole grid is `grid`.
    pub(super) fn n_levels(&self, grid: Grid) -> usize {
        ladder::n_levels(self.base.grid(), grid)
    }

    pub(super) fn hierarchy(&self, mesh: &Mesh, reach: Reach) -> Arc<Hierarchy> {
        Arc::new(Hierarchy::new(self.base, mesh.clone(), reach))
    }

    /// Approximate mean of pressures like that of `start`.
    pub(super) fn mean_pressure(&self, start: &MeshStart) -> f64 {
        let n_cell = start.elements.finest().sides().into_iter().product::<usize>() as f64;
        match self.problem.control {
            Control::MeanPressure(mean) => mean,
            Control::Penetration(_) => mean_pressure(n_cell, &start.elements.layout(), &start.pressure),
        }
    }

    /// An operator for fresh gaps under pressures like that of `start`.
    pub(super) fn operator<'t>(
        &self,
        hierarchy: Arc<Hierarchy>,
        tables: &'t GapTables,
        start: &MeshStart,
    ) -> Box<dyn GapOperator + 't> {
        tables.operator(hierarchy, self.mean_pressure(start), self.problem.h_range)
    }

    /// The quick operator under pressures like that of `start`.
    pub(super) fn quick_operator<'t>(
        &self,
        hierarchy: Arc<Hierarchy>,
        tables: &'t Tables<f32>,
        start: &MeshStart,
    ) -> ScaledOperator<'t, f32> {
        ScaledOperator::new(hierarchy, tables, self.mean_pressure(start), self.problem.h_range)
    }

    /// The penetration at which the gap in contact is `contact_gap`.
    ///
    /// No displacement of a partial contact exceeds it.
    pub(super) fn penetration(&self, contact_gap: f64) -> f64 {
        contact_gap - self.problem.offset() + self.problem.h_max
    }

    /// Tiles where the gap may be less than `gap`, with `extent` columns and rows.
    ///
    /// `smooth` is the smooth part of the displacement.
    pub(super) fn possible_contact(
        &self,
        smooth: &SmoothDisplacement<'_>,
        extent: [usize; 2],
        gap: f64,
    ) -> Vec<[u32; 2]> {
        let heights = (self.heights, self.base);
        possible_contact(smooth, heights, gap - self.problem.offset(), (extent, self.ranks))
    }

    /// Whether a pressure has reached the hardness.
    pub(super) fn is_plastic(&self, pressure: &[f64]) -> bool {
        is_plastic(pressure, self.problem.hardness)
    }

    /// The mesh with elements divided where they are too coarse for their pressure and gap.
    ///
    /// With `deepen`, the smallest elements are divided too.
    pub(super) fn refined(&self, fields: &ContactFields<'_>, deepen: bool) -> Elements {
        let (heights, pressure) = (self.heights.curvature(), parallel::maximum(fields.pressure, 0.0));
        let hardness = self.problem.hardness;
        // No pressure is nearer than the ring. So ∫ p |∂²(1/πr)/∂x²| dA ≤ max p ∫ 2/(π r³) dA.
        let of_displacement = |side: f64| 4.0 * pressure / ((RING - 1) as f64 * side);
        let curvature = |coarser| heights + of_displacement(fields.elements.side(coarser));
        let mut chosen = fields.too_coarse(curvature);
        if pressure >= hardness {
            // The edges of the plastic part are those of the rest that pressures leave to the hardness. Plastic
            // elements must not hide any of it.
            let rest: Vec<f64> = fields.pressure.iter().map(|p| hardness - p).collect();
            let gap: Vec<f64> = fields.gap.iter().map(|g| -g).collect();
            let (beyond, contact_gap) = (hardness, -fields.contact_gap);
            let rest = ContactFields { pressure: &rest, beyond, gap: &gap, contact_gap, ..*fields };
            for (chosen, of_rest) in chosen.iter_mut().flatten().zip(rest.too_coarse(curvature).into_iter().flatten()) {
                *chosen |= of_rest;
            }
        }
        divide(fields.elements, chosen, deepen, self.certified().reach().stencil)
    }
}
