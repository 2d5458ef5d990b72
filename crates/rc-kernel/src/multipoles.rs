//! The multipole series of a uniformly loaded square, for ∫∫ 1/r far from it.
//!
//! R, φ are the polar coordinates of the point, and s, ψ those of a point of the square. 1/|r - s| is the sum of
//! `s^l/R^(l+1) P_l(cos(φ - ψ))`. In the average over the square, only even l and angular orders that are multiples of
//! 4 remain:
//!
//! ```text
//! ⟨1/|r - s|⟩ = 1/R Σ_j (d/R)^2j Σ_a M_ja cos(4aφ),      a ≤ j/2.
//! ```

use std::sync::LazyLock;

use crate::chebyshev;

/// Number of pairs of orders 2i, 2i + 1 in (d/R)², enough at a distance of 2.5 half-sides.
const PAIRS: usize = 16;

/// For each pair of orders, the coefficients of both at the powers of c = cos 4φ.
type Table = [[[f64; 2]; PAIRS]; PAIRS];

static MULTIPOLES: LazyLock<Table> = LazyLock::new(|| std::array::from_fn(powers_of_cosine));

/// Mean of 1/|r - s| over a square of half-side d, times d.
///
/// `inverse` is d/x and `slope` is y/x, with 0 ≤ y ≤ x. The relative error is a few roundings for d/x ≤ 0.4. The number
/// of orders depends on the distance.
pub(crate) fn multipole_series(inverse: f64, slope: f64) -> f64 {
    let squared = slope * slope;
    let cos_squared = 1.0 / (1.0 + squared);
    let c = 1.0 - 8.0 * squared * cos_squared * cos_squared;
    let u = inverse * inverse * cos_squared;
    // The corner of the square is at √2 d, so order j is below (2u)^j. The first omitted order is below 2^-52.
    let pairs = ((18.0 / -(2.0 * u).ln()) as usize + 1).min(PAIRS);
    let mut sum = 0.0;
    let table = &*MULTIPOLES;
    for i in (0..pairs).rev() {
        let (mut even, mut odd) = (0.0, 0.0);
        for &[m_even, m_odd] in table[i][..=i].iter().rev() {
            (even, odd) = (even * c + m_even, odd * c + m_odd);
        }
        sum = sum * (u * u) + (even + odd * u);
    }
    inverse * cos_squared.sqrt() * sum
}

/// The angular sums of orders 2i and 2i + 1 as polynomials in c.
///
/// cos(4aφ) is the Chebyshev polynomial T_a(c).
fn powers_of_cosine(i: usize) -> [[f64; 2]; PAIRS] {
    let mut powers = [[0.0; 2]; PAIRS];
    for (a, polynomial) in chebyshev::powers::<PAIRS>().iter().enumerate().take(i + 1) {
        let multipoles = [multipole(4 * i, 4 * a), multipole(4 * i + 2, 4 * a)];
        for (power, t) in powers.iter_mut().zip(polynomial) {
            *power = [power[0] + multipoles[0] * t, power[1] + multipoles[1] * t];
        }
    }
    powers
}

/// The coefficient M of degree l and angular order m.
///
/// `P_l(cos γ) = Σ_k p_k p_(l-k) cos((l-2k)γ)` with `p_k = (2k-1)!!/(2k)!!`. So order m appears twice, at k = (l-m)/2,
/// and once when m = 0.
fn multipole(l: usize, m: usize) -> f64 {
    let p = |k: usize| (1..=k).map(|i| (2 * i - 1) as f64 / (2 * i) as f64).product::<f64>();
    let k = (l - m) / 2;
    let times = if m == 0 { 1.0 } else { 2.0 };
    times * p(k) * p(l - k) * mean_over_square(l, m)
}

/// Mean of `s^l cos mψ` over |s_x|, |s_y| ≤ 1.
///
/// It is the mean of the real part of (s_x + i s_y)^m times (s_x² + s_y²)^((l-m)/2), expanded. High orders cancel (to
/// 1e-16 4^j at order j = l/2). Their factor (d/R)^2j is smaller than this loss.
fn mean_over_square(l: usize, m: usize) -> f64 {
    let k = (l - m) / 2;
    let mut sum = 0.0;
    for i in (0..=m).step_by(2) {
        let sign = if i % 4 == 0 { 1.0 } else { -1.0 };
        for j in 0..=k {
            // ⟨s^2a⟩ = 1/(2a + 1) along each axis.
            let power_y = i + 2 * j;
            let moments = 1.0 / ((l - power_y + 1) * (power_y + 1)) as f64;
            sum += sign * binomial(m, i) * binomial(k, j) * moments;
        }
    }
    sum
}

fn binomial(n: usize, k: usize) -> f64 {
    (0..k).map(|i| (n - i) as f64 / (k - i) as f64).product()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn low_multipoles_are_those_of_a_square() {
        // Computed by hand: M_00 = 1; M_10 = ⟨s²⟩/4 = 1/6; M_20 = 9/64 ⟨s⁴⟩ = 9/64 · 28/45; M_21 = 35/64 ⟨s⁴ cos 4ψ⟩,
        // = -35/64 · 4/15.
        for ((l, m), expected) in [((0, 0), 1.0), ((2, 0), 1.0 / 6.0), ((4, 0), 7.0 / 80.0), ((4, 4), -7.0 / 48.0)] {
            let value = multipole(l, m);
            assert!((value - expected).abs() <= 1e-15, "degree {l}, order {m}: {value}, expected {expected}");
        }
    }
}
