//! The half-space in the form that the paper's procedure needs.

use rc_core::Kernel;

use crate::paper::coefficients::Coefficient;

/// One half-space in two forms: its symbol on uniform grids, and L_ij between squares.
///
/// [`rc_kernel::Love`] and `rc_kernel::PeriodicLove` are such a pair.
#[derive(Clone, Copy)]
pub(crate) struct HalfSpace<'a> {
    /// The symbol.
    pub(crate) kernel: &'a dyn Kernel,
    /// L_ij between squares.
    pub(crate) coefficient: Coefficient<'a>,
}
