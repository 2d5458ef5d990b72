//! Spikes: isolated points far from their neighbours.
//!
//! A point deviates from the median of its eight neighbours. The deviations of a map have a robust standard deviation.
//! A spike deviates by more than [`SPIKE`] of them, and
//!
//! - is alone: points of its level form a group of at most four, so that lines, edges and corners of plateaus are none;
//! - is not the summit of a slope: what the next ring of neighbours says about the shape does not explain it;
//! - deviates as much from what is usual near it, because one part of a map may be rougher than another, and much more
//!   than its neighbours differ from each other;
//! - is rare: on a map with edges, pits or posts, more points deviate as much without being alone.

use std::collections::HashSet;

use rc_core::Field;

use super::borders::outliers;
use super::map::{Map, NEIGHBOURS, square};
use super::near::{CANDIDATE, Near, SPIKE};

/// Deviation of other points relative to a spike from which on they are like it.
const AS_MUCH: f64 = 0.5;

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
    let (map, deviation) = usual(heights, periodic)?;
    let mut found = Spikes { count: 0, largest: 0.0, deviation, at: Vec::new() };
    for ([x, y], height) in rare(&map, SPIKE * deviation) {
        found.count += 1;
        if height.abs() > found.largest.abs() {
            found.largest = height;
        }
        if found.at.len() < Spikes::MOST_PLACES {
            found.at.push((x as usize, y as usize));
        }
    }
    (found.count > 0).then_some(found)
}

/// Indices of the spikes of a map that is not periodic, which deviate by more than `sigma` robust standard deviations.
///
/// [`spikes`] has a `sigma` of [`SPIKE`].
#[must_use]
pub fn spike_points(heights: &Field, sigma: f64) -> Vec<usize> {
    let Some((map, deviation)) = usual(heights, false) else { return Vec::new() };
    let index = |[x, y]: [isize; 2]| heights.grid().index(x as usize, y as usize);
    rare(&map, sigma * deviation).into_iter().map(|(at, _)| index(at)).collect()
}

/// Outliers at the borders of holes of a map that is not periodic: indices, and heights of the points near them.
///
/// They deviate by more than `sigma` robust standard deviations from the nearest points that are away from holes.
/// `spikes` count as missing.
#[must_use]
pub fn border_outliers(heights: &Field, sigma: f64, spikes: &[usize]) -> Vec<(usize, f64)> {
    usual(heights, false).map_or_else(Vec::new, |(_, deviation)| outliers(heights, spikes, sigma * deviation))
}

/// A map with the usual deviation of its points. `None` if no point can be a spike.
fn usual(heights: &Field, periodic: bool) -> Option<(Map<'_>, f64)> {
    let map = Map::new(heights, periodic)?;
    let deviation = map.usual_deviation()?;
    Some((map, deviation))
}

/// Places and heights of the spikes that deviate by more than `threshold`, row by row.
fn rare(map: &Map<'_>, threshold: f64) -> Vec<([isize; 2], f64)> {
    let (mut alone, mut others) = (Vec::<([isize; 2], f64)>::new(), Vec::new());
    for [x, y] in map.beyond(CANDIDATE * threshold) {
        let near = Near::new(map, [x, y]);
        match near.spike(threshold) {
            Some(height) => alone.push(([x, y], height)),
            None if NEIGHBOURS.iter().all(|[dx, dy]| map.at(x + dx, y + dy).is_finite()) => {
                others.push(([x, y], near.height().abs()));
            }
            None => {}
        }
    }
    // The neighbours of a spike deviate because of it, and points with neighbours on one side because of the slope.
    let places: HashSet<[isize; 2]> = alone.iter().map(|(at, _)| *at).collect();
    let is_beside = |[x, y]: [isize; 2]| square(2).any(|[dx, dy]| places.contains(&[x + dx, y + dy]));
    let mut others: Vec<f64> = others.into_iter().filter(|(at, _)| !is_beside(*at)).map(|(_, other)| other).collect();
    others.sort_unstable_by(f64::total_cmp);
    let as_much = |height: f64| others.len() - others.partition_point(|other| *other < AS_MUCH * height.abs());
    alone.into_iter().filter(|(_, height)| as_much(*height) <= places.len()).collect()
}
