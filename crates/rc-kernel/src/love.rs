//! Love's square: the displacement of a half-space under uniform pressure on a square, one term of Eq. 5.
//!
//! Love, *Phil. Trans. R. Soc. A* 228 (1929) 377; Johnson, *Contact Mechanics* (1985), Eq. 3.25. The logarithms of the printed
//! form cancel where the point is far away or in line with a side. Near the square the same integral is taken with asinh,
//! which does not cancel in line; far from it a multipole series replaces the differences.

use std::f64::consts::{FRAC_1_PI, SQRT_2};
use std::sync::LazyLock;

/// Distance, in half-sides, from which the multipole series is used: there both forms are accurate to rounding.
const FAR: f64 = 4.0;

/// Orders of the multipole series, in (d/R)²: enough for [`FAR`].
const ORDERS: usize = 19;

/// Displacement at offset (`x`, `y`) from the centre of a square of half-side `half_side` d under unit pressure:
///
/// ```text
/// u = 1/(π E*) ∫∫ ds / |r - s|       over |s_x|, |s_y| ≤ d,  with E* = 1.
/// ```
///
/// In units of λ when `x`, `y`, `half_side` are. At the centre `8 d ln(1 + √2)/π`; far away `4 d²/(π R)`.
///
/// *Accuracy*: relative error at most 2e-15 at every distance, inside, on edges and on corners included (test
/// `matches_reference_values_everywhere`). Exactly symmetric under x → -x, y → -y and x ↔ y.
#[must_use]
pub fn love_displacement(x: f64, y: f64, half_side: f64) -> f64 {
    let (long, short) = (x.abs().max(y.abs()), x.abs().min(y.abs()));
    let (long, short) = (long / half_side, short / half_side);
    FRAC_1_PI * half_side * if long < FAR { near(long, short) } else { far(long, short) }
}

/// ∫∫ 1/r over the square of half-side 1, from its four corners.
fn near(x: f64, y: f64) -> f64 {
    let corner = |a: f64, b: f64| arm(a, b) + arm(b, a);
    (corner(x + 1.0, y + 1.0) - corner(x - 1.0, y + 1.0)) - (corner(x + 1.0, y - 1.0) - corner(x - 1.0, y - 1.0))
}

/// a asinh(b/|a|), 0 for a = 0.
fn arm(a: f64, b: f64) -> f64 {
    if a == 0.0 { 0.0 } else { a * (b / a.abs()).asinh() }
}

/// ∫∫ 1/r over the square of half-side 1, from its multipoles: `4/R Σ_j R^-2j Σ_i M_ji cos(4 i φ)`.
fn far(x: f64, y: f64) -> f64 {
    let distance = x.hypot(y);
    let (cos, sin) = (x / distance, y / distance);
    let (c2, s2) = (cos * cos - sin * sin, 2.0 * cos * sin);
    let cos_4 = c2 * c2 - s2 * s2;
    let u = 1.0 / (distance * distance);
    // The farthest point of the square is √2 away, so order j is below (√2/R)^2j; 2^-56 is below rounding.
    let orders = (28.0 / (distance / SQRT_2).log2()) as usize + 2;
    let mut sum = 0.0;
    for multipoles in MULTIPOLES[..orders.min(ORDERS)].iter().rev() {
        // Clenshaw's recurrence for the cosine sum.
        let (mut b1, mut b2) = (0.0, 0.0);
        for &m in multipoles[1..].iter().rev() {
            (b1, b2) = (m + 2.0 * cos_4 * b1 - b2, b1);
        }
        sum = sum * u + (multipoles[0] + cos_4 * b1 - b2);
    }
    4.0 / distance * sum
}

/// M_ji: mean over the square of half-side 1 of s^2j times the cos(4iφ) part of the Legendre polynomial P_2j.
static MULTIPOLES: LazyLock<Vec<Vec<f64>>> =
    LazyLock::new(|| (0..ORDERS).map(|j| (0..=j / 2).map(|i| multipole(2 * j, 4 * i)).collect()).collect());

/// One multipole: degree l, angular order m.
///
/// `P_l(cos γ) = Σ_k a_k a_{l-k} cos((l-2k)γ)` with `a_k = (2k-1)!!/(2k)!!`, so order m has the factor `2 a_k a_{l-k}`,
/// k = (l-m)/2 (once for m = 0), times the mean of `s^l cos(mφ)` over the square.
fn multipole(l: usize, m: usize) -> f64 {
    let a = |k: usize| (1..=k).map(|i| (2 * i - 1) as f64 / (2 * i) as f64).product::<f64>();
    let k = (l - m) / 2;
    let factor = if m == 0 { 1.0 } else { 2.0 } * a(k) * a(l - k);
    factor * mean_over_square(l, m)
}

/// Mean of `s^l cos(mφ)` over |s_x|, |s_y| ≤ 1: the real part of (s_x + i s_y)^m times (s_x² + s_y²)^((l-m)/2), expanded,
/// with ⟨s^2a⟩ = 1/(2a+1) along each axis.
fn mean_over_square(l: usize, m: usize) -> f64 {
    let k = (l - m) / 2;
    let mut sum = 0.0;
    for i in (0..=m).step_by(2) {
        let sign = if i % 4 == 0 { 1.0 } else { -1.0 };
        for j in 0..=k {
            let power_y = i + 2 * j;
            let moment = 1.0 / ((l - power_y + 1) * (power_y + 1)) as f64;
            sum += sign * binomial(m, i) * binomial(k, j) * moment;
        }
    }
    sum
}

fn binomial(n: usize, k: usize) -> f64 {
    (0..k).map(|i| (n - i) as f64 / (k - i) as f64).product()
}
