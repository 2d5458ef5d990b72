//! The half-space as the paper's procedure needs it.

use rc_core::Kernel;

use super::coefficients::Coefficient;

/// One half-space in two forms: its symbol on uniform grids, and L_ij between squares, as [`rc_kernel::Love`] and
/// `rc_kernel::PeriodicLove` are.
#[derive(Clone, Copy)]
pub(crate) struct HalfSpace<'a> {
    /// The symbol.
    pub(crate) kernel: &'a dyn Kernel,
    /// L_ij between squares.
    pub(crate) coefficient: Coefficient<'a>,
}
