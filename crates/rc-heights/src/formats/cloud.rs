//! The regular grid of a list of points.

use rc_core::Grid;
use rc_core::quantity::digits;

use super::field::field;
use crate::{FormatError, HeightMap, ReadNote, Unit};

/// Maximum number of grid points for each point of the list.
///
/// Scattered points would otherwise make a grid of any size.
const MOST_MISSING: usize = 16;

/// Maximum distance of a coordinate from its grid line, in spacings.
const FARTHEST: f64 = 0.1;

/// Minimum ratio of the smallest gap between grid lines to the largest gap on one.
///
/// At the maximum distance it is 4, without chance. A smaller one finds lines of points that are farther, for the
/// message.
const CLEAR_GAP: f64 = 1.4;

/// Maximum number of ways to divide coordinates into lines that are tried.
const MOST_TRIES: usize = 64;

/// Maximum shift of points that is not worth a note, in spacings. Coordinates are rounded when they are written.
const ROUNDING: f64 = 0.01;

/// Maximum difference of coordinates on one grid line that is not worth a note, in spacings.
const SAME_LINE: f64 = 1e-5;

fn irregular(message: String) -> FormatError {
    FormatError::Irregular(message)
}

/// The map of points x, y, height on the nearest points of a regular grid.
///
/// # Errors
/// [`FormatError::Irregular`] when they are farther than a tenth of a spacing from one, and [`FormatError::Profile`]
/// when they are on one line.
pub(super) fn on_grid(points: &[[f64; 3]]) -> Result<HeightMap, FormatError> {
    let axes = [Axis::of("x", points, 0)?, Axis::of("y", points, 1)?];
    check_density(&axes, points.len())?;
    let grid = Grid::new(axes[0].n as usize, axes[1].n as usize)?;
    let mut values = vec![f64::NAN; grid.len()];
    let mut seen = vec![false; grid.len()];
    for [x, y, z] in points {
        let i = grid.index(axes[0].line(*x), axes[1].line(*y));
        if std::mem::replace(&mut seen[i], true) {
            return Err(irregular(format!("two points are at x = {}, y = {}", digits(*x, 9), digits(*y, 9))));
        }
        values[i] = *z;
    }
    let sides = Some([axes[0].step * axes[0].n, axes[1].step * axes[1].n]);
    let mut map = HeightMap::new(field(grid, values), Unit::Unnamed, sides, Unit::Unnamed);
    if axes.iter().any(|axis| axis.is_moved) {
        let largest = axes[0].farthest.max(axes[1].farthest);
        map.notes.push(ReadNote::Moved { largest });
    }
    Ok(map)
}

/// Refuses grids of which few points are there.
fn check_density(axes: &[Axis; 2], points: usize) -> Result<(), FormatError> {
    if axes[0].n * axes[1].n <= (MOST_MISSING * points) as f64 {
        return Ok(());
    }
    // Coordinates with few decimals are on a fine grid, of which few points are there.
    if let Some(farthest) = axes.iter().find_map(|axis| axis.of_coarser.filter(|farthest| *farthest < 0.5)) {
        return Err(too_far("the coordinates", farthest));
    }
    let lines = axes.each_ref().map(|axis| axis.n);
    let message = format!("{points} points on {} x {} grid lines", lines[0], lines[1]);
    Err(irregular(format!("{message}; fewer than one in {MOST_MISSING} is present")))
}

fn too_far(what: &str, farthest: f64) -> FormatError {
    let farthest = digits(farthest.min(0.5), 2);
    irregular(format!(
        "{what} are up to {farthest} spacings from even grid lines, and points are moved by at most a tenth of one"
    ))
}

/// Grid lines in even steps along one axis.
struct Axis {
    first: f64,
    step: f64,
    /// Number of lines, a whole number.
    n: f64,
    /// Largest distance of a coordinate from its line, in steps.
    farthest: f64,
    /// The same for coarser lines, from which coordinates are too far.
    of_coarser: Option<f64>,
    /// Whether coordinates differ from those of the lines by more than their rounding.
    is_moved: bool,
}

impl Axis {
    fn of(name: &str, points: &[[f64; 3]], axis: usize) -> Result<Self, FormatError> {
        let mut all: Vec<f64> = points.iter().map(|point| point[axis]).collect();
        all.sort_unstable_by(f64::total_cmp);
        let (first, last) = (all.first().copied().unwrap_or(0.0), all.last().copied().unwrap_or(0.0));
        if !(last - first).is_finite() {
            return Err(irregular(format!("{name} goes from {first:e} to {last:e}")));
        }
        if last - first == 0.0 {
            let what = if axis == 0 { "a list of points with one x" } else { "a list of points with one y" };
            return Err(FormatError::profile_in_text(what));
        }
        let mut of_coarser: Option<f64> = None;
        for gap in gaps_between_lines(&all) {
            match Self::with_gap(&all, gap) {
                Some(found) if found.farthest <= FARTHEST => return Ok(Self { of_coarser, ..found }),
                Some(found) => {
                    of_coarser = Some(of_coarser.map_or(found.farthest, |other| other.min(found.farthest)));
                }
                None => {}
            }
        }
        // Coordinates without gaps are anywhere between two lines.
        Err(too_far(&format!("values of {name}"), of_coarser.unwrap_or(0.5)))
    }

    /// The lines of sorted coordinates, where larger gaps than `gap` are between lines.
    ///
    /// `None` if they have no even steps, or if few of the lines are there.
    fn with_gap(all: &[f64], gap: f64) -> Option<Self> {
        let lines: Vec<&[f64]> = all.chunk_by(|a, b| b - a <= gap).collect();
        let width = |line: &[f64]| line[line.len() - 1] - line[0];
        let centre = |line: &[f64]| {
            // The mean, without loss of digits.
            line[0] + line.iter().map(|at| at - line[0]).sum::<f64>() / line.len() as f64
        };
        let centres: Vec<f64> = lines.iter().map(|line| centre(line)).collect();
        let widest = lines.iter().map(|line| width(line)).fold(0.0, f64::max);
        let (numbers, step) = numbers(&centres)?;
        let is_exact = widest <= SAME_LINE * step;
        let (first, step) = if is_exact {
            (centres[0], (centres[centres.len() - 1] - centres[0]) / numbers[numbers.len() - 1])
        } else {
            fit(&numbers, &centres, step)
        };
        let distance = |(line, number): (&&[f64], &f64)| {
            let at = first + number * step;
            (line[0] - at).abs().max((line[line.len() - 1] - at).abs()) / step
        };
        let farthest = lines.iter().zip(&numbers).map(distance).fold(0.0, f64::max);
        let n = numbers[numbers.len() - 1] + 1.0;
        let is_moved = !is_exact || farthest > ROUNDING;
        (n <= (MOST_MISSING * lines.len()) as f64).then_some(Self {
            first,
            step,
            n,
            farthest,
            of_coarser: None,
            is_moved,
        })
    }

    /// The grid line of a coordinate.
    fn line(&self, coordinate: f64) -> usize {
        (((coordinate - self.first) / self.step).round() as usize).min(self.n as usize - 1)
    }
}

/// Gaps of sorted coordinates that may be the largest on a line, the largest first.
///
/// The next larger gap is then clearly larger, because it is between lines.
fn gaps_between_lines(all: &[f64]) -> Vec<f64> {
    let mut gaps: Vec<f64> = all.windows(2).map(|pair| pair[1] - pair[0]).filter(|gap| *gap > 0.0).collect();
    gaps.sort_unstable_by(|a, b| b.total_cmp(a));
    let mut found: Vec<f64> =
        gaps.windows(2).filter(|pair| pair[0] >= CLEAR_GAP * pair[1]).map(|pair| pair[1]).take(MOST_TRIES).collect();
    // All gaps may be between lines.
    found.push(0.0);
    found
}

/// Numbers of the lines at increasing `centres`, from 0, and the distance of neighbours.
///
/// Lines may be missing.
fn numbers(centres: &[f64]) -> Option<(Vec<f64>, f64)> {
    let gaps: Vec<f64> = centres.windows(2).map(|pair| pair[1] - pair[0]).collect();
    let smallest = gaps.iter().copied().fold(f64::INFINITY, f64::min);
    // The mean of the gaps between neighbours, as far as they can be told from those with missing lines.
    let (sum, n) =
        gaps.iter().filter(|gap| **gap < 1.5 * smallest).fold((0.0, 0.0), |(sum, n), gap| (sum + gap, n + 1.0));
    let step = sum / n;
    let mut at = 0.0;
    let mut numbers = vec![0.0];
    for gap in gaps {
        at += (gap / step).round().max(1.0);
        numbers.push(at);
    }
    (step.is_finite() && step > 0.0 && at > 0.0).then_some((numbers, step))
}

/// The straight line through centres at whole numbers: the first centre, and the step.
fn fit(numbers: &[f64], centres: &[f64], step: f64) -> (f64, f64) {
    let n = numbers.len() as f64;
    let mean = numbers.iter().sum::<f64>() / n;
    // Deviations from the first guess keep the digits.
    let off = |i: usize| centres[i] - centres[0] - numbers[i] * step;
    let mean_off = (0..numbers.len()).map(off).sum::<f64>() / n;
    let square: f64 = numbers.iter().map(|at| (at - mean) * (at - mean)).sum();
    let product: f64 = (0..numbers.len()).map(|i| (numbers[i] - mean) * off(i)).sum();
    let more = product / square;
    (centres[0] + mean_off - mean * more, step + more)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Numbers from 0 to 1 that repeat in every run.
    fn random(seed: u64) -> impl FnMut() -> f64 {
        let mut state = seed;
        move || {
            state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            (state >> 11) as f64 / (1_u64 << 53) as f64
        }
    }

    /// Points of a grid, each moved by up to `jitter` spacings, in any order and with a few missing.
    fn cloud(nx: usize, ny: usize, spacing: [f64; 2], jitter: f64, seed: u64) -> Vec<[f64; 3]> {
        let mut random = random(seed);
        let mut points = Vec::new();
        for i in 0..nx * ny {
            let at = [i % nx, i / nx];
            let moved =
                |k: usize, random: f64| (at[k] as f64 + jitter * (2.0 * random - 1.0)) * spacing[k] - 7.0 * spacing[k];
            let point = [moved(0, random()), moved(1, random()), i as f64];
            if random() > 0.02 || i == 0 {
                points.push(point);
            }
        }
        for i in (1..points.len()).rev() {
            points.swap(i, (random() * (i + 1) as f64) as usize);
        }
        points
    }

    #[test]
    fn points_up_to_a_tenth_of_a_spacing_away_are_moved_onto_the_grid() {
        for (seed, jitter) in [1e-9, 1e-6, 1e-4, 1e-2, 0.05, 0.09].into_iter().enumerate() {
            for (nx, ny, spacing) in [(30, 20, [2.0, 2.0]), (7, 61, [1e-6, 3e-6]), (128, 90, [0.3, 1e3])] {
                let points = cloud(nx, ny, spacing, jitter, seed as u64);
                let map = on_grid(&points).unwrap_or_else(|error| panic!("{jitter}: {error}"));
                assert_eq!((map.heights.grid().nx(), map.heights.grid().ny()), (nx, ny), "{jitter}");
                let right = |(i, z): (usize, &f64)| z.is_nan() || (z - i as f64).abs() < 0.5;
                assert!(map.heights.values().iter().enumerate().all(right), "{jitter}");
                assert_eq!(map.missing(), nx * ny - points.len());
                let sides = map.sides.expect("sides");
                for (k, n) in [nx, ny].into_iter().enumerate() {
                    let expected = n as f64 * spacing[k];
                    assert!(
                        (sides[k] / expected - 1.0).abs() < 0.2 * jitter + 1e-12,
                        "{jitter}: {} {expected}",
                        sides[k]
                    );
                }
                match map.notes.as_slice() {
                    [ReadNote::Moved { largest }] => {
                        assert!((largest / jitter - 1.0).abs() < 0.2, "{largest} {jitter}");
                    }
                    notes => assert!(jitter < 1e-5 && notes.is_empty(), "{jitter}: {notes:?}"),
                }
            }
        }
    }

    #[test]
    fn points_farther_away_are_refused_with_their_distance() {
        for (seed, jitter) in [0.12, 0.16, 0.2, 0.3, 0.4, 0.5].into_iter().enumerate() {
            let exact = cloud(50, 40, [1.0, 2.0], jitter, seed as u64);
            // With few decimals, coordinates are on a fine grid.
            let rounded = exact.iter().map(|point| point.map(|at| (at * 100.0).round() / 100.0)).collect();
            for points in [exact, rounded] {
                let error = on_grid(&points).expect_err("too far").to_string();
                let figure =
                    error.split_once("up to ").and_then(|(_, rest)| rest.split(' ').next()?.parse::<f64>().ok());
                // Points between two lines have no nearest line that could be known.
                let is_right = figure.map_or(jitter > 0.25, |figure| (figure - jitter).abs() < 0.02 || jitter > 0.25);
                assert!(is_right && !error.contains('\n'), "{jitter}: {error}");
            }
        }
    }

    #[test]
    fn whole_lines_may_be_missing_and_points_on_one_line_are_a_profile() {
        let points: Vec<[f64; 3]> = (0..60)
            .map(|i| [f64::from(i % 6), f64::from(i / 6), 1.0])
            .filter(|point| (point[0] - 3.0).abs() > 0.5)
            .collect();
        let map = on_grid(&points).expect("a map");
        assert_eq!((map.heights.grid().nx(), map.heights.grid().ny(), map.missing()), (6, 10, 10));
        let line: Vec<[f64; 3]> = (0..9).map(|i| [f64::from(i), 2.0, 1.0]).collect();
        let error = on_grid(&line).expect_err("one line").to_string();
        assert!(error.contains("profile") && error.contains("one y"), "{error}");
    }

    #[test]
    fn a_scan_back_and_forth_is_a_map() {
        let at = |i: i32| if i / 10 % 2 == 0 { i % 10 } else { 9 - i % 10 };
        let points: Vec<[f64; 3]> = (0..100).map(|i| [f64::from(at(i)), f64::from(i / 10), f64::from(at(i))]).collect();
        let map = on_grid(&points).expect("a map");
        assert_eq!(map.heights.row(1)[..3], [0.0, 1.0, 2.0]);
    }
}
