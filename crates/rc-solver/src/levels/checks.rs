//! The conditions that a problem must meet for the adaptive method, checked before any work.

use rc_core::{Grid, HeightSource};
use rc_kernel::SplitParams;

use crate::levels::params::AdaptiveParams;
use crate::problem::adaptive_error::AdaptiveError;
use crate::problem::tolerance::ErrorBound;
use crate::tiles::split::GapSplit;

/// Error of L that descents may have, as a multiple of a relative tolerance.
///
/// The error is relative to the rms displacement, and tolerances to the height range. On any surface, the height range
/// is at least ten times the rms displacement. The maximum error of an element is up to five times the rms error. With
/// a multiple of 10, a third of a cell in contact at λ_min/128 did not converge to 3e-7.
const OPERATOR_ERROR_PER_TOLERANCE: f64 = 3.0;

/// Error of L that descents may have, under an energy error.
///
/// It is a multiple of the overlap that the energy error aims at. The overlap is in units of U/σ0, which is 0.02 to
/// 0.08 of the height range.
const OPERATOR_ERROR_PER_ENERGY: f64 = 0.5;

/// Maximum number of the smallest elements per side. Indices of tiles are 32-bit numbers.
const DEEPEST_SIDE: usize = 1 << 17;

/// The operator of descents, which follows from the tolerance alone.
pub(crate) fn first_split(params: &AdaptiveParams) -> Result<GapSplit, AdaptiveError> {
    let of_bound = match params.solve.bound {
        ErrorBound::Relative(value) => OPERATOR_ERROR_PER_TOLERANCE * value,
        ErrorBound::Energy(_) => OPERATOR_ERROR_PER_ENERGY * params.solve.bound.aim(),
    };
    let error = params.operator_error.min(of_bound);
    GapSplit::for_error(error)
        .ok_or(AdaptiveError::OperatorError { value: error, smallest: SplitParams::SMALLEST_ERROR })
}

/// The source of heights on the grid of the smallest elements, on a square grid.
pub(super) fn with_border_level(
    source: HeightSource<'_>,
    border_level: usize,
) -> Result<HeightSource<'_>, AdaptiveError> {
    if border_level == 0 {
        return Ok(source);
    }
    let side = source.grid().nx();
    let finest = (border_level < 32).then(|| side.checked_shl(border_level as u32)).flatten();
    let finest = finest.filter(|&finest| finest >> border_level == side && finest <= DEEPEST_SIDE);
    let deepest = (DEEPEST_SIDE / side.max(1)).checked_ilog2().unwrap_or(0);
    let finest = finest.ok_or(AdaptiveError::BorderLevel { border_level, side, deepest })?;
    Ok(source.on_grid(Grid::square(finest).expect("a side of at most the deepest one")))
}

/// Refuses a problem that needs more bytes than the limit.
pub(super) fn check_memory(
    grid: Grid,
    limit: Option<u64>,
    bytes: f64,
    area_percent: Option<f64>,
) -> Result<(), AdaptiveError> {
    match limit {
        Some(limit) if bytes > limit as f64 => {
            let needed = (bytes / 1e6).ceil() as u64;
            Err(AdaptiveError::Memory { grid, needed, limit: limit / 1_000_000, area_percent })
        }
        _ => Ok(()),
    }
}
