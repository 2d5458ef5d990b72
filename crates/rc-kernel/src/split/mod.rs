//! The kernel split by scale.
//!
//! Each level of a mesh has a short-range stencil, and leaves a smooth remainder to the next coarser level. A window χ
//! falls from 1 at r = 0 to 0 at the cutoff c ([`window`](self)). With it, the half-space is
//!
//! ```text
//! 1/(π r) = χ(r/c)/(π r)  +  Ψ(r/c)/(π r),     χ = 1 - Ψ,
//! ```
//!
//! The first kernel ends at c. A grid twice as coarse resolves the second, smooth one. There the smooth kernel is split
//! again at 2c, and so on, down to a grid that is small enough for one Fourier transform. The same short filter
//! ([`Filter`]) passes pressures to coarser levels and displacements to finer levels, so the whole operator is
//! symmetric. Lengths are in elements of the present level, so one set of tables serves every level:
//!
//! ```text
//! level K (finest): v_K = h_K  S p_K + F  u_{K-1}  S: [`ScaleSplit::love_stencil`],  F: [`ScaleSplit::love_filter`]
//! level k:          u_k = h_k  D ρ_k + F' u_{k-1}  D: [`ScaleSplit::level_stencil`],  F': [`ScaleSplit::level_filter`]
//!                   ρ_k = ¼ F'ᵀ ρ_{k+1}  (F at the finest)
//! base:             u_0 = inverse FFT( remainder · FFT ρ_0 )    [`ScaleSplit::remainder_symbol`]
//! ```
//!
//! The Kaiser-Bessel window is used in particle-mesh sums too (J. F. Kaiser, 1974). The recursion follows the
//! dual-space multilevel kernel splitting of Jiang and Greengard (*Commun. Pure Appl. Math.* 2025), applied to a
//! half-space.

mod coarse;
mod filter;
mod inverse;
mod kept;
mod params;
mod relaxed;
mod stencil;
mod uneven;
mod window;

pub use coarse::{CoarseElement, CoarseFilter};
pub use filter::Filter;
pub use params::SplitParams;
pub use relaxed::{RelaxedStencil, Tail};
pub use stencil::Stencil;
pub use uneven::UnevenFilter;

use std::sync::Arc;

use kept::Kept;
use rc_core::SlidingCompliance;
use relaxed::Rows;
use window::Window;

/// Tables of the split kernel.
#[derive(Clone, Debug)]
pub struct ScaleSplit {
    params: SplitParams,
    window: Window,
}

impl ScaleSplit {
    /// The split with these parameters.
    #[must_use]
    pub fn new(params: SplitParams) -> Self {
        Self { params, window: Window::new(params.shape, params.cutoff) }
    }

    /// The parameters of the split.
    #[must_use]
    pub fn params(&self) -> SplitParams {
        self.params
    }

    /// Displacement at the centres around an element under unit pressure (Love's square).
    ///
    /// The remainder is excluded. Elements have side 1.
    #[must_use]
    pub fn love_stencil(&self) -> Stencil {
        static STENCILS: Kept<Stencil> = Kept::new();
        STENCILS.of(self.params, || stencil::love(&self.window, self.params.cutoff))
    }

    /// The part of the remainder of the next finer level that this level adds.
    ///
    /// It is the kernel between cutoffs c/2 and c, sampled at the centres of elements of side 1.
    #[must_use]
    pub fn level_stencil(&self) -> Stencil {
        static STENCILS: Kept<Stencil> = Kept::new();
        STENCILS.of(self.params, || stencil::level(&self.window, self.params.cutoff))
    }

    /// The stencil of a level below a level with cutoff `inner`.
    ///
    /// As [`ScaleSplit::level_stencil`], for elements of `sides` along x and y, of which the smaller is 1.
    #[must_use]
    pub fn uneven_level_stencil(&self, inner: f64, sides: [f64; 2]) -> Stencil {
        stencil::between(&self.window, self.params.cutoff, inner, sides)
    }

    /// [`ScaleSplit::love_stencil`] of a solid that relaxes, with lengths in elements.
    #[must_use]
    pub fn relaxed_love(&self, compliance: &SlidingCompliance) -> RelaxedStencil {
        static ROWS: Kept<Arc<Rows>> = Kept::new();
        let rows = ROWS.of(self.params, || Arc::new(Rows::love(&self.window, self.params)));
        rows.relaxed(&self.love_stencil(), compliance)
    }

    /// [`ScaleSplit::level_stencil`] of a solid that relaxes, with lengths in elements.
    #[must_use]
    pub fn relaxed_level(&self, compliance: &SlidingCompliance) -> RelaxedStencil {
        let (cutoff, inner) = (self.params.cutoff, 0.5 * self.params.cutoff as f64);
        let rows = Rows::between(&self.window, cutoff, inner, [1.0, 1.0]);
        rows.relaxed(&self.level_stencil(), compliance)
    }

    /// [`ScaleSplit::uneven_level_stencil`] of a solid that relaxes, with lengths in elements.
    #[must_use]
    pub fn relaxed_uneven_level(&self, inner: f64, sides: [f64; 2], compliance: &SlidingCompliance) -> RelaxedStencil {
        let rows = Rows::between(&self.window, self.params.cutoff, inner, sides);
        rows.relaxed(&self.uneven_level_stencil(inner, sides), compliance)
    }

    /// Filter along one axis between the finest level and a level with other elements.
    ///
    /// The finest level consists of Love's squares. The other level has `ratio` elements for each finest one.
    #[must_use]
    pub fn uneven_filter(&self, ratio: f64) -> UnevenFilter {
        uneven::design(&self.window, self.params, ratio)
    }

    /// Filter between the finest level, of Love's squares, and the next coarser level.
    #[must_use]
    pub fn love_filter(&self) -> Filter {
        static FILTERS: Kept<Filter> = Kept::new();
        FILTERS.of(self.params, || filter::design(&self.window, self.params, filter::love_target))
    }

    /// Filter between two coarser levels, whose values are samples of smooth functions.
    #[must_use]
    pub fn level_filter(&self) -> Filter {
        static FILTERS: Kept<Filter> = Kept::new();
        FILTERS.of(self.params, || filter::design(&self.window, self.params, |_| 1.0))
    }

    /// Elements of 2, 4, … 2^`n_levels` times the finest side.
    ///
    /// Each has one pressure and one mean displacement.
    #[must_use]
    pub fn coarse_elements(&self, n_levels: usize) -> Vec<CoarseElement> {
        coarse::elements(&self.window, self.params, &self.love_stencil(), &self.level_stencil(), n_levels)
    }

    /// Symbol of the remainder at the angular wavenumber `q` > 0.
    ///
    /// It is `2/q` minus the transform of the short-range kernel. The cutoff `c` has the unit of length of 1/q.
    #[must_use]
    pub fn remainder_symbol(&self, q: f64, c: f64) -> f64 {
        2.0 / q - self.short_range_symbol(q, c)
    }

    /// The remainder `Ψ(r/c)/(π r)` itself, at the distance `r` and for the cutoff `c`.
    #[must_use]
    pub fn remainder(&self, r: f64, c: f64) -> f64 {
        self.window.rise_over(r / c) / (std::f64::consts::PI * c)
    }

    /// Transform of `χ(r/c)/(π r)` at the angular wavenumber `q`.
    #[must_use]
    pub fn short_range_symbol(&self, q: f64, c: f64) -> f64 {
        c * self.window.short_range(q * c)
    }

    /// Bound of the second derivatives of the remainder's displacement along x and along y.
    ///
    /// The bound holds for pressures between 0 and 1 and a cutoff `c`. It limits the error of linear interpolation
    /// between two points of a grid.
    #[must_use]
    pub fn remainder_curvature(&self, c: f64) -> f64 {
        self.window.curvature() / (std::f64::consts::PI * c)
    }

    /// Stencil of one level of the inverse operator |q|/2.
    ///
    /// Elements have side 1, and the stencil reaches to `radius`. Divide it by the side of the elements. With
    /// [`ScaleSplit::level_filter`] on every level and |q|/2 on the base grid, it forms a preconditioner.
    #[must_use]
    pub fn inverse_stencil(&self, radius: usize) -> Stencil {
        inverse::stencil(&self.level_filter(), radius)
    }

    /// [`ScaleSplit::inverse_stencil`] of |q|/2 divided by a compliance that is real.
    ///
    /// Lengths of the compliance are in elements.
    #[must_use]
    pub fn inverse_stencil_of(&self, radius: usize, compliance: &SlidingCompliance) -> Stencil {
        inverse::stencil_along_x(&self.level_filter(), radius, &|q| compliance.at(q).re.recip())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Tests the bound of the curvature with the pressure that bends the remainder most.
    ///
    /// Pressure 1 where the second derivative has one sign bends the remainder most. The test sums both signs
    /// separately. Each sum must be below the bound.
    #[test]
    fn no_pressure_bends_the_remainder_more_than_its_bound() {
        let (step, reach) = (0.02, 300_i32);
        for params in [SplitParams::quick(), SplitParams::certified()] {
            let split = ScaleSplit::new(params);
            let remainder = |x: f64, y: f64| split.window.rise_over(x.hypot(y)) / std::f64::consts::PI;
            let mut bent = [0.0; 2];
            for (ix, iy) in (0..reach * reach).map(|i| (i % reach, i / reach)) {
                let (x, y) = (step * (f64::from(ix) + 0.5), step * (f64::from(iy) + 0.5));
                let difference = remainder(x + step, y) - 2.0 * remainder(x, y) + remainder(x - step, y);
                // Factor 4 for four quadrants. The second derivative is the difference divided by the area of the
                // square.
                bent[usize::from(difference < 0.0)] += 4.0 * difference.abs();
            }
            let bound = split.remainder_curvature(1.0);
            let [up, down] = bent;
            assert!(up.max(down) < bound, "{params:?}: bent by {up} and {down}, more than {bound}");
        }
    }
}
