//! The split by scale of the half-space.

use rc_core::SplitByScale;

/// The half-space, without a deviation at any wave: the split of [`Love`](crate::Love) and of
/// [`FreeLove`](crate::FreeLove).
#[derive(Clone, Copy, Debug, Default)]
pub struct HalfSpace;

impl SplitByScale for HalfSpace {
    fn deviation(&self, _q: f64) -> f64 {
        0.0
    }

    fn deviates_below(&self, _tolerance: f64) -> f64 {
        0.0
    }

    fn curvature(&self) -> f64 {
        0.0
    }
}
