//! Chebyshev series.
//!
//! The module has interpolants through the Chebyshev nodes, their sums, and their polynomials in powers.

use std::f64::consts::PI;

/// The `i`-th of `n` Chebyshev nodes on [-1, 1].
pub(crate) fn node(i: usize, n: usize) -> f64 {
    node_angle(i, n).cos()
}

/// The angle whose cosine is the node.
fn node_angle(i: usize, n: usize) -> f64 {
    PI * (i as f64 + 0.5) / n as f64
}

/// cos(k θ_i) of `n` nodes. These convert values at the nodes to coefficients.
struct Cosines {
    n: usize,
    /// `values[k * n + i]`.
    values: Vec<f64>,
}

impl Cosines {
    fn new(n: usize) -> Self {
        Self { n, values: (0..n * n).map(|at| (node_angle(at % n, n) * (at / n) as f64).cos()).collect() }
    }

    /// Σ_i `values[i]` cos(k θ_i).
    fn sum(&self, k: usize, values: &[f64]) -> f64 {
        values.iter().zip(&self.values[k * self.n..]).map(|(value, cosine)| value * cosine).sum()
    }
}

/// Factor of a mean over nodes: 1 for the constant, 2 for other polynomials.
fn multiplicity(k: usize) -> f64 {
    if k == 0 { 1.0 } else { 2.0 }
}

/// Coefficients c_k of the interpolant `Σ c_k T_k` through `values` at the nodes.
pub(crate) fn coefficients(values: &[f64]) -> Vec<f64> {
    let n = values.len();
    let cosines = Cosines::new(n);
    (0..n).map(|k| cosines.sum(k, values) * multiplicity(k) / n as f64).collect()
}

/// Coefficients c_ij, row-major in i, of `Σ c_ij T_i(x) T_j(y)` through `values` at the n × n nodes.
pub(crate) fn coefficients_in_two(values: &[f64], n: usize) -> Vec<f64> {
    let cosines = Cosines::new(n);
    // Once along y and transposed, once along x and transposed back.
    let transform = |values: &[f64]| -> Vec<f64> {
        let along = |k: usize, row: &[f64]| multiplicity(k) / n as f64 * cosines.sum(k, row);
        (0..n).flat_map(|k| values.chunks_exact(n).map(move |row| along(k, row))).collect()
    };
    transform(&transform(values))
}

/// T_0(x) to T_(N-1)(x).
pub(crate) fn polynomials<const N: usize>(x: f64) -> [f64; N] {
    let (mut next, mut after) = (1.0, x);
    std::array::from_fn(|_| {
        let value = next;
        (next, after) = (after, 2.0 * x * after - next);
        value
    })
}

/// Σ c_k T_k(x), by Clenshaw's recurrence.
///
/// The length is a constant of the compiler, for inner loops.
#[inline]
pub(crate) fn sum<const N: usize>(coefficients: &[f64; N], x: f64) -> f64 {
    let (mut b1, mut b2) = (0.0, 0.0);
    for &c in coefficients[1..].iter().rev() {
        (b1, b2) = (c + 2.0 * x * b1 - b2, b1);
    }
    coefficients[0] + x * b1 - b2
}

/// The interpolant of a function on [0, 1], with as many terms as rounding accuracy needs.
#[derive(Clone, Debug)]
pub(crate) struct Series {
    coefficients: Vec<f64>,
}

impl Series {
    /// The interpolant through the values at `n` nodes.
    ///
    /// Coefficients below 1e-16 of the largest are dropped from the end.
    pub(crate) fn new(n: usize, value: impl Fn(f64) -> f64) -> Self {
        let values: Vec<f64> = (0..n).map(|i| value(0.5 + 0.5 * node(i, n))).collect();
        let mut coefficients = coefficients(&values);
        let negligible = 1e-16 * coefficients.iter().fold(0.0_f64, |max, c| max.max(c.abs()));
        while coefficients.last().is_some_and(|c| c.abs() < negligible) {
            coefficients.pop();
        }
        Self { coefficients }
    }

    /// The value at `x` in [0, 1], by Clenshaw's recurrence.
    ///
    /// The coefficient is added last, whereas [`sum`] adds it first. Tables from each of the two keep their last digit.
    pub(crate) fn at(&self, x: f64) -> f64 {
        let t = 2.0 * x - 1.0;
        let (mut b1, mut b2) = (0.0, 0.0);
        for &c in self.coefficients[1..].iter().rev() {
            (b1, b2) = (2.0 * t * b1 - b2 + c, b1);
        }
        t * b1 - b2 + self.coefficients[0]
    }
}

/// Coefficients of x^i y^j of a polynomial with Chebyshev coefficients `c`.
///
/// Both are row-major in i. In powers of low degree on [-1, 1], only the *high* coefficients lose a factor (1 +
/// √2)^degree, and these are small.
pub(crate) fn to_powers<const N: usize>(c: &[f64]) -> [[f64; N]; N] {
    let powers = powers::<N>();
    let mut half = [[0.0; N]; N];
    for (i, row) in c.chunks_exact(N).enumerate() {
        for (c, t) in row.iter().zip(&powers) {
            half[i] = std::array::from_fn(|power| half[i][power] + c * t[power]);
        }
    }
    let mut all = [[0.0; N]; N];
    for (row, t) in half.iter().zip(&powers) {
        for (power, all) in all.iter_mut().enumerate() {
            *all = std::array::from_fn(|j| all[j] + t[power] * row[j]);
        }
    }
    all
}

/// For each k < N, the coefficients of x^i in T_k. They are integers.
pub(crate) fn powers<const N: usize>() -> [[f64; N]; N] {
    let mut all = [[0.0; N]; N];
    all[0][0] = 1.0;
    all[1][1] = 1.0;
    for k in 2..N {
        all[k] = std::array::from_fn(|i| if i == 0 { 0.0 } else { 2.0 * all[k - 1][i - 1] } - all[k - 2][i]);
    }
    all
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_fit_reproduces_a_polynomial_in_both_bases() {
        const N: usize = 5;
        let f = |x: f64, y: f64| 1.0 - 2.0 * x * y * y + 0.25 * x.powi(4) * y.powi(3) - y.powi(4);
        let points: Vec<f64> = (0..N).map(|i| node(i, N)).collect();
        let values: Vec<f64> = points.iter().flat_map(|&x| points.iter().map(move |&y| f(x, y))).collect();
        let c = coefficients_in_two(&values, N);
        let powers = to_powers::<N>(&c);
        for (x, y) in [(0.3, -0.7), (1.0, 1.0), (-0.9, 0.0)] {
            let (tx, ty) = (polynomials::<N>(x), polynomials::<N>(y));
            let chebyshev: f64 = (0..N * N).map(|at| c[at] * tx[at / N] * ty[at % N]).sum();
            let power: f64 =
                (0..N * N).map(|at| powers[at / N][at % N] * x.powi(at as i32 / 5) * y.powi(at as i32 % 5)).sum();
            for value in [chebyshev, power] {
                assert!((value - f(x, y)).abs() <= 1e-14, "at ({x}, {y}): {value}, expected {}", f(x, y));
            }
        }
    }

    #[test]
    fn sums_are_those_of_the_polynomials() {
        const N: usize = 12;
        let f = |x: f64| (3.0 * x).sin() + x * x;
        let values: [f64; N] = std::array::from_fn(|i| f(0.5 + 0.5 * node(i, N)));
        let fitted: [f64; N] = std::array::from_fn(|k| coefficients(&values)[k]);
        let series = Series::new(N, f);
        for x in [0.0, 0.2, 0.77, 1.0] {
            let t = 2.0 * x - 1.0;
            let direct: f64 = polynomials::<N>(t).iter().zip(&fitted).map(|(t, c)| t * c).sum();
            assert!((direct - f(x)).abs() <= 1e-9, "at {x}: {direct}, expected {}", f(x));
            assert!((sum(&fitted, t) - direct).abs() <= 1e-15 && (series.at(x) - direct).abs() <= 1e-15, "at {x}");
        }
    }
}
