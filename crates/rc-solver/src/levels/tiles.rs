//! The levels on tiles of one problem, with their operators.

use std::sync::Arc;

use rc_comm::Ranks;
use rc_core::{Boundary, Grid, HeightSource, Kernel, SplitByScale};
use rc_quadtree::{ContactFields, Elements, RING, divide};

use crate::descent::load::mean_pressure;
use crate::levels::base_grid::base_sides;
use crate::levels::checks::{check_memory, first_split, with_border_level};
use crate::levels::estimate::{Estimate, MORE_BYTES_OF_SLIDING};
use crate::levels::params::AdaptiveParams;
use crate::levels::split::{check_modes, check_split};
use crate::parallel;
use crate::problem::adaptive_error::AdaptiveError;
use crate::problem::capabilities::{Feature, refusal};
use crate::problem::checked::Problem;
use crate::problem::checkpoint::Checkpoint;
use crate::problem::contact_problem::ContactProblem;
use crate::problem::control::Control;
use crate::problem::kernel::OwnedKernel;
use crate::problem::method::Method;
use crate::problem::steps::Step;
use crate::problem::support::Support;
use crate::problem::tolerance::ErrorBound;
use crate::tiles::base::Base;
use crate::tiles::data::TileData;
use crate::tiles::exclusion::{SmoothDisplacement, possible_contact};
use crate::tiles::gap_operator::{GapOperator, GapTables, PreparedGap};
use crate::tiles::heights::on_demand::Heights;
use crate::tiles::kernels::Kernels;
use crate::tiles::ladder::{Ladder, n_levels};
use crate::tiles::memory::base_bytes;
use crate::tiles::mesh::Mesh;
use crate::tiles::operator::hierarchy::{Hierarchy, Reach};
use crate::tiles::operator::tables::Tables;
use crate::tiles::prolongation::MeshStart;
use crate::tiles::scaled_operator::ScaledOperator;
use crate::tiles::solid::Solid;
use crate::tiles::split::GapSplit;

/// A checked contact problem on tiles.
///
/// Heights are sampled, but nothing is solved. Displacements are those of the kernel's [`rc_core::Kernel::split`].
#[derive(Clone)]
pub(crate) struct TileLevels<'a> {
    pub(crate) data: Arc<TileData<'a>>,
    pub(crate) problem: Problem,
    pub(crate) params: AdaptiveParams,
    ranks: Ranks,
    pub(super) checkpoint: Option<Arc<dyn Checkpoint>>,
    pub(super) kernel: OwnedKernel<'a>,
    /// Split for fresh gaps in descents.
    fresh: GapSplit,
    /// Split for certificates: the same or a better one.
    pub(crate) certified: GapSplit,
}

/// Part of a bound on the overlap that deviations may have which the base grid does not resolve, relative to 2/q.
///
/// Where they have more, the base grid is finer. Overlaps are relative to a length that is about a quarter of the
/// largest displacement, and half of the bound is for the rest of the operator's error.
const UNRESOLVED_PART: f64 = 0.05;

/// Smallest energy tolerance at which a descent may be in single precision.
///
/// Rounding moves gaps by 1e-7 of the displacements around them, and errors of single precision in corrections by more.
const LOOSE: f64 = 1e-3;

/// Checks the `split` of the `kernel`, and samples the heights. Tables are made when they are needed.
///
/// # Errors
/// [`AdaptiveError`].
pub(crate) fn prepare<'a>(
    source: HeightSource<'a>,
    kernel: &dyn Kernel,
    split: &dyn SplitByScale,
    params: &AdaptiveParams,
) -> Result<TileData<'a>, AdaptiveError> {
    let grid = source.grid();
    let boundary = Support::of(kernel, grid).boundary;
    // This check comes before any work.
    first_split(params)?;
    let usual = base_sides(&source, params.base_side, boundary)?;
    let finer = params.base_side.is_none().then(|| base_sides(&source, Some(2 * usual[0]), boundary).ok()).flatten();
    let source = with_border_level(source, params.border_level)?;
    let allowed = UNRESOLVED_PART * params.solve.bound.overlap();
    let solid = |base| Solid::new(kernel, split, Base::new(Ladder::new(base, source.grid()), boundary), allowed);
    let (base, solid) = match (solid(usual), finer) {
        (Ok(solid), _) => (usual, solid),
        (_, Some(finer)) => (finer, solid(finer)?),
        (Err(error), None) => return Err(error),
    };
    check_split(kernel, split, grid)?;
    let ladder = Ladder::new(base, source.grid());
    let sampled_bytes = Heights::sampled_bytes(&source, ladder);
    let mut kernels = Kernels::new(solid, params.border_level);
    if kernel.sliding_velocity().is_some() {
        // Stencils with tails are those of elements of one size, on levels that halve.
        let has_form = boundary == Boundary::Periodic && ladder.is_even() && params.border_level == 0;
        if let Some(modes) = kernel.sliding_modes().filter(|_| has_form) {
            check_modes(kernel, split, &modes, ladder.base())?;
            kernels = kernels.under_sliding(modes);
        } else if let Some(refusal) = refusal(&[Feature::LagOnGrid], Some(Method::Adaptive)) {
            return Err(refusal.into());
        }
    }
    check_memory(grid, params.memory_limit, base_bytes(kernels.base().period()) + sampled_bytes, None)?;
    let heights = Heights::with_borders(source, base, boundary)?;
    let half_space = kernel.half_space().map(|_| Kernels::new(kernels.base().into(), params.border_level));
    Ok(TileData { heights, kernels, half_space, sampled_bytes })
}

impl<'a> TileLevels<'a> {
    /// The problem of one load.
    ///
    /// `data` was prepared with its kernel and the same `params`.
    ///
    /// # Errors
    /// [`AdaptiveError`].
    pub(crate) fn new(
        data: &Arc<TileData<'a>>,
        asked: &ContactProblem<'a>,
        params: &AdaptiveParams,
    ) -> Result<Self, AdaptiveError> {
        let split = first_split(params)?;
        let support = Support { boundary: data.boundary(), compliance: data.kernels.compliance() };
        let problem = Problem::of_statistics(data.heights.extremes(), asked.bounds(), &params.solve, support)?;
        if problem.h_range == 0.0
            && let Some(refusal) = refusal(&[Feature::Flat], Some(Method::Adaptive))
        {
            return Err(refusal.into());
        }
        let levels = Self {
            data: Arc::clone(data),
            problem,
            params: *params,
            ranks: asked.ranks.clone(),
            checkpoint: asked.checkpoint.clone(),
            kernel: asked.kernel.clone(),
            fresh: split,
            certified: split,
        };
        let Estimate { area_fraction, adaptive_bytes, .. } = levels.estimate();
        // Ranks share all bytes except those of the base grid.
        let base_bytes = base_bytes(levels.base().period()) + levels.data.sampled_bytes;
        let bytes = base_bytes + (adaptive_bytes - base_bytes) / levels.ranks().size() as f64;
        check_memory(levels.solution_grid(), params.memory_limit, bytes, Some(100.0 * area_fraction))?;
        Ok(levels)
    }

    /// The expected cost of the solve, from only the surface and the load.
    pub(crate) fn estimate(&self) -> Estimate {
        let TileData { heights, sampled_bytes, .. } = &*self.data;
        let period_and_spares = (self.base().period(), |n| self.spares(n));
        let estimate = Estimate::new(heights, self.params.border_level, &self.problem, period_and_spares);
        let of_sliding = if self.data.kernels.is_sliding() { MORE_BYTES_OF_SLIDING * estimate.cells } else { 0.0 };
        Estimate { adaptive_bytes: estimate.adaptive_bytes + sampled_bytes + of_sliding, ..estimate }
    }

    /// The same levels with another split for certificates.
    pub(super) fn with(&self, certified: GapSplit) -> Self {
        Self { certified, ..self.clone() }
    }

    /// Whether a descent or an evaluation on `n` elements spares memory.
    ///
    /// Pressure and gap of a descent are then in single precision, and heights and gaps are not kept.
    pub(super) fn spares(&self, n: usize) -> bool {
        let (bounds, bound) = (self.problem.bounds, self.params.solve.bound);
        let is_loose = matches!(bound, ErrorBound::Energy(value) if value >= LOOSE);
        let is_usual = bounds.mean().is_some() && !bounds.is_limited() && self.problem.support.is_none();
        let is_simple = self.params.border_level == 0 && self.ranks().size() == 1 && !self.data.kernels.is_sliding();
        n > self.params.spare_above && is_loose && is_usual && is_simple
    }

    /// The grid that solutions are on.
    pub(super) fn solution_grid(&self) -> Grid {
        let (finest, level) = (self.finest(), self.params.border_level);
        finest.with_elements(finest.nx() >> level, finest.ny() >> level).expect("a coarser grid than the finest")
    }

    pub(super) fn finest(&self) -> Grid {
        self.ladder().finest()
    }

    pub(super) fn ladder(&self) -> Ladder {
        self.data.heights.ladder()
    }

    pub(super) fn boundary(&self) -> Boundary {
        self.problem.support.boundary
    }

    pub(crate) fn ranks(&self) -> &Ranks {
        &self.ranks
    }

    /// The base grid.
    pub(crate) fn base(&self) -> Base {
        self.data.kernels.base()
    }

    /// L for fresh gaps of descents.
    pub(crate) fn fresh(&self) -> &PreparedGap {
        self.data.kernels.gap(self.fresh)
    }

    /// L for certificates, if it differs from that of descents.
    pub(crate) fn better(&self) -> Option<&PreparedGap> {
        (self.certified != self.fresh).then(|| self.certified())
    }

    /// L for certificates.
    pub(crate) fn certified(&self) -> &PreparedGap {
        self.data.kernels.gap(self.certified)
    }

    /// Number of levels from the base grid to one whose whole grid is `grid`.
    pub(crate) fn n_levels(&self, grid: Grid) -> usize {
        n_levels(self.base().grid(), grid)
    }

    pub(crate) fn hierarchy(&self, mesh: &Mesh, reach: Reach) -> Arc<Hierarchy> {
        Arc::new(Hierarchy::new(self.base(), mesh.clone(), reach))
    }

    /// Approximate mean of pressures like that of `start`.
    fn mean_pressure(&self, start: &MeshStart) -> f64 {
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

    /// A bound of the displacements under pressures like that of `start`, without the one by their mean.
    ///
    /// It is the penetration at which the gap in contact is `contact_gap`. No displacement of a partial contact exceeds
    /// it.
    pub(crate) fn largest_displacement(&self, start: &MeshStart, contact_gap: f64) -> f64 {
        let uniform = self.problem.uniform_displacement(self.mean_pressure(start));
        (contact_gap - self.problem.offset() + self.problem.h_max - uniform).abs()
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
        let _running = Step::Exclusion.begin();
        let heights = (&self.data.heights, self.base());
        possible_contact(smooth, heights, gap - self.problem.offset(), (extent, self.ranks()))
    }

    /// The mesh with elements divided where they are too coarse for their pressure and gap.
    ///
    /// With `deepen`, the smallest elements are divided too.
    pub(crate) fn refined(&self, fields: &ContactFields<'_>, deepen: bool) -> Elements {
        let _running = Step::Exclusion.begin();
        let (heights, pressure) = (self.data.heights.curvature(), parallel::maximum(fields.pressure, 0.0));
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

#[cfg(test)]
mod tests {
    use rc_core::{DVec2, HeightField};

    use super::*;
    use crate::problem::params::IterationParams;

    #[test]
    fn a_base_grid_above_the_limit_is_refused_before_heights_are_sampled() {
        struct Unsampled;
        impl HeightField for Unsampled {
            fn height(&self, _at: DVec2) -> f64 {
                panic!("sampled")
            }

            fn band_limit(&self) -> Option<usize> {
                Some(1000)
            }
        }
        let params = AdaptiveParams {
            solve: IterationParams::relative(1e-6),
            operator_error: 1e-6,
            spare_above: usize::MAX,
            border_level: 0,
            base_side: None,
            memory_limit: Some(100_000_000),
        };
        let source = Unsampled.on(Grid::square(32768).expect("a grid"));
        let error = prepare(source, &rc_kernel::Love, &rc_kernel::HalfSpace, &params).err();
        let expected = matches!(error, Some(AdaptiveError::Memory { limit: 100, area_percent: None, .. }));
        assert!(expected, "{error:?}");
    }
}
