//! Errors of requests for periodic coefficients.

use rc_core::DVec2;
use thiserror::Error;

/// Error of a request for a periodic coefficient, or for its number of image shells.
///
/// Lengths are in units of λ.
#[derive(Clone, Copy, Debug, PartialEq, Error)]
pub enum KernelError {
    /// An offset is infinite or not a number.
    #[error("offset ({x}, {y}) between target and source is not finite", x = .offset.x, y = .offset.y)]
    Offset {
        /// The offset as given.
        offset: DVec2,
    },
    /// A half side is not in (0, 1/2].
    ///
    /// The source would be empty or overlap its own images.
    #[error("half side {half_side} of the source is not in (0, 0.5] cell sides")]
    HalfSide {
        /// The half side as given.
        half_side: f64,
    },
    /// The number of shells of images is zero. An empty sum has no meaning.
    #[error("0 shells of images; at least 1 is needed")]
    NoShells,
    /// More shells than [`MAX_SHELLS`](crate::MAX_SHELLS).
    #[error("{shells} shells of images are more than the maximum of {max}; use the exact coefficients", max = crate::shells::MAX_SHELLS)]
    TooManyShells {
        /// The number of shells as given.
        shells: usize,
    },
    /// A tolerance is not a positive number.
    #[error("tolerance {tolerance} is not a positive number")]
    Tolerance {
        /// The tolerance as given.
        tolerance: f64,
    },
    /// The truncation error at [`MAX_SHELLS`](crate::MAX_SHELLS) shells may still be larger than the tolerance.
    #[error("tolerance {tolerance:e} is out of reach: {max} shells of images guarantee {reached:e}; use the exact coefficients", max = crate::shells::MAX_SHELLS)]
    Unreachable {
        /// The tolerance as given.
        tolerance: f64,
        /// The error bound with the maximum number of shells.
        reached: f64,
    },
}
