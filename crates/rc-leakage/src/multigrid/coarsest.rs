//! The coarsest level, by elimination.

use super::interpolation::Bonds;
use super::stencil::Stencil;

/// Pivots below this part of their diagonal are rounding: the element closes a cluster, whose level is free.
const FREE: f64 = 1e-10;

/// The factors L D Lᵀ of the coarsest network.
#[derive(Debug)]
pub(super) struct Coarsest {
    n: usize,
    /// Rows of L below the diagonal, and the pivots on it; 0 for a level that is free.
    factors: Vec<f64>,
}

impl Coarsest {
    pub(super) fn new(stencil: &Stencil) -> Self {
        let n = stencil.nx * stencil.ny;
        let mut matrix = vec![0.0_f64; n * n];
        let bonds = Bonds(stencil);
        let mut add = |a: usize, b: usize, bond: f32| {
            let bond = f64::from(bond);
            for (i, j, value) in [(a, a, bond), (b, b, bond), (a, b, -bond), (b, a, -bond)] {
                matrix[i * n + j] += value;
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
        Self { n, factors: factorise(matrix, n) }
    }

    /// Writes the solution for `right` to `x`; clusters have a level of their own.
    pub(super) fn solve(&self, right: &[f32], x: &mut [f32]) {
        let n = self.n;
        let mut y: Vec<f64> = right.iter().copied().map(f64::from).collect();
        for i in 0..n {
            let (done, rest) = y.split_at_mut(i);
            rest[0] -= done.iter().zip(&self.factors[i * n..]).map(|(y, l)| y * l).sum::<f64>();
        }
        for (i, y) in y.iter_mut().enumerate() {
            let pivot = self.factors[i * n + i];
            *y = if pivot > 0.0 { *y / pivot } else { 0.0 };
        }
        for i in (0..n).rev() {
            let (earlier, value) = (&mut y[..=i]).split_at_mut(i);
            earlier.iter_mut().zip(&self.factors[i * n..]).for_each(|(y, l)| *y -= value[0] * l);
        }
        x.iter_mut().zip(y).for_each(|(x, y)| *x = y as f32);
    }
}

fn factorise(mut a: Vec<f64>, n: usize) -> Vec<f64> {
    let diagonal: Vec<f64> = (0..n).map(|i| a[i * n + i]).collect();
    for j in 0..n {
        let mut pivot = a[j * n + j];
        if pivot <= FREE * diagonal[j] {
            pivot = 0.0;
        }
        a[j * n + j] = pivot;
        for i in j + 1..n {
            let entry = a[i * n + j];
            let factor = if pivot > 0.0 { entry / pivot } else { 0.0 };
            if factor != 0.0 {
                for k in j + 1..=i {
                    a[i * n + k] -= factor * a[k * n + j];
                }
            }
        }
        for i in j + 1..n {
            a[i * n + j] = if pivot > 0.0 { a[i * n + j] / pivot } else { 0.0 };
        }
    }
    a
}
