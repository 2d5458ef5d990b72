//! Data that all levels of one problem share.

use std::sync::Arc;

use rc_comm::Ranks;
use rc_core::{Grid, Kernel};
use rc_quadtree::{ContactFields, Elements, RING, divide};

use crate::descent::load::mean_pressure;
use crate::levels::ground::Ground;
use crate::levels::params::AdaptiveParams;
use crate::parallel;
use crate::problem::checked::Problem;
use crate::problem::control::Control;
use crate::problem::params::IterationParams;
use crate::problem::place::{Checkpoint, Place};
use crate::tiles::base::Base;
use crate::tiles::exclusion::{SmoothDisplacement, possible_contact};
use crate::tiles::gap_operator::{GapOperator, GapTables, PreparedGap};
use crate::tiles::heights::on_demand::Heights;
use crate::tiles::ladder;
use crate::tiles::mesh::Mesh;
use crate::tiles::operator::hierarchy::{Hierarchy, Reach};
use crate::tiles::operator::tables::{Prepared, Tables};
use crate::tiles::prolongation::MeshStart;
use crate::tiles::scaled_operator::ScaledOperator;
use crate::tiles::split::GapSplit;

/// The splits of the kernel for gaps.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Splits {
    /// Split in descents.
    pub(crate) fresh: GapSplit,
    /// Split for certificates: the same or a better one.
    pub(crate) certified: GapSplit,
}

/// What a problem is solved with, whatever its load.
#[derive(Clone, Copy)]
pub(crate) struct Given<'a> {
    pub(crate) ground: &'a Ground<'a>,
    pub(crate) place: &'a Place,
    /// The kernel whose split the ground has.
    pub(crate) kernel: &'a dyn Kernel,
}

/// Heights, load and operators of a problem.
pub(crate) struct Setup<'a> {
    pub(crate) kernel: &'a dyn Kernel,
    pub(crate) heights: &'a Heights<'a>,
    base: Base,
    pub(crate) problem: Problem,
    pub(crate) params: IterationParams,
    pub(crate) border_level: usize,
    /// Ranks that elements are dealt among.
    pub(crate) ranks: &'a Ranks,
    /// Storage for the start of each level, if a solve is to be continued.
    pub(crate) checkpoint: Option<&'a dyn Checkpoint>,
    /// L for corrections, a few percent off on rough pressures. Its approximate inverse is below.
    pub(crate) quick: &'a Prepared<f32>,
    pub(crate) preconditioner: &'a Prepared<f32>,
    /// L for fresh gaps of descents.
    pub(crate) fresh: &'a PreparedGap,
    /// L for certificates, if it differs from that of descents.
    pub(crate) better: Option<&'a PreparedGap>,
}

impl<'a> Setup<'a> {
    pub(crate) fn new(given: Given<'a>, problem: Problem, params: &AdaptiveParams, splits: Splits) -> Self {
        let Given { ground: Ground { heights, kernels, .. }, place, kernel } = given;
        let Splits { fresh, certified } = splits;
        Self {
            kernel,
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
    pub(crate) fn certified(&self) -> &'a PreparedGap {
        self.better.unwrap_or(self.fresh)
    }

    /// Number of levels from the base grid to one whose whole grid is `grid`.
    pub(crate) fn n_levels(&self, grid: Grid) -> usize {
        ladder::n_levels(self.base.grid(), grid)
    }

    pub(crate) fn hierarchy(&self, mesh: &Mesh, reach: Reach) -> Arc<Hierarchy> {
        Arc::new(Hierarchy::new(self.base, mesh.clone(), reach))
    }

    /// Approximate mean of pressures like that of `start`.
    pub(crate) fn mean_pressure(&self, start: &MeshStart) -> f64 {
        let n_cell = start.elements.finest().sides().into_iter().product::<usize>() as f64;
        match self.problem.bounds.control {
            Control::MeanPressure(mean) => mean,
            Control::Penetration(_) => mean_pressure(n_cell, &start.elements.layout(), &start.pressure),
        }
    }

    /// An operator for fresh gaps under pressures like that of `start`.
    pub(crate) fn operator<'t>(
        &self,
        hierarchy: Arc<Hierarchy>,
        tables: &'t GapTables,
        start: &MeshStart,
    ) -> Box<dyn GapOperator + 't> {
        tables.operator(hierarchy, self.mean_pressure(start), self.problem.h_range)
    }

    /// The quick operator under pressures like that of `start`.
    pub(crate) fn quick_operator<'t>(
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
    pub(crate) fn penetration(&self, contact_gap: f64) -> f64 {
        contact_gap - self.problem.offset() + self.problem.h_max
    }

    /// Tiles where the gap may be less than `gap`, with `extent` columns and rows.
    ///
    /// `smooth` is the smooth part of the displacement.
    pub(crate) fn possible_contact(
        &self,
        smooth: &SmoothDisplacement<'_>,
        extent: [usize; 2],
        gap: f64,
    ) -> Vec<[u32; 2]> {
        let heights = (self.heights, self.base);
        possible_contact(smooth, heights, gap - self.problem.offset(), (extent, self.ranks))
    }

    /// The mesh with elements divided where they are too coarse for their pressure and gap.
    ///
    /// With `deepen`, the smallest elements are divided too.
    pub(crate) fn refined(&self, fields: &ContactFields<'_>, deepen: bool) -> Elements {
        let (heights, pressure) = (self.heights.curvature(), parallel::maximum(fields.pressure, 0.0));
        let hardness = self.problem.bounds.hardness;
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
