//! Removal of spikes.

use super::error::TreatError;
use super::fill::replace;
use crate::HeightMap;
use crate::suspicion::spike_points;

/// Least number of deviations of a spike. Three of 1000 points of a normal distribution deviate more.
const LEAST: f64 = 3.0;

/// A point that was a spike: its index, and its height above the one that replaces it.
pub(super) type Removed = (usize, f64);

/// Replaces spikes by a membrane through the points around them.
pub(super) fn despike(mut map: HeightMap, sigma: f64) -> Result<(HeightMap, Vec<Removed>), TreatError> {
    if !(sigma >= LEAST && sigma.is_finite()) {
        return Err(TreatError::Sigma { sigma, least: LEAST });
    }
    let points = spike_points(&map.heights, sigma);
    let before: Vec<f64> = points.iter().map(|i| map.heights.values()[*i]).collect();
    replace(&mut map, &points);
    let removed = points.iter().zip(before).map(|(i, height)| (*i, height - map.heights.values()[*i])).collect();
    Ok((map, removed))
}
