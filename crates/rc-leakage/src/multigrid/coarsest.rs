//! The coarsest level, by elimination.

use super::interpolation::Bonds;
use super::real::Real;
use super::stencil::Stencil;

/// The coarsest network with its elements eliminated one after the other.
///
/// A bond that elimination makes is a sum of products of bonds, and a pivot the sum of the bonds that are left (Grassmann, Taksar and Heyman, Oper. Res. 33,
/// 1985): nothing cancels, so that weak bonds keep their digits beside strong ones, and the last element of a cluster is left without a bond exactly.
#[derive(Debug)]
pub(super) struct Coarsest {
    n: usize,
    /// In row i, the part of its pivot that each later element has.
    shares: Vec<f64>,
    pivots: Vec<f64>,
}

impl Coarsest {
    pub(super) fn new<T: Real>(stencil: &Stencil<T>) -> Self {
        let n = stencil.nx * stencil.ny;
        let mut network = vec![0.0_f64; n * n];
        let bonds = Bonds(stencil);
        let mut add = |a: usize, b: usize, bond: T| {
            if a != b {
                network[a.min(b) * n + a.max(b)] += bond.to_f64();
            }
        };
        for y in 0..stencil.ny {
            for x in 0..stencil.nx {
                let here = bonds.index(x, y);
                let [next, above, both] = [[x + 1, y], [x, y + 1], [x + 1, y + 1]].map(|[x, y]| bonds.index(x, y));
                add(here, next, bonds.east(x, y));
                add(here, above, bonds.north(x, y));
                add(here, both, bonds.rising(x, y));
                add(next, above, bonds.falling(x, y));
            }
        }
        Self::eliminate(network, n)
    }

    fn eliminate(mut network: Vec<f64>, n: usize) -> Self {
        let mut pivots = vec![0.0; n];
        for i in 0..n {
            let (done, rest) = network.split_at_mut((i + 1) * n);
            let row = &mut done[i * n + i + 1..];
            let pivot: f64 = row.iter().sum();
            if pivot <= 0.0 {
                row.fill(0.0);
                continue;
            }
            pivots[i] = pivot;
            for (k, bond) in row.iter().enumerate().filter(|(_, bond)| **bond != 0.0) {
                let share = bond / pivot;
                let to_later = &mut rest[k * n + i + 1 + k + 1..(k + 1) * n];
                to_later.iter_mut().zip(&row[k + 1..]).for_each(|(made, other)| *made += share * other);
            }
            for bond in row {
                *bond /= pivot;
            }
        }
        Self { n, shares: network, pivots }
    }

    /// Writes the solution for `right` to `x`; the last element of each cluster is at level 0.
    pub(super) fn solve<T: Real>(&self, right: &[T], x: &mut [T]) {
        let n = self.n;
        let mut y: Vec<f64> = right.iter().copied().map(T::to_f64).collect();
        for i in 0..n {
            let (value, later) = (y[i], &self.shares[i * n + i + 1..(i + 1) * n]);
            y[i + 1..].iter_mut().zip(later).for_each(|(y, share)| *y += share * value);
        }
        for i in (0..n).rev() {
            let later: f64 = self.shares[i * n + i + 1..(i + 1) * n].iter().zip(&y[i + 1..]).map(|(s, x)| s * x).sum();
            y[i] = if self.pivots[i] > 0.0 { y[i] / self.pivots[i] + later } else { 0.0 };
        }
        x.iter_mut().zip(y).for_each(|(x, y)| *x = T::of(y));
    }
}
