//! The symbol of the paper's element on a uniform grid, fast.
//!
//! The alias sum ([`crate::alias_sum`]) is split: the few aliases nearest to the wave are summed as they are, and the rest,
//! which is smooth and even in θx and θy, is a Chebyshev interpolant in θx², θy² built from the slow truth. With the
//! nearest aliases taken out, the rest is analytic far beyond [0, π/2]² and [`NODES`] nodes reach rounding.

use std::f64::consts::{FRAC_PI_2, PI};

use rc_core::Grid;

use crate::alias_sum::{AliasSum, alias_range, damping};

/// Chebyshev nodes per direction. The interpolant converges like 38^-nodes or faster.
const NODES: usize = 12;

/// Everything that depends on one coordinate of the wave.
struct Axis {
    /// For each k up to half the grid and each near alias: (T_m, ((θ + πm)/h)²).
    aliases: Vec<(f64, f64)>,
    n_aliases: usize,
    /// θ² mapped to [-1, 1], for each k.
    mapped: Vec<f64>,
}

impl Axis {
    fn new(n: usize, reach: usize) -> Self {
        let spacing = 1.0 / n as f64;
        let theta = |k: usize| PI * k as f64 / n as f64;
        let near = |k: usize| {
            alias_range(reach).map(move |m| {
                let q = (theta(k) + PI * m) / spacing;
                (damping(theta(k), m), q * q)
            })
        };
        Self {
            aliases: (0..=n / 2).flat_map(near).collect(),
            n_aliases: 2 * reach + 1,
            mapped: (0..=n / 2).map(|k| 2.0 * (theta(k) / FRAC_PI_2).powi(2) - 1.0).collect(),
        }
    }

    fn near(&self, k: usize) -> &[(f64, f64)] {
        &self.aliases[k * self.n_aliases..(k + 1) * self.n_aliases]
    }
}

/// Evaluates λ(kx, ky) on one grid.
pub(crate) struct LoveSymbol {
    x: Axis,
    y: Axis,
    /// Chebyshev coefficients in θy² for each kx.
    rest: Vec<[f64; NODES]>,
}

impl LoveSymbol {
    pub(crate) fn new(grid: Grid) -> Self {
        let (hx, hy) = grid.spacing();
        // Near enough for the rest to be analytic in |Im θ| < 3π/2, also on elongated elements.
        let reach = |along: f64, across: f64| (1.5 * along / across - 0.5).ceil().max(1.0) as usize;
        let reach = (reach(hx, hy), reach(hy, hx));
        let (x, y) = (Axis::new(grid.nx(), reach.0), Axis::new(grid.ny(), reach.1));
        let sum = AliasSum::new((hx, hy));
        let theta = |node: usize| {
            let angle = PI * (node as f64 + 0.5) / NODES as f64;
            FRAC_PI_2 * (0.5 * (angle.cos() + 1.0)).sqrt()
        };
        // Values at the nodes, then coefficients along y, then along x.
        let along_y: [[f64; NODES]; NODES] =
            std::array::from_fn(|i| coefficients(&std::array::from_fn(|j| sum.remainder((theta(i), theta(j)), reach))));
        let table: [[f64; NODES]; NODES] =
            std::array::from_fn(|j| coefficients(&std::array::from_fn(|i| along_y[i][j])));
        let collapse = |&mapped: &f64| std::array::from_fn(|j| chebyshev(&table[j], mapped));
        let rest = x.mapped.iter().map(collapse).collect();
        Self { x, y, rest }
    }

    /// λ for 0 ≤ kx ≤ nx/2, 0 ≤ ky ≤ ny/2; zero at k = 0 (Eq. 3).
    pub(crate) fn eigenvalue(&self, kx: usize, ky: usize) -> f64 {
        if kx == 0 && ky == 0 {
            return 0.0;
        }
        let mut sum = chebyshev(&self.rest[kx], self.y.mapped[ky]);
        for &(ty, qy) in self.y.near(ky) {
            for &(tx, qx) in self.x.near(kx) {
                sum += tx * ty / (qx + qy).sqrt();
            }
        }
        sum
    }
}

/// Chebyshev coefficients of the interpolant of values at the nodes cos(π(i + ½)/n).
fn coefficients(values: &[f64; NODES]) -> [f64; NODES] {
    let n = NODES as f64;
    std::array::from_fn(|k| {
        let terms = values.iter().enumerate().map(|(i, v)| v * (PI * k as f64 * (i as f64 + 0.5) / n).cos());
        terms.sum::<f64>() * if k == 0 { 1.0 / n } else { 2.0 / n }
    })
}

/// Σ c_k T_k(x), by Clenshaw's recurrence.
fn chebyshev(c: &[f64; NODES], x: f64) -> f64 {
    let (mut b1, mut b2) = (0.0, 0.0);
    for &ck in c[1..].iter().rev() {
        (b1, b2) = (ck + 2.0 * x * b1 - b2, b1);
    }
    c[0] + x * b1 - b2
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn fast_symbol_matches_the_alias_sum() {
        for (nx, ny) in [(16, 16), (64, 64), (4096, 4096), (15, 15), (12, 30), (9, 7), (64, 8), (3, 100)] {
            let grid = Grid::new(nx, ny).expect("grid");
            let (fast, slow) = (LoveSymbol::new(grid), AliasSum::new(grid.spacing()));
            let mut worst = 0.0_f64;
            for i in 0..=8 {
                for j in 0..=8 {
                    let (kx, ky) = (i * (nx / 2) / 8, j * (ny / 2) / 8);
                    if kx + ky > 0 {
                        let theta = (PI * kx as f64 / nx as f64, PI * ky as f64 / ny as f64);
                        worst = worst.max((fast.eigenvalue(kx, ky) / slow.full(theta) - 1.0).abs());
                    }
                }
            }
            assert!(worst < 2e-14, "{nx} x {ny}: off by {worst:e} relative");
        }
    }

    #[test]
    fn alias_sum_matches_brute_force() {
        // Partial sums over |m|, |n| ≤ M alternate around the limit with errors of order 1/M²; the mean of two neighbours
        // removes the leading one.
        let sum = AliasSum::new((1.0, 0.7));
        for theta in [(0.3, 1.1), (FRAC_PI_2, FRAC_PI_2), (0.0, 0.8), (1.2, 0.0)] {
            let brute = f64::midpoint(sum.explicit(theta, (400, 400)), sum.explicit(theta, (401, 401)));
            let (exact, error) = (sum.full(theta), (brute / sum.full(theta) - 1.0).abs());
            assert!(error < 1e-6, "at {theta:?}: {exact} against {brute}");
        }
    }
}
