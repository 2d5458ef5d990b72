//! The kernel split by scale: a short-range stencil for each level of a mesh, and a smooth remainder for the next
//! coarser one.
//!
//! With a window χ that falls from 1 at r = 0 to 0 at the cutoff c ([`window`](self)), the half-space is
//!
//! ```text
//! 1/(π r) = χ(r/c)/(π r)  +  Ψ(r/c)/(π r),     χ = 1 - Ψ,
//! ```
//!
//! a kernel that ends at c, and a smooth one that a grid twice as coarse resolves. On that grid the smooth one is split
//! again at 2c, and so on up to a grid small enough for one Fourier transform. Pressures go up, and displacements come
//! down, by the same short filter ([`Filter`]), so that the whole is symmetric. Lengths are in elements of the level at
//! hand, hence one set of tables serves every level:
//!
//! ```text
//! level K (finest):  v_K = h_K  S p_K + F  u_{K-1}            S: [`ScaleSplit::love_stencil`],     F: [`ScaleSplit::love_filter`]
//! level k:           u_k = h_k  D ρ_k + F' u_{k-1}            D: [`ScaleSplit::level_stencil`],    F': [`ScaleSplit::level_filter`]
//!                    ρ_k = ¼ F'ᵀ ρ_{k+1}  (F at the finest)
//! base:              u_0 = inverse FFT( remainder · FFT ρ_0 )    [`ScaleSplit::remainder_symbol`]
//! ```
//!
//! The window is the Kaiser-Bessel one, as in particle-mesh sums (J. F. Kaiser, 1974); the recursion is that of the
//! dual-space multilevel kernel splitting of Jiang and Greengard (*Commun. Pure Appl. Math.* 2025), in a half-space.

mod coarse;
mod filter;
mod inverse;
mod kept;
mod params;
mod stencil;
mod uneven;
mod window;

pub use coarse::{CoarseElement, CoarseFilter};
pub use filter::Filter;
pub use params::SplitParams;
pub use stencil::Stencil;
pub use uneven::UnevenFilter;

use kept::Kept;
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

    /// Its parameters.
    #[must_use]
    pub fn params(&self) -> SplitParams {
        self.params
    }

    /// Displacement at the centres around an element under unit pressure (Love's square), remainder excluded, for
    /// elements of side 1.
    #[must_use]
    pub fn love_stencil(&self) -> Stencil {
        static STENCILS: Kept<Stencil> = Kept::new();
        STENCILS.of(self.params, || stencil::love(&self.window, self.params.cutoff))
    }

    /// The part of the next finer level's remainder that this level adds, for elements of side 1: the kernel between
    /// cutoffs c/2 and c, sampled at the centres.
    #[must_use]
    pub fn level_stencil(&self) -> Stencil {
        static STENCILS: Kept<Stencil> = Kept::new();
        STENCILS.of(self.params, || stencil::level(&self.window, self.params.cutoff))
    }

    /// The same for elements of other `sides`, of which the smaller is 1, when the finer level has the cutoff `inner`.
    #[must_use]
    pub fn uneven_level_stencil(&self, inner: f64, sides: [f64; 2]) -> Stencil {
        stencil::between(&self.window, self.params.cutoff, inner, sides)
    }

    /// Filter between the finest level, of Love's squares, and a level with `ratio` elements to a finest one, along one
    /// axis.
    #[must_use]
    pub fn uneven_filter(&self, ratio: f64) -> UnevenFilter {
        uneven::design(&self.window, self.params, ratio)
    }

    /// Filter between the finest level, of Love's squares, and the next one.
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

    /// Elements of 2, 4, … 2^`n_levels` times the finest side, each as one pressure and one mean displacement.
    #[must_use]
    pub fn coarse_elements(&self, n_levels: usize) -> Vec<CoarseElement> {
        coarse::elements(&self.window, self.params, &self.love_stencil(), &self.level_stencil(), n_levels)
    }

    /// Symbol of the remainder at the angular wavenumber `q` > 0, for a cutoff `c` in the unit of length of 1/q:
    /// `2/q` minus the transform of the short-range kernel.
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

    /// Bound of the second derivatives along x and along y of the remainder's displacement, for pressures between 0 and
    /// 1 and a cutoff `c`: what lies between two points of a grid cannot differ more from the line between them than
    /// this allows.
    #[must_use]
    pub fn remainder_curvature(&self, c: f64) -> f64 {
        self.window.curvature() / (std::f64::consts::PI * c)
    }

    /// Stencil of one level of the inverse operator |q|/2, for elements of side 1 and reach `radius`; to be divided by
    /// the side. Together with [`ScaleSplit::level_filter`] on every level and |q|/2 on the base grid it is a
    /// preconditioner.
    #[must_use]
    pub fn inverse_stencil(&self, radius: usize) -> Stencil {
        inverse::stencil(&self.level_filter(), radius)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The displacement of the pressure that bends the remainder most, 1 where it is bent up, is between the bound's
    /// part for that sign and the bound, which is for both.
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
                // Four quadrants; the second derivative is the difference over the area of the square.
                bent[usize::from(difference < 0.0)] += 4.0 * difference.abs();
            }
            let bound = split.remainder_curvature(1.0);
            let [up, down] = bent;
            assert!(up.max(down) < bound, "{params:?}: bent by {up} and {down}, more than {bound}");
            // What is beyond the square, and the rule, are a tenth or so.
            assert!(up + down > 0.8 * bound, "{params:?}: bent by {up} and {down}, far less than {bound}");
        }
    }
}
