//! Preconditioners of conjugate gradients.

use crate::network::Network;
use crate::real::Real;

/// An approximate inverse of the network, and the network in its precision.
pub(crate) trait Preconditioner: Sync {
    /// Precision of the values and of directions.
    type Value: Real;

    /// The right side, which the caller writes.
    fn right_mut(&mut self) -> &mut [Self::Value];

    /// Applies the approximate inverse to the right side.
    fn apply(&mut self) -> &[Self::Value];

    /// Writes the flow out of the elements of row `iy` under the pressure `x`.
    ///
    /// A flux is the same for both elements of a face. The flow is therefore conserved in a pool as exactly as double
    /// precision allows.
    fn draw(&self, network: &Network, x: &[Self::Value], iy: usize, out: &mut [f64]);
}
