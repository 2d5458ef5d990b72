//! Removal of spikes.

use super::error::TreatError;
use super::fill::replace;
use crate::HeightMap;
use crate::suspicion::{border_outliers, spike_points};

/// Least number of deviations of a spike. Three of 1000 points of a normal distribution deviate more.
const LEAST: f64 = 3.0;

/// A point that was a spike: its index, and its height above the one that replaces it.
pub(super) type Removed = (usize, f64);

/// Replaces spikes by a membrane through the points around them, and outliers at holes by the points near them.
pub(super) fn despike(mut map: HeightMap, sigma: f64) -> Result<(HeightMap, Vec<Removed>), TreatError> {
    if !(sigma >= LEAST && sigma.is_finite()) {
        return Err(TreatError::Sigma { sigma, least: LEAST });
    }
    let mut points = spike_points(&map.heights, sigma);
    let at_holes = border_outliers(&map.heights, sigma, &points);
    let before = map.heights.values().to_vec();
    // A membrane at a hole would follow the outliers beside it.
    for (i, base) in &at_holes {
        map.heights.values_mut()[*i] = *base;
    }
    replace(&mut map, &points);
    points.extend(at_holes.iter().map(|(i, _)| i));
    let removed = points.iter().map(|i| (*i, before[*i] - map.heights.values()[*i])).collect();
    Ok((map, removed))
}
