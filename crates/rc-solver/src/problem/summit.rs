//! The highest point of a surface. It may lie between samples.
//!
//! The penetration is measured from the highest sample. On coarse grids and at light loads, the summit above it is the
//! largest error of the penetration.

use rc_core::{Boundary, DVec2, Field, HeightField};

use crate::parallel;

/// The highest sample, and the true maximum above it, in λ.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Summit {
    /// Maximum height at the centres of the smallest elements.
    pub(crate) sampled: f64,
    /// The true maximum minus `sampled`, ≥ 0. It is an estimate.
    pub(crate) excess: f64,
}

/// Maximum number of places from which the summit of a surface is searched.
pub(crate) const MAX_CLIMBS: usize = 8;

/// Ratio of the summit of a map to that of parabolas through its samples, above the highest sample. Parabolas through
/// distant samples are too flat.
const OF_FIT: f64 = 1.25;

/// Part of the rise of a parabola half a step from a sample that is added for each axis.
///
/// It is for summits that parabolas place too near a sample.
const UNSURE: f64 = 0.04;

/// Curvature at a summit that is certain, relative to the step down to the higher neighbour. A plateau has no such step.
const STEEP: f64 = 3.0;

impl Summit {
    /// The summit of heights at the centres of elements, with the maximum `sampled`. They are those of a `surface`, or
    /// a map.
    ///
    /// It passes over the samples once, and evaluates a surface at most a few hundred times.
    pub(crate) fn on_grid(
        surface: Option<&dyn HeightField>,
        (samples, sampled): (&Field, f64),
        boundary: Boundary,
    ) -> Self {
        let around = Neighbourhood { samples, boundary };
        let excess = if let Some(surface) = surface {
            around.excess_of_surface(surface, sampled)
        } else {
            let tops = around.tops(Fit::rise_of_map);
            OF_FIT * tops.iter().map(|top| top.height + top.rise - sampled).fold(0.0, f64::max)
        };
        Self { sampled, excess }
    }
}

/// The maximum of a function near `at`.
///
/// It has one summit within about `steps` of there, along both axes.
pub(crate) fn climb(height: &impl Fn(DVec2) -> f64, at: DVec2, steps: DVec2) -> f64 {
    const ROUNDS: i32 = 4;
    let (mut best, mut at) = (height(at), at);
    for round in 1..=ROUNDS {
        let (centre, steps) = (at, 0.5_f64.powi(round) * steps);
        let mut take = |place: DVec2| {
            let h = height(place);
            if h > best {
                (best, at) = (h, place);
            }
            h
        };
        let mut around = [[take(centre); 3]; 3];
        for [dx, dy] in BESIDE {
            let place = centre + steps * DVec2::new(dx as f64, dy as f64);
            around[(dy + 1) as usize][(dx + 1) as usize] = take(place);
        }
        let fit = Fit::of(&|dx, dy| Some(around[(dy + 1) as usize][(dx + 1) as usize]));
        take(centre + steps * fit.top);
    }
    best
}

/// Offsets to the neighbours of a sample.
const BESIDE: [[isize; 2]; 8] = [[1, 0], [-1, 0], [0, 1], [0, -1], [1, 1], [-1, 1], [1, -1], [-1, -1]];

/// A sample that no neighbour exceeds.
struct Top {
    at: DVec2,
    height: f64,
    /// How far the surface may rise above it.
    rise: f64,
}

/// Samples and their neighbours. There are none beyond a free border.
struct Neighbourhood<'a> {
    samples: &'a Field,
    boundary: Boundary,
}

impl Neighbourhood<'_> {
    /// Height of a summit that is searched from the highest tops, above the highest sample.
    fn excess_of_surface(&self, surface: &dyn HeightField, sampled: f64) -> f64 {
        // A fit may miss half of what it looks for.
        let reach = |top: &Top| top.height + 2.0 * top.rise;
        let mut tops = self.tops(|at| Fit::of(at).rise);
        tops.retain(|top| reach(top) > sampled);
        tops.sort_by(|a, b| reach(b).total_cmp(&reach(a)));
        tops.truncate(MAX_CLIMBS);
        let grid = self.samples.grid();
        let corner = DVec2::new(1.0, grid.cell_ratio());
        let inside = |at: DVec2| if self.boundary == Boundary::Free { at.clamp(DVec2::ZERO, corner) } else { at };
        let climbed = tops.iter().map(|top| climb(&|at| surface.height(inside(at)), top.at, grid.spacing()));
        climbed.fold(sampled, f64::max) - sampled
    }

    /// The tops with a positive `rise`. It is a function of the heights by offset from the top.
    fn tops(&self, rise: impl Fn(&dyn Fn(isize, isize) -> Option<f64>) -> f64 + Sync) -> Vec<Top> {
        let grid = self.samples.grid();
        let of_row = |iy: usize| {
            let row = self.samples.row(iy);
            let top = |ix: usize| {
                let height = row[ix];
                // Most samples end here.
                if ix > 0 && row[ix - 1] > height || row.get(ix + 1).is_some_and(|&next| next > height) {
                    return None;
                }
                let at = |dx, dy| self.height(ix as isize + dx, iy as isize + dy);
                let is_top = BESIDE.iter().all(|&[dx, dy]| at(dx, dy).is_none_or(|beside| beside <= height));
                let rise = if is_top { rise(&at) } else { 0.0 };
                (rise > 0.0).then(|| Top { at: grid.centre(ix, iy), height, rise })
            };
            (0..row.len()).filter_map(top).collect::<Vec<_>>()
        };
        parallel::map(0..grid.ny(), of_row).into_iter().flatten().collect()
    }

    fn height(&self, x: isize, y: isize) -> Option<f64> {
        let grid = self.samples.grid();
        let inside = |i: isize, n: usize| match self.boundary {
            Boundary::Periodic => Some(i.rem_euclid(n as isize) as usize),
            Boundary::Free => usize::try_from(i).ok().filter(|&i| i < n),
        };
        Some(self.samples.at(inside(x, grid.nx())?, inside(y, grid.ny())?))
    }
}

/// The parabola through a sample and its neighbours along one axis, in steps between samples.
struct Line {
    slope: f64,
    /// Minus the second derivative.
    curvature: f64,
}

impl Line {
    /// The parabola through the heights at -1, 0 and 1. A border is half a step beyond the last sample, and the line to
    /// it is straight.
    fn of(at: impl Fn(isize) -> Option<f64>) -> Self {
        let height = at(0).unwrap_or(0.0);
        match (at(-1), at(1)) {
            (Some(left), Some(right)) => Self { slope: 0.5 * (right - left), curvature: 2.0 * height - left - right },
            (left, right) => {
                Self { slope: right.map_or(0.0, |h| h - height) + left.map_or(0.0, |h| height - h), curvature: 0.0 }
            }
        }
    }

    /// Place of the maximum within half a step.
    fn top(&self) -> f64 {
        let at_end = 0.5 * self.slope.signum();
        if self.curvature > 2.0 * self.slope.abs() { self.slope / self.curvature } else { at_end }
    }

    fn rise(&self) -> f64 {
        let top = self.top();
        top * (self.slope - 0.5 * self.curvature * top)
    }

    /// The rise above a sample of a map, on which slopes may jump.
    ///
    /// At the end of a plateau the parabola would rise above it. The parabola about the next sample does not. A parabola
    /// continues the last samples to a border, unless it bends upward.
    fn rise_of_map(&self, at: impl Fn(isize) -> Option<f64>) -> f64 {
        let toward = self.slope.signum() as isize;
        if let (None, Some(height), Some(next), Some(second)) = (at(toward), at(0), at(-toward), at(-2 * toward)) {
            let bend = (2.0 * next - height - second).max(0.0);
            return (self.rise() - 0.375 * bend).max(0.0);
        }
        let (Some(height), Some(next), Some(second)) = (at(0), at(toward), at(2 * toward)) else { return self.rise() };
        let beside = 2.0 * next - height - second;
        let curvature = self.curvature.min((2.0 * beside).max(STEEP * (height - next)));
        let top = if curvature > 0.0 { (0.5 + (next - height) / curvature).max(0.0) } else { 0.0 };
        0.5 * curvature * top * top * self.of_shorter_wave(at) + UNSURE * 0.125 * curvature
    }

    /// Ratio of the rise by the derivatives of five samples to that by three, from 1 to 2.
    ///
    /// A parabola through samples a quarter of a wave apart rises by 0.6 of the summit, and five samples by 0.9.
    fn of_shorter_wave(&self, at: impl Fn(isize) -> Option<f64>) -> f64 {
        let (Some(before), Some(behind)) = (at(-2), at(2)) else { return 1.0 };
        let height = at(0).unwrap_or(0.0);
        let slope = (16.0 * self.slope - (behind - before)) / 12.0;
        let curvature = (16.0 * self.curvature - (2.0 * height - before - behind)) / 12.0;
        let rise = self.rise();
        if curvature > 0.0 && rise > 0.0 { (0.5 * slope * slope / (curvature * rise)).clamp(1.0, 2.0) } else { 1.0 }
    }
}

/// The quadratic function through a sample and its eight neighbours.
struct Fit {
    lines: [Line; 2],
    /// Place of its maximum, in steps from the sample.
    top: DVec2,
    /// Its maximum above the sample.
    rise: f64,
}

impl Fit {
    fn of(at: &dyn Fn(isize, isize) -> Option<f64>) -> Self {
        let lines = [Line::of(|i| at(i, 0)), Line::of(|i| at(0, i))];
        let [x, y] = &lines;
        let diagonals = [at(1, 1), at(-1, 1), at(1, -1), at(-1, -1)];
        let twist = if let [Some(a), Some(b), Some(c), Some(d)] = diagonals { 0.25 * (a - b - c + d) } else { 0.0 };
        let determinant = x.curvature * y.curvature - twist * twist;
        let [along_x, along_y] = [y.curvature * x.slope + twist * y.slope, x.curvature * y.slope + twist * x.slope]
            .map(|top| top / determinant);
        if determinant > 0.0 && x.curvature > 0.0 && along_x.abs().max(along_y.abs()) <= 1.0 {
            let rise = 0.5 * (x.slope * along_x + y.slope * along_y);
            return Self { top: DVec2::new(along_x, along_y), rise, lines };
        }
        Self { top: DVec2::new(x.top(), y.top()), rise: x.rise() + y.rise(), lines }
    }

    /// The rise above a sample of a map, on which slopes may jump.
    fn rise_of_map(at: &dyn Fn(isize, isize) -> Option<f64>) -> f64 {
        let Self { lines: [x, y], rise, .. } = Self::of(at);
        let of_lines = x.rise() + y.rise();
        let limited = x.rise_of_map(|i| at(i, 0)) + y.rise_of_map(|i| at(0, i));
        // The ratio is that of a ridge across the axes.
        if of_lines > 0.0 { limited * (rise / of_lines) } else { 0.0 }
    }
}

#[cfg(test)]
mod tests {
    use std::f64::consts::TAU;

    use rc_core::Grid;

    use super::*;

    /// Waves along x and y with this number of periods. The maximum is 2, at a place between samples.
    struct EggBox(usize);

    impl HeightField for EggBox {
        fn height(&self, at: DVec2) -> f64 {
            let wave = |x: f64| (TAU * self.0 as f64 * (x - 0.137)).cos();
            wave(at.x) + wave(at.y + 0.4)
        }

        fn band_limit(&self) -> Option<usize> {
            Some(self.0)
        }
    }

    fn sampled(n: usize, height: impl Fn(DVec2) -> f64) -> Field {
        Field::from_fn(Grid::square(n).expect("a grid"), height)
    }

    fn of_map(map: &Field, boundary: Boundary) -> Summit {
        Summit::on_grid(None, (map, map.max()), boundary)
    }

    #[test]
    fn the_summit_of_a_surface_is_found_between_samples() {
        for (waves, n) in [(1, 4), (3, 12), (3, 13), (5, 64), (7, 30)] {
            let (surface, grid) = (EggBox(waves), Grid::square(n).expect("a grid"));
            for boundary in [Boundary::Periodic, Boundary::Free] {
                let samples = surface.sample(grid);
                let found = Summit::on_grid(Some(&surface), (&samples, samples.max()), boundary);
                let excess = 2.0 - found.sampled;
                assert!((found.excess / excess - 1.0).abs() < 1e-3, "{waves} waves on {n}²: {found:?}");
            }
        }
    }

    #[test]
    fn the_summit_of_a_map_is_estimated_not_too_low() {
        for (waves, n) in [(1, 8), (1, 17), (3, 29), (5, 64)] {
            let map = EggBox(waves).sample(Grid::square(n).expect("a grid"));
            let found = of_map(&map, Boundary::Periodic);
            let excess = 2.0 - found.sampled;
            // All summits are equally high. That with the largest error of its fit counts, which is a part of the
            // largest distance to a sample.
            let of_fit = (0.03 + OF_FIT * UNSURE) * 2.0 * (1.0 - (0.5 * TAU * waves as f64 / n as f64).cos());
            let allowed = 0.95 * excess..1.5 * excess + of_fit;
            assert!(allowed.contains(&found.excess), "{waves} waves on {n}²: {found:?}, {allowed:?}");
        }
        // A ridge across the axes.
        let ridge = sampled(64, |at| {
            let (along, across) = (at.x + at.y - 0.97, at.x - at.y + 0.013);
            (1.5 * TAU * along).cos() + (4.0 * TAU * across).cos()
        });
        let found = of_map(&ridge, Boundary::Free);
        // Both waves bend the heights along both axes.
        let bend: f64 = [1.5, 4.0].map(|waves| 2.0 * (1.0 - (waves * TAU / 64.0).cos())).iter().sum();
        let (excess, unsure) = (2.0 - found.sampled, OF_FIT * UNSURE * 2.0 * 0.125 * bend);
        assert!((0.95 * excess..2.0 * excess + unsure).contains(&found.excess), "{found:?}");
    }

    /// A slope that ends at a border is half an element higher there.
    #[test]
    fn borders_may_be_higher_than_samples() {
        let slope = |at: DVec2| at.x + 0.5 * at.y;
        let found = of_map(&sampled(16, slope), Boundary::Free);
        assert!((found.sampled + found.excess / OF_FIT - 1.5).abs() < 1e-12, "{found:?}");
    }

    #[test]
    fn plateaus_and_single_samples_have_no_summit_above_them() {
        let block = |at: DVec2| if (at - 0.5).abs().max_element() < 0.3 { 1.0 } else { 0.0 };
        let peak = |at: DVec2| if (at - 17.0 / 32.0).length() < 1e-3 { 1.0 } else { 0.0 };
        for map in [sampled(16, block), sampled(16, peak), sampled(16, |_| 0.3)] {
            for boundary in [Boundary::Periodic, Boundary::Free] {
                assert_eq!(of_map(&map, boundary), Summit { sampled: map.max(), excess: 0.0 });
            }
        }
    }

    /// Beyond the neighbour, the heights of this ridge bend upward.
    #[test]
    fn a_ridge_of_short_waves_has_a_summit_between_samples() {
        let ridge =
            |at: DVec2| (TAU * at.x + 0.3).cos() + 0.9 * (2.0 * TAU * at.x - 0.4).cos() + (3.0 * TAU * at.x).cos();
        let summit = sampled(4096, ridge).max();
        let found = of_map(&sampled(12, ridge), Boundary::Periodic);
        let excess = summit - found.sampled;
        assert!((0.8 * excess..2.0 * excess).contains(&found.excess), "{found:?}, {excess}");
    }
}
