//! One element of a mesh that is not the grid itself.

use rc_core::DVec2;

/// One element in contact, in units of λ and E*.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ContactElement {
    /// Centre.
    pub centre: DVec2,
    /// Side of the square.
    pub side: f64,
    /// Pressure, > 0.
    pub pressure: f64,
}
