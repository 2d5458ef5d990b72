//! The filter between two levels.
//!
//! It takes pressures to the coarser level, and displacements to the finer level. The centre of an element is a quarter
//! of a coarse element away from the nearest coarse centre, on one side or the other. So one set of taps and its mirror
//! image form the whole table. The taps are fitted by least squares to interpolate waves, with the spectrum of the
//! remainder as weight.

use super::SplitParams;
use super::window::Window;

/// Number of wavenumbers of the fit.
pub(super) const SAMPLES: usize = 400;

/// Weight of the condition that a constant is interpolated exactly.
///
/// It is relative to the largest weight of the fit.
pub(super) const EXACT: f64 = 1e4;

/// Interpolation along one axis, from a grid to a grid twice as fine.
#[derive(Clone, Debug, PartialEq)]
pub struct Filter {
    taps: Vec<f64>,
}

impl Filter {
    /// Weights of the coarse centres in the value at a fine centre.
    ///
    /// There are n coarse centres `c - (n/2 - 1), …, c + n/2`. The fine centre is a quarter of a coarse element beyond
    /// the coarse centre `c`. For the fine centre before `c` the weights are mirrored.
    #[must_use]
    pub fn taps(&self) -> &[f64] {
        &self.taps
    }

    /// The factor with which a wave of `q` radians per fine element is interpolated.
    #[must_use]
    pub fn response(&self, q: f64) -> f64 {
        let first = 1 - self.taps.len() as i32 / 2;
        self.taps.iter().zip(first..).map(|(tap, j)| tap * (q * (2.0 * f64::from(j) - 0.5)).cos()).sum()
    }
}

/// Target of the filter for the finest level, √sinc(q/2) along each axis.
///
/// sinc(q/2) is the factor between an element and a point. The filter and its transpose contribute one square root
/// each.
pub(super) fn love_target(q: f64) -> f64 {
    ((0.5 * q).sin() / (0.5 * q)).sqrt()
}

/// Weight of the wavenumber `q` in a fit.
///
/// It is the remainder of the cutoff `c`, times the decay of the spectrum of a pressure with square-root edges.
pub(super) fn weight(window: &Window, c: f64, q: f64) -> f64 {
    (2.0 / q - c * window.short_range(q * c)) * q.powf(-1.5)
}

/// The taps whose response at q is nearest to `target(q)`.
///
/// q is in radians per fine element.
pub(super) fn design(window: &Window, params: SplitParams, target: impl Fn(f64) -> f64) -> Filter {
    let n = params.taps;
    let c = params.cutoff as f64;
    let first = 1 - n as i32 / 2;
    let mut rows: Vec<Vec<f64>> = Vec::with_capacity(2 * SAMPLES + 1);
    for sample in 1..=SAMPLES {
        // Up to the shortest wave of the coarse grid.
        let q = std::f64::consts::FRAC_PI_2 * sample as f64 / SAMPLES as f64;
        let weight = weight(window, c, q);
        let phases: Vec<f64> = (0..n as i32).map(|j| q * (2.0 * f64::from(first + j) - 0.5)).collect();
        let wanted = weight * target(q);
        rows.push(phases.iter().map(|phase| weight * phase.cos()).chain([wanted]).collect());
        rows.push(phases.iter().map(|phase| weight * phase.sin()).chain([0.0]).collect());
    }
    // The heaviest rows come first. Only in this order are reflections accurate for rows of very different weights.
    let heaviest = rows.iter().map(|row| row[n].abs()).fold(0.0, f64::max);
    rows.insert(0, vec![EXACT * heaviest; n + 1]);
    Filter { taps: least_squares(rows, n) }
}

/// Solves an overdetermined system. The right-hand side is the last item of each row.
pub(super) fn least_squares(rows: Vec<Vec<f64>>, n: usize) -> Vec<f64> {
    fit(rows, n).pop().unwrap_or_default()
}

/// Solves an overdetermined system of `n` unknowns by Householder reflections.
///
/// Right-hand sides are the last items of each row. There is one solution for each of them.
pub(super) fn fit(mut rows: Vec<Vec<f64>>, n: usize) -> Vec<Vec<f64>> {
    let width = rows.first().map_or(n, Vec::len);
    for column in 0..n {
        let norm = rows[column..].iter().map(|row| row[column] * row[column]).sum::<f64>().sqrt();
        let alpha = if rows[column][column] > 0.0 { -norm } else { norm };
        let mut reflector: Vec<f64> = rows[column..].iter().map(|row| row[column]).collect();
        reflector[0] -= alpha;
        let squared: f64 = reflector.iter().map(|v| v * v).sum();
        if squared == 0.0 {
            continue;
        }
        for k in column..width {
            let product: f64 = reflector.iter().zip(&rows[column..]).map(|(v, row)| v * row[k]).sum();
            let factor = 2.0 * product / squared;
            for (v, row) in reflector.iter().zip(&mut rows[column..]) {
                row[k] -= factor * v;
            }
        }
    }
    let solve = |side: usize| {
        let mut solution = vec![0.0; n];
        for k in (0..n).rev() {
            let known: f64 = (k + 1..n).map(|j| rows[k][j] * solution[j]).sum();
            solution[k] = (rows[k][side] - known) / rows[k][k];
        }
        solution
    };
    (n..width).map(solve).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{ScaleSplit, SplitParams};

    #[test]
    fn least_squares_recovers_an_exact_solution() {
        let rows = (0..9).map(|i| {
            let x = f64::from(i);
            vec![1.0, x, x * x, 2.0 - 3.0 * x + 0.5 * x * x]
        });
        let solution = least_squares(rows.collect(), 3);
        for (value, exact) in solution.iter().zip([2.0, -3.0, 0.5]) {
            assert!((value - exact).abs() < 1e-12, "{solution:?}");
        }
    }

    #[test]
    fn long_waves_pass_and_the_error_falls_with_the_number_of_taps() {
        let mut last = f64::INFINITY;
        for taps in [4, 6, 8, 12] {
            let split = ScaleSplit::new(SplitParams { taps, ..SplitParams::certified() });
            let (plain, love) = (split.level_filter(), split.love_filter());
            assert!((plain.response(0.0) - 1.0).abs() < 1e-8);
            let error = |q: f64| (plain.response(q) - 1.0).abs().max((love.response(q) - love_target(q)).abs());
            let worst = [0.1, 0.2, 0.3, 0.4].into_iter().map(error).fold(0.0, f64::max);
            assert!(worst < 0.5 * last, "{taps} taps: {worst:e} after {last:e}");
            last = worst;
        }
        assert!(last < 2e-5, "{last:e}");
    }
}
