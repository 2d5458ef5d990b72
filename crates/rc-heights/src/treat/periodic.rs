//! Maps whose opposite borders match.

use rc_core::{Field, Grid, GridError};

use super::error::TreatError;
use super::moments::mean;
use super::treatment::Periodic;
use crate::HeightMap;

pub(super) fn periodic(map: HeightMap, how: Periodic) -> Result<HeightMap, TreatError> {
    match how {
        Periodic::AsIs => Ok(map),
        Periodic::Mirror => mirror(&map),
        Periodic::Window { taper } if taper > 0.0 && taper <= 0.5 => {
            let lowest = map.heights.min();
            Ok(window(map, lowest, |t| tukey(t, taper)))
        }
        Periodic::Window { taper } => Err(TreatError::Taper(taper)),
    }
}

/// The grid of a map with its mirror images. A profile, which is a map of one row, stays one row.
pub(super) fn mirrored(grid: Grid) -> Result<Grid, GridError> {
    Grid::new(2 * grid.nx(), if grid.ny() == 1 { 1 } else { 2 * grid.ny() })
}

fn mirror(map: &HeightMap) -> Result<HeightMap, TreatError> {
    let grid = map.heights.grid();
    let twice = mirrored(grid)?;
    let mut values = Vec::with_capacity(twice.len());
    for iy in (0..grid.ny()).chain((0..grid.ny()).rev()).take(twice.ny()) {
        values.extend_from_slice(map.heights.row(iy));
        values.extend(map.heights.row(iy).iter().rev());
    }
    let heights = Field::new(twice, values).expect("as many values as points");
    Ok(HeightMap { heights, sides: map.sides.map(|sides| sides.map(|side| 2.0 * side)), ..map.clone() })
}

/// Tukey's window: 1 in the middle, decreasing to 0 at both ends over the length `taper`.
///
/// `t` is in [0, 1].
fn tukey(t: f64, taper: f64) -> f64 {
    let from_end = t.min(1.0 - t) / taper;
    if from_end >= 1.0 { 1.0 } else { 0.5 - 0.5 * (std::f64::consts::PI * from_end).cos() }
}

/// Heights above `base`, multiplied by a window.
///
/// The window is the product of `weight` of the places along x and y, which are in [0, 1]. A single row or column has
/// no window across itself.
fn window(mut map: HeightMap, base: f64, weight: impl Fn(f64) -> f64) -> HeightMap {
    let grid = map.heights.grid();
    let weights = |n: usize| -> Vec<f64> {
        if n == 1 { vec![1.0] } else { (0..n).map(|i| weight((i as f64 + 0.5) / n as f64)).collect() }
    };
    let (along_x, along_y) = (weights(grid.nx()), weights(grid.ny()));
    for (row, y) in map.heights.values_mut().chunks_exact_mut(grid.nx()).zip(&along_y) {
        row.iter_mut().zip(&along_x).for_each(|(height, x)| *height = base + x * y * (*height - base));
    }
    map
}

/// Heights about their mean under Hann's window.
///
/// The window is scaled so that its mean square is 1. The power spectrum of a map that is not periodic is taken from
/// these heights. T. D. B. Jacobs, T. Junge and L. Pastewka recommend this (Surf. Topogr.: Metrol. Prop. 5 (2017)
/// 013001).
#[must_use]
pub fn hann(heights: &Field) -> Field {
    // ⟨sin⁴⟩ = 3/8, so the mean square of each factor is 1 after division by √(3/8).
    let scale = (8.0_f64 / 3.0).sqrt();
    let (mean, _) = mean(heights);
    let windowed = window(HeightMap::bare(heights.clone()), mean, |t| scale * (std::f64::consts::PI * t).sin().powi(2));
    let mut field = windowed.heights;
    field.values_mut().iter_mut().for_each(|height| *height -= mean);
    field
}
