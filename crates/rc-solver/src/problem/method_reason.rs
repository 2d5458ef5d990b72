//! Why a method solves a problem.

use std::fmt;

use rc_core::Grid;
use rc_core::quantity::digits;

use crate::problem::capabilities::Refusal;
use crate::problem::method::Method;

/// The reason why a problem is solved by its method.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub enum MethodReason {
    /// [`crate::SolveParams::method`] names the method.
    AskedFor(Method),
    /// The other method excludes a feature of the problem.
    Only {
        /// The method.
        method: Method,
        /// What excludes the other one.
        refusal: Refusal,
    },
    /// The adaptive method is the cheaper one.
    SmallContact {
        /// Estimated contact area, in percent of the nominal one.
        percent: f64,
    },
    /// The uniform grid is the cheaper one.
    LargeContact {
        /// Estimated contact area, in percent of the nominal one.
        percent: f64,
    },
    /// Most of the surface is in contact, and the uniform grid was solved for its gap.
    HeavyContact,
    /// Contact is so scattered that the uniform grid is the cheaper one.
    ///
    /// The adaptive method finds this on its base grid, a coarse grid that it stores in full.
    ScatteredContact {
        /// Tiles near contact, in percent of all.
        percent: f64,
    },
    /// The uniform grid would be cheaper but exceeds the memory limit.
    UniformDoesNotFit {
        /// Estimated contact area, in percent of the nominal one.
        percent: f64,
    },
    /// The base grid of the adaptive method exceeds the memory limit.
    AdaptiveDoesNotFit,
    /// The base grid of the adaptive method is too coarse for the waves at which the solid is not a half-space.
    DeviationNotResolved {
        /// Name of the kernel.
        kernel: &'static str,
    },
    /// The grid is too small for a base grid below it.
    NoLevels {
        /// The grid.
        grid: Grid,
    },
    /// The adaptive operator is not accurate enough for the tolerance.
    ToleranceTooSmall {
        /// The given tolerance.
        tolerance: f64,
    },
    /// The adaptive method ended above the tolerance.
    NotCertified {
        /// The error of its certificate.
        error: f64,
        /// The given tolerance.
        tolerance: f64,
    },
}

impl fmt::Display for MethodReason {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let round = |percent: &f64| digits(*percent, 2);
        match self {
            Self::AskedFor(method) => write!(f, "{method}: as requested"),
            Self::Only { method, refusal } => write!(f, "{method}: {}", refusal.because),
            Self::SmallContact { percent } => {
                write!(f, "adaptive: the contact area was estimated as {} % before the solve", round(percent))
            }
            Self::LargeContact { percent } => {
                write!(
                    f,
                    "uniform: it is cheaper on this grid for the contact area of {} % that was estimated before the solve",
                    round(percent)
                )
            }
            Self::HeavyContact => write!(f, "uniform, from the gaps: most of the surface is in contact"),
            Self::ScatteredContact { percent } => {
                write!(f, "uniform: it is cheaper because {} % of the cell would be near contact", round(percent))
            }
            Self::UniformDoesNotFit { percent } => write!(
                f,
                "adaptive: the uniform grid is cheaper for the estimated contact area of {} % but does not fit into memory",
                round(percent)
            ),
            Self::AdaptiveDoesNotFit => write!(f, "uniform: the adaptive method does not fit into memory"),
            Self::DeviationNotResolved { kernel } => {
                write!(
                    f,
                    "uniform: the base grid of the adaptive method is too coarse for the waves at which the solid (kernel {kernel}) is not a half-space, as a thin layer is not"
                )
            }
            Self::NoLevels { grid } => {
                write!(
                    f,
                    "uniform: the grid {grid} is too coarse for the adaptive method or no coarse grid of nearly square elements fits it"
                )
            }
            Self::ToleranceTooSmall { tolerance } => {
                write!(f, "uniform: the adaptive operator cannot certify a tolerance of {tolerance:e}")
            }
            Self::NotCertified { error, tolerance } => {
                write!(
                    f,
                    "uniform: the adaptive method ended at an error of {error:.1e}, above the tolerance of {tolerance:e}"
                )
            }
        }
    }
}
