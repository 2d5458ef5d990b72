//! Smooth part of the mean of φ over a square, from tables.
//!
//! It is the contribution of the background and of all images except the nearest. `ψ = φ - 1/r` is smooth on the whole
//! cell. It is fitted once to Ewald's sum, in the squares of the coordinates. The mean of the fit over a square is
//! exact: along each axis it is the mean of Chebyshev polynomials over an interval.
//!
//! For one size of square, this mean is a function of the offset. The table divides the offsets into patches, with a
//! polynomial of degree 7 in each coordinate on each patch.

use rc_core::DVec2;

use crate::chebyshev::{coefficients_in_two, node, polynomials, to_powers};
use crate::gauss_legendre::gauss_legendre;
use crate::lattice::ewald_remainder;

/// Largest half side of a square for which means are computed.
///
/// ψ is fitted on the cell with a margin of this width. The nearest images, where ψ is singular, lie beyond the margin.
/// With 1/8, [`TERMS`] are enough for 1e-14.
pub(crate) const MAX_HALF_SIDE: f64 = 0.125;

/// Half the side of the square on which ψ is fitted.
const REACH: f64 = 0.5 + MAX_HALF_SIDE;

/// Number of Chebyshev polynomials in x², and in y², of the fit.
const TERMS: usize = 24;

/// Points of the Gauss-Legendre rule along one side of a square.
///
/// The rule is exact up to degree 23, which is far beyond what ψ needs there.
const GAUSS: usize = 12;

/// Number of patches along half a side of the cell.
const PATCHES: usize = 12;

/// Coefficients per direction on one patch, with error 3e-13 (test `tables_agree_with_the_means`).
///
/// With eight of them, a row fills four registers of two.
const DEGREES: usize = 8;

/// ψ in Chebyshev polynomials of (x/REACH)² and (y/REACH)².
#[derive(Debug)]
pub(crate) struct Remainder {
    coefficients: Vec<f64>,
    gauss: [(f64, f64); GAUSS],
}

/// Means of the Chebyshev polynomials over one interval.
type Means = [f64; TERMS];

impl Remainder {
    pub(crate) fn new() -> Self {
        let point = |i: usize| REACH * (0.5 + 0.5 * node(i, TERMS)).sqrt();
        let mut values = vec![0.0; TERMS * TERMS];
        for i in 0..TERMS {
            for j in 0..=i {
                let value = ewald_remainder(DVec2::new(point(i), point(j)));
                values[i * TERMS + j] = value;
                values[j * TERMS + i] = value;
            }
        }
        Self { coefficients: coefficients_in_two(&values, TERMS), gauss: gauss_legendre() }
    }

    /// Mean of ψ over the square of half-side `half_side` ≤ [`MAX_HALF_SIDE`] around `centre`, |x|, |y| ≤ 1/2.
    pub(crate) fn mean(&self, centre: DVec2, half_side: f64) -> f64 {
        let (along_x, along_y) = (self.means(centre.x, half_side), self.means(centre.y, half_side));
        dot(&self.contract(&along_x), &along_y)
    }

    /// Mean of each Chebyshev polynomial over [x - d, x + d].
    fn means(&self, x: f64, half_side: f64) -> Means {
        let mut means = [0.0; TERMS];
        for &(point, weight) in &self.gauss {
            let u = (x + half_side * point) / REACH;
            let values = polynomials::<TERMS>(2.0 * u * u - 1.0);
            for (mean, value) in means.iter_mut().zip(values) {
                *mean += weight * value;
            }
        }
        means
    }

    /// The sum over the polynomials in x. It gives the coefficients of the polynomials in y.
    fn contract(&self, along_x: &Means) -> Means {
        let mut left = [0.0; TERMS];
        for (row, mean) in self.coefficients.chunks_exact(TERMS).zip(along_x) {
            for (left, c) in left.iter_mut().zip(row) {
                *left += c * mean;
            }
        }
        left
    }
}

fn dot(a: &Means, b: &Means) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

/// The mean of ψ over squares of one size, as a function of the offset.
///
/// It consists of polynomials on patches of the triangle 0 ≤ y ≤ x ≤ 1/2.
#[derive(Debug)]
pub(crate) struct MeanTable {
    /// Coefficients of powers of the offset from the centre of the patch, in half patches.
    ///
    /// Patch (i, j), j ≤ i, is at i (i + 1)/2 + j.
    patches: Vec<[[f64; DEGREES]; DEGREES]>,
}

impl MeanTable {
    /// The table for squares of half-side `half_side` ≤ [`MAX_HALF_SIDE`]. A half side of 0 gives ψ itself.
    pub(crate) fn new(remainder: &Remainder, half_side: f64) -> Self {
        let half_patch = 0.25 / PATCHES as f64;
        let point = |at: usize| {
            let (patch, point) = (at / DEGREES, at % DEGREES);
            half_patch * ((2 * patch + 1) as f64 + node(point, DEGREES))
        };
        let means: Vec<Means> = (0..PATCHES * DEGREES).map(|at| remainder.means(point(at), half_side)).collect();
        let contracted: Vec<Means> = means.iter().map(|means| remainder.contract(means)).collect();
        let patch = |i: usize, j: usize| {
            let (x, y) = (&contracted[i * DEGREES..][..DEGREES], &means[j * DEGREES..][..DEGREES]);
            let values: Vec<f64> = x.iter().flat_map(|x| y.iter().map(move |y| dot(x, y))).collect();
            to_powers(&coefficients_in_two(&values, DEGREES))
        };
        Self { patches: (0..PATCHES).flat_map(|i| (0..=i).map(move |j| (i, j))).map(|(i, j)| patch(i, j)).collect() }
    }

    /// The table from means at offsets (x, y) with 0 ≤ y, x ≤ 1/2.
    ///
    /// It serves squares larger than [`MAX_HALF_SIDE`].
    pub(crate) fn of_means(mean: impl Fn(DVec2) -> f64) -> Self {
        let half_patch = 0.25 / PATCHES as f64;
        let point = |patch: usize, at: usize| half_patch * ((2 * patch + 1) as f64 + node(at, DEGREES));
        let patch = |i: usize, j: usize| {
            let points =
                (0..DEGREES * DEGREES).map(|at| mean(DVec2::new(point(i, at / DEGREES), point(j, at % DEGREES))));
            to_powers(&coefficients_in_two(&points.collect::<Vec<f64>>(), DEGREES))
        };
        Self { patches: (0..PATCHES).flat_map(|i| (0..=i).map(move |j| (i, j))).map(|(i, j)| patch(i, j)).collect() }
    }

    /// The mean at offset (`long`, `short`), 0 ≤ short ≤ long ≤ 1/2.
    ///
    /// The function is never inlined. It takes 18 ns as a function, and up to 30 ns inside loops, where the compiler
    /// spills the eight sums.
    #[inline(never)]
    pub(crate) fn mean(&self, long: f64, short: f64) -> f64 {
        const PER_LENGTH: f64 = 2.0 * PATCHES as f64;
        let (x, y) = (long * PER_LENGTH, short * PER_LENGTH);
        let (i, j) = ((x as usize).min(PATCHES - 1), (y as usize).min(PATCHES - 1));
        let (x, y) = (2.0 * (x - i as f64) - 1.0, 2.0 * (y - j as f64) - 1.0);
        let mut along_y = [0.0; DEGREES];
        for row in self.patches[i * (i + 1) / 2 + j].iter().rev() {
            for (sum, c) in along_y.iter_mut().zip(row) {
                *sum = *sum * x + c;
            }
        }
        // Estrin's scheme needs half as many operations in sequence.
        let [c0, c1, c2, c3, c4, c5, c6, c7] = along_y;
        let (y2, y4) = (y * y, y * y * y * y);
        (c0 + c1 * y + (c2 + c3 * y) * y2) + (c4 + c5 * y + (c6 + c7 * y) * y2) * y4
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn means_agree_with_a_rule_of_forty_points_on_ewald_sums() {
        let remainder = Remainder::new();
        let rule = gauss_legendre::<40>();
        for half_side in [MAX_HALF_SIDE, 0.05, 1e-3] {
            for (x, y) in [(0.0, 0.0), (0.5, 0.0), (0.5, 0.5), (0.31, 0.47)] {
                let along_y =
                    |u: f64| rule.map(|(point, weight)| weight * ewald_remainder(DVec2::new(u, y + half_side * point)));
                let rows = rule.map(|(point, weight)| weight * along_y(x + half_side * point).iter().sum::<f64>());
                let reference: f64 = rows.iter().sum();
                let value = remainder.mean(DVec2::new(x, y), half_side);
                let error = (value - reference).abs();
                assert!(
                    error <= 3e-14,
                    "({x}, {y}), d = {half_side}: {value}, reference {reference}, off by {error:.1e}"
                );
            }
        }
    }

    #[test]
    fn tables_agree_with_the_means() {
        let remainder = Remainder::new();
        for half_side in [MAX_HALF_SIDE, 0.0625, 0.01, 0.0] {
            let table = MeanTable::new(&remainder, half_side);
            for at in 0..41 * 41_i32 {
                let offset = DVec2::new(f64::from(at % 41) / 80.0, f64::from(at / 41) / 80.0);
                if offset.y <= offset.x {
                    let (value, reference) = (table.mean(offset.x, offset.y), remainder.mean(offset, half_side));
                    let error = (value - reference).abs();
                    assert!(error <= 5e-13, "{offset}, d = {half_side}: {value}, reference {reference}, {error:.1e}");
                }
            }
        }
    }
}
