//! The tolerance of a solve: a number, or `auto`.

use serde::{Deserialize, Serialize};

/// The tolerance, as written.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub(crate) enum Tolerance {
    /// Certified, relative to the peak-to-valley height.
    Relative(f64),
    /// `auto`: that of the discretisation error.
    Auto,
}

/// The tolerance `auto` on a grid with so many elements for the shortest wave.
pub(crate) fn auto_tolerance(elements_per_wave: f64) -> f64 {
    (3e-5 * (elements_per_wave / 8.0).powf(-1.5)).clamp(1e-8, 1e-3)
}
