//! Elastic kernels of the half-space (Eq. 2-6) and of layers, in units of λ and E*.
//!
//! The paper's operator is `v_i = Σ_j L_ij p_j` (Eq. 4). L_ij is the displacement of i by a uniform pressure on element
//! j and all its periodic images (Eq. 5). The mean displacement is subtracted (Eq. 6). The sums over images in Eq. 5
//! and Eq. 6 diverge. If both are cut after K shells (rings of images), the error of their difference is of order 1/K.
//! The crate has the paper's truncated sums for comparison. All other periodic sums are over all images.
//! [`love_displacement`] and [`FreeLove`] have no images. The main items of the crate are:
//!
//! | item | what it computes | file |
//! |---|---|---|
//! | [`love_displacement`] | one term of Eq. 5: one square without images, at any distance | `love.rs`, far away `multipoles.rs` |
//! | [`Love`] | Eq. 4-6 on a uniform grid with all images, in Fourier space; the symbol is summed over aliases (waves with the same values at all element centres); it is 0 at k = 0, because the mean is 0 (Eq. 3) | `love_symbol.rs` |
//! | [`love_alias_sum`] | the same symbol one value at a time: the slow reference for [`Love`] | `alias_sum.rs` |
//! | [`PeriodicLove`] | Eq. 4-6 for any two squares of the cell with all images; accurate to 1e-12, 31 to 54 ns per value | `periodic.rs`, which uses `square.rs` and `averages.rs` |
//! | [`ewald_phi`], [`ewald_coefficient`] | the point load and the square by Ewald's sum: the slow reference for [`PeriodicLove`] | `lattice.rs` |
//! | [`truncated_coefficient`] | Eq. 4-6 as in the paper, with images up to K shells, and a proven bound on the truncation error | `truncated.rs` |
//! | [`ScaleSplit`] | Eq. 4-6 split by scale, for meshes of many levels: short-range stencils, filters between levels, a smooth remainder | `split/` |
//! | [`HalfSpace`] | the split of [`Love`] and [`FreeLove`] ([`rc_core::SplitByScale`]) | `half_space.rs` |
//! | [`Spectral`] | Eq. 2-3 for each Fourier wave: the symbol of the continuous half-space, without aliases | `spectral.rs` |
//! | [`FreeLove`] | Eq. 4-5 on an infinite half-space, without images | `free_love.rs`, rectangles in `love.rs` |
//! | [`Viscoelastic`] | any of these solids, of a material that relaxes ([`Relaxation`]), under a sliding surface | `viscoelastic.rs`, [`Love`] in `love_sliding.rs` |
//! | [`LoveLayer`], [`SpectralLayer`] | [`Love`] and [`Spectral`] for a layer on a rigid base ([`Layer`]) | `layer.rs` |
//!
//! d_j of Eq. 5 and 6 is the half side of an element, `half_side` here.
//!
//! ```
//! use rc_core::{Grid, Kernel};
//! use rc_kernel::{Love, Spectral};
//!
//! // With sixteen elements per wave, the response to piecewise constant pressures is 0.55 % smaller than that of the
//! // continuous half-space.
//! let grid = Grid::square(16)?;
//! let ratio = Love.symbol(grid)(1, 0) / Spectral.symbol(grid)(1, 0);
//! assert!((ratio - 0.99446903).abs() < 1e-8);
//! # Ok::<(), rc_core::GridError>(())
//! ```
//!
//! Conventions and units are in [`rc_core`].

mod alias_sum;
mod averages;
mod bessel;
mod chebyshev;
mod creep;
mod curvature;
mod error;
mod free_love;
mod gauss_legendre;
mod half_space;
mod lattice;
mod layer;
mod love;
mod love_sliding;
mod love_symbol;
mod multipoles;
mod periodic;
mod relaxation;
mod shells;
mod spectral;
mod split;
mod square;
mod truncated;
mod viscoelastic;

pub use alias_sum::love_alias_sum;
pub use bessel::bessel_series;
pub use creep::Retardation;
pub use error::KernelError;
pub use free_love::FreeLove;
pub use half_space::HalfSpace;
pub use lattice::{LATTICE_CONSTANT, ewald_coefficient, ewald_phi};

pub use layer::{Layer, LoveLayer, SpectralLayer, Substrate, THINNEST_LAYER};
pub use love::{love_displacement, love_rectangle_displacement};
pub use periodic::{PeriodicLove, PeriodicSource};
pub use relaxation::{MaterialError, Relaxation};
pub use shells::MAX_SHELLS;
pub use spectral::Spectral;
pub use split::{
    CoarseElement, CoarseFilter, Filter, RelaxedStencil, ScaleSplit, SplitParams, Stencil, Tail, UnevenFilter,
};
pub use truncated::{LoadForm, shells_for, truncated_coefficient, truncation_error_bound};
pub use viscoelastic::Viscoelastic;

use std::sync::Arc;

use love_symbol::LoveSymbol;
use rc_core::{ComplexSymbol, Grid, Kernel, Sliding, SplitByScale, Symbol};

/// The kernel of the paper's elements.
///
/// The pressure is uniform on each element, and the displacement is taken at its centre. Displacements are summed over
/// all periodic images (Eq. 4-6) without truncation. Elements and cell are squares or rectangles. The symbol is `Σ
/// 2/|q| sinc(q_x hx/2) sinc(q_y hy/2)` over the aliases q of the wave, for elements of hx × hy.
///
/// *Accuracy*: every value is within 4e-15 relative of [`love_alias_sum`] (test `fast_symbol_matches_the_alias_sum`).
/// The coefficients L_ij are accurate to 1e-12 (test `love_symbol_reproduces_the_periodic_coefficients`).
///
/// *Cost*: the first [`Kernel::symbol`] for a shape of elements takes 2 ms, to fit the smooth part of the alias sum.
/// The process keeps this fit, so later calls take only 0.3 µs times the number of elements along a side. A value takes
/// 25 ns on square elements, and up to 70 ns on others.
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

    fn symbol_while<'a>(&'a self, sliding: &Sliding, grid: Grid) -> ComplexSymbol<'a> {
        love_sliding::symbol(sliding, grid)
    }

    fn split(&self) -> Option<&dyn SplitByScale> {
        Some(&HalfSpace)
    }

    fn to_shared(&self) -> Option<Arc<dyn Kernel + Send + Sync>> {
        Some(Arc::new(*self))
    }

    // `edge_bias` is the default, which is fitted to this kernel.
}
