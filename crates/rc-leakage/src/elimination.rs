//! Elimination of a small network, element by element.

use crate::real::Real;

/// An eliminated network.
///
/// A bond that elimination makes is a sum of products of bonds, and a pivot is the sum of the remaining bonds
/// (Grassmann, Taksar and Heyman, Oper. Res. 33, 1985). So nothing cancels, and weak bonds keep their digits beside
/// strong ones. The last element of a cluster has exactly no bond left.
#[derive(Debug)]
pub(crate) struct Elimination {
    n: usize,
    /// In row i, the share of each later element in the pivot.
    shares: Vec<f64>,
    pivots: Vec<f64>,
}

impl Elimination {
    /// Eliminates `n` elements with bonds of two elements and a conductance.
    pub(crate) fn new(n: usize, bonds: impl Iterator<Item = (usize, usize, f64)>) -> Self {
        let mut network = vec![0.0_f64; n * n];
        for (a, b, bond) in bonds.filter(|(a, b, _)| a != b) {
            network[a.min(b) * n + a.max(b)] += bond;
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

    /// Writes the solution for `right` to `x`. The last element of each cluster has the pressure 0.
    pub(crate) fn solve<T: Real>(&self, right: &[T], x: &mut [T]) {
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
