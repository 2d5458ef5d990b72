//! Parameters of the adaptive method.

use crate::params::IterationParams;

/// How accurately, and within which limits, the adaptive method solves.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct AdaptiveParams {
    /// Tolerance of the certificate and limit of iterations.
    pub solve: IterationParams,
    /// Bound on the error of one application of L, relative to the rms displacement, on pressures of contacts
    /// ([`SplitParams`] has the measurements). A tolerance below a third of it lowers it, and so does a pressure so
    /// rough that the tolerance would not hold.
    pub operator_error: f64,
    /// How often elements at the edges of contacts are halved beyond the finest grid. Inside contacts they stay as they
    /// are.
    pub border_level: usize,
    /// Elements per side of the base grid; `None` chooses.
    pub base_side: Option<usize>,
    /// Most memory, in bytes; a larger estimate is an error, before any work. That of the base grid is checked before
    /// heights are sampled.
    pub memory_limit: Option<u64>,
}
