//! A map with the deviations of its points from their neighbours.

use rayon::prelude::*;
use rc_core::Field;

use super::medians::{median, medians_of_eight, robust_deviation, upper_deviation};

/// Smallest deviation that counts, relative to the range of heights.
///
/// Deviations below it are rounding, or too small to matter for the contact of the other points.
const SMALLEST: f64 = 1e-6;

/// Fewest neighbours that a median is taken of.
pub(super) const FEWEST: usize = 3;

/// Number of points that the usual deviation of a large map is taken from.
const SAMPLE: usize = 1 << 16;

/// Columns and rows about a point that are looked at: half of the side of a square.
const NEAR: isize = 4;

/// Largest ratio of the usual deviation to the one that the half of all points with the smaller deviations suggests.
const MOST_TAIL: f64 = 1.5;

/// A map without its mean slope.
pub(super) struct Map<'a> {
    values: &'a [f64],
    nx: isize,
    ny: isize,
    periodic: bool,
    /// Median steps from a point to the next along x and y.
    slope: [f64; 2],
    /// Deviations below this are none.
    smallest: f64,
}

impl<'a> Map<'a> {
    /// `None` for maps that have too few points for medians.
    pub(super) fn new(heights: &'a Field, periodic: bool) -> Option<Self> {
        let grid = heights.grid();
        let (nx, ny) = (grid.nx() as isize, grid.ny() as isize);
        let (values, periodic) = (heights.values(), periodic && nx >= 2 * NEAR && ny >= 2 * NEAR);
        let mut map = Self { values, nx, ny, periodic, slope: [0.0; 2], smallest: 0.0 };
        let finite = values.iter().filter(|height| height.is_finite());
        let (low, high) = finite.fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), v| (l.min(*v), h.max(*v)));
        map.smallest = SMALLEST * (high - low);
        if nx < 3 || ny < 3 || map.smallest <= 0.0 || !map.smallest.is_finite() {
            return None;
        }
        let steps = |dx, dy| median(&mut map.sampled(|x, y| map.at(x + dx, y + dy) - map.at(x, y))).unwrap_or(0.0);
        map.slope = if periodic { [0.0; 2] } else { [steps(1, 0), steps(0, 1)] };
        Some(map)
    }

    /// The height of a point. `NaN` outside the map.
    pub(super) fn at(&self, x: isize, y: isize) -> f64 {
        let (x, y) = if self.periodic { (x.rem_euclid(self.nx), y.rem_euclid(self.ny)) } else { (x, y) };
        let inside = x >= 0 && y >= 0 && x < self.nx && y < self.ny;
        if inside { self.values[(y * self.nx + x) as usize] } else { f64::NAN }
    }

    /// Values of a function at points that are spread over the map. `NaN` is omitted.
    fn sampled(&self, value: impl Fn(isize, isize) -> f64 + Sync) -> Vec<f64> {
        let n = self.values.len();
        let at = |i: usize| {
            // Steps of the golden ratio do not follow any pattern of the map.
            let i = if n <= SAMPLE { i } else { ((i as f64 * 0.618_033_988_749_894_9).fract() * n as f64) as usize };
            ((i % self.nx as usize) as isize, (i / self.nx as usize) as isize)
        };
        let all = (0..n.min(SAMPLE)).into_par_iter().map(at).map(|(x, y)| value(x, y));
        all.filter(|value| value.is_finite()).collect()
    }

    /// The height of a neighbour above a plane of the mean slope through the point.
    fn beside(&self, x: isize, y: isize, [dx, dy]: [isize; 2]) -> f64 {
        self.at(x + dx, y + dy) - self.slope[0] * dx as f64 - self.slope[1] * dy as f64
    }

    /// Deviation of a point from the median of its neighbours. `NaN` if too few are measured.
    pub(super) fn deviation(&self, x: isize, y: isize) -> f64 {
        let (mut values, mut n) = ([0.0; 8], 0);
        for offset in NEIGHBOURS {
            let value = self.beside(x, y, offset);
            if !value.is_nan() {
                values[n] = value;
                n += 1;
            }
        }
        if n < FEWEST { f64::NAN } else { self.at(x, y) - median(&mut values[..n]).unwrap_or(f64::NAN) }
    }

    /// The robust standard deviation of all points from the median of their neighbours.
    ///
    /// It is larger for a map that is much rougher in some parts than in others, as far as that is no effect of spikes.
    /// If half of the points do not deviate, as on plateaus, it is that of those which do. `None` if none does.
    pub(super) fn usual_deviation(&self) -> Option<f64> {
        let mut deviations = self.sampled(|x, y| self.deviation(x, y));
        let deviation = robust_deviation(&mut deviations, 0.0)?;
        if deviation > self.smallest {
            return Some(upper_deviation(&mut deviations).clamp(deviation, MOST_TAIL * deviation));
        }
        let mut others: Vec<f64> = self.beyond(self.smallest).into_iter().map(|[x, y]| self.deviation(x, y)).collect();
        robust_deviation(&mut others, 0.0)
    }

    /// The points that deviate from the median of their neighbours by more than `threshold`, row by row.
    pub(super) fn beyond(&self, threshold: f64) -> Vec<[isize; 2]> {
        let of_row = |y| {
            let mut found = Vec::new();
            self.each_deviation(y, |x, deviation| {
                if deviation.abs() > threshold {
                    found.push([x, y]);
                }
            });
            found
        };
        (0..self.ny).into_par_iter().flat_map_iter(of_row).collect()
    }

    /// Calls `found` with the deviation of each point of a row.
    fn each_deviation(&self, y: isize, mut found: impl FnMut(isize, f64)) {
        let is_inside = y > 0 && y + 1 < self.ny;
        let mut x = 0;
        while x < self.nx {
            let many = is_inside && x > 0 && x + (LANES as isize) < self.nx;
            if let Some(deviations) = if many { self.lanes(x, y) } else { None } {
                (x..).zip(deviations).for_each(|(x, deviation)| found(x, deviation));
                x += LANES as isize;
            } else {
                let end = if many { x + LANES as isize } else { x + 1 };
                (x..end).for_each(|x| found(x, self.deviation(x, y)));
                x = end;
            }
        }
    }

    /// The deviations of the points from `x` on, or `None` if one of their neighbours is missing.
    fn lanes(&self, x: isize, y: isize) -> Option<[f64; LANES]> {
        let row = |dy: isize| &self.values[((y + dy) * self.nx + x - 1) as usize..][..LANES + 2];
        let rows = [row(-1), row(0), row(1)];
        let ring: [[f64; LANES]; 8] = std::array::from_fn(|k| {
            let [dx, dy] = NEIGHBOURS[k];
            let (row, offset) = (rows[(dy + 1) as usize], self.slope[0] * dx as f64 + self.slope[1] * dy as f64);
            let start = (dx + 1) as usize;
            std::array::from_fn(|i| row[start + i] - offset)
        });
        let sum: f64 = rows.iter().flat_map(|row| row.iter()).sum();
        let medians = medians_of_eight(ring);
        (!sum.is_nan()).then(|| std::array::from_fn(|i| rows[1][i + 1] - medians[i]))
    }

    /// The median steps along x and y near a point.
    pub(super) fn local_slope(&self, [x, y]: [isize; 2]) -> [f64; 2] {
        [[1, 0], [0, 1]].map(|[sx, sy]| {
            let step = |[dx, dy]: [isize; 2]| self.at(x + dx + sx, y + dy + sy) - self.at(x + dx - sx, y + dy - sy);
            let mut steps: Vec<f64> = square(2).map(step).filter(|step| !step.is_nan()).collect();
            0.5 * median(&mut steps).unwrap_or(0.0)
        })
    }

    /// The usual deviation of the points near a point from the median of their neighbours. 0 if there are too few.
    ///
    /// It is the robust standard deviation about the median, or that of the one in seven that deviates most, if that is
    /// larger, as on a map that is flat but for a few features.
    pub(super) fn deviation_near(&self, [x, y]: [isize; 2]) -> f64 {
        let near = square(NEAR).filter(|[dx, dy]| dx.abs().max(dy.abs()) > 2);
        let mut deviations: Vec<f64> =
            near.map(|[dx, dy]| self.deviation(x + dx, y + dy)).filter(|deviation| !deviation.is_nan()).collect();
        if deviations.len() < 2 * FEWEST {
            return 0.0;
        }
        let centre = median(&mut deviations).unwrap_or(0.0);
        let robust = robust_deviation(&mut deviations, centre).unwrap_or(0.0);
        robust.max(upper_deviation(&mut deviations))
    }
}

/// Number of points whose medians are found at once.
const LANES: usize = 8;

/// The neighbours of a point.
pub(super) const NEIGHBOURS: [[isize; 2]; 8] = [[-1, -1], [0, -1], [1, -1], [-1, 0], [1, 0], [-1, 1], [0, 1], [1, 1]];

/// The points of a square about the origin, without the origin.
pub(super) fn square(radius: isize) -> impl Iterator<Item = [isize; 2]> {
    let all = (-radius..=radius).flat_map(move |dy| (-radius..=radius).map(move |dx| [dx, dy]));
    all.filter(|at| *at != [0, 0])
}
