//! Parameters of the adaptive method.

use crate::problem::params::IterationParams;

/// Accuracy and limits of the adaptive method.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct AdaptiveParams {
    /// Tolerance of the certificate and limit of iterations.
    pub solve: IterationParams,
    /// Bound on the error of one application of L, relative to the rms displacement.
    ///
    /// It holds on pressures of contacts ([`SplitParams`] has the measurements). A tolerance below a third of it lowers
    /// it. A pressure so rough that the tolerance would not hold lowers it too.
    pub operator_error: f64,
    /// Number of elements above which descents and evaluations spare memory, if a loose tolerance allows it.
    pub spare_above: usize,
    /// Number of times that elements at edges of contacts are halved beyond the finest grid.
    ///
    /// Elements inside contacts stay as they are.
    pub border_level: usize,
    /// Elements per side of the base grid. `None` chooses the number.
    pub base_side: Option<usize>,
    /// Maximum memory, in bytes. A larger estimate is an error before any work.
    ///
    /// The memory of the base grid is checked before heights are sampled.
    pub memory_limit: Option<u64>,
}

impl AdaptiveParams {
    /// [`AdaptiveParams::spare_above`] of every solve. Digits of smaller meshes are those of double precision.
    pub(crate) const SPARE_ABOVE: usize = 100_000_000;
}
