//! The methods, and why one of them solves a problem.

use std::fmt;

use rc_core::Grid;
use rc_core::quantity::digits;

/// How a contact problem is solved.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(rename_all = "kebab-case"))]
pub enum Method {
    /// Preconditioned conjugate gradients on elements near contact only.
    ///
    /// Work and memory grow with the contact area, not with the area of the cell.
    Adaptive,
    /// Preconditioned conjugate gradients on all elements of the grid.
    Uniform,
    /// The procedure of the paper (Sec. 2): Gauss-Seidel on an adaptive mesh.
    ///
    /// Its work and memory are those of a dense matrix.
    GaussSeidel,
}

impl Method {
    /// Name as in scene files and summaries: `adaptive`, `uniform`, `gauss-seidel`.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Adaptive => "adaptive",
            Self::Uniform => "uniform",
            Self::GaussSeidel => "gauss-seidel",
        }
    }
}

impl fmt::Display for Method {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name())
    }
}

/// The reason why a problem is solved by its method.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub enum MethodReason {
    /// [`crate::SolveParams::method`] names the method.
    AskedFor(Method),
    /// Only the adaptive method divides elements at contact edges.
    BorderLevel,
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
    /// The caller's operator is known only on one grid.
    OwnOperator,
    /// The kernel has no split by scale.
    NoSplitOfKernel {
        /// Name of the kernel.
        kernel: &'static str,
    },
    /// The base grid of the adaptive method is too coarse for the waves at which the solid is not a half-space.
    DeviationNotResolved {
        /// Name of the kernel.
        kernel: &'static str,
    },
    /// The adaptive method solves the half-space, not a layer.
    Layer,
    /// The adaptive method needs square elements.
    ElementsNotSquare {
        /// The grid.
        grid: Grid,
    },
    /// The grid is too small for a base grid below it.
    NoLevels {
        /// The grid.
        grid: Grid,
    },
    /// A flat surface touches everywhere.
    Flat,
    /// The adaptive operator is not accurate enough for the tolerance.
    ToleranceTooSmall {
        /// The given tolerance.
        tolerance: f64,
    },
}

impl fmt::Display for MethodReason {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let round = |percent: &f64| digits(*percent, 2);
        match self {
            Self::AskedFor(method) => write!(f, "{method}: as requested"),
            Self::BorderLevel => write!(f, "adaptive: a border level was given"),
            Self::SmallContact { percent } => {
                write!(f, "adaptive: the contact area was estimated as {} % before the solve", round(percent))
            }
            Self::LargeContact { percent } => {
                write!(
                    f,
                    "uniform: it is cheaper for the contact area of {} % that was estimated before the solve",
                    round(percent)
                )
            }
            Self::ScatteredContact { percent } => {
                write!(f, "uniform: it is cheaper because {} % of the cell would be near contact", round(percent))
            }
            Self::UniformDoesNotFit { percent } => write!(
                f,
                "adaptive: the uniform grid is cheaper for the estimated contact area of {} % but does not fit into memory",
                round(percent)
            ),
            Self::AdaptiveDoesNotFit => write!(f, "uniform: the adaptive method does not fit into memory"),
            Self::OwnOperator => write!(f, "uniform: the operator is the caller's"),
            Self::NoSplitOfKernel { kernel } => write!(f, "uniform: the kernel {kernel} has no adaptive form"),
            Self::DeviationNotResolved { kernel } => {
                write!(
                    f,
                    "uniform: the base grid of the adaptive method is too coarse for the solid of the kernel {kernel}"
                )
            }
            Self::Layer => write!(f, "uniform: a layer has no adaptive form"),
            Self::ElementsNotSquare { grid } => write!(f, "uniform: the elements of the grid {grid} are not square"),
            Self::NoLevels { grid } => {
                write!(
                    f,
                    "uniform: the grid {grid} is too coarse for the adaptive method or no coarse grid of nearly square elements fits it"
                )
            }
            Self::Flat => write!(f, "uniform: a flat surface needs no adaptive mesh"),
            Self::ToleranceTooSmall { tolerance } => {
                write!(f, "uniform: the adaptive operator cannot certify a tolerance of {tolerance:e}")
            }
        }
    }
}
