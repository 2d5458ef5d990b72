//! The filter between the finest level and a level of any size.
//!
//! The coarse level does not have half as many elements along a side. So fine centres are at any place between coarse
//! centres, and each has its own taps. The targets of the fits differ only by a shift. One fit at Chebyshev nodes gives
//! the taps at any place, as polynomials.

use std::f64::consts::PI;

use super::SplitParams;
use super::filter::{EXACT, SAMPLES, fit, love_target, weight};
use super::window::Window;
use crate::chebyshev::{coefficients, node, polynomials};

/// Number of places at which taps are fitted.
///
/// The fastest wave advances by half a period in a coarse element. A polynomial of this many terms represents it up to
/// rounding.
const NODES: usize = 24;

/// Interpolation along one axis to the finest level, from a level with other elements.
#[derive(Clone, Debug, PartialEq)]
pub struct UnevenFilter {
    /// Coefficients of the Chebyshev polynomials in 2 δ - 1, for each tap.
    taps: Vec<Vec<f64>>,
}

impl UnevenFilter {
    /// Weights of the coarse centres in the value at a fine centre.
    ///
    /// There are n coarse centres `c - (n/2 - 1), …, c + n/2`. The fine centre is `offset` (0 to 1) of a coarse element
    /// beyond the coarse centre `c`.
    #[must_use]
    pub fn taps(&self, offset: f64) -> Vec<f64> {
        let waves = polynomials::<NODES>(2.0 * offset - 1.0);
        self.taps.iter().map(|tap| tap.iter().zip(waves).map(|(c, wave)| c * wave).sum()).collect()
    }
}

/// Fits the filter for Love's squares, with `ratio` coarse elements for each fine one.
///
/// The method is that of [`super::filter::design`].
pub(super) fn design(window: &Window, params: SplitParams, ratio: f64) -> UnevenFilter {
    let (n, c) = (params.taps, params.cutoff as f64);
    let offsets: [f64; NODES] = std::array::from_fn(|i| 0.5 + 0.5 * node(i, NODES));
    // Coarse centres, in fine elements, from the middle between two of them. There, errors are about even.
    let place = |j: usize| (j as f64 - 0.5 * (n - 1) as f64) / ratio;
    let mut rows: Vec<Vec<f64>> = Vec::with_capacity(2 * SAMPLES + 1);
    for sample in 1..=SAMPLES {
        // Up to the shortest wave of the coarse grid.
        let q = PI * ratio * sample as f64 / SAMPLES as f64;
        let weight = weight(window, c, q);
        let wanted = weight * love_target(q);
        let shifts = offsets.map(|offset| q * (offset - 0.5) / ratio);
        let row = |of: fn(f64) -> f64| {
            let waves = (0..n).map(|j| weight * of(q * place(j)));
            waves.chain(shifts.iter().map(|&shift| wanted * of(shift))).collect()
        };
        rows.push(row(f64::cos));
        rows.push(row(f64::sin));
    }
    let heaviest = rows.iter().flat_map(|row| &row[n..]).fold(0.0_f64, |most, value| most.max(value.abs()));
    rows.insert(0, vec![EXACT * heaviest; n + NODES]);
    let at_nodes = fit(rows, n);
    let taps = (0..n).map(|j| coefficients(&at_nodes.iter().map(|taps| taps[j]).collect::<Vec<f64>>()));
    UnevenFilter { taps: taps.collect() }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{ScaleSplit, SplitParams};

    #[test]
    fn with_half_as_many_elements_it_is_the_even_filter() {
        for params in [SplitParams::quick(), SplitParams::certified()] {
            let split = ScaleSplit::new(params);
            let (even, uneven) = (split.love_filter(), split.uneven_filter(0.5));
            let [beyond, before] = [0.25, 0.75].map(|offset| uneven.taps(offset));
            for (i, tap) in even.taps().iter().enumerate() {
                assert!((beyond[i] - tap).abs() < 1e-7, "{params:?}: {beyond:?} for {:?}", even.taps());
                assert!((before[params.taps - 1 - i] - tap).abs() < 1e-7, "{params:?}: {before:?}");
            }
        }
    }

    #[test]
    fn waves_pass_at_any_place_as_squares_see_them() {
        let split = ScaleSplit::new(SplitParams::certified());
        for ratio in [0.5, 0.511, 0.56] {
            let filter = split.uneven_filter(ratio);
            for offset in [0.0, 0.1, 0.37, 0.5, 0.93, 1.0] {
                let taps = filter.taps(offset);
                assert!((taps.iter().sum::<f64>() - 1.0).abs() < 1e-9);
                for q in [0.1, 0.3, 0.5] {
                    let first = 1.0 - 0.5 * taps.len() as f64;
                    let phase = |j: usize| q * (first + j as f64 - offset) / ratio;
                    let real: f64 = taps.iter().enumerate().map(|(j, tap)| tap * phase(j).cos()).sum();
                    let imaginary: f64 = taps.iter().enumerate().map(|(j, tap)| tap * phase(j).sin()).sum();
                    let error = (real - love_target(q)).hypot(imaginary);
                    assert!(error < 1e-5, "ratio {ratio}, offset {offset}, q {q}: {error:e}");
                }
            }
        }
    }
}
