//! A fast integral of 1/r over a square, to 1e-13.
//!
//! [`love_displacement`](crate::love_displacement) is accurate to rounding at every distance. This is the same
//! integral, for sums in which it is one term of several. Such a sum would lose the last two digits anyway. The
//! function takes little more than the time of its four logarithms.

/// Distance, in half-sides, from which six orders of the multipole series are used.
///
/// There, the first omitted order is below 2.5e-14. So is the cancellation of the logarithms, which grows with the
/// square of the distance.
const FAR: f64 = 13.0;

/// ∫∫ 1/|r - s| ds over the square |s_x|, |s_y| ≤ d = `half_side`, at r = (`long`, `short`).
///
/// The arguments have 0 ≤ short ≤ long.
#[inline]
pub(crate) fn square_integral(long: f64, short: f64, half_side: f64) -> f64 {
    if long > FAR * half_side { six_orders(long, short, half_side) } else { four_logarithms(long, short, half_side) }
}

/// The multipole series of [`crate::multipoles`] up to order (d/r)^10.
///
/// Its coefficients are fractions, and c = cos 4φ.
#[inline]
fn six_orders(long: f64, short: f64, half_side: f64) -> f64 {
    let (x2, y2) = (long * long, short * short);
    let inverse = 1.0 / (x2 + y2);
    let c = 1.0 - 8.0 * (x2 * inverse) * (y2 * inverse);
    let area = 4.0 * half_side * half_side;
    let u = 0.25 * area * inverse;
    let low = 1.0 + u * (1.0 / 6.0);
    let middle = (7.0 / 80.0 - 7.0 / 48.0 * c) + u * (15.0 / 224.0 - 3.0 / 32.0 * c);
    let high = (-353.0 / 4608.0 + c * (-121.0 / 1280.0 + c * (143.0 / 512.0)))
        + u * (-449.0 / 11264.0 + c * (-169.0 / 1536.0 + c * (221.0 / 1024.0)));
    area * inverse.sqrt() * (low + u * u * (middle + u * u * high))
}

/// Johnson's four logarithms, one for each side.
///
/// Each is the distance of the side times ∫ dt/√(distance² + t²) along it. t goes from `from` to `to`, at the radii
/// `r_from` and `r_to`. The function is never inlined, so that it is as fast in every caller.
#[inline(never)]
fn four_logarithms(long: f64, short: f64, half_side: f64) -> f64 {
    let scale = 1.0 / half_side;
    // Differences are taken before the scaling, so that they are exact next to a side.
    let [a, b] = [(long + half_side) * scale, (long - half_side) * scale];
    let [c, e] = [(short + half_side) * scale, (short - half_side) * scale];
    let (a2, b2, c2, e2) = (a * a, b * b, c * c, e * e);
    // For each side: squared distance to its line, offsets and squared radii of its ends.
    let squared = [a2, b2, c2, e2];
    let to = [c, c, a, a];
    let from = [e, e, b, b];
    let [ac, ae, bc, be] = [a2 + c2, a2 + e2, b2 + c2, b2 + e2].map(f64::sqrt);
    let r_to = [ac, bc, ac, ae];
    let r_from = [ae, be, bc, be];
    let mut logarithms = [0.0; 4];
    for (i, logarithm) in logarithms.iter_mut().enumerate() {
        let ahead = to[i] + r_to[i];
        let start = from[i].abs() + r_from[i];
        // Where a side starts behind the point, r_from + from would cancel. It equals squared/(r_from - from).
        let behind = from[i] < 0.0;
        let numerator = ahead * if behind { start } else { 1.0 };
        let denominator = if behind { squared[i] } else { start };
        *logarithm = ln(numerator / denominator.max(TINY));
    }
    half_side * ((a * logarithms[0] - b * logarithms[1]) + (c * logarithms[2] - e * logarithms[3]))
}

/// A squared distance below this, times its logarithm, is far below rounding.
const TINY: f64 = 1e-60;

/// Natural logarithm of a number ≥ 1, to a few roundings.
///
/// Unlike the logarithm of the standard library, it is inlined and free of branches. The processor can then compute all
/// four logarithms at once. This makes a periodic coefficient 10 ns faster.
#[inline]
fn ln(number: f64) -> f64 {
    const SQRT_HALF: u64 = 0x3fe6_a09e_667f_3bcd;
    // 2^52 with an integer in its last bits is 2^52 plus the integer.
    const TWO_52: u64 = 0x4330_0000_0000_0000;
    // number = 2^exponent · m, with m from √½ to √2.
    let exponent = number.to_bits().wrapping_sub(SQRT_HALF) >> 52;
    let m = f64::from_bits(number.to_bits().wrapping_sub(exponent << 52));
    let exponent = f64::from_bits(exponent | TWO_52) - f64::from_bits(TWO_52);
    // ln m = 2 artanh t.
    let t = (m - 1.0) / (m + 1.0);
    let t2 = t * t;
    let t4 = t2 * t2;
    let low = (1.0 + t2 * (1.0 / 3.0)) + t4 * (1.0 / 5.0 + t2 * (1.0 / 7.0));
    let high = (1.0 / 9.0 + t2 * (1.0 / 11.0)) + t4 * (1.0 / 13.0 + t2 * (1.0 / 15.0 + t2 * (1.0 / 17.0)));
    exponent * std::f64::consts::LN_2 + 2.0 * t * (low + t4 * t4 * high)
}

#[cfg(test)]
mod tests {
    use std::f64::consts::PI;

    use rc_core::DVec2;

    use super::*;
    use crate::love_displacement;

    #[test]
    fn agrees_with_the_square_that_is_accurate_to_rounding() {
        let half_side = 0.03;
        let mut offsets = vec![0.0, 1e-30, 0.5, 1.0 - 1e-9, 1.0 - 1e-16, 1.0, 1.0 + 1e-9];
        offsets.extend((0..200).map(|i| 1.03_f64.powi(i)));
        for &x in &offsets {
            for &y in offsets.iter().filter(|y| **y <= x) {
                let (x, y) = (x * half_side, y * half_side);
                let value = square_integral(x, y, half_side) / PI;
                let reference = love_displacement(DVec2::new(x, y), half_side);
                let error = (value / reference - 1.0).abs();
                assert!(error <= 1e-13, "at ({x}, {y}): {value:e}, reference {reference:e}, off by {error:.1e}");
            }
        }
    }
}
