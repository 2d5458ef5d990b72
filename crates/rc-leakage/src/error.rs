use rc_core::Grid;
use thiserror::Error;

/// A gap without a flow that can be computed.
#[derive(Clone, Copy, Debug, PartialEq, Error)]
#[non_exhaustive]
pub enum LeakageError {
    /// A gap is negative or not finite.
    #[error("the gap of element ({ix}, {iy}) is {value}, not a finite number of at least 0")]
    Gap {
        /// Column.
        ix: usize,
        /// Row.
        iy: usize,
        /// The value.
        value: f64,
    },
    /// The flow through sections still differs after the most iterations.
    #[error(
        "the flow along {axis} through two sections of {grid} elements differs by {conservation:.1e} of it after {iterations} iterations"
    )]
    NotConverged {
        /// Direction of the flow.
        axis: &'static str,
        /// Elements.
        grid: Grid,
        /// Largest relative difference.
        conservation: f64,
        /// Iterations done.
        iterations: usize,
    },
}
