//! Outliers at the borders of holes.
//!
//! An instrument that loses the surface measures the last points before a hole, and points inside it, wrongly. Such a
//! point has few neighbours, and these are as wrong as itself. It is compared with the nearest points away from holes.

use rc_core::Field;

use super::map::{NEIGHBOURS, square};
use super::medians::{median, upper_deviation};

/// Largest distance along x or y of the points that an outlier is compared with.
const FARTHEST: isize = 8;

/// Number of points that are enough for a comparison, and the fewest.
const ENOUGH: usize = 20;
const FEWEST: usize = 8;

/// Most points of a group of outliers.
const MOST_POINTS: usize = 8;

/// Height of a point relative to that of an outlier from which on it belongs to the same group.
const AS_FAR: f64 = 0.3;

/// Height of an outlier relative to the deviations of the points that it is compared with from their plane.
///
/// With these two numbers, holes that are cut into complete maps of rubber, steel and a ski make outliers of less than
/// 0.01 % of their points.
const UNUSUAL: f64 = 12.0;

/// Height of an outlier relative to the rise of that plane up to the farthest of them.
const STEEP: f64 = 2.0;

/// Times that borders are looked at. Behind the outliers of the first time there may be others.
const PASSES: usize = 4;

/// Heights in the order of a field, of which some count as missing.
struct Borders {
    heights: Vec<f64>,
    nx: isize,
    ny: isize,
    threshold: f64,
}

/// What a point at a hole is.
enum Found {
    /// An outlier, with the height that points away from holes have there.
    Outlier(f64),
    /// As far off as an outlier, but not alone.
    Feature,
    Usual,
}

/// Outliers at the borders of holes: indices, and the heights of the points near them that are away from holes.
///
/// They are farther than `threshold` from these points. `spikes` count as missing. Where more points are as far off
/// without being alone, as at the walls of posts and grooves, there are no outliers.
pub(super) fn outliers(heights: &Field, spikes: &[usize], threshold: f64) -> Vec<(usize, f64)> {
    let grid = heights.grid();
    let mut values = heights.values().to_vec();
    let mut all = Vec::new();
    if !values.iter().any(|height| height.is_nan()) {
        return all;
    }
    for i in spikes {
        values[*i] = f64::NAN;
    }
    let mut borders = Borders { heights: values, nx: grid.nx() as isize, ny: grid.ny() as isize, threshold };
    for _ in 0..PASSES {
        let found = borders.outliers();
        if found.is_empty() {
            break;
        }
        for (i, _) in &found {
            borders.heights[*i] = f64::NAN;
        }
        all.extend(found);
    }
    all
}

impl Borders {
    fn outliers(&self) -> Vec<(usize, f64)> {
        let (mut outliers, mut features) = (Vec::new(), 0);
        let places = (0..self.ny).flat_map(|y| (0..self.nx).map(move |x| [x, y]));
        for (i, at) in places.enumerate() {
            if self.heights[i].is_nan() || !self.is_at_hole(at) {
                continue;
            }
            match self.look(at) {
                Found::Outlier(base) => outliers.push((i, base)),
                Found::Feature => features += 1,
                Found::Usual => {}
            }
        }
        if features > outliers.len() { Vec::new() } else { outliers }
    }

    /// The height of a point. `None` outside the map.
    fn height(&self, [x, y]: [isize; 2]) -> Option<f64> {
        let inside = x >= 0 && y >= 0 && x < self.nx && y < self.ny;
        inside.then(|| self.heights[(y * self.nx + x) as usize])
    }

    /// The height of a point. `NaN` outside the map.
    fn measured(&self, at: [isize; 2]) -> f64 {
        self.height(at).unwrap_or(f64::NAN)
    }

    /// Whether a neighbour inside the map is missing.
    fn is_at_hole(&self, [x, y]: [isize; 2]) -> bool {
        NEIGHBOURS.iter().any(|[dx, dy]| self.height([x + dx, y + dy]).is_some_and(f64::is_nan))
    }

    /// What a point at a hole is, by a plane through the nearest points away from holes.
    fn look(&self, at: [isize; 2]) -> Found {
        let near = self.away_from_holes(at);
        if near.len() < FEWEST {
            return Found::Usual;
        }
        let slope = self.slope(&near);
        let level =
            |[x, y]: [isize; 2]| self.measured([x, y]) - slope[0] * (x - at[0]) as f64 - slope[1] * (y - at[1]) as f64;
        let mut levels: Vec<f64> = near.iter().map(|place| level(*place)).collect();
        let Some(base) = median(&mut levels) else { return Found::Usual };
        for level in &mut levels {
            *level = (*level - base).abs();
        }
        let farthest = near.iter().map(|[x, y]| (x - at[0]).abs().max((y - at[1]).abs())).max().unwrap_or(0);
        // A bent slope is off its plane by a part of its rise.
        let rise = farthest as f64 * slope[0].abs().max(slope[1].abs());
        let height = (level(at) - base).abs();
        if height <= self.threshold.max(UNUSUAL * upper_deviation(&mut levels)).max(STEEP * rise) {
            return Found::Usual;
        }
        let is_as_far = |at| (level(at) - base).abs() > AS_FAR * height;
        if is_small_group(at, is_as_far) { Found::Outlier(base) } else { Found::Feature }
    }

    /// The nearest measured points without a hole beside them, ring by ring.
    fn away_from_holes(&self, [x, y]: [isize; 2]) -> Vec<[isize; 2]> {
        let mut near = Vec::new();
        for radius in 1..=FARTHEST {
            let ring = square(radius).filter(|[dx, dy]| dx.abs().max(dy.abs()) == radius);
            let places = ring.map(|[dx, dy]| [x + dx, y + dy]);
            near.extend(places.filter(|at| self.measured(*at).is_finite() && !self.is_at_hole(*at)));
            if near.len() >= ENOUGH {
                break;
            }
        }
        near
    }

    /// The median steps along x and y between these points and the next ones.
    fn slope(&self, near: &[[isize; 2]]) -> [f64; 2] {
        [[1, 0], [0, 1]].map(|[dx, dy]| {
            let steps = near.iter().map(|[x, y]| self.measured([x + dx, y + dy]) - self.measured([*x, *y]));
            median(&mut steps.filter(|step| step.is_finite()).collect::<Vec<_>>()).unwrap_or(0.0)
        })
    }
}

/// Whether few points that are as far off are connected with this one.
fn is_small_group(at: [isize; 2], is_as_far: impl Fn([isize; 2]) -> bool) -> bool {
    let (mut group, mut next) = (vec![at], 0);
    while let Some([x, y]) = group.get(next).copied() {
        next += 1;
        for place in NEIGHBOURS.map(|[dx, dy]| [x + dx, y + dy]) {
            if !group.contains(&place) && is_as_far(place) {
                group.push(place);
            }
        }
        if group.len() > MOST_POINTS {
            return false;
        }
    }
    true
}
