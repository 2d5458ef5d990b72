//! What conjugate gradients are preconditioned with.

use crate::network::Network;
use crate::real::Real;

/// An approximate inverse of the network, and the network in its precision.
pub(crate) trait Preconditioner: Sync {
    /// Its precision, and that of directions.
    type Value: Real;

    /// The right side, to be written.
    fn right_mut(&mut self) -> &mut [Self::Value];

    /// Applies the approximate inverse to the right side.
    fn apply(&mut self) -> &[Self::Value];

    /// Writes what the network draws under the pressure `x`, of row `iy`: sums of fluxes that are the same for both
    /// elements of a face, so that what is drawn balances in a pool as exactly as double precision does.
    fn draw(&self, network: &Network, x: &[Self::Value], iy: usize, out: &mut [f64]);
}
