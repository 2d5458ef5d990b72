//! The support of a solid under a uniform pressure.

use rc_core::{Boundary, Grid, Kernel};

/// The support of a solid under a uniform pressure.
///
/// On the periodic half-space such a pressure displaces nothing (Eq. 3).
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct Support {
    /// The boundary of the heights.
    pub(crate) boundary: Boundary,
    /// Displacement of a periodic cell under a uniform pressure of 1, in λ/E*.
    ///
    /// It is zero, except for a layer on a base.
    pub(crate) compliance: f64,
}

impl Support {
    /// The support of the solid of `kernel`, for heights on `grid`.
    pub(crate) fn of(kernel: &dyn Kernel, grid: Grid) -> Self {
        match kernel.free_response(grid) {
            Some(_) => Self { boundary: Boundary::Free, compliance: 0.0 },
            None => Self { boundary: Boundary::Periodic, compliance: kernel.uniform_displacement().unwrap_or(0.0) },
        }
    }

    /// Whether a uniform pressure displaces nothing.
    pub(crate) fn is_none(self) -> bool {
        self.boundary == Boundary::Periodic && self.compliance == 0.0
    }
}
