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
    /// The elements in the order of elimination.
    order: Vec<usize>,
    /// In row i, the share of each later element in the pivot.
    shares: Vec<f64>,
    pivots: Vec<f64>,
}

impl Elimination {
    /// Eliminates `n` elements with bonds of two elements and a conductance.
    pub(crate) fn new(n: usize, bonds: impl Iterator<Item = (usize, usize, f64)>) -> Self {
        let bonds: Vec<_> = bonds.filter(|(a, b, _)| a != b).collect();
        let order = by_strength(n, &bonds);
        let mut place = vec![0; n];
        order.iter().enumerate().for_each(|(at, &element)| place[element] = at);
        let mut network = vec![0.0_f64; n * n];
        for (a, b, bond) in bonds {
            let [a, b] = [place[a], place[b]];
            network[a.min(b) * n + a.max(b)] += bond;
        }
        Self::eliminate(network, order)
    }

    fn eliminate(mut network: Vec<f64>, order: Vec<usize>) -> Self {
        let n = order.len();
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
        Self { n, order, shares: network, pivots }
    }

    /// Writes the solution for `right` to `x`. The last element of each cluster has the pressure 0.
    pub(crate) fn solve<T: Real>(&self, right: &[T], x: &mut [T]) {
        let n = self.n;
        let mut y: Vec<f64> = self.order.iter().map(|&element| right[element].to_f64()).collect();
        for i in 0..n {
            let (value, later) = (y[i], &self.shares[i * n + i + 1..(i + 1) * n]);
            y[i + 1..].iter_mut().zip(later).for_each(|(y, share)| *y += share * value);
        }
        for i in (0..n).rev() {
            let later: f64 = self.shares[i * n + i + 1..(i + 1) * n].iter().zip(&y[i + 1..]).map(|(s, x)| s * x).sum();
            y[i] = if self.pivots[i] > 0.0 { y[i] / self.pivots[i] + later } else { 0.0 };
        }
        self.order.iter().zip(y).for_each(|(&element, y)| x[element] = T::of(y));
    }
}

/// The elements by the sum of their bonds, the weakest first.
///
/// The right side of a cluster sums to zero but for rounding. What is left of the sum leaves through the last element.
/// Through a weak one, it would need a large pressure.
fn by_strength(n: usize, bonds: &[(usize, usize, f64)]) -> Vec<usize> {
    let mut totals = vec![0.0; n];
    for (a, b, bond) in bonds {
        totals[*a] += bond;
        totals[*b] += bond;
    }
    let mut order: Vec<usize> = (0..n).collect();
    order.sort_by(|a, b| totals[*a].total_cmp(&totals[*b]));
    order
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Two strong bonds and a weak one in a chain. The right side sums to 1e-7.
    ///
    /// The rest leaves through a strong element, so the weak bond carries only what its own element gets.
    #[test]
    fn rounding_of_the_right_side_does_not_raise_a_weakly_connected_element() {
        let weak = 1e-15;
        let solver = Elimination::new(4, [(0, 1, 1.0), (1, 2, 1.0), (2, 3, weak)].into_iter());
        let mut x = [0.0; 4];
        solver.solve(&[1.0, 1e-7, -1.0, 0.0], &mut x);
        assert!((x[0] - x[1] - 1.0).abs() < 1e-6 && (x[1] - x[2] - 1.0).abs() < 1e-6, "{x:?}");
        assert!((x[3] - x[2]).abs() < 1e-12, "{x:?}");
    }
}
