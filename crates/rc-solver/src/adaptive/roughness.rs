//! How rough a pressure is: what the split kernel's error grows with.

use rayon::prelude::*;

use super::elements::Elements;
use super::tiles::TILE;

/// Greatest error of a displacement over [`roughness`], in units of the split's error (`SplitParams::for_error`). On pressures that
/// alternate from element to element 20 was measured for splits of 1e-6 and 57 for those of 2e-9; on smooth ones the rule of the split
/// itself holds.
pub(super) const ERROR_OF_ROUGHNESS: f64 = 60.0;

/// Greatest difference, over all elements, of `pressure` from the mean of its four neighbours, times the element's side (λ = 1).
pub(super) fn roughness(elements: &Elements, pressure: &[f64]) -> f64 {
    let of_level = |coarser: usize| {
        let first = elements.cells(coarser).start;
        let places = elements.levels()[coarser].places();
        let of_tile = |(tile, &place): (usize, &[u32; 2])| {
            let start = first + tile * TILE * TILE;
            if pressure[start..start + TILE * TILE].iter().all(|&p| p <= 0.0) {
                return 0.0;
            }
            let p = elements.around(pressure, coarser, place, 0.0);
            let cells = (TILE..2 * TILE).flat_map(|y| (TILE..2 * TILE).map(move |x| (x, y)));
            cells.fold(0.0_f64, |greatest, (x, y)| {
                let mean = 0.25 * (p[y - 1][x] + p[y + 1][x] + p[y][x - 1] + p[y][x + 1]);
                greatest.max((p[y][x] - mean).abs())
            })
        };
        elements.side(coarser) * places.par_iter().enumerate().map(of_tile).reduce(|| 0.0, f64::max)
    };
    (0..elements.levels().len()).map(of_level).fold(0.0, f64::max)
}
