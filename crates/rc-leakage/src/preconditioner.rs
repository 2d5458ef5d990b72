//! What conjugate gradients are preconditioned with.

use crate::real::Real;

/// An approximate inverse of the network.
pub(crate) trait Preconditioner {
    /// Its precision.
    type Value: Real;

    /// The right side, to be written.
    fn right_mut(&mut self) -> &mut [Self::Value];

    /// Applies the approximate inverse to the right side.
    fn apply(&mut self) -> &[Self::Value];
}
