//! Parameters of a solve.

use crate::adaptive::AdaptiveParams;
use crate::{ErrorBound, GaussSeidelParams, IterationParams, Method, Tolerance};

/// How accurately, by which method and within which limits a contact problem is solved.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SolveParams {
    /// What the certificate ([`crate::Certificate`]) has to meet.
    pub tolerance: Tolerance,
    /// Largest number of iterations on any one level.
    pub max_iterations: usize,
    /// The method; `None` chooses by the estimated contact area.
    pub method: Option<Method>,
    /// How often elements at contact edges are halved beyond the grid. Only the adaptive method does so, and only on a
    /// surface.
    pub border_level: usize,
    /// Maximum memory, in bytes. A larger estimate is an error before any work, or after the base grid where scattered
    /// contact turns out to need the uniform grid.
    pub memory_limit: Option<u64>,
    /// Whether a method that does not fit into memory gives way to one that does. Their results differ within the error
    /// bars, so one of many solves, which may run on another machine, sets this to `false`.
    pub method_follows_memory: bool,
    /// Bound on the error of one application of the adaptive operator, relative to the rms displacement. A smaller
    /// tolerance lowers it.
    pub operator_error: f64,
    /// Elements per side of the base grid of the adaptive method; `None` chooses.
    pub base_side: Option<usize>,
    /// Parameters of the paper's procedure alone.
    pub gauss_seidel: GaussSeidelParams,
}

impl SolveParams {
    /// Certified to [`Tolerance::DEFAULT`]: area and rms pressure are then those of the discrete problem to about five
    /// digits.
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

    /// [`SolveParams::certified`] with this tolerance, relative to the peak-to-valley height ([`Tolerance::Relative`]).
    #[must_use]
    pub fn to_tolerance(tolerance: f64) -> Self {
        Self { tolerance: Tolerance::Relative(tolerance), ..Self::certified() }
    }

    /// The same parameters with this method.
    #[must_use]
    pub fn by(self, method: Method) -> Self {
        Self { method: Some(method), ..self }
    }

    /// What the iteration needs of them.
    pub(super) fn iteration(&self, bound: ErrorBound) -> IterationParams {
        IterationParams { bound, max_iterations: self.max_iterations }
    }

    /// What the adaptive method needs of them.
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
