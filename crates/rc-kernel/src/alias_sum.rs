//! The symbol of the paper's element as a sum over aliases: the slow truth of this crate.
//!
//! On a grid of spacing (hx, hy) the wave k looks the same as its aliases k + (m nx, n ny). A pressure that is constant on
//! each element contains all of them, each damped by the transform of the element, so the symbol is
//!
//! ```text
//! λ(k) = Σ_mn 2/|q| sinc(q_x hx/2) sinc(q_y hy/2),     q = 2π (kx + m nx, ky + n ny),     sinc z = sin z / z.
//! ```
//!
//! With θ = π k/n the sines come out of the sums and leave alternating signs:
//!
//! ```text
//! λ(k) = Σ_mn T_m(θx) T_n(θy) / √(((θx + πm)/hx)² + ((θy + πn)/hy)²),     T_m(θ) = (-1)^m sin θ / (θ + πm).
//! ```
//!
//! Such a sum converges like 1/m² if added up. With the weights of Cohen, Rodriguez Villegas and Zagier (*Convergence
//! acceleration of alternating series*, Experimental Math. 9 (2000) 3-12) its error falls like 5.8^-terms: they ask for
//! terms that are moments of a positive measure, which 1/(t √(t² + b²)) is at equidistant t, being the Laplace transform of
//! the positive function ∫ J0(b s) ds.

use std::f64::consts::PI;

use rc_core::Grid;

/// Terms of an accelerated sum: 5.8^-24 = 4e-19 is below rounding.
pub(crate) const TERMS: usize = 24;

/// The symbol of [`Love`](crate::Love) at wave (`kx`, `ky`) of `grid`, summed over all aliases; in λ/E*, zero at k = 0.
///
/// The slow truth behind [`Love`](crate::Love), for tests and for single values: about 2500 terms, 10 µs.
///
/// *Accuracy*: 2e-15 relative (test `alias_sum_is_converged`; against sums without acceleration, test
/// `alias_sum_matches_brute_force`). Any kx and ky are allowed; the symbol is periodic in them.
#[must_use]
pub fn love_alias_sum(grid: Grid, kx: usize, ky: usize) -> f64 {
    let (nx, ny) = (grid.nx(), grid.ny());
    // The nearest of all aliases, and by symmetry its mirror image with positive components.
    let nearest = |k: usize, n: usize| (k % n).min(n - k % n);
    let (kx, ky) = (nearest(kx, nx), nearest(ky, ny));
    if kx == 0 && ky == 0 {
        return 0.0;
    }
    AliasSum::<TERMS>::new(grid.spacing()).full((phase(kx, nx), phase(ky, ny)))
}

/// θ = π k/n.
pub(crate) fn phase(k: usize, n: usize) -> f64 {
    PI * (k as f64 / n as f64)
}

/// The sum and its parts, on elements of sides (hx, hy), with `N` terms where it is accelerated.
///
/// θ = (θx, θy) lies in [0, π/2]² and is not (0, 0), except for the parts that do not contain m = n = 0.
pub(crate) struct AliasSum<const N: usize> {
    inverse_spacing: (f64, f64),
    weights: [f64; N],
}

impl<const N: usize> AliasSum<N> {
    pub(crate) fn new(spacing: (f64, f64)) -> Self {
        Self { inverse_spacing: (1.0 / spacing.0, 1.0 / spacing.1), weights: alternating_weights() }
    }

    /// All terms: λ.
    pub(crate) fn full(&self, theta: (f64, f64)) -> f64 {
        self.row(theta, 0.0) + self.outside_row(theta)
    }

    /// The terms with n ≠ 0.
    pub(crate) fn outside_row(&self, theta: (f64, f64)) -> f64 {
        self.accelerated(1, |n| damping(theta.1, n) * self.row(theta, n))
    }

    /// The terms with |m| > `reach.0` or |n| > `reach.1`.
    pub(crate) fn outside_block(&self, theta: (f64, f64), reach: (usize, usize)) -> f64 {
        let beside = |n: f64| self.accelerated(reach.0 + 1, |m| damping(theta.0, m) * self.reciprocal(theta, m, n));
        let within_rows: f64 = alias_range(reach.1).map(|n| damping(theta.1, n) * beside(n)).sum();
        within_rows + self.accelerated(reach.1 + 1, |n| damping(theta.1, n) * self.row(theta, n))
    }

    /// Σ_m T_m(θx) / √(…) for one n; all of λ's row n = 0 but for the factor `T_0(θy)`, which `full` has as 1·T_0.
    fn row(&self, theta: (f64, f64), n: f64) -> f64 {
        let term = |m: f64| damping(theta.0, m) * self.reciprocal(theta, m, n);
        term(0.0) + self.accelerated(1, term)
    }

    /// Σ over |k| ≥ `first` of `term(k)`, whose signs alternate like (-1)^k.
    fn accelerated(&self, first: usize, term: impl Fn(f64) -> f64) -> f64 {
        let pairs = self.weights.iter().enumerate().map(|(i, weight)| {
            let k = (first + i) as f64;
            weight * (term(k) + term(-k))
        });
        pairs.sum()
    }

    /// 1/|q|, but for the factor 2 that the sincs bring in and that cancels the 2 of 2/|q|.
    fn reciprocal(&self, theta: (f64, f64), m: f64, n: f64) -> f64 {
        let (a, b) = ((theta.0 + PI * m) * self.inverse_spacing.0, (theta.1 + PI * n) * self.inverse_spacing.1);
        1.0 / (a * a + b * b).sqrt()
    }
}
