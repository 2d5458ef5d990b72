//! Errors of flows: gaps that are refused, and flows that do not converge.

use rc_core::Grid;
use thiserror::Error;

/// A flow that cannot be computed.
#[derive(Clone, Copy, Debug, PartialEq, Error)]
#[non_exhaustive]
pub enum LeakageError {
    /// A gap is negative or not finite.
    #[error("the gap of element ({ix}, {iy}) is {value}, not a finite number of at least 0")]
    Gap {
        /// Column of the element.
        ix: usize,
        /// Row of the element.
        iy: usize,
        /// Value of the gap.
        value: f64,
    },
    /// A patch with its mirror images has more elements than a grid.
    #[error(
        "the flow through a patch of {grid} elements needs twice as many per side, and a grid has at most {max}; give at most {half} per side",
        max = Grid::MAX_SIDE,
        half = Grid::MAX_SIDE / 2
    )]
    Images {
        /// Elements of the patch.
        grid: Grid,
    },
    /// The bounds of the permeance, or the flow through sections, still differ after the most iterations.
    #[error(
        "the flow along {axis} on {grid} elements did not converge in {iterations} iterations: its bounds differ by {error:.1e} of the \
         permeance, and the flow through sections by {conservation:.1e}; try another grid or load"
    )]
    NotConverged {
        /// Direction of the flow.
        axis: &'static str,
        /// Elements of the grid.
        grid: Grid,
        /// Maximum relative error of the permeance.
        error: f64,
        /// Maximum relative difference of the flow through a section from the mean over all sections.
        conservation: f64,
        /// Number of iterations.
        iterations: usize,
    },
}
