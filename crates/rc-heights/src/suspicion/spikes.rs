//! Spikes: isolated points far from their neighbours.
//!
//! A point deviates from the median of its eight neighbours. The deviations of a map have a robust standard deviation.
//! A spike deviates by more than [`SPIKE`] of them, and
//!
//! - is alone: points of its level form a group of at most four, so that lines, edges and corners of plateaus are none;
//! - is not the summit of a slope: what the next ring of neighbours says about the shape does not explain it;
//! - deviates as much from what is usual near it, because one part of a map may be rougher than another, and much more
//!   than its neighbours differ from each other.

use rc_core::Field;

use super::map::Map;
use super::near::{CANDIDATE, Near, SPIKE};

/// Spikes of a map.
#[derive(Clone, Debug, PartialEq)]
pub struct Spikes {
    /// Number of points.
    pub count: usize,
    /// Largest deviation from the median of the neighbours, with its sign, in the unit of the heights.
    pub largest: f64,
    /// Robust standard deviation of all points from the median of their neighbours.
    pub deviation: f64,
    /// Columns and rows of the first [`Spikes::MOST_PLACES`] points.
    pub at: Vec<(usize, usize)>,
}

impl Spikes {
    /// Most places that are listed.
    pub const MOST_PLACES: usize = 16;
}

/// The spikes of a map, or `None` if there are none. `NaN` is a missing point.
///
/// Points at the border of a `periodic` map have neighbours at the other end.
#[must_use]
pub fn spikes(heights: &Field, periodic: bool) -> Option<Spikes> {
    let map = Map::new(heights, periodic)?;
    let deviation = map.usual_deviation()?;
    let mut found = Spikes { count: 0, largest: 0.0, deviation, at: Vec::new() };
    map.each_beyond(CANDIDATE * SPIKE * deviation, |x, y| {
        let Some(height) = Near::new(&map, [x, y]).spike(deviation) else { return };
        found.count += 1;
        if height.abs() > found.largest.abs() {
            found.largest = height;
        }
        if found.at.len() < Spikes::MOST_PLACES {
            found.at.push((x as usize, y as usize));
        }
    });
    (found.count > 0).then_some(found)
}
