//! Resampling to other numbers of points on the same rectangle.

use rc_core::{Field, Grid};

use super::stencil::{Edges, Taps, along_x, along_y};
use crate::HeightMap;

/// Resamples a map to another grid.
///
/// Fewer points are means over their elements. More points are on cubic curves (Catmull and Rom's) through the points
/// around them.
pub(super) fn resample(mut map: HeightMap, wanted: Grid, edges: Edges) -> HeightMap {
    let grid = map.heights.grid();
    let across = |field: Field| {
        let table = table(grid.nx(), wanted.nx());
        along_x(&field, wanted.nx(), edges, |i| taps(&table[i]))
    };
    let up = |field: Field| {
        let table = table(grid.ny(), wanted.ny());
        along_y(&field, wanted.ny(), edges, |i| taps(&table[i]))
    };
    // The side that becomes shorter is resampled first. So the intermediate field is not larger than both ends.
    map.heights = match (wanted.nx() != grid.nx(), wanted.ny() != grid.ny()) {
        (true, true) if wanted.ny() < grid.ny() && wanted.nx() > grid.nx() => across(up(map.heights)),
        (true, true) => up(across(map.heights)),
        (true, false) => across(map.heights),
        (false, true) => up(map.heights),
        (false, false) => map.heights,
    };
    map
}

fn taps((first, weights): &(i64, Vec<f64>)) -> Taps<'_> {
    Taps { first: *first, weights }
}

/// For each of `wanted` points, weights of the `n` points.
fn table(n: usize, wanted: usize) -> Vec<(i64, Vec<f64>)> {
    let ratio = n as f64 / wanted as f64;
    (0..wanted)
        .map(|i| if wanted < n { mean(i as f64 * ratio, ratio, n) } else { cubic((i as f64 + 0.5) * ratio - 0.5) })
        .collect()
}

/// The mean over [`from`, `from + width`), where points are elements of width 1.
fn mean(from: f64, width: f64, n: usize) -> (i64, Vec<f64>) {
    let to = (from + width).min(n as f64);
    let first = from.floor();
    let last = (to.ceil() - 1.0).max(first);
    let overlap = |i: i64| (to.min(i as f64 + 1.0) - from.max(i as f64)).max(0.0);
    let weights: Vec<f64> = (first as i64..=last as i64).map(overlap).collect();
    let sum: f64 = weights.iter().sum();
    (first as i64, weights.iter().map(|weight| weight / sum).collect())
}

fn cubic(at: f64) -> (i64, Vec<f64>) {
    let t = at - at.floor();
    let (t2, t3) = (t * t, t * t * t);
    let weights = [
        0.5 * (-t3 + 2.0 * t2 - t),
        0.5 * (3.0 * t3 - 5.0 * t2 + 2.0),
        0.5 * (-3.0 * t3 + 4.0 * t2 + t),
        0.5 * (t3 - t2),
    ];
    (at.floor() as i64 - 1, weights.to_vec())
}
