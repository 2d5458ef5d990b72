//! Chebyshev fits of smooth functions of two variables, and Gauss-Legendre rules.

use std::f64::consts::PI;

/// The `i`-th of `n` Chebyshev points on [-1, 1].
pub(crate) fn chebyshev_point(i: usize, n: usize) -> f64 {
    angle(i, n).cos()
}

fn angle(i: usize, n: usize) -> f64 {
    PI * (i as f64 + 0.5) / n as f64
}

/// Coefficients c_ij, row-major in i, of `Σ c_ij T_i(x) T_j(y)` through `values` at the n × n Chebyshev points.
pub(crate) fn chebyshev_coefficients(values: &[f64], n: usize) -> Vec<f64> {
    let cosines: Vec<f64> = (0..n * n).map(|at| (angle(at % n, n) * (at / n) as f64).cos()).collect();
    // Once along y and transposed, once along x and transposed back.
    let transform = |values: &[f64]| -> Vec<f64> {
        let along = |k: usize, row: &[f64]| {
            let weight = if k == 0 { 1.0 } else { 2.0 } / n as f64;
            weight * row.iter().zip(&cosines[k * n..]).map(|(value, cosine)| value * cosine).sum::<f64>()
        };
        (0..n).flat_map(|k| values.chunks_exact(n).map(move |row| along(k, row))).collect()
    };
    transform(&transform(values))
}

/// T_0(x) to T_(N-1)(x).
pub(crate) fn chebyshev_values<const N: usize>(x: f64) -> [f64; N] {
    let (mut next, mut after) = (1.0, x);
    std::array::from_fn(|_| {
        let value = next;
        (next, after) = (after, 2.0 * x * after - next);
        value
    })
}

/// Coefficients of x^i y^j of the polynomial with the Chebyshev coefficients `c`, both row-major in i.
///
/// Powers of low degree on [-1, 1] lose a factor (1 + √2)^degree of the *high* coefficients only, which are small.
pub(crate) fn to_powers<const N: usize>(c: &[f64]) -> [[f64; N]; N] {
    let powers = chebyshev_powers::<N>();
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

/// For each k < N, the coefficients of x^i in T_k.
fn chebyshev_powers<const N: usize>() -> [[f64; N]; N] {
    let mut all = [[0.0; N]; N];
    all[0][0] = 1.0;
    all[1][1] = 1.0;
    for k in 2..N {
        all[k] = std::array::from_fn(|i| if i == 0 { 0.0 } else { 2.0 * all[k - 1][i - 1] } - all[k - 2][i]);
    }
    all
}

/// Points and weights of the Gauss-Legendre rule on [-1, 1]; the weights add up to 1, for means.
pub(crate) fn gauss_legendre<const N: usize>() -> [(f64, f64); N] {
    let n = N as f64;
    std::array::from_fn(|i| {
        let mut x = (PI * (i as f64 + 0.75) / (n + 0.5)).cos();
        let mut slope = 1.0;
        // Newton's method on P_N from within its basin; the fifth step is below rounding.
        for _ in 0..6 {
            let (mut before, mut p) = (1.0, x);
            for k in 2..=N {
                let k = k as f64;
                (before, p) = (p, ((2.0 * k - 1.0) * x * p - (k - 1.0) * before) / k);
            }
            slope = n * (x * p - before) / (x * x - 1.0);
            x -= p / slope;
        }
        (x, 1.0 / ((1.0 - x * x) * slope * slope))
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_fit_reproduces_a_polynomial_in_both_bases() {
        const N: usize = 5;
        let f = |x: f64, y: f64| 1.0 - 2.0 * x * y * y + 0.25 * x.powi(4) * y.powi(3) - y.powi(4);
        let points: Vec<f64> = (0..N).map(|i| chebyshev_point(i, N)).collect();
        let values: Vec<f64> = points.iter().flat_map(|&x| points.iter().map(move |&y| f(x, y))).collect();
        let c = chebyshev_coefficients(&values, N);
        let powers = to_powers::<N>(&c);
        for (x, y) in [(0.3, -0.7), (1.0, 1.0), (-0.9, 0.0)] {
            let (tx, ty) = (chebyshev_values::<N>(x), chebyshev_values::<N>(y));
            let chebyshev: f64 = (0..N * N).map(|at| c[at] * tx[at / N] * ty[at % N]).sum();
            let power: f64 =
                (0..N * N).map(|at| powers[at / N][at % N] * x.powi(at as i32 / 5) * y.powi(at as i32 % 5)).sum();
            for value in [chebyshev, power] {
                assert!((value - f(x, y)).abs() <= 1e-14, "at ({x}, {y}): {value}, expected {}", f(x, y));
            }
        }
    }
}
