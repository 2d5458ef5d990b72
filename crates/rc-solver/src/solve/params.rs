//! Parameters of a solve.

use crate::levels::params::AdaptiveParams;
use crate::paper::params::GaussSeidelParams;
use crate::problem::method::Method;
use crate::problem::params::IterationParams;
use crate::problem::tolerance::{ErrorBound, Tolerance};

/// Accuracy, method and limits of a solve.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SolveParams {
    /// Tolerance of the solve, from which the bound on the [`crate::Certificate`] follows.
    pub tolerance: Tolerance,
    /// Maximum number of iterations on any one level.
    pub max_iterations: usize,
    /// The method. `None` chooses by the estimated contact area.
    pub method: Option<Method>,
    /// Number of times that elements of the grid are halved at contact edges.
    ///
    /// Only the adaptive method halves elements, and only on a [`rc_core::HeightField`], not on a map.
    pub border_level: usize,
    /// Maximum memory, in bytes.
    ///
    /// If no allowed method fits, the solve fails before any work. Without [`SolveParams::method_follows_memory`], it
    /// may also fail later, after the base grid has been solved. This happens if the adaptive method turns out not to
    /// suit the problem, and the uniform grid does not fit. The base grid is a coarse grid that the adaptive method
    /// stores in full.
    pub memory_limit: Option<u64>,
    /// Whether another method is chosen if the first does not fit into memory.
    ///
    /// Results of the methods differ within the error bars. Sweeps set this to `false`, because their solves may run on
    /// machines with different memory.
    pub method_follows_memory: bool,
    /// Bound on the error of one application of the adaptive operator.
    ///
    /// The bound is relative to the rms displacement. A smaller tolerance of the solve lowers this bound automatically.
    pub operator_error: f64,
    /// Elements per side of the base grid of the adaptive method. `None` chooses the number.
    pub base_side: Option<usize>,
    /// Parameters that only the Gauss-Seidel method (the paper's procedure) uses.
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
    pub(crate) fn iteration(&self, bound: ErrorBound) -> IterationParams {
        IterationParams { bound, max_iterations: self.max_iterations }
    }

    /// The parameters of the adaptive method.
    pub(crate) fn adaptive(&self, bound: ErrorBound) -> AdaptiveParams {
        AdaptiveParams {
            spare_above: AdaptiveParams::SPARE_ABOVE,
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
