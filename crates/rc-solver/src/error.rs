//! What is wrong with a contact problem.

use rc_core::Grid;
use thiserror::Error;

/// Heights, a load or a tolerance that cannot be.
#[derive(Clone, Debug, PartialEq, Error)]
#[non_exhaustive]
pub enum ProblemError {
    /// The operator is not for the grid of the heights.
    #[error("the operator has {n_elements} elements and the heights are on {grid}")]
    Operator {
        /// Grid of the heights.
        grid: Grid,
        /// Elements of the operator.
        n_elements: usize,
    },
    /// A height is NaN or infinite.
    #[error("height at element ({ix}, {iy}) is {value}; heights must be finite")]
    Height {
        /// Column.
        ix: usize,
        /// Row.
        iy: usize,
        /// The value.
        value: f64,
    },
    /// The peak-to-valley height is neither 0 nor of a size whose products with pressures are numbers.
    #[error(
        "the range of the heights must be 0 or from {smallest:e} to {greatest:e} (in units of the cell side), not {value:e}"
    )]
    HeightRange {
        /// h_max - h_min, in λ.
        value: f64,
        /// The smallest that can be solved for.
        smallest: f64,
        /// The greatest.
        greatest: f64,
    },
    /// The mean pressure is not positive and finite.
    #[error("the mean pressure must be positive and finite, not {value}")]
    MeanPressure {
        /// Mean pressure given, in E*.
        value: f64,
    },
    /// The penetration is outside (0, Δ_full]. Under penetration control no unique pressure exists beyond full contact: use
    /// pressure control there.
    #[error(
        "the penetration must be above 0 and below that of full contact, {full_contact}, not {value} (in units of the cell side)"
    )]
    Penetration {
        /// Penetration given, in λ.
        value: f64,
        /// h_max - mean(h), in λ.
        full_contact: f64,
    },
    /// The tolerance is not in (0, 1), or below what rounding allows.
    #[error("the tolerance must be between {smallest:e} and 1, not {value:e}")]
    Tolerance {
        /// The tolerance given.
        value: f64,
        /// The smallest that can be certified.
        smallest: f64,
    },
}
