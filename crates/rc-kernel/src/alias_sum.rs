//! The symbol of the paper's element as a sum over aliases.
//!
//! This is the slow reference of the crate. On a grid of spacing (hx, hy) the wave k has the same values as its aliases
//! k + (m nx, n ny). A pressure that is constant on each element contains all of them. Each alias is damped by the
//! transform of the element, so the symbol is
//!
//! ```text
//! λ(k) = Σ_mn 2/|q| sinc(q_x hx/2) sinc(q_y hy/2),     q = 2π (kx + m nx, ky + n ny),     sinc z = sin z / z.
//! ```
//!
//! With θ = π k/n the sines are common factors, and alternating signs remain:
//!
//! ```text
//! λ(k) = Σ_mn T_m(θx) T_n(θy) / √(((θx + πm)/hx)² + ((θy + πn)/hy)²),     T_m(θ) = (-1)^m sin θ / (θ + πm).
//! ```
//!
//! The plain sum converges like 1/m². With the weights of Cohen, Rodriguez Villegas and Zagier (*Convergence
//! acceleration of alternating series*, Experimental Math. 9 (2000) 3-12) its error falls like 5.8^-terms. The weights
//! need terms that are moments of a positive measure. The terms 1/(t √(t² + b²)) at equidistant t are such moments,
//! because they are the Laplace transform of the positive function ∫ J0(b s) ds.

use std::f64::consts::PI;

use rc_core::Grid;

/// Number of terms of an accelerated sum. 5.8^-24 = 4e-19 is below rounding.
pub(crate) const TERMS: usize = 24;

/// The symbol of [`Love`](crate::Love) at wave (`kx`, `ky`) of `grid`, in λ/E*.
///
/// The sum is over all aliases, and the symbol is zero at k = 0. It takes about 2500 terms and 10 µs, so it serves as a
/// reference in tests and for single values.
///
/// *Accuracy*: 2e-15 relative (test `alias_sum_is_converged`). Test `alias_sum_matches_brute_force` compares it with
/// sums without acceleration. Any kx and ky are allowed, and the symbol is periodic in them.
#[must_use]
pub fn love_alias_sum(grid: Grid, kx: usize, ky: usize) -> f64 {
    let (nx, ny) = (grid.nx(), grid.ny());
    // The nearest of all aliases. By symmetry, its mirror image with positive components has the same value.
    let nearest = |k: usize, n: usize| (k % n).min(n - k % n);
    let (kx, ky) = (nearest(kx, nx), nearest(ky, ny));
    if kx == 0 && ky == 0 {
        return 0.0;
    }
    AliasSum::<TERMS>::new(grid.spacing().into()).full((phase(kx, nx), phase(ky, ny)))
}

/// Phase θ = π k/n.
pub(crate) fn phase(k: usize, n: usize) -> f64 {
    PI * (k as f64 / n as f64)
}

/// The alias sum and its parts, for elements of sides (hx, hy).
///
/// An accelerated sum has `N` terms. θ = (θx, θy) lies in [0, π/2]². It is not (0, 0), except for the parts without the
/// term m = n = 0.
pub(crate) struct AliasSum<const N: usize> {
    inverse_spacing: (f64, f64),
    weights: [f64; N],
}

impl<const N: usize> AliasSum<N> {
    pub(crate) fn new(spacing: (f64, f64)) -> Self {
        Self { inverse_spacing: (1.0 / spacing.0, 1.0 / spacing.1), weights: alternating_weights() }
    }

    /// Sum of all terms, λ.
    pub(crate) fn full(&self, theta: (f64, f64)) -> f64 {
        Damping::new(theta.1).at(0.0) * self.row(theta, 0.0) + self.outside_row(theta)
    }

    /// Sum of the terms with n ≠ 0.
    pub(crate) fn outside_row(&self, theta: (f64, f64)) -> f64 {
        let y = Damping::new(theta.1);
        self.accelerated(1, |n| y.at(n) * self.row(theta, n))
    }

    /// Sum of the terms with |m| > `reach.0` or |n| > `reach.1`.
    pub(crate) fn outside_block(&self, theta: (f64, f64), reach: (usize, usize)) -> f64 {
        let (x, y) = (Damping::new(theta.0), Damping::new(theta.1));
        let beside = |n: f64| self.accelerated(reach.0 + 1, |m| x.at(m) * self.reciprocal(theta, m, n));
        let within_rows: f64 = alias_range(reach.1).map(|n| y.at(n) * beside(n)).sum();
        within_rows + self.accelerated(reach.1 + 1, |n| y.at(n) * self.row(theta, n))
    }

    /// Σ_m T_m(θx) / √(…) for one n.
    fn row(&self, theta: (f64, f64), n: f64) -> f64 {
        let x = Damping::new(theta.0);
        let term = |m: f64| x.at(m) * self.reciprocal(theta, m, n);
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

    /// The factor 2/|q| = 1/√(…).
    fn reciprocal(&self, theta: (f64, f64), m: f64, n: f64) -> f64 {
        let (a, b) = ((theta.0 + PI * m) * self.inverse_spacing.0, (theta.1 + PI * n) * self.inverse_spacing.1);
        1.0 / (a * a + b * b).sqrt()
    }
}

/// The numbers -reach..=reach as floats.
pub(crate) fn alias_range(reach: usize) -> impl Iterator<Item = f64> {
    (0..=2 * reach).map(move |i| i as f64 - reach as f64)
}

/// The factors T_m for one θ.
pub(crate) struct Damping {
    theta: f64,
    sin: f64,
}

impl Damping {
    pub(crate) fn new(theta: f64) -> Self {
        Self { theta, sin: theta.sin() }
    }

    /// T_m(θ) = (-1)^m sin θ / (θ + πm), or 1 where numerator and denominator are zero.
    pub(crate) fn at(&self, m: f64) -> f64 {
        let argument = self.theta + PI * m;
        if argument == 0.0 {
            return 1.0;
        }
        let sign = if (m as i64) & 1 == 0 { 1.0 } else { -1.0 };
        sign * self.sin / argument
    }
}

/// Weights w_i, decreasing from 1 to 0, of alternating terms a_i.
///
/// Σ w_i a_i, i < N, replaces Σ a_i, i < ∞. This is algorithm 1 of the paper cited above. Its weights belong to |a_i|
/// and carry the signs. Here a_i has the signs.
pub(crate) fn alternating_weights<const N: usize>() -> [f64; N] {
    let n = N as f64;
    let d = (3.0 + 8.0_f64.sqrt()).powi(N as i32);
    let d = f64::midpoint(d, d.recip());
    let (mut b, mut c, mut sign) = (-1.0, -d, -1.0);
    std::array::from_fn(|k| {
        let k = k as f64;
        (c, sign) = (b - c, -sign);
        b *= (k + n) * (k - n) / ((k + 0.5) * (k + 1.0));
        sign * c / d
    })
}

#[cfg(test)]
mod tests {
    use std::f64::consts::FRAC_PI_2;

    use super::*;

    /// Phases (θx, θy) on edges, at corners, near the origin, and in between.
    const PHASES: [(f64, f64); 9] = [
        (0.3, 1.1),
        (FRAC_PI_2, FRAC_PI_2),
        (0.0, 0.8),
        (1.2, 0.0),
        (1e-3, 0.0),
        (0.0, 1e-6),
        (1e-4, 1e-3),
        (FRAC_PI_2, 0.0),
        (0.7, FRAC_PI_2),
    ];

    /// Sides of elements, from squares to very thin rectangles.
    const SPACINGS: [(f64, f64); 6] = [(1.0, 1.0), (0.25, 0.25), (1.0, 0.7), (0.1, 0.4), (1.0, 0.05), (0.02, 1.0)];

    /// The double sum over |m|, |n| ≤ 100, tapered to 0 over ten more terms.
    ///
    /// The taper is repeated averaging of the last partial sums. The sum is slow and shares nothing with the
    /// accelerated sum.
    fn brute_force(spacing: (f64, f64), theta: (f64, f64)) -> f64 {
        const KEPT: usize = 100;
        const AVERAGED: i32 = 10;
        // The number of averaged partial sums that include a term beyond the kept ones follows a binomial law.
        let mut taper = vec![1.0; KEPT + 1];
        let (mut share, mut left) = (0.5_f64.powi(AVERAGED), 1.0);
        for i in 0..AVERAGED {
            left -= share;
            taper.push(left);
            share *= f64::from(AVERAGED - i) / f64::from(i + 1);
        }
        let (x, y) = (Damping::new(theta.0), Damping::new(theta.1));
        let weight = |m: f64| taper[m.abs() as usize];
        let term = |m: f64, n: f64| {
            let q = ((theta.0 + PI * m) / spacing.0).hypot((theta.1 + PI * n) / spacing.1);
            weight(m) * weight(n) * x.at(m) * y.at(n) / q
        };
        // Summed row by row. In a single sum, 48 841 roundings would reach 2e-14.
        let reach = taper.len() - 1;
        alias_range(reach).map(|n| alias_range(reach).map(|m| term(m, n)).sum::<f64>()).sum()
    }

    /// Asserts `value(spacing, θ)` = `reference(spacing, θ)` to `tolerance` relative, for all spacings and phases.
    fn assert_equal(
        value: impl Fn((f64, f64), (f64, f64)) -> f64,
        reference: impl Fn((f64, f64), (f64, f64)) -> f64,
        tolerance: f64,
    ) {
        for spacing in SPACINGS {
            for theta in PHASES {
                let (value, reference) = (value(spacing, theta), reference(spacing, theta));
                let error = (value / reference - 1.0).abs();
                assert!(
                    error <= tolerance,
                    "elements {spacing:?}, θ = {theta:?}: {value:e}, reference {reference:e}, off by {error:.1e}"
                );
            }
        }
    }

    #[test]
    fn alias_sum_is_converged() {
        let (value, more) = (AliasSum::<TERMS>::full, AliasSum::<32>::full);
        let value = |spacing, theta| value(&AliasSum::new(spacing), theta);
        assert_equal(value, |spacing, theta| more(&AliasSum::new(spacing), theta), 2e-15);
    }

    #[test]
    fn alias_sum_matches_brute_force() {
        assert_equal(|spacing, theta| AliasSum::<TERMS>::new(spacing).full(theta), brute_force, 5e-15);
    }

    #[test]
    fn block_and_rest_make_up_the_sum() {
        let split = |spacing, theta: (f64, f64)| {
            let sum = AliasSum::<TERMS>::new(spacing);
            let (x, y) = (Damping::new(theta.0), Damping::new(theta.1));
            let term = |m, n| x.at(m) * y.at(n) * sum.reciprocal(theta, m, n);
            let block: f64 =
                alias_range(2).flat_map(|m| alias_range(1).map(move |n| (m, n))).map(|(m, n)| term(m, n)).sum();
            block + sum.outside_block(theta, (2, 1))
        };
        assert_equal(split, |spacing, theta| AliasSum::<TERMS>::new(spacing).full(theta), 4e-15);
    }

    #[test]
    fn alias_sum_is_periodic_in_the_wave() {
        let grid = Grid::new(12, 30).expect("grid");
        let value = love_alias_sum(grid, 5, 11);
        for (kx, ky) in [(7, 11), (5, 19), (17, 11), (5, 41), (19, 49)] {
            let same = love_alias_sum(grid, kx, ky);
            assert!(same.to_bits() == value.to_bits(), "({kx}, {ky}) is an alias of (5, 11)");
        }
        assert!(love_alias_sum(grid, 12, 60) == 0.0, "(12, 60) is an alias of (0, 0)");
    }
}
