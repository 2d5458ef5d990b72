//! Elastic half-space kernels on the periodic unit cell (Eq. 2-6), in units of λ and E*.
//!
//! - [`love_displacement`]: one square under uniform pressure, one term of Eq. 5.
//! - [`Love`]: the paper's element on a uniform grid, piecewise-constant pressure collocated at element centres. Its
//!   coefficients `L_ij = l_ij - l_m` (Eq. 4-6, summed over all images) are diagonal in Fourier space, with a symbol that is
//!   a sum over aliases; Eq. 3's zero mean is the zero at k = 0.
//! - [`Spectral`]: the same half-space without aliases, as the FFT codes of this field use it.
//!
//! Conventions and units: see [`rc_core`].

mod alias_sum;
mod love;
mod love_symbol;
mod spectral;

pub use love::love_displacement;
pub use spectral::Spectral;

use love_symbol::LoveSymbol;
use rc_core::{Grid, Kernel, Symbol};

/// The paper's element: uniform pressure on each square, displacement at its centre, summed over all periodic images
/// (Eq. 4-6) without truncation.
///
/// *Accuracy*: the symbol is within 2e-14 relative of the converged alias sum (test
/// `fast_symbol_matches_the_alias_sum`). Elements are rectangles on a grid with nx ≠ ny.
#[derive(Clone, Copy, Debug, Default)]
pub struct Love;

impl Kernel for Love {
    fn name(&self) -> &'static str {
        "love"
    }

    fn symbol(&self, grid: Grid) -> Symbol<'_> {
        let symbol = LoveSymbol::new(grid);
        Box::new(move |kx, ky| symbol.eigenvalue(kx, ky))
    }

    /// Calibrated on Hertz contacts of 51 elements per radius at random offsets: 0.0872 ± 0.0025.
    fn perimeter_constant(&self) -> f64 {
        0.0872
    }
}
