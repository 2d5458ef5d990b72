//! The Gaussian filter of ISO 16610-61.

use rc_core::Field;

use super::error::TreatError;
use super::stencil::{Edges, Taps, about_x, along_y};
use crate::HeightMap;

/// Distance from the peak, in widths, at which the weights are cut off: exp(-π 2.5²) = 3e-9.
const REACH: f64 = 2.5;

/// Minimum wavelength in points.
///
/// Sampled weights for shorter waves equal weights for longer waves. A wave of four points keeps 0.5 + 0.002 of its
/// amplitude. The error is smaller for longer waves.
const LEAST_POINTS: f64 = 4.0;

/// Filters with weights exp(-π (x/αλ)²), α = √(ln 2/π).
///
/// A wave of length λ keeps half of its amplitude.
pub(super) fn low_pass(mut map: HeightMap, wavelength: f64, edges: Edges) -> Result<HeightMap, TreatError> {
    map.heights = gaussian(&map, wavelength, edges, "low_pass")?;
    Ok(map)
}

/// The heights that the filter keeps. An error names the `filter`.
pub(super) fn gaussian(
    map: &HeightMap,
    wavelength: f64,
    edges: Edges,
    filter: &'static str,
) -> Result<Field, TreatError> {
    let (grid, spacing) = (map.heights.grid(), map.spacing());
    let sides = [spacing[0] * grid.nx() as f64, spacing[1] * grid.ny() as f64];
    // A profile has one row.
    let (longest_step, most) = match grid.ny() {
        1 => (spacing[0], sides[0]),
        _ => (spacing[0].max(spacing[1]), sides[0].min(sides[1])),
    };
    let least = LEAST_POINTS * longest_step;
    if !(least..=most).contains(&wavelength) {
        return Err(TreatError::Wavelength { filter, wavelength, least, most });
    }
    let [x, y] = spacing.map(|step| weights(wavelength / step));
    let filtered = about_x(&map.heights, &x, edges);
    let first = |i: usize| i as i64 - (y.len() / 2) as i64;
    Ok(along_y(&filtered, grid.ny(), edges, |i| Taps { first: first(i), weights: &y }))
}

/// Weights for a wavelength in points, with sum 1.
fn weights(wavelength: f64) -> Vec<f64> {
    let width = (std::f64::consts::LN_2 / std::f64::consts::PI).sqrt() * wavelength;
    let reach = (REACH * width).ceil() as i64;
    let at = |i: i64| (-std::f64::consts::PI * (i as f64 / width).powi(2)).exp();
    let sum: f64 = (-reach..=reach).map(at).sum();
    (-reach..=reach).map(|i| at(i) / sum).collect()
}
