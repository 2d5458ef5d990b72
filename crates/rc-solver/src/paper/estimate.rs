//! Refusals before any work: parameters out of range, and scenes beyond the budget.

use rc_core::{Boundary, Field, Silent};
use rc_quadtree::paper::{Mask, MeshKind, MeshParams, count};

use crate::descent::info::SolveInfo;
use crate::grid::coarser::{Pits, coarsen, halved};
use crate::levels::uniform::solve_uniform;
use crate::paper::error::GaussSeidelError;
use crate::paper::half_space::HalfSpace;
use crate::paper::params::GaussSeidelParams;
use crate::problem::control::Control;
use crate::problem::params::IterationParams;

/// Maximum number of doublings from the finest to the largest element.
///
/// Beyond it coarsening saves nothing, and heights at centres would need more levels.
pub(super) const LARGEST_DOUBLINGS: u32 = 5;

/// Maximum side of the coarse grid that the cost is estimated on.
const ESTIMATE_SIDE: usize = 256;

/// Rough time of one coefficient from a table, for the message about the budget.
const SECONDS_PER_COEFFICIENT: f64 = 2e-9;

pub(super) fn check(params: &GaussSeidelParams) -> Result<(), GaussSeidelError> {
    let bad = |what, wanted, value| Err(GaussSeidelError::Parameter { what, wanted, value });
    if !(params.relaxation > 0.0 && params.relaxation < 2.0) {
        return bad("the relaxation factor", "above 0 and below 2", params.relaxation);
    }
    if params.increments == 0 {
        return bad("the number of increments", "at least 1", 0.0);
    }
    if params.max_checks == 0 || params.max_sweeps == 0 {
        return bad("the number of sweeps and of double checks", "at least 1", 0.0);
    }
    Ok(())
}

/// The mesh of a grid of `side` elements.
pub(super) fn mesh_params(side: usize, ring: usize) -> MeshParams {
    let doublings = side.trailing_zeros().min(LARGEST_DOUBLINGS);
    MeshParams { base: side >> doublings, ring, halo: 0 }
}

pub(super) fn mesh_kind(params: &GaussSeidelParams) -> MeshKind {
    if params.uniform_elements { MeshKind::AdaptiveUniform } else { MeshKind::Adaptive }
}

/// Results on a coarse grid, in λ.
pub(super) struct Estimate {
    /// Penetration Δ.
    pub(super) penetration: f64,
    /// U/σ0, the ratio of elastic energy to mean pressure.
    pub(super) length: f64,
}

/// Solves the scene on a coarse grid.
///
/// Refuses a scene whose cost would exceed the budget.
pub(super) fn estimate(
    heights: &Field,
    half_space: HalfSpace<'_>,
    control: Control,
    params: &GaussSeidelParams,
) -> Result<Estimate, GaussSeidelError> {
    let coarse = coarsen(heights, Boundary::Periodic, Pits::Filled, halved(heights.grid(), ESTIMATE_SIDE / 2));
    let coarse = std::iter::once(heights).chain(&coarse).find(|field| field.grid().nx() <= ESTIMATE_SIDE);
    // A grid that cannot be halved is its own coarse grid.
    let coarse = coarse.unwrap_or(heights);
    let full_contact = coarse.max() - coarse.mean();
    let control = match control {
        // The coarse grid misses the highest point. Its penetration is kept below its own full contact.
        Control::Penetration(value) => Control::Penetration(value.min(0.999 * full_contact)),
        Control::MeanPressure(_) => control,
    };
    let limits = IterationParams::relative(1e-4);
    let solution = solve_uniform(coarse, half_space.kernel, control, &limits, &Silent)?;
    check_budget(heights, &solution.pressure, params)?;
    let SolveInfo { penetration, elastic_energy, mean_pressure, .. } = solution.info;
    Ok(Estimate { penetration: penetration.max(f64::MIN_POSITIVE), length: elastic_energy / mean_pressure })
}

/// Refuses a scene that needs more coefficients than the budget allows.
///
/// The number comes from the contact of a coarse solution.
fn check_budget(heights: &Field, coarse: &Field, params: &GaussSeidelParams) -> Result<(), GaussSeidelError> {
    let side = heights.grid().nx();
    let ratio = side / coarse.grid().nx();
    let contact = |i: usize| {
        let (ix, iy) = (i % side, i / side);
        coarse.at(ix / ratio, iy / ratio) > 0.0
    };
    let mask = Mask::new(side, (0..heights.grid().len()).map(contact).collect())?;
    let elements: usize = count(&mask, mesh_kind(params), &mesh_params(side, params.ring))?.into_iter().sum();
    let (coefficients, budget) = ((elements as f64).powi(2), params.sweep_budget as f64);
    if coefficients > budget {
        let seconds_per_sweep = coefficients * SECONDS_PER_COEFFICIENT;
        return Err(GaussSeidelError::Budget { elements, coefficients, seconds_per_sweep, budget });
    }
    Ok(())
}
