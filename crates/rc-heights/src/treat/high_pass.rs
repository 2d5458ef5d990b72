//! The L-filter of ISO 25178-3.

use super::error::TreatError;
use super::low_pass::gaussian;
use super::stencil::Edges;
use crate::HeightMap;

/// Subtracts the mean with the weights of the low-pass filter, so that long waves go.
pub(super) fn high_pass(mut map: HeightMap, wavelength: f64, edges: Edges) -> Result<HeightMap, TreatError> {
    let long = gaussian(&map, wavelength, edges, "high_pass")?;
    map.heights.values_mut().iter_mut().zip(long.values()).for_each(|(height, long)| *height -= long);
    Ok(map)
}
