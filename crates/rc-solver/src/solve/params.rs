//! Parameters of a solve.

use crate::adaptive::AdaptiveParams;
use crate::{ErrorBound, GaussSeidelParams, IterationParams, Method, Tolerance};

/// Accuracy, method and limits of a solve.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SolveParams {
    /// Tolerance of the solve, from which the bound on the [`crate::Certificate`] follows.
    pub tolerance: Tolerance,
    /// Maximum number of iterations on any one level.
    pub max_iterations: usize,
    /// The method. `None` chooses by the estimated contact area.
    pub method: Option<Method>,
    /// Number of times that elements at contact edges are halved beyond the grid.
    ///
    /// Only the adaptive method does so, and only on a surface.
    pub border_level: usize,
    /// Maximum memory, in bytes.
    ///
    /// A larger estimate is an error before any work. If scattered contact needs the uniform grid, the error comes
    /// after the base grid.
    pub memory_limit: Option<u64>,
    /// Whether a method that does not fit into memory gives way to one that does.
    ///
    /// Their results differ within the error bars. One of many solves may run on another machine, and therefore sets
    /// this to `false`.
    pub method_follows_memory: bool,
    /// Bound on the error of one application of the adaptive operator.
    ///
    /// It is relative to the rms displacement. A smaller tolerance lowers it.
    pub operator_error: f64,
    /// Elements per side of the base grid of the adaptive method. `None` chooses the number.
    pub base_side: Option<usize>,
    /// Parameters of the paper's procedure alone.
    pub gauss_seidel: GaussSeidelParams,
}

impl SolveParams {
    /// Parameters that certify a solution to [`Tolerance::DEFAULT`].
    ///
    /// Area and rms pressure are then those of the discrete problem to about five digits.
    #[must_use]
    pub fn certified() -> Self {
        Self {
            tolerance: Tolerance::DEFAULT,
            max_iterations: 2000,
            method: None,
            border_level: 0,
            memory_limit: None,
            method_follows_memory: true,
            operator_error: 1e-6,
            base_side: None,
            gauss_seidel: GaussSeidelParams::paper(),
        }
    }

    /// [`SolveParams::certified`] with this tolerance.
    ///
    /// It is relative to the peak-to-valley height ([`Tolerance::Relative`]).
    #[must_use]
    pub fn to_tolerance(tolerance: f64) -> Self {
        Self { tolerance: Tolerance::Relative(tolerance), ..Self::certified() }
    }

    /// The same parameters with this method.
    #[must_use]
    pub fn by(self, method: Method) -> Self {
        Self { method: Some(method), ..self }
    }

    /// The parameters of the iteration.
    pub(super) fn iteration(&self, bound: ErrorBound) -> IterationParams {
        IterationParams { bound, max_iterations: self.max_iterations }
    }

    /// The parameters of the adaptive method.
    pub(super) fn adaptive(&self, bound: ErrorBound) -> AdaptiveParams {
        AdaptiveParams {
            solve: self.iteration(bound),
            operator_error: self.operator_error,
            border_level: self.border_level,
            base_side: self.base_side,
            memory_limit: self.memory_limit,
        }
    }
}

impl Default for SolveParams {
    /// [`SolveParams::certified`].
    fn default() -> Self {
        Self::certified()
    }
}
