//! The surroundings of a point, and whether it is a spike.

use super::map::{FEWEST, Map, NEIGHBOURS, square};
use super::medians::median;

/// Robust standard deviations from the median of the neighbours that make a spike.
///
/// A normal distribution exceeds six with a probability of 2e-9, less than once in the largest measured maps.
pub const SPIKE: f64 = 6.0;

/// Part of the threshold from which on a point is looked at. Other points of the same spike bias the median.
pub(super) const CANDIDATE: f64 = 0.6;

/// Deviation of a spike relative to the step from the first ring of neighbours to the second.
///
/// It is 0.7 at the tip of a cone, 0.9 on a Gaussian of one element, and less on all that is smoother.
const STEEP: f64 = 1.5;

/// Deviation of a spike relative to what is usual near it, which is known less well than that of the whole map.
const UNUSUAL: f64 = 5.0;

/// Height of a spike relative to the differences of its neighbours from each other.
///
/// Most neighbours of a spike are on one smooth surface. On a rough part of a map they differ as much as the point.
const CLEAR: f64 = 3.0;

/// Most points of a spike, and most columns and rows of them.
const MOST_POINTS: usize = 4;
const MOST_EXTENT: isize = 3;

/// The points near a point, without the local slope.
pub(super) struct Near<'a> {
    map: &'a Map<'a>,
    at: [isize; 2],
    slope: [f64; 2],
}

impl<'a> Near<'a> {
    pub(super) fn new(map: &'a Map<'a>, at: [isize; 2]) -> Self {
        Self { map, at, slope: map.local_slope(at) }
    }

    /// The height of a point above what its neighbours say, if it is a spike of more than `threshold`.
    pub(super) fn spike(&self, threshold: f64) -> Option<f64> {
        let group = self.group()?;
        let mut first = self.ring(1, &group);
        let complete = first.len() + group.len() > NEIGHBOURS.len();
        let base = if first.len() < FEWEST { return None } else { median(&mut first)? };
        let (step, mut height) = self.above(base, &group)?;
        if !complete {
            height = smaller(height, self.level([0, 0]) - self.extrapolated(&group)?);
            // A membrane that fills a point at the border is wrong by a part of the step to the next point.
            if height.abs() < self.slope[0].abs().max(self.slope[1].abs()) {
                return None;
            }
        }
        let is_far = height.abs() > threshold && height.abs() > STEEP * step.abs();
        let mut is_clear = || {
            for level in &mut first {
                *level = (*level - base).abs();
            }
            first.sort_unstable_by(f64::total_cmp);
            height.abs() > CLEAR * first[2 * first.len() / 3]
        };
        (is_far && is_clear() && height.abs() > UNUSUAL * self.map.deviation_near(self.at)).then_some(height)
    }

    /// The height of the point above its neighbours, whatever else deviates near it. 0 if too few are measured.
    pub(super) fn height(&self) -> f64 {
        let mut first = self.ring(1, &[]);
        let base = if first.len() < FEWEST { None } else { median(&mut first) };
        base.and_then(|base| self.above(base, &[])).map_or(0.0, |(_, height)| height)
    }

    /// The step from `base`, the level of the first ring, to the second, and the height of the point above a paraboloid
    /// through both.
    fn above(&self, base: f64, group: &[[isize; 2]]) -> Option<(f64, f64)> {
        let mut second = self.ring(2, group);
        let step = if second.len() < FEWEST { 0.0 } else { median(&mut second)? - base };
        // The medians are at squares 1.5 and 5 of the distance.
        let raw = self.level([0, 0]) - base;
        Some((step, smaller(raw, raw + step * (1.5 / 3.5))))
    }

    /// The height of a point near this one above the plane of the local slope. `NaN` if it is missing.
    fn level(&self, [dx, dy]: [isize; 2]) -> f64 {
        self.map.at(self.at[0] + dx, self.at[1] + dy) - self.slope[0] * dx as f64 - self.slope[1] * dy as f64
    }

    /// The levels of the measured points on the border of a square that are not in `group`.
    fn ring(&self, radius: isize, group: &[[isize; 2]]) -> Vec<f64> {
        let ring = square(radius).filter(|[dx, dy]| dx.abs().max(dy.abs()) == radius);
        let others = ring.filter(|at| !group.contains(at));
        others.map(|at| self.level(at)).filter(|level| !level.is_nan()).collect()
    }

    /// The median of linear extrapolations from the eight directions, for a point with neighbours on one side only.
    fn extrapolated(&self, group: &[[isize; 2]]) -> Option<f64> {
        let is_free = |at: &[isize; 2]| !group.contains(at);
        let lines = NEIGHBOURS.iter().map(|[dx, dy]| [[*dx, *dy], [2 * dx, 2 * dy]]);
        let free = lines.filter(|line| line.iter().all(is_free));
        let levels = free.map(|[one, two]| 2.0 * self.level(one) - self.level(two));
        median(&mut levels.filter(|level| !level.is_nan()).collect::<Vec<_>>())
    }

    /// The points about the level of this one that are connected with it, or `None` if they are too many for a spike.
    fn group(&self) -> Option<Vec<[isize; 2]>> {
        let mut ring = self.ring(1, &[]);
        let base = if ring.len() < FEWEST { return None } else { median(&mut ring)? };
        let height = self.level([0, 0]) - base;
        let is_as_high = |at: [isize; 2]| (self.level(at) - base) * height.signum() > 0.5 * height.abs();
        let mut group = vec![[0, 0]];
        let mut next = 0;
        while let Some([cx, cy]) = group.get(next).copied() {
            next += 1;
            for [dx, dy] in NEIGHBOURS {
                let at = [cx + dx, cy + dy];
                if !group.contains(&at) && is_as_high(at) {
                    group.push(at);
                }
            }
            if group.len() > MOST_POINTS {
                return None;
            }
        }
        let extent = |i: usize| {
            let along = group.iter().map(|at| at[i]);
            along.clone().max().unwrap_or(0) - along.min().unwrap_or(0) + 1
        };
        (extent(0) <= MOST_EXTENT && extent(1) <= MOST_EXTENT).then_some(group)
    }
}

/// The one of two heights that is nearer to 0, or 0 if they are on different sides.
fn smaller(a: f64, b: f64) -> f64 {
    if a * b <= 0.0 {
        0.0
    } else if a.abs() < b.abs() {
        a
    } else {
        b
    }
}
