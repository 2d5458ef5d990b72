//! The point-collocated kernel that FFT codes of this field use.

use std::f64::consts::PI;
use std::sync::Arc;

use rc_core::{EdgeBias, Grid, Kernel, Symbol};

/// The symbol of the continuous half-space, `2/(E* |q|)`, without aliases.
///
/// The symbol is evaluated at the wavenumbers of the grid, and exact for band-limited pressures. Results can be
/// compared digit by digit with codes that use the same symbol.
#[derive(Clone, Copy, Debug, Default)]
pub struct Spectral;

impl Kernel for Spectral {
    fn name(&self) -> &'static str {
        "spectral"
    }

    /// The Fourier transform of the Green function of Eq. (2), 2/(E* |q|).
    fn symbol(&self, grid: Grid) -> Symbol<'_> {
        // 2/|q| with q = 2πk.
        Box::new(move |kx, ky| {
            let waves = grid.waves(kx, ky);
            if waves == 0.0 { 0.0 } else { 1.0 / (PI * waves) }
        })
    }

    fn edge_bias(&self, _grid: Grid) -> EdgeBias {
        EdgeBias {
            per_edge: 0.0417,
            per_contact: -0.32,
            per_deviation: -0.043,
            per_square: 0.0186,
            per_difference: 0.0,
            per_second_difference: 0.0,
            per_edge_error: 0.0,
            per_difference_error: 0.0,
            gap_errors: [0.001, 0.095],
        }
    }

    fn to_shared(&self) -> Option<Arc<dyn Kernel + Send + Sync>> {
        Some(Arc::new(*self))
    }
}
