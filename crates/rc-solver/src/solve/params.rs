//! Parameters of a solve.

use crate::adaptive::AdaptiveParams;
use crate::{GaussSeidelParams, IterationParams, Method, Tolerance};

/// How accurately, by which method and within which limits a contact problem is solved.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SolveParams {
    /// Bound on the certificate ([`crate::Certificate`]), relative to the peak-to-valley height h_max - h_min.
    pub tolerance: Tolerance,
    /// Largest number of iterations on any one level.
    pub max_iterations: usize,
    /// The method; `None` chooses by the estimated contact area.
    pub method: Option<Method>,
    /// How often elements at contact edges are halved beyond the grid. Only the adaptive method does so, and only on a surface.
    pub border_level: usize,
    /// Maximum memory, in bytes. A larger estimate is an error, before any work.
    pub memory_limit: Option<u64>,
    /// Whether a method that does not fit into memory gives way to one that does. Their results differ within the error bars, so one of many
    /// solves, which may run on another machine, sets this to `false`.
    pub method_follows_memory: bool,
    /// Bound on the error of one application of the adaptive operator, relative to the rms displacement. A smaller tolerance lowers it.
    pub operator_error: f64,
    /// Elements per side of the base grid of the adaptive method; `None` chooses.
    pub base_side: Option<usize>,
    /// Parameters of the paper's procedure alone.
    pub gauss_seidel: GaussSeidelParams,
}

impl SolveParams {
    /// Certified to 1e-6 of the peak-to-valley height: area and rms pressure are then exact to about five digits.
    #[must_use]
    pub fn certified() -> Self {
        Self {
            tolerance: Tolerance::Relative(1e-6),
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
    #[must_use]
    pub fn to_tolerance(tolerance: f64) -> Self {
        Self { tolerance: Tolerance::Relative(tolerance), ..Self::certified() }
    }

    /// The same parameters with this method.
    #[must_use]
    pub fn by(self, method: Method) -> Self {
        Self { method: Some(method), ..self }
    }

    /// What the iteration needs of them, with the tolerance as a number.
    pub(super) fn iteration(&self, tolerance: f64) -> IterationParams {
        IterationParams { tolerance, max_iterations: self.max_iterations }
    }

    /// What the adaptive method needs of them.
    pub(super) fn adaptive(&self, tolerance: f64) -> AdaptiveParams {
        AdaptiveParams {
            solve: self.iteration(tolerance),
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
