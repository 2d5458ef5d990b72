//! Reasons why the adaptive method cannot solve a problem.

use rc_core::Grid;
use rc_core::quantity::digits;
use thiserror::Error;

use crate::problem::capabilities::Refusal;
use crate::problem::error::ProblemError;

/// A contact problem that the adaptive method cannot solve.
#[derive(Clone, Debug, PartialEq, Error)]
#[non_exhaustive]
pub enum AdaptiveError {
    /// Heights, load or tolerance are out of range.
    ///
    /// [`crate::solve()`] returns it as [`crate::SolveError::Problem`].
    #[error(transparent)]
    Problem(#[from] ProblemError),
    /// A feature that the adaptive method excludes.
    ///
    /// [`crate::solve()`] returns it as [`crate::SolveError::Unsupported`].
    #[error(transparent)]
    Unsupported(#[from] Refusal),
    /// The grid has no base grid below it.
    #[error("{}", no_base_grid([*nx, *ny], *smallest))]
    Grid {
        /// Elements along x.
        nx: usize,
        /// Elements along y.
        ny: usize,
        /// Number of elements along the longer side below which no grid has one.
        smallest: usize,
    },
    /// The base grid does not resolve the waves at which the solid differs from the half-space.
    #[error(
        "the kernel {kernel} deviates from the half-space up to a wavenumber of {} rad/λ, but the base grid of the adaptive method resolves deviations up to {} (0 with free borders)", digits(*deviates_below, 3), digits(*resolved, 3)
    )]
    Deviation {
        /// Name of the kernel.
        kernel: &'static str,
        /// The angular wavenumber up to which it deviates, in rad/λ ([`rc_core::SplitByScale::deviates_below`]).
        deviates_below: f64,
        /// The angular wavenumber up to which the base grid resolves deviations, in rad/λ.
        resolved: f64,
    },
    /// The base grid cannot hold the surface's spectrum, or does not divide the finest grid.
    #[error(
        "a base grid of {base} elements per side does not fit {waves} waves and {finest} elements per side: it must be a multiple of 8, more than twice the waves, and the finest grid 2^k times it"
    )]
    Base {
        /// Elements per side of the base grid.
        base: usize,
        /// Largest wavenumber of the surface.
        waves: usize,
        /// Elements per side of the finest grid.
        finest: usize,
    },
    /// The smallest elements would be too small for the tables of tiles.
    #[error(
        "border level {border_level} on a grid of {side} elements per side is too deep: {deepest} is the deepest for it"
    )]
    BorderLevel {
        /// The border level that was requested.
        border_level: usize,
        /// Elements per side of the grid.
        side: usize,
        /// The maximum border level.
        deepest: u32,
    },
    /// The estimated memory is above the limit.
    #[error("the adaptive method needs about {needed} MB {}, more than the limit of {limit} MB", needed_for(*area_percent))]
    Memory {
        /// The grid.
        grid: Grid,
        /// Estimate, in 10^6 bytes.
        needed: u64,
        /// Limit, in 10^6 bytes.
        limit: u64,
        /// Estimated contact area, in percent of the nominal one.
        ///
        /// `None` when the base grid alone is too large, because heights are not sampled then.
        area_percent: Option<f64>,
    },
    /// The requested accuracy of the operator is out of reach.
    #[error("the error bound of the operator must be between {smallest:e} and 1e-3, not {value:e}")]
    OperatorError {
        /// The accuracy that was requested.
        value: f64,
        /// The smallest error that is possible.
        smallest: f64,
    },
}

fn needed_for(area_percent: Option<f64>) -> String {
    match area_percent {
        Some(percent) => format!("for an estimated contact area of {percent:.1} %"),
        None => "for its base grid alone".into(),
    }
}

fn no_base_grid([nx, ny]: [usize; 2], smallest: usize) -> String {
    if nx.max(ny) < smallest {
        format!(
            "the adaptive method needs at least {smallest} elements along the longer side of the grid, not {nx} x {ny}"
        )
    } else {
        format!(
            "the adaptive method has no base grid of nearly square elements for {nx} x {ny}; other numbers of elements may have one, and multiples of 16 do"
        )
    }
}
